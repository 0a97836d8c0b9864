#include "daemon/service.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <spdlog/spdlog.h>
#include <stdexcept>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <thread>
#include <utility>
#include <vector>

#include "base/signals.hpp"
#include "base/system_call.hpp"
#include "can/interface.hpp"

namespace lpvmpcd {
namespace {

using namespace std::chrono_literals;

constexpr int kFramesAtOnce = 4096;  // more than a full receive buffer holds; afterwards the timer is served
constexpr base::Time kRetryPeriod = 100ms;

can::SocketOptions Options(const loop::ControlLoop& loop) {
  can::SocketOptions options;
  for (const std::uint32_t id : loop.monitor().Ids()) {
    options.filters.push_back(can::ExactStandardId(id));
  }
  options.receive_buffer_bytes = 2 * 1024 * 1024;
  return options;
}

const char* WhyDown(can::SendStatus status, int error) {
  switch (status) {
    case can::SendStatus::kQueueFull:
      return "does not send";
    case can::SendStatus::kInvalidFrame:
      return "refuses our frames";
    case can::SendStatus::kError:
      return std::strerror(error);
    case can::SendStatus::kSent:
    case can::SendStatus::kInterfaceDown:
    case can::SendStatus::kInterfaceGone:
      break;
  }
  return "is down";
}

}  // namespace

Service::Service(const loop::ServiceSettings& settings, loop::ControlLoop& loop, std::function<void()> reload)
    : settings_(settings),
      loop_(&loop),
      reload_(std::move(reload)),
      socket_(settings.interface, Options(loop)),
      signals_(base::BlockSignals({SIGTERM, SIGINT, SIGUSR1, SIGHUP})),
      epoll_(base::Checked(::epoll_create1(EPOLL_CLOEXEC), "epoll_create1")),
      transmitter_(
          loop.gate(), [this](const can::Frame& frame) { return socket_.Send(frame); }, base::MonotonicNow),
      last_empty_(base::MonotonicNow()) {
  if (settings_.lockstep && !can::IsVirtual(settings_.interface)) {
    throw std::runtime_error("interface \"" + settings_.interface +
                             "\" is not virtual (vcan, vxcan), and lock step is for simulation only");
  }
  for (const int fd : {socket_.fd(), signals_.get(), timer_.fd(), retry_timer_.fd()}) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = fd;
    static_cast<void>(base::Checked(::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event), "epoll_ctl"));
  }
}

void Service::Run() {
  BecomeRealTime();
  spdlog::info("listening on {}{}", settings_.interface, settings_.lockstep ? " in lock step" : "");
  notifier_.Ready();
  timer_.Set(settings_.timeout);
  for (;;) {
    std::array<epoll_event, 4> events{};
    const int n = ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()), -1);
    if (n < 0 && errno != EINTR) {
      throw std::runtime_error(std::string("epoll_wait: ") + std::strerror(errno));
    }
    const auto ready = [&](int fd) {
      return std::any_of(events.begin(), events.begin() + std::max(n, 0),
                         [fd](const epoll_event& event) { return event.data.fd == fd; });
    };
    if (ready(signals_.get()) && !ReactToSignals()) {
      break;
    }
    // The socket is served before the timer: a state that has arrived in the meantime sets the timer again.
    if (ready(socket_.fd())) {
      ReadSocket();
    }
    if (ready(timer_.fd()) && timer_.Expired()) {
      ReactToTimer();
    }
    if (ready(retry_timer_.fd()) && retry_timer_.Expired()) {
      Retry();
    }
  }
  notifier_.Stopping();
  SendLastWords();
  spdlog::info("stopped after {} cycles, {} deadline misses", loop_->report().cycles,
               loop_->report().deadline_misses);
  EventLog::Times(latencies_);
}

void Service::BecomeRealTime() {
  const RealTimeOutcome outcome = ApplyRealTime(settings_.real_time);
  std::vector<std::string> refused;
  for (const auto& [what, why] : outcome.refused) {
    spdlog::warn("real time: {} refused: {}", what, why);
    refused.push_back(what);
  }
  if (!refused.empty()) {
    notifier_.SetRemark(fmt::format("real time: refused {}", fmt::join(refused, ", ")));
  }
  if (!outcome.granted.empty()) {
    spdlog::info("real time: {}", fmt::join(outcome.granted, ", "));
  }
}

bool Service::ReactToSignals() {
  signalfd_siginfo signal{};
  while (::read(signals_.get(), &signal, sizeof(signal)) == sizeof(signal)) {
    switch (signal.ssi_signo) {
      case SIGUSR1:
        EventLog::Times(latencies_);
        break;
      case SIGHUP:
        notifier_.Reloading();
        reload_();
        notifier_.Ready();
        break;
      default:
        return false;
    }
  }
  return true;
}

