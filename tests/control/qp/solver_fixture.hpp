// OcpQpSolver with each of its methods, and the problems that its tests share.
#pragma once

#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "config/qp_file.hpp"
#include "control/qp/solver.hpp"

namespace control {

using Qp = OcpQp<8, 2>;
using Point = OcpQpPoint<8, 2>;
using Solver = OcpQpSolver<8, 2>;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The parameter is the largest working set: 0 leaves the interior point, 96 the active set, 3 either of them.
class OcpQpSolverBy : public ::testing::TestWithParam<int> {
 protected:
  QpSettings settings_{.max_working_set = GetParam()};
};

inline Qp ReadInstance(const std::string& name) {
  return config::QpFile(LPVMPC_TEST_DATA "/qp/" + name).Build();
}

// One state, one input, one step: x₁ = x₀ + u, cost ½ (x₁ − 1)² + ½ u², whose optimum is x₁ = ½ (1 + x₀).
inline OcpQp<1, 1> Scalar(double x0) {
  OcpQp<1, 1> qp(1);
  qp.x0[0] = x0;
  qp.stages[0].A(0, 0) = 1.0;
  qp.stages[0].B(0, 0) = 1.0;
  qp.stages[0].R[0] = 1.0;
  qp.stages[1].Q[0] = 1.0;
  qp.stages[1].q[0] = -1.0;
  return qp;
}

}  // namespace control
