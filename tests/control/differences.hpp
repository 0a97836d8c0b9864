// Derivatives by central differences, and their comparison with analytic ones.
#pragma once

#include <Eigen/Core>

#include "gtest/gtest.h"

namespace control::testing {

// `function` maps a vector to a vector.
template <typename Function>
Eigen::MatrixXd Differences(const Eigen::VectorXd& at, const Function& function) {
  constexpr double kH = 1e-6;
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    Eigen::VectorXd up = at, down = at;
    up[j] += kH;
    down[j] -= kH;
    const Eigen::VectorXd column = (function(up) - function(down)) / (2.0 * kH);
    if (j == 0) jacobian.resize(column.size(), at.size());
    jacobian.col(j) = column;
  }
  return jacobian;
}

// Expects an error below `tolerance`, relative to large entries and absolute for small ones.
inline void ExpectClose(const Eigen::MatrixXd& analytic, const Eigen::MatrixXd& numeric,
                        double tolerance = 1e-6) {
  ASSERT_EQ(analytic.rows(), numeric.rows());
  ASSERT_EQ(analytic.cols(), numeric.cols());
  const Eigen::MatrixXd error =
      (analytic - numeric).cwiseAbs().cwiseQuotient((1.0 + numeric.cwiseAbs().array()).matrix());
  Eigen::Index row = 0, column = 0;
  EXPECT_LT(error.maxCoeff(&row, &column), tolerance)
      << "at (" << row << ", " << column << "): " << analytic(row, column) << " against "
      << numeric(row, column);
}

}  // namespace control::testing
