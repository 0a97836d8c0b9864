#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <ranges>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "tools/falsify/falsify_result.hpp"
#include "tools/io/json_values.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

ordered_json SetupJson(const FalsifySetup& setup) {
  return {{"seed", setup.seed},
          {"budget", setup.budget},
          {"speed_m_s", {setup.ranges.speed.low, setup.ranges.speed.high}},
          {"mu", {setup.ranges.mu.low, setup.ranges.mu.high}},
          {"controller", setup.controller}};
}

FalsifySetup SetupOf(const ordered_json& json) {
  const auto interval = [&](const char* key) {
    return Interval{.low = json.at(key).at(0), .high = json.at(key).at(1)};
  };
  FalsifySetup setup{.seed = json.at("seed"),
                     .budget = json.at("budget"),
                     .ranges = {.speed = interval("speed_m_s"), .mu = interval("mu"), .traffic = true},
                     .controller = json.at("controller")};
  CheckSetup(setup);
  return setup;
}

ordered_json FindingJson(const std::optional<Finding>& finding) {
  if (!finding) return nullptr;
  return {{"margin_m", finding->margin},      {"outcome", NameOf(finding->outcome)}, {"why", finding->why},
          {"possible", NameOf(finding->way)}, {"description", finding->description}, {"key", finding->key}};
}

std::optional<Finding> FindingOf(const ordered_json& json) {
  using enum PossibleWay;
  if (json.is_null()) return std::nullopt;
  return Finding{.key = json.at("key"),
                 .margin = json.at("margin_m"),
                 .outcome = Named(kAllOutcomes, json.at("outcome").get<std::string>()),
                 .why = json.at("why"),
                 .way = Named(std::array{kPass, kStop, kNone}, json.at("possible").get<std::string>()),
                 .description = json.at("description")};
}

ordered_json SearchesJson(const FalsifyResult& result) {
  ordered_json searches = ordered_json::array();
  for (const FalsifySearch& search : result.searches) {
    ordered_json least = ordered_json::array();
    for (const std::optional<double>& margin : search.least) least.push_back(OrNull(margin));
    searches.push_back({{"index", search.index},
                        {"drives", result.setup.DrivesOf(search.index)},
                        {"impossible", search.impossible},
                        {"violated", search.violated},
                        {"least_margin_m", least},
                        {"worst", FindingJson(search.worst)}});
  }
  return searches;
}

FalsifySearch SearchOf(const ordered_json& json) {
  FalsifySearch search{.index = json.at("index"),
                       .impossible = json.at("impossible"),
                       .violated = json.at("violated"),
                       .least = {},
                       .worst = FindingOf(json.at("worst"))};
  for (const ordered_json& margin : json.at("least_margin_m")) search.least.push_back(NumberOrNone(margin));
  return search;
}

}  // namespace

ordered_json ToJson(const FalsifyResult& result) {
  return {{"falsify", SetupJson(result.setup)}, {"searches", SearchesJson(result)}};
}

ordered_json PartJson(const FalsifyPart& part) {
  return {{"falsify", SetupJson(part.result.setup)},
          {"shard", {{"index", part.shard.index}, {"of", part.shard.of}}},
          {"searches", SearchesJson(part.result)}};
}

FalsifyPart FalsifyPartOf(const ordered_json& json) {
  FalsifyPart part;
  part.result.setup = SetupOf(json.at("falsify"));
  part.shard = {.index = json.at("shard").at("index"), .of = json.at("shard").at("of")};
  if (part.shard.index < 1 || part.shard.index > part.shard.of)
    throw std::invalid_argument(fmt::format("shard {}/{} does not exist", part.shard.index, part.shard.of));
  for (const ordered_json& search : json.at("searches")) part.result.searches.push_back(SearchOf(search));
  if (!std::ranges::equal(part.result.searches, part.shard.Indices(part.result.setup.Searches()), {},
                          &FalsifySearch::index))
    throw std::invalid_argument("its searches are not those of its shard");
  return part;
}

}  // namespace tools
