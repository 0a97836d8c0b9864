#include "config/route_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "config/toml_table.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/header_example.hpp"

namespace config {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class RouteFileTest : public testing::Test {
 protected:
  RouteFileTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / ("route_file." + std::string(test->name()));
    std::filesystem::create_directories(folder_);
  }
  ~RouteFileTest() override { std::filesystem::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  RouteFile Load(const std::string& text) const {
    Write("route.toml", text);
    return LoadRoute(folder_ / "route.toml");
  }
  // The error text after the folder's path.
  std::string ErrorOf(const std::string& text) const {
    try {
      (void)Load(text);
    } catch (const ConfigError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find(folder_.string()), 0u) << what;
      return what.substr(folder_.string().size() + 1);
    }
    return "no error";
  }
  std::string CsvErrorOf(const std::string& csv) const {
    Write("points.csv", csv);
    return ErrorOf("[route]\nspeed = 10\nwaypoints = \"points.csv\"\n[road]\nleft = 4\nright = 4\n");
  }

  // The route through the waypoints of a file without speeds, at 10 m/s; `more`: further lines of the route file.
  [[nodiscard]] RouteFile LoadCsv(const std::string& csv, const std::string& more = "") const {
    Write("points.csv", csv);
    return Load("[route]\nspeed = 10\nwaypoints = \"points.csv\"\n" + more);
  }
  // The error in a file of waypoints that have widths.
  std::string WidthErrorOf(const std::string& csv) const {
    Write("points.csv", csv);
    return ErrorOf("[route]\nspeed = 10\nwaypoints = \"points.csv\"\n");
  }

  std::filesystem::path folder_;
};

const std::string kHeaders =
    "\"X,Y\", \"X,Y,speed\", \"X,Y,left,right\", \"X,Y,left,right,speed\" or \"# "
    "x_m,y_m,w_tr_right_m,w_tr_left_m\"";
const std::string kHead =
    "[road]\nleft = 4\nright = 1\n[route]\nspeed = 12\nstart = {X = 0, Y = 0, psi = 0}\n";

TEST_F(RouteFileTest, PiecesFollowOneAnother) {
  const RouteFile file =
      Load(kHead +
           "pieces = [\n"
           "  {kind = \"straight\", length = 10},\n"
           "  {kind = \"clothoid\", length = 20, curvature_from = 0, curvature_to = 0.01},\n"
           "  {kind = \"arc\", length = 30, curvature = 0.01},\n"
           "  {kind = \"arc\", length = 40, radius = 50, turn = \"right\", speed = 9},\n"
           "]\n");
  EXPECT_NEAR(file.route.length(), 100.0, 1e-9);
  EXPECT_NEAR(file.route.At(20.0).curvature, 0.005, 1e-12);
  EXPECT_NEAR(file.route.At(45.0).curvature, 0.01, 1e-12);
  EXPECT_NEAR(file.route.At(80.0).curvature, -0.02, 1e-12);
  EXPECT_NEAR(file.route.At(100.0).psi, 0.1 + 0.3 - 0.8, 1e-12);
  EXPECT_NEAR(file.route.At(80.0).speed, 10.5, 1e-12);
}

TEST_F(RouteFileTest, RightEdgeIsNegativeInside) {
  const RouteFile file = Load(kHead + "pieces = [{kind = \"straight\", length = 10}]\n");
  for (const double s : {-1.0, 0.0, 3.7, 10.0, 11.0}) {
    EXPECT_EQ(file.road.At(s).left, 4.0);
    EXPECT_EQ(file.road.At(s).right, -1.0);
  }
}

TEST_F(RouteFileTest, WaypointsAreReadFromBesideTheRouteFile) {
  Write("points.csv", "X,Y\r\n0,0\r\n\r\n 30 , 40\r\n");
  const RouteFile file =
      Load("[route]\nspeed = 10\nwaypoints = \"points.csv\"\n[road]\nleft = 4\nright = 4\n");
  EXPECT_NEAR(file.route.length(), 50.0, 1e-9);
}

