#include "tools/catalogue/catalogue.hpp"

#include <algorithm>
#include <fmt/ranges.h>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "sim/scenario.hpp"
#include "tests/support/temp_dir.hpp"
#include "tools/catalogue/drive_catalogue.hpp"
#include "tools/catalogue/open_list.hpp"
#include "tools/io/write_file.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::ThrowsMessage;
using tools::CatalogueDrive;
using tools::CatalogueOutcome;

const std::filesystem::path kCatalogue = LPVMPC_SOURCE_DIR "/scenarios/catalogue";

TEST(TheCatalogue, HoldsWhatEachScenarioExpects) {
  const std::vector<CatalogueDrive> drives = tools::DriveCatalogue(kCatalogue, "", 2, false);
  EXPECT_GE(drives.size(), 60U);
  for (const CatalogueDrive& drive : drives) {
    EXPECT_TRUE(drive.outcome == CatalogueOutcome::kPassed || drive.outcome == CatalogueOutcome::kOpen)
        << drive.name << ", " << NameOf(drive.outcome) << ": "
        << fmt::format("{}", fmt::join(drive.failed_expectations, "; "));
  }
}

TEST(TheCatalogue, NumbersAndDescribesEachScenario) {
  std::set<std::string> numbers;
  for (const auto& entry : std::filesystem::directory_iterator(kCatalogue)) {
    if (!entry.is_directory()) continue;
    const std::string folder = entry.path().filename().string();
    const sim::Scenario scenario = sim::LoadScenario(entry.path() / "scenario.toml");
    EXPECT_EQ(folder.find_first_not_of("0123456789"), 3U) << folder;
    EXPECT_TRUE(numbers.insert(folder.substr(0, 3)).second) << folder;
    EXPECT_EQ(folder.substr(3), "-" + scenario.name);
    EXPECT_NE(scenario.description, "") << folder;
    EXPECT_TRUE(scenario.expect.min_road_margin_m) << folder;
    EXPECT_TRUE(scenario.expect.min_clearance_m || scenario.obstacles.empty()) << folder;
  }
}

// A catalogue of a drive that stops at the end of a free road as expected, and one that is expected to do without steering.
class SmallCatalogue : public testing::Test {
 protected:
  SmallCatalogue() {
    for (const char* name : {"001-good", "002-bad"}) {
      std::filesystem::copy(kCatalogue / "087-stop-at-end", folder_ / name);
    }
    const std::filesystem::path bad = folder_ / "002-bad" / "scenario.toml";
    std::string text = config::ReadTextFile(bad);
    const std::string key = "max_rms_steering_rate = ";
    text.replace(text.find(key), key.size() + 3, key + "0.0");
    tools::WriteFile(bad, text);
  }

  void Open(const std::string& lines) { tools::WriteFile(folder_ / "open.txt", lines); }
  // Returns the exit status; the text is in `out_`.
  int Drive(const std::string& filter = "") {
    out_.str("");
    return tools::Catalogue(
        {.folder = folder_.path(), .filter = filter, .jobs = 2, .json = folder_ / "out.json", .report = {}},
        out_);
  }
  [[nodiscard]] std::vector<std::string> Outcomes() const {
    std::vector<std::string> outcomes;
    for (const auto& drive : nlohmann::json::parse(config::ReadTextFile(folder_ / "out.json"))) {
      outcomes.push_back(drive.at("outcome"));
      EXPECT_EQ(drive.at("summary").at("passed"),
                outcomes.back() == "passed" || outcomes.back() == "no longer open");
    }
    return outcomes;
  }

  test_support::TempDir folder_;
  std::ostringstream out_;
};

TEST_F(SmallCatalogue, FailsIfAScenarioDoes) {
  EXPECT_EQ(Drive(), 1);
  EXPECT_THAT(Outcomes(), ElementsAre("passed", "failed"));
  EXPECT_THAT(out_.str(), HasSubstr("002-bad, failed: rms_steering_rate"));
  EXPECT_THAT(out_.str(), HasSubstr("1 passed, 1 failed, 0 open"));
}

