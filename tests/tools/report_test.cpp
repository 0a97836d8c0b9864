#include "tools/report/report.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include <nlohmann/json.hpp>

#include "sim/scenario.hpp"
#include "tests/support/temp_dir.hpp"
#include "tools/commands/run.hpp"
#include "tools/drive/drive_file.hpp"
#include "tools/report/report_data.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::filesystem::path kDemo = LPVMPC_SOURCE_DIR "/scenarios/demo";

std::string Read(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A folder as `lpvmpc run --out` writes it.
class ReportTest : public testing::Test {
 protected:
  explicit ReportTest(const std::filesystem::path& scenario = kDemo / "scenario.toml") {
    std::ostringstream out;
    tools::RunOptions options;
    options.scenario = scenario;
    options.out = run_;
    EXPECT_EQ(tools::Run(options, out), 0);
    text_ = out.str();
  }
  void Write(const char* name, const std::string& text) const { std::ofstream(run_ / name) << text; }
  // The report's error about the folder; empty if the page was written.
  [[nodiscard]] std::string Error() const {
    std::filesystem::remove(page_);
    try {
      tools::Report({.run_dir = run_, .output = page_});
    } catch (const std::exception& error) {
      EXPECT_FALSE(std::filesystem::exists(page_));
      return error.what();
    }
    EXPECT_TRUE(std::filesystem::exists(page_));
    return "";
  }
  [[nodiscard]] nlohmann::json Data() const {
    const std::string page = Read(page_);
    const std::string begin = "<script type=\"application/json\"";
    const std::size_t from = page.find('>', page.find(begin)) + 1;
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  test_support::TempDir folder_;
  const std::filesystem::path run_ = folder_.path() / "run";
  const std::filesystem::path page_ = folder_.path() / "page.html";
  std::string text_;  // that the run printed
};

// A car ahead that stops and drives on three times.
const std::filesystem::path kStopAndGo =
    LPVMPC_SOURCE_DIR "/scenarios/catalogue/033-stop-and-go/scenario.toml";
class TrafficReport : public ReportTest {
 protected:
  TrafficReport() : ReportTest(kStopAndGo) {}
};

TEST_F(TrafficReport, ObjectIsOnTheCourseWhereItTrulyWas) {
  ASSERT_EQ(Error(), "");
  const nlohmann::json drive = Data().at("drives").at("drive");
  const nlohmann::json& t = drive.at("series").at("t");
  const nlohmann::json& object = drive.at("obstacles").at(0);
  const nlohmann::json& places = object.at("places");
  const sim::Scenario scenario = sim::LoadScenario(kStopAndGo);
  EXPECT_EQ(object.at("from"), 0);
  EXPECT_EQ(object.at("to"), t.size() - 1);
  std::size_t entry = 0;
  double greatest_error_of_constant_speed = 0.0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (entry + 1 < places.at("k").size() && places.at("k").at(entry + 1) == k) ++entry;
    const double time = t.at(k), truth = sim::StateAt(scenario.motions.at(object.at("id")), time).s;
    if (truth > scenario.route.length()) break;
    ASSERT_EQ(places.at("s").at(entry).size(), 1u) << time;
    EXPECT_NEAR(places.at("s").at(entry).at(0).get<double>(), truth, 0.15) << time;
    EXPECT_NEAR(places.at("half_length").at(entry).get<double>(), scenario.obstacles[0].r_x, 0.01);
    const double first = sim::StateAt(scenario.motions.at(object.at("id")), 0.0).speed;
    greatest_error_of_constant_speed =
        std::max(greatest_error_of_constant_speed,
                 std::abs(places.at("s").at(0).at(0).get<double>() + first * time - truth));
  }
  EXPECT_GT(greatest_error_of_constant_speed, 50.0) << "the test asks for real motion";
}

TEST_F(TrafficReport, DecisionsAndTheirReasonsAreThereInWordsAsTheRunPrintedThem) {
  ASSERT_EQ(Error(), "");
  const nlohmann::json drive = Data().at("drives").at("drive");
  int waits = 0;
  for (const nlohmann::json& decision : drive.at("decisions")) {
    const std::string words =
        fmt::format("{:7.2f} s  {}: {}\n", decision.at("t").get<double>(),
                    decision.at("decision").get<std::string>(), decision.at("reason").get<std::string>());
    EXPECT_THAT(text_, HasSubstr(words));
    if (decision.at("decision") == "waits behind object 0") ++waits;
  }
  EXPECT_EQ(waits, 3) << "it stops three times";
  // While it waits, it tells the line at which it stands.
  const nlohmann::json &s = drive.at("series").at("s"), &stop = drive.at("series").at("stop");
  std::size_t lines = 0;
  for (std::size_t k = 0; k < s.size(); ++k) lines += stop.at(k).is_null() ? 0 : 1;
  EXPECT_GT(lines, 300u);
  EXPECT_LT(lines, s.size());
}

TEST_F(ReportTest, PageOfADriveHoldsItsSeriesRoadAndResult) {
  ASSERT_EQ(Error(), "");
  const nlohmann::json data = Data();
  EXPECT_EQ(data.at("title"), "demo");
  const nlohmann::json& drive = data.at("drives").at("drive");
  EXPECT_EQ(drive.at("controller"), "lpv");
  EXPECT_EQ(drive.at("obstacles").size(), 3u);
  EXPECT_EQ(drive.at("obstacles").at(0).at("shape"), "ellipse");
  const std::size_t samples = drive.at("series").at("t").size();
  EXPECT_GT(samples, 1000u);
  for (const auto& [name, series] : drive.at("series").items()) EXPECT_EQ(series.size(), samples) << name;
  EXPECT_EQ(drive.at("plans").at("k").size(), drive.at("plans").at("dX").size());
  EXPECT_GT(drive.at("plans").at("k").size(), 1000u);
  EXPECT_GT(data.at("roads").at("road").at("left").at("X").size(), 300u);
  std::vector<std::string> types;
  for (const auto& section : data.at("sections")) types.push_back(section.at("type"));
  EXPECT_EQ(types, (std::vector<std::string>{"figures", "drives", "fans"}));
  EXPECT_LT(std::filesystem::file_size(page_), 600'000u) << "a few hundred kB are promised";
}

TEST(RoadData, EdgesAreDrawnWhereTheyAre) {
  const std::array pieces{control::RoutePiece{.length = 40.0}};
  const std::array samples{control::RoadSample{.s = 10.0},
                           control::RoadSample{.s = 30.0, .bounds = {.left = 2.0, .right = -1.0}}};
  const nlohmann::ordered_json data = tools::RoadData(
      {.route = control::Route::FromPieces({}, 10.0, pieces), .road = control::RoadEdges(samples)});
  for (std::size_t i = 0; i < 21; ++i) {
    const double X = 2.0 * static_cast<double>(i), share = std::clamp((X - 10.0) / 20.0, 0.0, 1.0);
    for (const char* line : {"reference", "left", "right"}) EXPECT_EQ(data.at(line).at("X").at(i), X);
    EXPECT_NEAR(data.at("left").at("Y").at(i).get<double>(), 4.0 - 2.0 * share, 0.005 + 1e-9);
    EXPECT_NEAR(data.at("right").at("Y").at(i).get<double>(), -4.0 + 3.0 * share, 0.005 + 1e-9);
    EXPECT_EQ(data.at("reference").at("Y").at(i), 0.0);
  }
}

TEST_F(ReportTest, RunWritesTheSamePageAsReport) {
  ASSERT_EQ(Error(), "");
  EXPECT_EQ(Read(run_ / "report.html"), Read(page_));
}

TEST_F(ReportTest, ControllerOfTheDriveFileIsThatOfThePage) {
  tools::WriteDriveFile(run_, kDemo / "scenario.toml", kDemo / "lpvmpcd.toml", "lpv-standard");
  ASSERT_EQ(Error(), "");
  EXPECT_EQ(Data().at("drives").at("drive").at("controller"), "lpv-standard");
  tools::WriteDriveFile(run_, kDemo / "scenario.toml", kDemo / "lpvmpcd.toml", "pid");
  EXPECT_THAT(Error(), AllOf(HasSubstr("drive.toml:4"), HasSubstr("pid")));
}

TEST_F(ReportTest, WithoutASummaryThePageDoesWithoutItsSection) {
  std::filesystem::remove(run_ / "summary.json");
  ASSERT_EQ(Error(), "");
  EXPECT_EQ(Data().at("sections").at(0).at("type"), "drives");
}

TEST_F(ReportTest, LastLineThatCandumpDidNotFinishIsPassedOver) {
  const std::string log = Read(run_ / "candump.log");
  Write("candump.log", log.substr(0, log.size() - 2));  // an odd number of digits
  EXPECT_EQ(Error(), "");
}

TEST_F(ReportTest, WithoutPlansThereAreNoFans) {
  std::istringstream log(Read(run_ / "candump.log"));
  std::string kept, line;
  while (std::getline(log, line)) {
    if (line.find(" 212#") == std::string::npos) kept += line + '\n';  // PlannedHorizon
  }
  Write("candump.log", kept);
  ASSERT_EQ(Error(), "");
  EXPECT_EQ(Data().at("sections").size(), 2u);
}

TEST_F(ReportTest, RunPutsItsOwnPageOverThatOfAnotherRun) {
  Write("report.json", R"({"title": "old", "sections": [], "roads": {}, "drives": {}, "subtitle": ""})");
  std::ostringstream out;
  tools::RunOptions options;
  options.scenario = kDemo / "scenario.toml";
  options.out = run_;
  EXPECT_EQ(tools::Run(options, out), 0);
  ASSERT_EQ(Error(), "");
  EXPECT_EQ(Data().at("title"), "demo");
}

TEST_F(ReportTest, DataThatAreThereAreShownAsTheyAre) {
  Write("report.json", R"({"title": "paper", "sections": [], "roads": {}, "drives": {}, "subtitle": ""})");
  ASSERT_EQ(Error(), "");
  EXPECT_EQ(Data().at("title"), "paper");
}

TEST_F(ReportTest, WhatIsMissingOrWrongIsNamedAndNoPageIsLeft) {
  Write("summary.json", "{\"passed\": true");
  EXPECT_THAT(Error(), AllOf(HasSubstr("summary.json"), HasSubstr("line 1")));
  Write("summary.json", "{\"passed\": true}");
  EXPECT_THAT(Error(), AllOf(HasSubstr("summary.json"), HasSubstr("completed")));
  std::filesystem::remove(run_ / "summary.json");

  Write("report.json", "[]");
  EXPECT_THAT(Error(), AllOf(HasSubstr("report.json"), HasSubstr("no data")));
  std::filesystem::remove(run_ / "report.json");

  Write("candump.log", "(0000000000.000000) vcan0 123#11\nnonsense\n");
  EXPECT_THAT(Error(), HasSubstr("candump.log:2: "));
  Write("candump.log", "(0000000000.000000) vcan0 123#11\n");
  EXPECT_THAT(Error(), AllOf(HasSubstr("candump.log"), HasSubstr("no state")));
  std::filesystem::remove(run_ / "candump.log");
  EXPECT_THAT(Error(), AllOf(HasSubstr("candump.log"), HasSubstr("cannot be read")));

  Write("drive.toml", "scenario = \"none.toml\"\nconfig = \"none.toml\"\n");
  EXPECT_THAT(Error(), HasSubstr("none.toml"));
  std::filesystem::remove(run_ / "drive.toml");
  EXPECT_THAT(Error(), AllOf(HasSubstr("drive.toml"), HasSubstr("cannot be read")));
}

TEST_F(ReportTest, FileThatCannotBeWrittenIsNamed) {
  EXPECT_THAT([&] { tools::Report({.run_dir = run_, .output = folder_.path() / "none" / "page.html"}); },
              testing::ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("page.html"), HasSubstr("cannot be written"))));
}

}  // namespace
