#include "daemon/event_log.hpp"

#include <chrono>
#include <spdlog/spdlog.h>
#include <string>

#include "bus/names.hpp"
#include "daemon/log.hpp"
#include "loop/violation_text.hpp"

namespace lpvmpcd {

using namespace std::chrono_literals;

bool EventCount::Due(std::uint64_t total, base::Time now, std::uint64_t& unreported) {
  if (total == reported_ || (reported_ != 0 && now - last_ < 1s)) {
    return false;
  }
  unreported = total - reported_;
  reported_ = total;
  last_ = now;
  return true;
}

void EventLog::Cycle(const loop::ControlLoop& loop, loop::Trigger trigger, base::Time now) {
  const loop::CycleReport& report = loop.report();
  const bool faulty = report.fault != bus::FaultCode::kNone;
  SetLogFields({.mode = Name(report.mode),
                .fault = faulty ? Name(report.fault) : "",
                .cause = safety::Name(report.cause)});
  if (report.mode != report.previous_mode) {
    const bool bad = report.mode == bus::Mode::kSafeStop || report.mode == bus::Mode::kFault;
    spdlog::log(bad ? spdlog::level::warn : spdlog::level::info, "mode {} -> {}: {}",
                Name(report.previous_mode), Name(report.mode), safety::Name(report.cause));
    reported_fault_ = report.fault;  // usually this is the cause, which was just logged
  } else if (!faulty) {
    reported_fault_ = report.fault;
  } else if (report.fault != reported_fault_ && now - last_fault_ >= 1s) {
    spdlog::log(bus::Commands(report.mode) ? spdlog::level::warn : spdlog::level::info, "in {}: {}",
                Name(report.mode), FaultText(report));
    reported_fault_ = report.fault;
    last_fault_ = now;
  }
  if (report.engagement_refused) {
    spdlog::warn("engagement refused: {}",
                 report.fault == bus::FaultCode::kNone
                     ? std::string("driver overrides, or inputs not healthy for long enough")
                     : FaultText(report));
  }
  if (!bus::Drives(report.mode)) {
    decision_.Reset();
  } else if (decision_.Take(report.manoeuvre)) {
    spdlog::info("{}", bus::ManoeuvreText(report.manoeuvre));
  }

  std::uint64_t n = 0;
  for (std::size_t i = 0; i < safety::kRxFaults; ++i) {
    const auto fault = static_cast<safety::RxFault>(i);
    if (rx_faults_[i].Due(loop.monitor().count(fault), now, n)) {
      spdlog::warn("{} refused: {} ({} since start)", n == 1 ? "frame" : fmt::format("{} frames", n),
                   Name(fault), loop.monitor().count(fault));
    }
  }
  if (lost_.Due(loop.monitor().lost(), now, n)) {
    spdlog::warn("frames lost on the bus: {}", n);
  }
  if (rejected_lists_.Due(loop.obstacles().rejected(), now, n)) {
    spdlog::warn("obstacle lists that do not match their objects: {}", n);
  }
  if (plans_refused_.Due(report.plans_refused, now, n)) {
    spdlog::warn("plans not accepted: {}, last: {}", n, Name(report.last_refusal));
  }
  Constraint(report, now);
  if (deadline_misses_.Due(report.deadline_misses, now, n)) {
    spdlog::warn("deadlines missed: {}", n);
  }
  if (trigger == loop::Trigger::kTimer && report.mode != bus::Mode::kInit) {
    ++timer_cycles_;
  }
  if (late_states_.Due(timer_cycles_, now, n)) {
    spdlog::warn("cycles without a new vehicle state: {}", n);
  }
}

// Logs at most once a second.
void EventLog::Constraint(const loop::CycleReport& report, base::Time now) {
  const auto& violation = report.unmet();
  if (!violation || (constraint_reported_ && now - last_constraint_ < 1s)) return;
  constraint_reported_ = true;
  last_constraint_ = now;
  const std::string text = loop::ViolationText(*violation);
  if (report.solver != bus::SolverStatus::kSolved) {
    spdlog::warn("problem not solved; constraint hardest to meet: {}", text);
  } else if (!report.rejection) {
    spdlog::info("constraint relaxed: {}", text);
  } else if (report.plan_accepted) {
    spdlog::warn("plan followed despite a violation, since the last plan is no better: {}", text);
  } else {
    spdlog::warn("plan rejected: {}", text);
  }
}

void EventLog::Dropped(std::uint64_t total, base::Time now) {
  std::uint64_t n = 0;
  if (dropped_.Due(total, now, n)) {
    spdlog::warn("receive buffer full: {} frames dropped by the kernel", n);
  }
}

void EventLog::Unsent(std::uint64_t total, base::Time now) {
  std::uint64_t n = 0;
  if (unsent_.Due(total, now, n)) {
    spdlog::warn("transmit queue full: {} frames not sent", n);
  }
}

void EventLog::Times(const base::Latencies& latencies) {
  const auto text = [](const base::LatencyHistogram& histogram) {
    if (histogram.count() == 0) return std::string("not measured");
    return fmt::format("median {:.3f} ms, p99 {:.3f} ms, max {:.3f} ms",
                       base::Milliseconds(histogram.Percentile(0.5)),
                       base::Milliseconds(histogram.Percentile(0.99)), base::Milliseconds(histogram.max()));
  };
  spdlog::info("cycle latency {}; control step {}", text(latencies.cycle), text(latencies.step));
}

std::string FaultText(const loop::CycleReport& report) {
  std::string text(Name(report.fault));
  if (report.fault != bus::FaultCode::kNone && report.faulty_message) {
    const auto& [message, reason] = *report.faulty_message;
    text += fmt::format(" ({} {})", Name(message),
                        reason ? fmt::format("refused: {}", Name(*reason)) : "missing");
  }
  return text;
}

}  // namespace lpvmpcd