TEST_F(RouteFileTest, WrongValueNamesFileLineKeyAndRange) {
  EXPECT_EQ(ErrorOf(kHead + "pieces = [\n{kind = \"straight\", length = -3},\n]\n"),
            "route.toml:8: key 'route.pieces[0].length' = -3 is outside [0.01, 100000] m");
  EXPECT_EQ(ErrorOf(kHead + "pieces = [{kind = \"bend\", length = 3}]\n"),
            "route.toml:7: key 'route.pieces[0].kind' = \"bend\" must be one of \"straight\", \"arc\", "
            "\"clothoid\"");
  EXPECT_THAT(ErrorOf("[route]\nspeed = 12\nstart = {X = 0, Y = 0, psi = 0}\n"
                      "pieces = [{kind = \"straight\", length = 3}]\n[road]\nleft = -4\nright = 4\n"),
              EndsWith(":6: key 'road.left' = -4 is outside [0.1, 100] m"));
}

TEST_F(RouteFileTest, MissingAndContradictingKeysAreRefused) {
  EXPECT_THAT(ErrorOf(kHead), HasSubstr("key 'route.pieces' must hold at least one piece"));
  EXPECT_THAT(ErrorOf(kHead + "pieces = [{kind = \"arc\", length = 3}]\n"),
              HasSubstr("pieces[0].curvature' is missing"));
  EXPECT_THAT(ErrorOf(kHead + "pieces = [{kind = \"arc\", length = 3, radius = 50}]\n"),
              HasSubstr("pieces[0].turn' is missing"));
  EXPECT_THAT(ErrorOf(kHead + "pieces = [{kind = \"arc\", length = 3, radius = 50, curvature = 0.02}]\n"),
              HasSubstr("must not be given along with radius"));
  EXPECT_THAT(ErrorOf(kHead + "waypoints = \"points.csv\"\n"),
              HasSubstr("must not be given along with waypoints"));
  EXPECT_THAT(ErrorOf(kHead + "pieces = [{kind = \"straight\", length = 3, curvature = 0.02}]\n"),
              HasSubstr("unknown key 'route.pieces[0].curvature'"));
}

TEST_F(RouteFileTest, WrongWaypointNamesFileLineColumnAndValue) {
  EXPECT_EQ(CsvErrorOf("X,Y\n0,0\n1,abc\n"), "points.csv:3: column 'Y' = \"abc\" is not a number");
  EXPECT_EQ(CsvErrorOf("X,Y\nnan,0\n"), "points.csv:2: column 'X' = \"nan\" is not a number");
  EXPECT_EQ(CsvErrorOf("X,Y\n0,1 2\n"), "points.csv:2: column 'Y' = \"1 2\" is not a number");
  EXPECT_EQ(CsvErrorOf("X,Y\n0,\n"), "points.csv:2: column 'Y' = \"\" is not a number");
  EXPECT_EQ(CsvErrorOf("X,Y\n2e6,1\n"),
            "points.csv:2: column 'X' = 2000000 is outside [-1000000, 1000000] m");
  EXPECT_EQ(CsvErrorOf("X,Y\n0,1,2\n"), "points.csv:2: has 3 columns, must be X,Y");
  EXPECT_EQ(CsvErrorOf("x;y\n0,1\n"), "points.csv:1: \"x;y\" must be the header " + kHeaders);
  EXPECT_EQ(CsvErrorOf("X,Y\n0,1\n0,1\n"), "points.csv:3: waypoint 0,1 repeats its predecessor");
  EXPECT_EQ(CsvErrorOf("X,Y\n0,1\n"), "points.csv: has 1 waypoints, must be at least 2");
}

