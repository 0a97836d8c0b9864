#include "daemon/service.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <spdlog/spdlog.h>
#include <stdexcept>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <thread>

namespace lpvmpcd {
namespace {

using namespace std::chrono_literals;

constexpr int kFramesAtOnce = 256;  // then the timer and the signals have their turn
constexpr Time kRetryPeriod = 100ms;

[[nodiscard]] int Checked(int result, const char* call) {
  if (result < 0) {
    throw std::runtime_error(std::string(call) + ": " + std::strerror(errno));
  }
  return result;
}

Time Read(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

int BlockedSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  return Checked(::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC), "signalfd");
}

int NewTimer() {
  return Checked(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC), "timerfd_create");
}

// Once after `first`, then every `every`; never if both are 0.
void Set(const FileDescriptor& timer, Time first, Time every) {
  const auto to_timespec = [](Time time) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
    return timespec{.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
  };
  const itimerspec spec{.it_interval = to_timespec(every), .it_value = to_timespec(first)};
  static_cast<void>(Checked(::timerfd_settime(timer.get(), 0, &spec, nullptr), "timerfd_settime"));
}

// False if it had been set anew before it was read.
bool Expired(const FileDescriptor& timer) {
  std::uint64_t times = 0;
  return ::read(timer.get(), &times, sizeof(times)) == sizeof(times);
}

can::SocketOptions Options(const ControlLoop& loop) {
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

Time MonotonicNow() {
  return Read(CLOCK_MONOTONIC);
}

Service::Service(const ServiceSettings& settings, ControlLoop& loop)
    : settings_(settings),
      loop_(&loop),
      socket_(settings.interface, Options(loop)),
      signals_(BlockedSignals()),
      timer_(NewTimer()),
      retry_timer_(NewTimer()),
      epoll_(Checked(::epoll_create1(EPOLL_CLOEXEC), "epoll_create1")),
      transmitter_(loop.gate(), [this](const can::Frame& frame) { return socket_.Send(frame); }),
      last_empty_(MonotonicNow()) {
  for (const int fd : {socket_.fd(), signals_.get(), timer_.get(), retry_timer_.get()}) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = fd;
    static_cast<void>(Checked(::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event), "epoll_ctl"));
  }
}

void Service::Run() {
  spdlog::info("listening on {}{}", settings_.interface, settings_.lockstep ? " in lock step" : "");
  notifier_.Ready();
  Set(timer_, settings_.timeout, 0s);
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
    if (ready(signals_.get())) {
      break;
    }
    // The socket before the timer: a state that has come in the meantime sets the timer anew.
    if (ready(socket_.fd())) {
      ReadSocket();
    }
    if (ready(timer_.get()) && Expired(timer_)) {
      ReactToTimer();
    }
    if (ready(retry_timer_.get()) && Expired(retry_timer_)) {
      Retry();
    }
  }
  notifier_.Stopping();
  SendLastWords();
  spdlog::info("stopped after {} cycles, {} deadline misses", loop_->report().cycles,
               loop_->report().deadline_misses);
}

Time Service::Now() const {
  return settings_.lockstep ? cycles_ * settings_.period : MonotonicNow();
}

Time Service::Received(const can::Frame& frame) const {
  if (settings_.lockstep) {
    return Now();
  }
  return ArrivalTime(MonotonicNow(), Read(CLOCK_REALTIME) - frame.timestamp, last_empty_);
}

void Service::ReadSocket() {
  const Time before = MonotonicNow();
  can::Received received;
  for (int i = 0; i < kFramesAtOnce; ++i) {
    switch (socket_.Receive(received)) {
      case can::ReceiveStatus::kFrame:
        if (loop_->Receive(received.frame, Received(received.frame))) {
          RunCycle(Trigger::kState);
        }
        break;
      case can::ReceiveStatus::kWouldBlock:
        last_empty_ = before;
        return;
      case can::ReceiveStatus::kInterfaceDown:
        SetBus(BusState::kDown, "is down");
        return;
      case can::ReceiveStatus::kInterfaceGone:
        SetBus(BusState::kGone, "is gone");
        return;
      case can::ReceiveStatus::kError:
        SetBus(BusState::kDown, std::strerror(socket_.last_error()));
        return;
    }
  }
}

void Service::ReactToTimer() {
  if (settings_.lockstep && cycles_ == 0) {
    Send(loop_->Announce());  // the vehicle waits for a sign of life before its first state
    Set(timer_, settings_.period, 0s);
  } else {
    RunCycle(Trigger::kTimer);
  }
}

void Service::RunCycle(Trigger trigger) {
  Send(loop_->Cycle(Now(), trigger));
  Arm(trigger);
  const Time now = MonotonicNow();
  log_.Cycle(*loop_, trigger, now);
  log_.Dropped(socket_.dropped(), now);
  log_.Unsent(transmitter_.unsent(), now);
  notifier_.Cycle(loop_->report(), now);
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

// The last words matter most: a queue that is full for a moment must not swallow them.
void Service::SendLastWords() {
  const auto wait = [] { std::this_thread::sleep_for(1ms); };
  if (!transmitter_.SendLast(loop_->Disable(), wait)) {
    spdlog::error("the last commands, not enabled, could not be sent on {}", settings_.interface);
  }
}

void Service::Arm(Trigger last) {
  if (settings_.lockstep) {
    Set(timer_, kLockstepTimeout, 0s);
  } else {
    Set(timer_, last == Trigger::kState ? settings_.timeout : settings_.period, 0s);
  }
}

void Service::SetBus(BusState bus, const char* what) {
  if (bus == bus_) {
    return;
  }
  spdlog::log(bus > bus_ ? spdlog::level::err : spdlog::level::info, "{} {}", settings_.interface, what);
  const Time retry = bus == BusState::kGone ? kRetryPeriod : 0s;
  Set(retry_timer_, retry, retry);
  bus_ = bus;
  loop_->SetBusUp(bus == BusState::kUp);
}

void Service::Retry() {
  if (socket_.Reopen()) {
    SetBus(BusState::kDown, "is back");  // up as soon as commands go out
  }
}

}  // namespace lpvmpcd
