#include "daemon/reload.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <spdlog/spdlog.h>
#include <utility>

#include "daemon/log.hpp"
#include "loop/config_tables.hpp"

namespace lpvmpcd {

std::vector<std::string> ChangedKeys(const loop::Config& before, const loop::Config& after) {
  std::vector<std::pair<std::string, std::string>> differences;
  std::ranges::set_symmetric_difference(before.written, after.written, std::back_inserter(differences));
  std::vector<std::string> keys;
  keys.reserve(differences.size());
  for (auto& [key, value] : differences) {
    keys.push_back(std::move(key));
  }
  keys.erase(std::ranges::unique(keys).begin(), keys.end());  // a key whose value differs occurs twice
  return keys;
}

std::string_view WhyNot(std::string_view key, bool commanding) {
  switch (loop::ReloadOf(key)) {
    case loop::Reload::kAlways:
      return "";
    case loop::Reload::kWhileNotCommanding:
      return commanding ? "cannot change while commands are enabled" : "";
    case loop::Reload::kNeedsRestart:
      break;
  }
  return "needs a restart";
}

Reloader::Reloader(loop::Config now, std::function<loop::Config()> load, loop::ControlLoop& loop)
    : now_(std::move(now)), load_(std::move(load)), loop_(&loop) {}

void Reloader::Reload() {
  try {
    loop::Config next = load_();
    const std::vector<std::string> changed = ChangedKeys(now_, next);
    std::vector<std::string> refused;
    for (const std::string& key : changed) {
      const std::string_view why = WhyNot(key, bus::Commands(loop_->report().mode));
      if (!why.empty()) {
        refused.push_back(fmt::format("{} {}", key, why));
      }
    }
    if (!refused.empty()) {
      spdlog::error("configuration not reloaded: {}", fmt::join(refused, ", "));
      return;
    }
    loop_->Reconfigure(next.loop);
    // Logged before the level is set, which may hide the line.
    spdlog::info("configuration reloaded: {}",
                 changed.empty() ? "nothing has changed" : fmt::format("{}", fmt::join(changed, ", ")));
    SetLogLevel(next.log_level);
    now_ = std::move(next);
  } catch (const std::exception& error) {
    spdlog::error("configuration not reloaded: {}", error.what());
  }
}

}  // namespace lpvmpcd
