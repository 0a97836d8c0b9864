#include "tools/bench/bench_qp.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/qp_file.hpp"
#include "control/qp/solver.hpp"
#include "tools/bench/times.hpp"

namespace tools {
namespace {

using Solver = control::OcpQpSolver<8, 2>;

struct Named {
  std::string series;
  config::QpFile instance;
};

struct Line {
  int instances = 0, solved = 0, infeasible = 0, failed = 0;
  std::array<int, 3> by_method{};  // counts by control::QpMethod
  double iterations = 0.0;         // sum over all instances
  double largest_kkt = 0.0;
  Times solve, build_solve;  // without and with building the problem
};

std::map<int, std::vector<Named>> ReadFolder(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder))
    throw std::invalid_argument(fmt::format("{}: no such folder", folder.string()));
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".qp") files.push_back(entry.path());
  }
  if (files.empty()) throw std::invalid_argument(fmt::format("{}: holds no *.qp", folder.string()));
  std::ranges::sort(files);
  std::map<int, std::vector<Named>> by_horizon;
  for (const std::filesystem::path& file : files) {
    const std::string name = file.stem().string();
    config::QpFile instance(file);
    const int horizon = instance.horizon();
    by_horizon[horizon].push_back(
        {.series = name.substr(0, name.rfind('_')), .instance = std::move(instance)});
  }
  return by_horizon;
}

Line Measure(const std::vector<Named>& all, bool warm, int repeat) {
  const int horizon = all.front().instance.horizon();
  Solver solver(horizon);
  control::OcpQp<8, 2> qp(horizon);
  control::OcpQpPoint<8, 2> before(horizon);
  std::string series;  // series of `before`; empty if there is no warm start
  Line line;
  for (const Named& named : all) {
    const control::OcpQpPoint<8, 2>* warm_start = warm && series == named.series ? &before : nullptr;
    control::QpResult result;
    named.instance.Build(qp);
    for (int i = 0; i < repeat; ++i) line.solve.Measure([&] { result = solver.Solve(qp, warm_start); });
    for (int i = 0; i < repeat; ++i) {
      line.build_solve.Measure([&] {
        named.instance.Build(qp);
        result = solver.Solve(qp, warm_start);
      });
    }
    ++line.instances;
    if (result.status != control::SolverStatus::kNumericalFailure)
      ++line.by_method[static_cast<std::size_t>(result.method)];
    line.iterations += result.iterations;
    const bool solved = result.status == control::SolverStatus::kSolved;
    if (solved) {
      ++line.solved;
      line.largest_kkt = std::max(line.largest_kkt, EvaluateKkt(qp, solver.solution()).Max());
      before = solver.solution();
    } else if (result.status == control::SolverStatus::kInfeasible &&
               ProvesInfeasible(qp, solver.solution())) {
      ++line.infeasible;
    } else {
      ++line.failed;
    }
    series = result.CanWarmStart() ? named.series : "";
  }
  return line;
}

nlohmann::ordered_json ToJson(int horizon, const char* start, const Line& line) {
  return {{"horizon", horizon},
          {"start", start},
          {"instances", line.instances},
          {"solved", line.solved},
          {"infeasible", line.infeasible},
          {"failed", line.failed},
          {"unconstrained", line.by_method[0]},
          {"active_set", line.by_method[1]},
          {"interior_point", line.by_method[2]},
          {"mean_iterations", line.iterations / line.instances},
          {"largest_kkt_residual", line.largest_kkt},
          {"solve", line.solve.ToJson()},
          {"build_and_solve", line.build_solve.ToJson()}};
}

std::string ToText(int horizon, const char* start, const Line& line) {
  const auto text = [](const Times& times) {
    return fmt::format("{:8.1f} {:8.1f} {:8.1f}", times.Median(), times.P99(), times.Max());
  };
  return fmt::format("{:4}  {:5} {:7} {:10} {:6} {:6} {:6} {:6} {:10.2f} {:9.1e}  {}  {}\n", horizon, start,
                     line.solved, line.infeasible, line.failed, line.by_method[0], line.by_method[1],
                     line.by_method[2], line.iterations / line.instances, line.largest_kkt, text(line.solve),
                     text(line.build_solve));
}

}  // namespace

void BenchQp(const BenchQpOptions& options, std::ostream& out) {
  const std::map<int, std::vector<Named>> by_horizon = ReadFolder(options.folder);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!options.json) {
    out << fmt::format("{:76}{:28}{}\n", "", "solve [us]", "build and solve [us]")
        << "   N  start  solved infeasible failed uncons active  inter iterations       KKT"
        << "    median      p99      max    median      p99      max\n";
  }
  for (const auto& [horizon, instances] : by_horizon) {
    for (const bool warm : {false, true}) {
      const char* start = warm ? "warm" : "cold";
      const Line line = Measure(instances, warm, options.repeat);
      if (options.json) {
        rows.push_back(ToJson(horizon, start, line));
      } else {
        out << ToText(horizon, start, line);
      }
    }
  }
  if (options.json) out << rows.dump(2) << '\n';
}

}  // namespace tools
