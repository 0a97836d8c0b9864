#include "config/route_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
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

  std::filesystem::path folder_;
};

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
  EXPECT_EQ(file.road.left, 4.0);
  EXPECT_EQ(file.road.right, -1.0);
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
  EXPECT_EQ(CsvErrorOf("x;y\n0,1\n"), "points.csv:1: \"x;y\" must be the header \"X,Y\"");
  EXPECT_EQ(CsvErrorOf("X,Y\n0,1\n0,1\n"), "points.csv:3: waypoint 0,1 repeats its predecessor");
  EXPECT_EQ(CsvErrorOf("X,Y\n0,1\n"), "points.csv: has 1 waypoints, must be at least 2");
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
}

TEST_F(RouteFileTest, MissingWaypointFileIsNamed) {
  EXPECT_EQ(ErrorOf("[route]\nspeed = 10\nwaypoints = \"none.csv\"\n[road]\nleft = 4\nright = 4\n"),
            "none.csv: cannot be read: No such file or directory");
}

}  // namespace
}  // namespace config
