#include "control/nmpc/nmpc.hpp"

#include <algorithm>
#include <vector>

#include "control/road/halfspace.hpp"

namespace control {
namespace {

std::size_t Size(int n) {
  return static_cast<std::size_t>(n);
}

}  // namespace

Nmpc::Nmpc(const VehicleParameters& vehicle, const NmpcSettings& settings)
    : settings_(settings),
      problem_(vehicle, settings),
      solver_({.tolerance = settings.tolerance,
               .max_iterations = settings.max_iterations,
               .max_cpu_time = settings.max_cpu_time}) {
  plan_.z.assign(Size(settings.horizon) + 1, State::Zero());
  plan_.u.assign(Size(settings.horizon), Input::Zero());
}

const Plan& Nmpc::Step(const TrackingInput& input) {
  problem_.Set(input);
  if (!has_guess_) StartFromReference(input);
  MoveOutOfObstacles(input);
  const bool warm = has_guess_ && point_.lambda.size() == Size(problem_.rows());
  const IpoptSolver::Result result = solver_.Solve(problem_, point_, warm);
  plan_.status = result.status;
  plan_.iterations = result.iterations;
  for (std::size_t i = 0; i < plan_.z.size(); ++i) {
    plan_.z[i] = problem_.StateOf(point_.x, static_cast<int>(i));
    if (i < plan_.u.size()) plan_.u[i] = problem_.InputOf(point_.x, static_cast<int>(i));
  }
  last_ = point_.x;
  has_guess_ = plan_.status == SolverStatus::kSolved;
  if (has_guess_) Shift();
  return plan_;
}

std::optional<ConstraintViolation> Nmpc::DiagnoseInfeasibility() const {
  if (last_.size() != Size(problem_.variables())) return std::nullopt;
  const ConstraintViolation largest = problem_.LargestViolation(problem_.Driven(last_));
  if (!(largest.amount > settings_.tolerance)) return std::nullopt;
  return largest;
}

void Nmpc::StartFromReference(const TrackingInput& input) {
  point_ = {};
  point_.x.assign(Size(problem_.variables()), 0.0);
  for (int i = 1; i <= horizon(); ++i) {
    std::ranges::copy(input.reference[Size(i)], point_.x.begin() + NmpcProblem::StateAt(i));
  }
}

void Nmpc::MoveOutOfObstacles(const TrackingInput& input) {
  for (int i = 1; i <= horizon(); ++i) {
    double* const z = point_.x.data() + NmpcProblem::StateAt(i);
    for (const Obstacle& obstacle : input.obstacles) {
      State at = problem_.StateOf(point_.x, i);
      at[kPsi] = input.reference[Size(i)][kPsi];  // the way out is across the road
      const auto outside = ObstacleHalfSpace(obstacle, at, settings_.obstacle_margin);
      if (!outside) continue;
      const double distance = outside->c - outside->a * at[kX] - outside->b * at[kY];
      z[kX] += distance * outside->a;
      z[kY] += distance * outside->b;
    }
  }
}

// Each step takes the values of the next one. The last keeps its inputs and multipliers, and its state follows the
// model.
void Nmpc::Shift() {
  const State z_N = problem_.StateOf(point_.x, horizon());
  const Input u_N = problem_.InputOf(point_.x, horizon() - 1);
  for (std::vector<double>* values : {&point_.x, &point_.z_lo, &point_.z_hi, &point_.lambda}) {
    const auto step = static_cast<std::ptrdiff_t>(values->size()) / horizon();
    std::copy(values->begin() + step, values->end(), values->begin());
  }
  std::ranges::copy(problem_.Next(z_N, u_N), point_.x.begin() + NmpcProblem::StateAt(horizon()));
}

}  // namespace control