TEST_F(SmallCatalogue, ThePageShowsEachDriveWithPurposeExpectationAndResult) {
  const std::filesystem::path file = folder_ / "page.html";
  EXPECT_EQ(
      tools::Catalogue({.folder = folder_.path(), .filter = "", .jobs = 2, .json = {}, .report = file}, out_),
      1);
  const std::string page = config::ReadTextFile(file);
  const std::size_t from = page.find('>', page.find("<script type=\"application/json\"")) + 1;
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  ASSERT_EQ(data.at("sections").size(), 3u);
  EXPECT_EQ(data.at("sections").at(0).at("rows").size(), 2u);
  const sim::Scenario scenario = sim::LoadScenario(folder_ / "001-good" / "scenario.toml");
  for (const auto& [i, title, verdict] :
       {std::tuple(1, "001-good: passed", "good"), std::tuple(2, "002-bad: failed", "bad")}) {
    const nlohmann::json& fold = data.at("sections").at(static_cast<std::size_t>(i));
    EXPECT_EQ(fold.at("title"), title);
    EXPECT_EQ(fold.at("verdict"), verdict);
    EXPECT_EQ(fold.at("paragraphs").at(0), scenario.description);
    const nlohmann::json& rows = fold.at("sections").at(0).at("rows");
    const auto row =
        std::ranges::find(rows, "rms_steering_rate", [](const auto& cells) { return cells.at(0); });
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(row->at(2).at("verdict"), verdict);
    const nlohmann::json& drive = data.at("drives").at(fold.at("sections").at(1).at("drives").at(0));
    EXPECT_TRUE(data.at("roads").contains(drive.at("road")));
    EXPECT_GT(drive.at("series").at("t").size(), 100u);
    EXPECT_EQ(drive.at("decisions").at(0).at("decision"), "drives");
  }
}

TEST_F(SmallCatalogue, AnOpenScenarioMayFail) {
  Open("002-bad: it steers\n");
  EXPECT_EQ(Drive(), 0);
  EXPECT_THAT(Outcomes(), ElementsAre("passed", "open"));
}

TEST_F(SmallCatalogue, AnOpenScenarioThatPassesIsNamed) {
  Open("001-good: nothing\n002-bad: it steers\n");
  EXPECT_EQ(Drive(), 0);
  EXPECT_THAT(Outcomes(), ElementsAre("no longer open", "open"));
  EXPECT_THAT(out_.str(), HasSubstr("1 no longer open"));
}

TEST_F(SmallCatalogue, TheFilterSelectsByName) {
  EXPECT_EQ(Drive("good"), 0);
  EXPECT_THAT(Outcomes(), ElementsAre("passed"));
  EXPECT_THAT([&] { Drive("none"); }, ThrowsMessage<std::invalid_argument>(HasSubstr("'none'")));
}

TEST_F(SmallCatalogue, AWrongListOfOpenScenariosIsRefused) {
  Open("002-bad: it steers\n");
  EXPECT_THAT(tools::LoadOpenList(folder_.path()), ElementsAre(Pair("002-bad", "it steers")));
  for (const auto& [line, reason] :
       {std::pair("001-good", "WHAT FAILS"), std::pair("001-good: ", "WHAT FAILS"),
        std::pair("003-other: x", "names no scenario"), std::pair("002-bad: x", "repeats")}) {
    Open(std::string("002-bad: it steers\n") + line + '\n');
    EXPECT_THAT(
        [&] { (void)tools::LoadOpenList(folder_.path()); },
        ThrowsMessage<std::runtime_error>(testing::AllOf(HasSubstr("open.txt:2: "), HasSubstr(reason))));
  }
}

TEST_F(SmallCatalogue, ABrokenScenarioIsNamed) {
  std::ofstream(folder_ / "001-good" / "scenario.toml", std::ios::app) << "nonsense = 1\n";
  EXPECT_THAT([&] { Drive(); }, ThrowsMessage<std::runtime_error>(HasSubstr("001-good/scenario.toml")));
}

}  // namespace
