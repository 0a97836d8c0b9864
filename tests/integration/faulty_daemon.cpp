// lpvmpcd whose controller fails as specified in the environment: the real service and loop on a real bus, for tests.
//
//   LPVMPC_TEST_FAULT="KIND FIRST COUNT"    steps FIRST .. FIRST + COUNT − 1 of the controller, counted from 1, are
//     unsolved    reported as infeasible by the solver
//     rejected    solved, but with a NaN in the plan
//     late        delayed by 70 ms
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "config/route_file.hpp"
#include "control/mpc/lpv_mpc.hpp"
#include "control/mpc/timed_controller.hpp"
#include "daemon/log.hpp"
#include "daemon/service.hpp"
#include "loop/assembly.hpp"

namespace {

struct Fault {
  std::string kind;
  int first = 0;
  int count = 0;
};

class FaultyController : public control::TrackingController {
 public:
  FaultyController(const loop::Config& config, Fault fault)
      : sound_(config.vehicle, config.mpc), fault_(std::move(fault)) {}

  int horizon() const override { return sound_.horizon(); }
  const control::Plan& Step(const control::TrackingInput& input) override {
    plan_ = sound_.Step(input);
    ++step_;
    if (step_ < fault_.first || step_ >= fault_.first + fault_.count) return plan_;
    if (fault_.kind == "unsolved") plan_.status = control::SolverStatus::kInfeasible;
    if (fault_.kind == "rejected") plan_.u[1][control::kDelta] = std::numeric_limits<double>::quiet_NaN();
    if (fault_.kind == "late") std::this_thread::sleep_for(std::chrono::milliseconds(70));
    return plan_;
  }
  void Reset() override { sound_.Reset(); }

 private:
  control::LpvMpc sound_;
  control::Plan plan_;
  Fault fault_;
  int step_ = 0;
};

Fault FaultFromEnvironment() {
  const char* text = std::getenv("LPVMPC_TEST_FAULT");
  Fault fault;
  std::istringstream in(text == nullptr ? "" : text);
  if (!(in >> fault.kind >> fault.first >> fault.count)) throw std::runtime_error("no LPVMPC_TEST_FAULT");
  return fault;
}

}  // namespace

// Arguments as passed by scripts/drive: --config FILE --interface IF [--lockstep]
int main(int argc, char** argv) {
  try {
    if (argc < 5) throw std::runtime_error("too few arguments");
    loop::Config config = loop::LoadConfig(argv[2]);
    config.service.interface = argv[4];
    loop::SelectController(config, "lpv");
    if (argc > 5) loop::SelectLockstep(config);
    loop::Assembly assembly(config, config::LoadRoute(config.route), base::MonotonicNow,
                            [](const loop::Config& of, const loop::Road& road) {
                              auto faulty = std::make_unique<FaultyController>(of, FaultFromEnvironment());
                              return std::make_unique<control::TimedController>(
                                  std::move(faulty), road.reference, road.profile.edges());
                            });
    lpvmpcd::OpenLog(config.log_level);
    lpvmpcd::Service service(config.service, assembly.loop(), [] {});
    service.Run();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "faulty lpvmpcd: " << error.what() << '\n';
    return 1;
  }
}