TEST_F(RouteFileTest, EdgesGoLinearlyToEachPiecesOwn) {
  const RouteFile file = Load(kHead +
                              "pieces = [\n"
                              "  {kind = \"straight\", length = 10},\n"
                              "  {kind = \"arc\", length = 20, curvature = 0.01, left = 2},\n"
                              "  {kind = \"straight\", length = 30, right = 4, speed = 9},\n"
                              "  {kind = \"straight\", length = 40},\n"
                              "]\n");
  const auto expect = [&](double s, double left, double right) {
    EXPECT_NEAR(file.road.At(s).left, left, 1e-12) << s;
    EXPECT_NEAR(file.road.At(s).right, right, 1e-12) << s;
  };
  expect(0.0, 4.0, -1.0);
  expect(10.0, 4.0, -1.0);
  expect(15.0, 3.5, -1.0);
  expect(30.0, 2.0, -1.0);
  expect(45.0, 2.0, -2.5);
  expect(60.0, 2.0, -4.0);
  expect(100.0, 2.0, -4.0);
}

TEST_F(RouteFileTest, WrongWidthOfAPieceNamesFileLineKeyAndRange) {
  EXPECT_EQ(ErrorOf(kHead + "pieces = [\n{kind = \"straight\", length = 3, left = 0},\n]\n"),
            "route.toml:8: key 'route.pieces[0].left' = 0 is outside [0.1, 100] m");
  EXPECT_EQ(ErrorOf(kHead + "pieces = [\n{kind = \"straight\", length = 3, right = -2},\n]\n"),
            "route.toml:8: key 'route.pieces[0].right' = -2 is outside [0.1, 100] m");
}

TEST_F(RouteFileTest, WaypointsMayHaveEdges) {
  const RouteFile file = LoadCsv("X,Y,left,right\n0,0,4,3\n30,0,2,3\n50,0,2,1\n");
  EXPECT_NEAR(file.road.At(15.0).left, 3.0, 1e-9);
  EXPECT_NEAR(file.road.At(15.0).right, -3.0, 1e-9);
  EXPECT_NEAR(file.road.At(40.0).left, 2.0, 1e-9);
  EXPECT_NEAR(file.road.At(40.0).right, -2.0, 1e-9);
  EXPECT_NEAR(file.route.At(40.0).speed, 10.0, 1e-12);
}

TEST_F(RouteFileTest, EdgesOfWaypointsOnABendAreWhereTheWaypointsAre) {
  const RouteFile file = LoadCsv("X,Y,left,right\n0,0,4,3\n30,20,2,3\n50,-20,5,1\n60,0,5,5\n");
  const Eigen::Vector2d waypoint(50.0, -20.0);
  const double s = file.route.Project(waypoint).s;
  EXPECT_GT(s, 82.0) << "the way is longer than the chords, 80.8 m";
  EXPECT_NEAR(file.road.At(s).left, 5.0, 1e-9);
  EXPECT_NEAR(file.road.At(s).right, -1.0, 1e-9);
}

TEST_F(RouteFileTest, WaypointsMayHaveSpeeds) {
  Write("points.csv", "X,Y,speed\n0,0,12\n30,0,6\n50,0,8\n");
  const std::string road = "[road]\nleft = 4\nright = 3\n", route = "[route]\nwaypoints = \"points.csv\"\n";
  const RouteFile file = Load(road + route);
  EXPECT_NEAR(file.route.At(15.0).speed, 9.0, 1e-9);
  EXPECT_NEAR(file.route.At(40.0).speed, 7.0, 1e-9);
  EXPECT_EQ(file.road.At(40.0).right, -3.0);
  EXPECT_EQ(ErrorOf(road + route + "speed = 10\n"),
            "route.toml:6: key 'route.speed' = 10 must not be given along with waypoints that have speeds");
  Write("points.csv", "X,Y,left,right,speed\n0,0,4,3,12\n30,0,2,3,6\n");
  const RouteFile both = Load(route);
  EXPECT_NEAR(both.route.At(15.0).speed, 9.0, 1e-9);
  EXPECT_NEAR(both.road.At(15.0).left, 3.0, 1e-9);
  EXPECT_NEAR(both.road.At(15.0).right, -3.0, 1e-9);
}