base::Time Service::Now() const {
  return settings_.lockstep ? cycles_ * settings_.period : base::MonotonicNow();
}

// If several states wait after a pause, only the newest is answered: commands for the others would be late.
void Service::ReadSocket() {
  const base::Time before = base::MonotonicNow();
  bool complete = false;
  can::Received received;
  for (int i = 0; i < kFramesAtOnce; ++i) {
    const can::ReceiveStatus status = socket_.Receive(received);
    if (status != can::ReceiveStatus::kFrame) {
      ReactToEmptyQueue(status, before);
      break;
    }
    const base::Time arrival =
        base::ArrivalTime(base::MonotonicNow(), base::RealNow() - received.frame.timestamp, last_empty_);
    if (loop_->Receive(received.frame, settings_.lockstep ? Now() : arrival)) {
      complete = true;
      state_arrival_ = arrival;
    }
  }
  if (complete) {
    RunCycle(loop::Trigger::kState);
  }
}

void Service::ReactToEmptyQueue(can::ReceiveStatus status, base::Time before) {
  switch (status) {
    case can::ReceiveStatus::kFrame:
      break;
    case can::ReceiveStatus::kWouldBlock:
      last_empty_ = before;
      break;
    case can::ReceiveStatus::kInterfaceDown:
      SetBus(BusState::kDown, "is down");
      break;
    case can::ReceiveStatus::kInterfaceGone:
      SetBus(BusState::kGone, "is gone");
      break;
    case can::ReceiveStatus::kError:
      SetBus(BusState::kDown, std::strerror(socket_.last_error()));
      break;
  }
}

void Service::ReactToTimer() {
  if (settings_.lockstep && cycles_ == 0) {
    Send(loop_->Announce());  // the simulated vehicle waits for a status before it sends its first state
    timer_.Set(settings_.period);
  } else {
    RunCycle(loop::Trigger::kTimer);
  }
}

void Service::RunCycle(loop::Trigger trigger) {
  Send(loop_->Cycle(Now(), trigger));
  Arm(trigger);
  if (trigger == loop::Trigger::kState && transmitter_.commands_left()) {
    const base::Time latency = *transmitter_.commands_left() - state_arrival_;
    latencies_.cycle.Add(latency);
    loop_->SetCycleLatency(latency);
  }
  if (loop_->report().solver != bus::SolverStatus::kNone) {
    latencies_.step.Add(loop_->report().step_time);
  }
  const base::Time now = base::MonotonicNow();
  log_.Cycle(*loop_, trigger, now);
  log_.Dropped(socket_.dropped(), now);
  log_.Unsent(transmitter_.unsent(), now);
  notifier_.Cycle(loop_->report(), latencies_, now);
  ++cycles_;
}

void Service::Send(std::span<const can::Frame> frames) {
  switch (transmitter_.Send(frames)) {
    case BusState::kUp:
      SetBus(BusState::kUp, "is up");
      break;
    case BusState::kGone:
      SetBus(BusState::kGone, "is gone");
      break;
    case BusState::kDown:
      SetBus(BusState::kDown, WhyDown(transmitter_.last_status(), socket_.last_error()));
      break;
  }
}

// The last commands matter most: they are retried while the queue is full.
void Service::SendLastWords() {
  const auto wait = [] { std::this_thread::sleep_for(1ms); };
  if (!transmitter_.SendLast(loop_->Disable(), wait)) {
    spdlog::error("the final, disabled commands could not be sent on {}", settings_.interface);
  }
}

void Service::Arm(loop::Trigger last) {
  if (settings_.lockstep) {
    timer_.Set(kLockstepTimeout);
  } else {
    timer_.Set(last == loop::Trigger::kState ? settings_.timeout : settings_.period);
  }
}

void Service::SetBus(BusState bus, const char* what) {
  if (bus == bus_) {
    return;
  }
  spdlog::log(bus > bus_ ? spdlog::level::err : spdlog::level::info, "{} {}", settings_.interface, what);
  const base::Time retry = bus == BusState::kGone ? kRetryPeriod : 0s;
  retry_timer_.Set(retry, retry);
  bus_ = bus;
  loop_->SetBusUp(bus == BusState::kUp);
}

void Service::Retry() {
  if (socket_.Reopen()) {
    SetBus(BusState::kDown, "is back");  // up as soon as commands are sent
  }
}

}  // namespace lpvmpcd
