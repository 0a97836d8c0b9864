// Comparison of a nonlinear program's derivatives with central differences.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "control/nmpc/nonlinear_program.hpp"
#include "gtest/gtest.h"
#include "tests/control/differences.hpp"
#include "tests/control/random.hpp"

namespace control::testing {

inline std::span<const double> Span(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

inline std::span<double> Span(Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

inline Eigen::VectorXd Rows(const NonlinearProgram& program, const Eigen::VectorXd& x) {
  Eigen::VectorXd g(program.rows());
  program.Rows(Span(x), Span(g));
  return g;
}

inline Eigen::VectorXd Gradient(const NonlinearProgram& program, const Eigen::VectorXd& x) {
  Eigen::VectorXd gradient(program.variables());
  program.Gradient(Span(x), Span(gradient));
  return gradient;
}

// Expects each entry of the pattern at most once: no value may overwrite another.
inline Eigen::MatrixXd Dense(const std::vector<NonlinearProgram::Entry>& pattern,
                             const Eigen::VectorXd& values, int rows, int columns) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, columns);
  Eigen::MatrixXd count = dense;
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    dense(pattern[k].row, pattern[k].column) = values[static_cast<Eigen::Index>(k)];
    count(pattern[k].row, pattern[k].column) += 1.0;
  }
  EXPECT_LE(count.maxCoeff(), 1.0);
  return dense;
}

inline Eigen::MatrixXd Jacobian(const NonlinearProgram& program, const Eigen::VectorXd& x) {
  Eigen::VectorXd values(program.jacobian_pattern().size());
  program.Jacobian(Span(x), Span(values));
  return Dense(program.jacobian_pattern(), values, program.rows(), program.variables());
}

inline void ExpectGradientOfCost(const NonlinearProgram& program, const Eigen::VectorXd& x) {
  const auto cost = [&](const Eigen::VectorXd& at) {
    return Eigen::VectorXd::Constant(1, program.Cost(Span(at)));
  };
  // For a quadratic cost central differences are exact but for round-off, which is large at a cost of 1e5.
  const Eigen::VectorXd gradient = Gradient(program, x);
  EXPECT_LT((gradient - Differences(x, cost).row(0).transpose()).norm(), 1e-5 * gradient.norm());
}

inline void ExpectJacobianOfRows(const NonlinearProgram& program, const Eigen::VectorXd& x) {
  ExpectClose(Jacobian(program, x),
              Differences(x, [&](const Eigen::VectorXd& at) { return Rows(program, at); }));
}

// The multipliers are drawn from `random`.
inline void ExpectHessianOfLagrangian(const NonlinearProgram& program, const Eigen::VectorXd& x,
                                      Random& random, double tolerance = 1e-6) {
  constexpr double kSigma = 0.7;
  Eigen::VectorXd lambda(program.rows());
  for (double& l : lambda) l = random.Uniform(-2.0, 2.0);
  Eigen::VectorXd values(program.hessian_pattern().size());
  program.Hessian(Span(x), kSigma, Span(std::as_const(lambda)), Span(values));
  for (const auto& [row, column] : program.hessian_pattern())
    EXPECT_LE(column, row) << "not the lower triangle";
  const Eigen::MatrixXd lower =
      Dense(program.hessian_pattern(), values, program.variables(), program.variables());
  const Eigen::MatrixXd hessian = lower.selfadjointView<Eigen::Lower>();
  const auto gradient = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    return kSigma * Gradient(program, at) + Jacobian(program, at).transpose() * lambda;
  };
  ExpectClose(hessian, Differences(x, gradient), tolerance);
}

}  // namespace control::testing
