#include "sim/bus_run.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <poll.h>
#include <stdexcept>
#include <thread>

#include "base/clock.hpp"
#include "sim/progress.hpp"

namespace sim {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRetry{2};  // pause between attempts to send into a full queue or a link that is down
constexpr milliseconds kPacedSendLimit{20};  // after it the cycle's other frames are lost, as on a bus
constexpr std::chrono::duration<double> kPeriod{kCycleTime};

}  // namespace

std::vector<can::Filter> ControllerFilters(const bus::VehicleBus& bus) {
  return {can::ExactStandardId(bus.Info<bus::SteeringCommand>().id),
          can::ExactStandardId(bus.Info<bus::AccelerationCommand>().id),
          can::ExactStandardId(bus.Info<bus::ControllerStatus>().id),
          can::ExactStandardId(bus.Info<bus::ConstraintReport>().id)};
}

BusRun::BusRun(const Scenario& scenario, const bus::VehicleBus& bus, can::Socket& socket, int stop_signals,
               const BusRunSettings& settings)
    : socket_(&socket),
      settings_(settings),
      vehicle_(scenario, bus),
      recorder_(scenario),
      stop_signals_(stop_signals) {}

Summary BusRun::Run() {
  WaitForController();
  if (settings_.lockstep) {
    DriveInLockStep();
  } else {
    DrivePaced();
  }
  return recorder_.Result();
}

void BusRun::ReceiveAll() {
  can::Received received;
  while (true) {
    switch (socket_->Receive(received)) {
      case can::ReceiveStatus::kFrame:
        vehicle_.Receive(received.frame);
        break;
      case can::ReceiveStatus::kInterfaceDown:
        break;
      case can::ReceiveStatus::kWouldBlock:
        return;
      case can::ReceiveStatus::kInterfaceGone:
        throw std::runtime_error(fmt::format("{}: the interface is gone", socket_->interface()));
      case can::ReceiveStatus::kError:
        throw std::runtime_error(
            fmt::format("{}: {}", socket_->interface(), std::strerror(socket_->last_error())));
    }
  }
}

template <typename Condition>
bool BusRun::HandleUntil(Clock::time_point deadline, const Condition& until) {
  while (!interrupted_) {
    ReceiveAll();
    if (until()) return true;
    const auto left = deadline - Clock::now();
    if (left <= Clock::duration::zero()) return false;
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec timeout{
        .tv_sec = seconds.count(),
        .tv_nsec = std::chrono::duration_cast<std::chrono::nanoseconds>(left - seconds).count()};
    std::array<pollfd, 2> fds{pollfd{.fd = socket_->fd(), .events = POLLIN, .revents = 0},
                              pollfd{.fd = stop_signals_, .events = POLLIN, .revents = 0}};
    if (ppoll(fds.data(), fds.size(), &timeout, nullptr) < 0 && errno != EINTR) {
      throw std::runtime_error(fmt::format("poll: {}", std::strerror(errno)));
    }
    interrupted_ = fds[1].revents != 0;
  }
  return true;
}

bool BusRun::SendCycle(Clock::time_point deadline) {
  for (const can::Frame& frame : vehicle_.Sense(base::RealNow())) {
    can::SendStatus status = socket_->Send(frame);
    while (status == can::SendStatus::kQueueFull || status == can::SendStatus::kInterfaceDown) {
      if (Clock::now() >= deadline) return false;
      std::this_thread::sleep_for(kRetry);
      status = socket_->Send(frame);
    }
    if (status == can::SendStatus::kSent) continue;
    throw std::runtime_error(fmt::format("{}: cannot send: {}", socket_->interface(),
                                         status == can::SendStatus::kInterfaceGone
                                             ? "the interface is gone"
                                             : std::strerror(socket_->last_error())));
  }
  return true;
}

void BusRun::WaitForController() {
  if (HandleUntil(Clock::now() + settings_.controller_timeout, [this] { return vehicle_.heard(); })) return;
  throw std::runtime_error(fmt::format("{}: no controller: no ControllerStatus within {:.1f} s",
                                       socket_->interface(),
                                       std::chrono::duration<double>(settings_.controller_timeout).count()));
}

void BusRun::DriveInLockStep() {
  Progress progress;
  while (!interrupted_ && !recorder_.finished()) {
    const auto deadline = Clock::now() + settings_.answer_timeout;
    if (!SendCycle(deadline) || !HandleUntil(deadline, [this] { return vehicle_.Answered(); })) {
      throw std::runtime_error(fmt::format("{}: no answer to the state at {:.2f} s within {:.1f} s",
                                           socket_->interface(), vehicle_.time(),
                                           std::chrono::duration<double>(settings_.answer_timeout).count()));
    }
    if (interrupted_) break;
    recorder_.Record(vehicle_);
    progress.Show(vehicle_, recorder_);
    vehicle_.Advance();
  }
}

void BusRun::DrivePaced() {
  Progress progress;
  const auto period = std::chrono::duration_cast<Clock::duration>(kPeriod);
  auto next = Clock::now();
  while (!interrupted_ && !recorder_.finished()) {
    (void)SendCycle(Clock::now() + kPacedSendLimit);
    next += period;
    if (const auto now = Clock::now(); now > next + period) {
      ++late_cycles_;
      next = now;  // lost time is not made up for by a burst
    }
    (void)HandleUntil(next, [] { return false; });
    if (interrupted_) break;
    recorder_.Record(vehicle_);
    progress.Show(vehicle_, recorder_);
    vehicle_.Advance();
  }
}

}  // namespace sim
