// Random OCP-QPs that are feasible, or not, by construction.
#pragma once

#include <algorithm>
#include <cmath>

#include "control/qp/kkt.hpp"
#include "tests/control/random.hpp"

namespace control::testing {

struct RandomQpOptions {
  double growth = 1.0;      // scale of A: beyond 1 the dynamics are unstable
  double equalities = 0.0;  // share of hard rows with lo = hi
  int max_horizon = 10;
  double exact = 0.0;    // share of soft rows with σ > 0; of these every third has ρ = 0
  double crossed = 0.0;  // share of soft rows with lo > hi
};

// Hard rows hold for a trajectory drawn at random with inputs within [-1, 1]; soft rows hold where they may.
template <int kNx, int kNu>
OcpQp<kNx, kNu> RandomQp(Random& random, const RandomQpOptions& options) {
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  const int N = random.Integer(1, options.max_horizon);
  OcpQp<kNx, kNu> qp(N);
  qp.x0 = random.Filled<VectorX>(2.0);
  VectorX x = qp.x0;
  for (int i = 0; i <= N; ++i) {
    auto& stage = qp.stages[static_cast<std::size_t>(i)];
    stage.Q = random.Filled<VectorX>(2.0).cwiseMax(0.0);
    stage.q = random.Filled<VectorX>(2.0);
    const VectorU u = random.Filled<VectorU>(1.0);
    if (i < N) {
      stage.R = random.Filled<VectorU>(1.0).cwiseAbs() + VectorU::Constant(0.1);
      stage.r = random.Filled<VectorU>(2.0);
      stage.A = options.growth * random.Filled<Eigen::Matrix<double, kNx, kNx>>(1.5 / std::sqrt(kNx));
      stage.B = random.Filled<Eigen::Matrix<double, kNx, kNu>>(1.0);
      stage.c = random.Filled<VectorX>(0.3);
      for (int k = 0; k < kNu; ++k) (void)stage.AddInputBound(k, -1.0, 1.0);
    }
    for (int count = random.Integer(0, 4); count > 0; --count) {
      const bool soft = random.Chance(0.4), unit = i > 0 && random.Chance(0.4);
      VectorX C = VectorX::Unit(random.Integer(0, kNx - 1));
      VectorU D = VectorU::Zero();
      if (!unit) {
        C = random.Filled<VectorX>(1.0);
        if (i < N) D = random.Filled<VectorU>(1.0);
      }
      const double value = soft ? random.Uniform(-3.0, 3.0) : C.dot(x) + D.dot(u);
      double rho = soft ? std::pow(10.0, random.Uniform(-1.0, 3.0)) : -1.0;
      double sigma = 0.0;
      if (soft && options.exact > 0.0 && random.Chance(options.exact)) {
        sigma = std::pow(10.0, random.Uniform(-1.0, 3.0));
        if (random.Chance(1.0 / 3.0)) rho = 0.0;
      }
      if (!soft && random.Chance(options.equalities)) {
        (void)stage.AddRow(C, D, value, value);
        continue;
      }
      if (soft && options.crossed > 0.0 && random.Chance(options.crossed)) {
        (void)stage.AddRow(C, D, value + random.Uniform(0.01, 1.0), value - random.Uniform(0.01, 1.0), rho,
                           sigma);
        continue;
      }
      const bool has_lo = random.Chance(0.7), has_hi = !has_lo || random.Chance(0.5);
      (void)stage.AddRow(C, D, has_lo ? value - random.Uniform(0.01, 1.0) : -kNoBound,
                         has_hi ? value + random.Uniform(0.01, 1.0) : kNoBound, rho, sigma);
    }
    if (i < N) x = (stage.A * x + stage.B * u + stage.c).eval();
  }
  return qp;
}

// Takes the rows out for which unwanted(row) is true.
template <typename Stage, typename Unwanted>
void EraseRows(Stage& stage, Unwanted&& unwanted) {
  const auto end = std::remove_if(stage.rows.begin(), stage.rows.begin() + stage.row_count, unwanted);
  stage.row_count = static_cast<int>(end - stage.rows.begin());
}

// The same row, multiplied by a factor.
template <typename Row>
void ScaleRow(double factor, Row& row) {
  row.C *= factor;
  row.D *= factor;
  row.lo *= factor;
  row.hi *= factor;
  if (row.soft()) row.rho /= factor * factor;
  row.sigma /= factor;
}

// Adds a hard row on a state that lies `beyond` outside what inputs within [-1, 1] can reach.
template <int kNx, int kNu>
void MakeInfeasible(Random& random, OcpQp<kNx, kNu>& qp, double beyond) {
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  const int k = random.Integer(1, qp.horizon());
  const VectorX C = random.Filled<VectorX>(1.0);
  VectorX adjoint = C;
  double largest = 0.0;
  for (int i = k; i-- > 0;) {
    const auto& stage = qp.stages[static_cast<std::size_t>(i)];
    largest += adjoint.dot(stage.c) + (stage.B.transpose() * adjoint).cwiseAbs().sum();
    adjoint = (stage.A.transpose() * adjoint).eval();
  }
  largest += adjoint.dot(qp.x0);
  (void)qp.stages[static_cast<std::size_t>(k)].AddRow(C, VectorU::Zero(), largest + beyond, kNoBound);
}

// Repeats some of the rows, as they are or multiplied by a factor: their multipliers are not unique.
template <int kNx, int kNu>
void RepeatRows(Random& random, OcpQp<kNx, kNu>& qp) {
  for (auto& stage : qp.stages) {
    for (int j = 0, count = stage.row_count; j < count && stage.row_count < kMaxRows - 1; ++j) {
      if (!random.Chance(0.4)) continue;
      auto row = stage.rows[static_cast<std::size_t>(j)];
      if (row.unit == row.kGeneral) ScaleRow(random.Uniform(0.5, 2.0), row);
      stage.rows[static_cast<std::size_t>(stage.row_count++)] = row;
    }
  }
}

// The same problem in other units: of each state, of each row and of the cost, by up to so many decades either way.
template <int kNx, int kNu>
void Rescale(Random& random, double decades, OcpQp<kNx, kNu>& qp) {
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  const auto factor = [&] { return std::pow(10.0, random.Uniform(-decades, decades)); };
  VectorX unit;  // x = unit ∘ (x in its unit)
  for (double& entry : unit) entry = factor();
  const VectorX inverse = unit.cwiseInverse();
  const double cost = factor();
  qp.x0 = qp.x0.cwiseProduct(inverse);
  for (auto& stage : qp.stages) {
    stage.Q = cost * stage.Q.cwiseProduct(unit).cwiseProduct(unit);
    stage.q = cost * stage.q.cwiseProduct(unit);
    stage.R *= cost;
    stage.r *= cost;
    stage.A = (inverse.asDiagonal() * stage.A * unit.asDiagonal()).eval();
    stage.B = (inverse.asDiagonal() * stage.B).eval();
    stage.c = stage.c.cwiseProduct(inverse);
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      auto& row = stage.rows[j];
      row.rho *= row.soft() ? cost : 1.0;
      row.sigma *= cost;
      if (row.unit >= kNx) continue;  // an input's bound
      row.C = row.C.cwiseProduct(unit);
      row.unit = row.kGeneral;
      ScaleRow(factor(), row);
    }
  }
}

}  // namespace control::testing
