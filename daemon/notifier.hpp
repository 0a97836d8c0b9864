// Tells the service manager (systemd) how the daemon is. Without one, nothing happens.
#pragma once

#include <string>

#include "daemon/cycle_report.hpp"
#include "daemon/latency_histogram.hpp"
#include "daemon/time.hpp"

namespace lpvmpcd {

class Notifier {
 public:
  Notifier();

  void Ready();
  // Before a reload; Ready ends it.
  void Reloading();
  void Stopping();
  // The end of every status text from now on; empty for none.
  void SetRemark(std::string remark) { remark_ = std::move(remark); }
  // Mode, fault and figures: at once when mode or fault change, otherwise once a second. And the watchdog's food, if it
  // asks for it, from here alone: a daemon without cycles is to be restarted.
  void Cycle(const CycleReport& report, const Latencies& latencies, Time now);

 private:
  std::string remark_;
  Time watchdog_period_{};  // 0: no watchdog
  Time last_watchdog_{};
  Time last_status_{};
  Mode mode_ = Mode::kInit;
  dbc::FaultCode fault_ = dbc::FaultCode::kNone;
  bool fed_ = false;
  bool told_ = false;
};

}  // namespace lpvmpcd
