#include "tools/bench_step.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "config/route_file.hpp"
#include "control/reference.hpp"
#include "daemon/config.hpp"
#include "sim/percentile.hpp"
#include "sim/plant.hpp"
#include "sim/scenario.hpp"
#include "sim/virtual_vehicle.hpp"
#include "tools/make_controller.hpp"
#include "tools/scenario_config.hpp"

namespace tools {
namespace {

struct Samples {
  std::vector<double> microseconds;
  std::int64_t iterations = 0;
  std::int64_t unsolved = 0;
};

// One drive of the plant with the controller, no frames: only the control step is timed.
void Drive(const sim::Scenario& scenario, const lpvmpcd::Config& config, const control::Reference& reference,
           const config::RouteFile& route, Samples& samples) {
  const int horizon = lpvmpcd::HorizonOf(config);
  const control::Course course(route.route, route.road, config.speed);
  const std::unique_ptr<control::Controller> controller = tools::MakeController(config, course);
  sim::Plant plant(scenario.plant, reference[0]);
  control::Input u = control::Input::Zero();
  std::vector<control::State> window(static_cast<std::size_t>(horizon) + 1);
  for (int k = 0; k + horizon < reference.size(); ++k) {
    const auto start = std::chrono::steady_clock::now();
    reference.Window(k, window);
    const control::Plan& plan = controller->Step({.z = plant.state(),
                                                  .u_previous = u,
                                                  .reference = window,
                                                  .road = route.road,
                                                  .obstacles = scenario.obstacles});
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    samples.microseconds.push_back(elapsed.count());
    samples.iterations += plan.iterations;
    if (plan.status == control::SolverStatus::kSolved) {
      u = plan.u[0];
    } else {
      ++samples.unsolved;
    }
    for (double t = 0.0; t < config.mpc.t_s - sim::kIntegrationStep / 2.0; t += sim::kIntegrationStep) {
      plant.Step(u, u, u, sim::kIntegrationStep);
    }
  }
}

}  // namespace

void BenchStep(const BenchStepOptions& options, std::ostream& out) {
  const sim::Scenario scenario = sim::LoadScenario(options.scenario);
  lpvmpcd::Config config = LoadConfigFor(scenario, options.scenario, options.config);
  const config::RouteFile route = config::LoadRoute(config.route);
  const control::Reference reference(control::SampleRoute(route.route, config.mpc.t_s), config.mpc.t_s);
  for (const int horizon : options.horizons) {
    if (horizon < 2 || horizon >= reference.size()) {
      throw std::invalid_argument(
          fmt::format("--horizon: {} is outside [2, {}]", horizon, reference.size() - 1));
    }
  }

  nlohmann::json rows = nlohmann::json::array();
  if (!options.json) out << "   N   steps  median_us    p99_us    max_us  iterations  unsolved\n";
  for (const int horizon : options.horizons) {
    config.mpc.horizon = config.affine.horizon = horizon;
    Samples samples;
    for (int i = 0; i < options.repeat; ++i) Drive(scenario, config, reference, route, samples);
    std::ranges::sort(samples.microseconds);
    const std::size_t count = samples.microseconds.size();
    const double median = sim::Percentile(samples.microseconds, 0.5);
    const double p99 = sim::Percentile(samples.microseconds, 0.99);
    const double max = samples.microseconds.back();
    const double iterations = static_cast<double>(samples.iterations) / static_cast<double>(count);
    if (options.json) {
      rows.push_back({{"horizon", horizon},
                      {"steps", count},
                      {"median_us", median},
                      {"p99_us", p99},
                      {"max_us", max},
                      {"mean_iterations", iterations},
                      {"unsolved", samples.unsolved}});
    } else {
      out << fmt::format("{:4} {:7} {:10.1f} {:9.1f} {:9.1f} {:11.2f} {:9}\n", horizon, count, median, p99,
                         max, iterations, samples.unsolved);
    }
  }
  if (options.json) out << rows.dump(2) << '\n';
}

}  // namespace tools
