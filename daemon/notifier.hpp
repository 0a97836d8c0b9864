// Reports the daemon's state to the service manager (systemd). Without a service manager, nothing happens.
#pragma once

#include <string>

#include "base/latency_histogram.hpp"
#include "base/time.hpp"
#include "bus/decision_change.hpp"
#include "loop/cycle_report.hpp"

namespace lpvmpcd {

class Notifier {
 public:
  Notifier();

  void Ready();
  // Starts a reload; Ready ends it.
  void Reloading();
  void Stopping();
  // `remark` is appended to every status text from now on; empty for none.
  void SetRemark(std::string remark) { remark_ = std::move(remark); }
  // Sends mode, fault, the present decision about other things on the road and latencies: at once when one of the first
  // three changes, otherwise once a second. If the watchdog is enabled, only this call feeds it: a daemon without cycles is
  // to be restarted.
  void Cycle(const loop::CycleReport& report, const base::Latencies& latencies, base::Time now);

 private:
  std::string remark_;
  base::Time watchdog_period_{};  // 0: no watchdog
  base::Time last_watchdog_{};
  base::Time last_status_{};
  bus::Mode mode_ = bus::Mode::kInit;
  bus::FaultCode fault_ = bus::FaultCode::kNone;
  bus::DecisionChange decision_;
  std::string decided_;  // the last decision in words; empty while commands are disabled
  bool fed_ = false;
  bool reported_ = false;
};

}  // namespace lpvmpcd