TEST_F(RouteFileTest, SpeedAndRoadAreGivenOnceAndOnlyOnce) {
  const std::string route = "[route]\nspeed = 10\nwaypoints = \"points.csv\"\n";
  Write("points.csv", "X,Y,left,right\n0,0,4,3\n30,0,2,3\n");
  EXPECT_EQ(ErrorOf(route + "[road]\nleft = 4\nright = 3\n"),
            "route.toml:4: key 'road' must not be given along with waypoints that have widths");
  EXPECT_THAT(ErrorOf("[route]\nwaypoints = \"points.csv\"\n"), HasSubstr("key 'route.speed' is missing"));
  Write("points.csv", "X,Y\n0,0\n30,0\n");
  EXPECT_THAT(ErrorOf(route), HasSubstr("key 'road.left' is missing"));
}

TEST_F(RouteFileTest, WrongWidthOrSpeedOfAWaypointNamesFileLineColumnAndValue) {
  EXPECT_EQ(WidthErrorOf("X,Y,left,right\n0,0,4,3\n1,0,-2,3\n"),
            "points.csv:3: column 'left' = -2 is outside [0.1, 100] m");
  EXPECT_EQ(WidthErrorOf("X,Y,left,right\n0,0,4,0\n"),
            "points.csv:2: column 'right' = 0 is outside [0.1, 100] m");
  EXPECT_EQ(WidthErrorOf("X,Y,left,right,speed\n0,0,4,3,0\n"),
            "points.csv:2: column 'speed' = 0 is outside [0.1, 100] m/s");
  EXPECT_EQ(WidthErrorOf("X,Y,left,right\n0,0,4,wide\n"),
            "points.csv:2: column 'right' = \"wide\" is not a number");
  EXPECT_EQ(WidthErrorOf("X,Y,left,right\n0,0,4\n"), "points.csv:2: has 3 columns, must be X,Y,left,right");
  EXPECT_EQ(WidthErrorOf("X,Y,right,left\n0,0,4,3\n"),
            "points.csv:1: \"X,Y,right,left\" must be the header " + kHeaders);
  EXPECT_EQ(WidthErrorOf("# x_m,y_m,w_tr_right_m,w_tr_left_m\n0,0,4,3\n5,0,4,-3\n"),
            "points.csv:3: column 'w_tr_left_m' = -3 is outside [0.1, 100] m");
  EXPECT_EQ(WidthErrorOf("# x_m,y_m,w_tr_right_m,w_tr_left_m\n0,0,4\n"),
            "points.csv:2: has 3 columns, must be x_m,y_m,w_tr_right_m,w_tr_left_m");
  EXPECT_EQ(WidthErrorOf("# x_m,y_m\n0,0,4,3\n"), "points.csv:2: \"0,0,4,3\" must be the header " + kHeaders);
  EXPECT_EQ(WidthErrorOf("# x_m,y_m,w_tr_right_m,w_tr_left_m\n"),
            "points.csv: has 0 waypoints, must be at least 2");
}

// A race track of 40 points on a circle of 100 m, 15.7 m apart; the width on its left is 3 m at the first point, 5 m after.
std::string RaceTrack(int points) {
  std::string text = "# A track\n# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  for (int i = 0; i < points; ++i) {
    const double angle = i * 2.0 * std::numbers::pi / 40.0;
    text += std::to_string(100.0 * std::cos(angle)) + "," + std::to_string(100.0 * std::sin(angle)) +
            ",4.5," + (i == 0 ? "3" : "5") + "\n# a comment\n";
  }
  return text;
}

TEST_F(RouteFileTest, RaceTrackIsReadAsItIsAndEndsWhereItBegins) {
  const RouteFile file = LoadCsv(RaceTrack(40));
  EXPECT_NEAR(file.route.length(), 200.0 * std::numbers::pi, 0.1);
  const control::RoutePoint start = file.route.At(0.0), end = file.route.At(file.route.length());
  EXPECT_NEAR(start.X, end.X, 1e-9);
  EXPECT_NEAR(start.Y, end.Y, 1e-9);
  EXPECT_NEAR(end.psi - start.psi, 2.0 * std::numbers::pi, 0.1) << "a natural spline is straight at its ends";
  EXPECT_NEAR(file.road.At(0.0).left, 3.0, 1e-9);
  EXPECT_NEAR(file.road.At(100.0).left, 5.0, 1e-9);
  EXPECT_NEAR(file.road.At(100.0).right, -4.5, 1e-9);
  EXPECT_NEAR(file.road.At(file.route.length()).left, 3.0, 1e-9);
}

