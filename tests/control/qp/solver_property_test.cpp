// The solver on 10⁵ random problems of every kind: each is solved to the residual or proven infeasible, and rightly so,
// by what is known of how it was made. Ipopt judges a sample of them. (One in some millions, whose equations depend on
// each other to the last digits, can end as kIterationLimit. The drawing is the same every time.)
#include <algorithm>
#include <cmath>
#include <rapidcheck/gtest.h>

#include "control/qp/solver.hpp"
#include "gtest/gtest.h"
#include "tests/control/qp/ipopt_qp.hpp"
#include "tests/control/qp/random_qp.hpp"

namespace control {
namespace {

using testing::Random;
using testing::RandomQpOptions;

constexpr int kProblemsPerCase = 1000;  // rapidcheck makes 100 cases

struct Kind {
  bool infeasible, redundant;
  double decades;  // of scale, up and down
  RandomQpOptions options;
};

Kind RandomKind() {
  const auto chance = rc::gen::element(false, true);
  return {.infeasible = *chance,
          .redundant = *chance,
          .decades = *rc::gen::element(0.0, 0.0, 1.0, 2.0),
          .options = {.equalities = *rc::gen::element(0.0, 0.15), .exact = *rc::gen::element(0.0, 0.5)}};
}

// Largest number whose round-off the residual holds: multipliers, and their products with the rows' terms.
template <int kNx, int kNu>
double ScaleOf(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point) {
  double scale = 1.0;
  for (std::size_t i = 0; i < qp.stages.size(); ++i) {
    const auto& stage = qp.stages[i];
    const auto& at = point.stages[i];
    scale = std::max(scale, at.pi.cwiseAbs().maxCoeff());
    if (i + 1 < qp.stages.size()) {
      scale = std::max(scale, (stage.A.cwiseAbs() * at.x.cwiseAbs()).maxCoeff());
      scale =
          std::max(scale, (stage.A.cwiseAbs().transpose() * point.stages[i + 1].pi.cwiseAbs()).maxCoeff());
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      const double lambda = at.lambda[j].lo + at.lambda[j].hi;
      const double terms = row.C.cwiseAbs().dot(at.x.cwiseAbs()) + row.D.cwiseAbs().dot(at.u.cwiseAbs());
      scale = std::max({scale, terms, lambda * std::max(1.0, terms + at.slack[j])});
    }
  }
  return scale;
}

template <typename Point>
double LargestMultiplier(const Point& point) {
  double largest = 0.0;
  for (const auto& stage : point.stages) {
    for (const RowMultiplier& lambda : stage.lambda) largest = std::max({largest, lambda.lo, lambda.hi});
  }
  return largest;
}

template <int kNx, int kNu>
void ExpectRightAnswer(const OcpQp<kNx, kNu>& qp, bool infeasible) {
  OcpQpSolver<kNx, kNu> solver(qp.horizon());
  const QpResult result = solver.Solve(qp);
  if (infeasible) {
    RC_ASSERT(result.status == SolverStatus::kInfeasible);
    RC_ASSERT(ProvesInfeasible(qp, solver.solution()));
  } else {
    RC_ASSERT(result.status == SolverStatus::kSolved);
    const KktResidual residual = EvaluateKkt(qp, solver.solution());
    const double round_off = 1e-11 * ScaleOf(qp, solver.solution());
    RC_ASSERT(std::max({residual.stationarity, residual.dynamics, residual.rows, residual.multipliers}) <=
              1e-8 + round_off);
    // Rows hold to 1e-8, and λ of rows that nearly contradict each other is large.
    RC_ASSERT(residual.complementarity <=
              1e-8 * std::max(1.0, LargestMultiplier(solver.solution())) + round_off);
  }
}

// Ipopt is slow, and no judge of badly scaled problems and of many equations.
template <int kNx, int kNu>
void ExpectIpoptAgrees(const OcpQp<kNx, kNu>& qp, bool infeasible) {
  const testing::IpoptResult ipopt = testing::SolveWithIpopt(testing::Flatten(qp));
  RC_ASSERT(ipopt.solved != infeasible);
  if (infeasible) return;
  OcpQpSolver<kNx, kNu> solver(qp.horizon());
  RC_ASSERT(solver.Solve(qp).status == SolverStatus::kSolved);
  for (int k = 0; k < kNu; ++k) {
    RC_ASSERT(std::abs(solver.solution().stages[0].u[k] - ipopt.x[static_cast<std::size_t>(k)]) < 1e-4);
  }
}

template <int kNx, int kNu>
void CheckProblems() {
  const Kind kind = RandomKind();
  Random random(*rc::gen::arbitrary<std::uint64_t>());
  for (int i = 0; i < kProblemsPerCase / 2; ++i) {
    auto qp = testing::RandomQp<kNx, kNu>(random, kind.options);
    if (kind.infeasible) testing::MakeInfeasible(random, qp, std::pow(10.0, random.Uniform(-3.0, 1.0)));
    if (kind.redundant) testing::RepeatRows(random, qp);
    if (i == 0 && kind.decades == 0.0 && !kind.redundant && kind.options.equalities == 0.0) {
      ExpectIpoptAgrees(qp, kind.infeasible);
    }
    if (kind.decades > 0.0) testing::Rescale(random, kind.decades, qp);
    ExpectRightAnswer(qp, kind.infeasible);
  }
}

RC_GTEST_PROP(OcpQpSolverProperty, SolvesOrProvesEveryProblem, ()) {
  CheckProblems<8, 2>();
  CheckProblems<4, 1>();
}

}  // namespace
}  // namespace control
