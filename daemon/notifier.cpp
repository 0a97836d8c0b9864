#include "daemon/notifier.hpp"

#include <chrono>
#include <cstdint>
#include <spdlog/fmt/fmt.h>

#include <systemd/sd-daemon.h>

#include "base/clock.hpp"
#include "bus/names.hpp"
#include "daemon/event_log.hpp"

namespace lpvmpcd {

using namespace std::chrono_literals;

Notifier::Notifier() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) > 0) {
    watchdog_period_ = std::chrono::microseconds(microseconds);
  }
}

void Notifier::Ready() {
  sd_notify(0, "READY=1");
}

void Notifier::Reloading() {
  const auto now = std::chrono::duration_cast<std::chrono::microseconds>(base::MonotonicNow());
  sd_notifyf(0, "RELOADING=1\nMONOTONIC_USEC=%lld", static_cast<long long>(now.count()));
}

void Notifier::Stopping() {
  sd_notify(0, "STOPPING=1");
}

void Notifier::Cycle(const loop::CycleReport& report, const base::Latencies& latencies, base::Time now) {
  if (watchdog_period_ > 0s && (!fed_ || now - last_watchdog_ >= watchdog_period_ / 4)) {
    fed_ = true;
    last_watchdog_ = now;
    sd_notify(0, "WATCHDOG=1");
  }
  bool changed = report.mode != mode_ || report.fault != fault_;
  if (!bus::Drives(report.mode)) {
    decision_.Reset();
    decided_.clear();
  } else if (decision_.Take(report.manoeuvre)) {
    decided_ = bus::ManoeuvreText(report.manoeuvre) + "; ";
    changed = true;
  }
  if (reported_ && !changed && now - last_status_ < 1s) {
    return;
  }
  reported_ = true;
  last_status_ = now;
  mode_ = report.mode;
  fault_ = report.fault;
  const auto figures = [](const base::LatencyHistogram& histogram) {
    return fmt::format("p99 {:.2f} ms, max {:.2f} ms", base::Milliseconds(histogram.Percentile(0.99)),
                       base::Milliseconds(histogram.max()));
  };
  sd_notify(
      0, fmt::format("STATUS={}; {}; {}{} cycles, {} deadline misses; latency {}; step {}{}{}", Name(mode_),
                     FaultText(report), decided_, report.cycles, report.deadline_misses,
                     figures(latencies.cycle), figures(latencies.step), remark_.empty() ? "" : "; ", remark_)
             .c_str());
}

}  // namespace lpvmpcd