TEST_F(RouteFileTest, RaceTrackWhoseEndsAreMoreThanThreeSpacingsApartIsOpen) {
  const double spacing = 5.0 * std::numbers::pi;
  EXPECT_NEAR(LoadCsv(RaceTrack(38)).route.length(), 200.0 * std::numbers::pi, 1.0)
      << "3 spacings, less the sagitta";
  EXPECT_NEAR(LoadCsv(RaceTrack(37)).route.length(), 36.0 * spacing, 1.0);
  EXPECT_NEAR(LoadCsv(RaceTrack(41)).route.length(), 40.0 * spacing, 1.0) << "its first point is repeated";
  EXPECT_NEAR(LoadCsv(RaceTrack(4)).route.length(), 3.0 * spacing, 0.5) << "too short to be a circuit";
}

TEST_F(RouteFileTest, OtherWaypointsAreNeverClosed) {
  const std::string square = "X,Y,left,right\n0,0,4,4\n9,0,4,4\n18,0,4,4\n18,9,4,4\n9,9,4,4\n0,9,4,4\n";
  const control::Route route = LoadCsv(square).route;
  EXPECT_NEAR(route.At(route.length()).Y, 9.0, 1e-9);
}

TEST_F(RouteFileTest, RouteThatCannotBeBuiltIsNamedWithFileLineAndPiece) {
  EXPECT_EQ(ErrorOf(kHead + "pieces = [{kind = \"arc\", length = 1e5, curvature = 0.5}]\n"),
            "route.toml:7: key 'route.pieces' gives no route: piece 0: turns too often");
  EXPECT_THAT(
      CsvErrorOf("X,Y\n0,0\n1e-300,0\n9,0\n"),
      AllOf(StartsWith("route.toml:3: key 'route.waypoints' = \"points.csv\""), HasSubstr("waypoint 1")));
}

TEST_F(RouteFileTest, RouteTooLongForMemoryIsRefused) {
  std::string csv = "X,Y\n";
  for (int i = 0; i < 1000; ++i) csv += i % 2 == 0 ? "-1e6,-1e6\n" : "1e6,1e6\n";
  EXPECT_THAT(CsvErrorOf(csv), HasSubstr("must be at most 1000000 m"));
  std::string pieces;
  for (int i = 0; i < 11; ++i) pieces += "{kind = \"straight\", length = 1e5},";
  EXPECT_THAT(ErrorOf(kHead + "pieces = [" + pieces + "]\n"), HasSubstr("must be at most 1000000 m"));
  EXPECT_THAT(ErrorOf(kHead + "pieces = [{kind = \"straight\", length = 9, speed = 0.1},\n{kind = "
                              "\"straight\", length = 1e5}]\n"),
              EndsWith("must be at most 100000 s"));
}

TEST_F(RouteFileTest, WaypointFileMayBeginWithAByteOrderMark) {
  EXPECT_EQ(CsvErrorOf("\xEF\xBB\xBFX,Y\n0,0\n9,0\n"), "no error");
}

TEST_F(RouteFileTest, ExampleOfTheHeaderIsARouteFile) {
  const RouteFile file = Load(test_support::ExampleOf("config/route_file.hpp"));
  EXPECT_NEAR(file.route.length(), 310.0, 1e-9);
  EXPECT_NEAR(file.route.At(170.0).curvature, file.route.At(230.0).curvature, 1e-12);
  EXPECT_NEAR(file.road.At(285.0).right, -4.0, 1e-9);
  EXPECT_NEAR(file.road.At(310.0).right, -3.0, 1e-9);
}

TEST_F(RouteFileTest, MissingWaypointFileIsNamed) {
  EXPECT_EQ(ErrorOf("[route]\nspeed = 10\nwaypoints = \"none.csv\"\n[road]\nleft = 4\nright = 4\n"),
            "none.csv: cannot be read: No such file or directory");
}

}  // namespace
}  // namespace config
