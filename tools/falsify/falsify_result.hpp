// The result of a falsification, or of a part of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/falsify/falsify_drive.hpp"
#include "tools/falsify/falsify_setup.hpp"
#include "tools/shards/shard.hpp"

namespace tools {

struct FalsifySearch {
  int index = 0;                             // from 0
  int impossible = 0;                        // drives that do not count, because there was no way
  int violated = 0;                          // drives with a negative margin that count
  std::vector<std::optional<double>> least;  // margin of each generation [m]; none: no drive of it counted
  std::optional<Finding> worst;              // none: no drive counted
};

struct FalsifyResult {
  FalsifySetup setup;
  std::vector<FalsifySearch> searches;  // by increasing index
};

struct FalsifyPart {
  FalsifyResult result;  // the shard's searches only
  Shard shard;
};

// The worst of each search, by increasing margin; `most` of them.
[[nodiscard]] std::vector<const FalsifySearch*> Worst(const FalsifyResult& result, std::size_t most);

// Text for a terminal, with the `most` worst.
[[nodiscard]] std::string ToText(const FalsifyResult& result, std::size_t most);
// {"falsify", "searches"}: reproducible, whatever the number of processes.
[[nodiscard]] nlohmann::ordered_json ToJson(const FalsifyResult& result);
// Likewise, with the shard.
[[nodiscard]] nlohmann::ordered_json PartJson(const FalsifyPart& part);
// Throws nlohmann::json::exception if a member is missing or of another type; std::invalid_argument if a value is
// impossible or the searches are not those of the shard.
[[nodiscard]] FalsifyPart FalsifyPartOf(const nlohmann::ordered_json& json);

}  // namespace tools
