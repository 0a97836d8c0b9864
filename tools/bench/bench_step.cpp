#include "tools/bench/bench_step.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/route_file.hpp"
#include "control/road/time_reference.hpp"
#include "loop/config.hpp"
#include "sim/plant.hpp"
#include "sim/scenario.hpp"
#include "sim/virtual_vehicle.hpp"
#include "tools/bench/times.hpp"
#include "tools/drive/make_controller.hpp"
#include "tools/drive/scenario_config.hpp"

namespace tools {
namespace {

struct Samples {
  Times times;
  std::int64_t iterations = 0;
  std::int64_t unsolved = 0;
};

// Drives the plant with the controller directly, without frames; only the control step is timed.
void Drive(const sim::Scenario& scenario, const loop::Config& config, const control::TimeReference& reference,
           const config::RouteFile& route, Samples& samples) {
  const int horizon = loop::HorizonOf(config);
  const control::RoadProfile profile(route.route, route.road, config.speed);
  const std::unique_ptr<control::Controller> controller =
      tools::MakeController(config, {.reference = reference, .profile = profile});
  sim::Plant plant(scenario.plant, reference[0]);
  control::Input u = control::Input::Zero();
  for (int k = 0; k + horizon < reference.size(); ++k) {
    const control::Plan* step = nullptr;
    samples.times.Measure([&] {
      const control::RoutePlace place{
          .on_route = true, .nearest = k, .s = reference.ArcLength(k), .due = k, .samples = reference.size()};
      step = &controller->Step(
          {.z = plant.state(), .u_previous = u, .place = place, .obstacles = scenario.obstacles});
    });
    const control::Plan& plan = *step;
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

// The slope of the least-squares line through the points (log N, log median).
double Exponent(const std::vector<int>& horizons, const std::vector<double>& medians) {
  const auto count = static_cast<Eigen::Index>(horizons.size());
  Eigen::MatrixX2d line(count, 2);
  Eigen::VectorXd log_median(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    line.row(k) << 1.0, std::log(horizons[static_cast<std::size_t>(k)]);
    log_median[k] = std::log(medians[static_cast<std::size_t>(k)]);
  }
  return line.colPivHouseholderQr().solve(log_median)[1];
}

}  // namespace

void BenchStep(const BenchStepOptions& options, std::ostream& out) {
  const sim::Scenario scenario = sim::LoadScenario(options.scenario);
  loop::Config config = LoadConfigFor(scenario, options.scenario, options.config);
  if (!options.controller.empty()) loop::SelectController(config, options.controller);
  const config::RouteFile route = config::LoadRoute(config.route);
  const control::TimeReference reference(control::SampleRoute(route.route, config.mpc.t_s), config.mpc.t_s);
  for (const int horizon : options.horizons) {
    if (horizon < 2 || horizon >= reference.size()) {
      throw std::invalid_argument(
          fmt::format("--horizon: {} is outside [2, {}]", horizon, reference.size() - 1));
    }
  }

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<double> medians;
  if (!options.json) out << "   N   steps  median_us    p99_us    max_us  iterations  unsolved\n";
  for (const int horizon : options.horizons) {
    config.mpc.horizon = config.affine.horizon = horizon;
    Samples samples;
    for (int i = 0; i < options.repeat; ++i) Drive(scenario, config, reference, route, samples);
    const Times& times = samples.times;
    medians.push_back(times.Median());
    const double iterations = static_cast<double>(samples.iterations) / static_cast<double>(times.count());
    if (options.json) {
      nlohmann::ordered_json row = {{"horizon", horizon}, {"steps", times.count()}};
      row.update(times.ToJson());
      row["mean_iterations"] = iterations;
      row["unsolved"] = samples.unsolved;
      rows.push_back(row);
    } else {
      out << fmt::format("{:4} {:7} {:10.1f} {:9.1f} {:9.1f} {:11.2f} {:9}\n", horizon, times.count(),
                         times.Median(), times.P99(), times.Max(), iterations, samples.unsolved);
    }
  }
  const bool several =
      std::ranges::adjacent_find(options.horizons, std::ranges::not_equal_to{}) != options.horizons.end();
  if (options.json) {
    nlohmann::ordered_json figures = {{"horizons", rows}};
    if (several) figures["exponent"] = Exponent(options.horizons, medians);
    out << figures.dump(2) << '\n';
  } else if (several) {
    out << fmt::format("median ~ N^{:.2f}\n", Exponent(options.horizons, medians));
  }
}

}  // namespace tools
