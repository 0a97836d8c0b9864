// Reads a recorded instance of the paper's QP: numbers separated by white space,
//   N nx nu, x0, N × (A B c) row-major, (N + 1) × (Q q), N × (R r), (N + 1) × (count, count × (C D lo hi
//   rho));
// a bound beyond ±1e19 is absent, rho < 0 marks a hard row.
#pragma once

#include <fstream>
#include <span>
#include <stdexcept>
#include <string>

#include "control/ocp_qp.hpp"

namespace control::testing {

inline OcpQp<8, 2> ReadQpInstance(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  const auto number = [&] {
    double value = 0.0;
    if (!(in >> value)) throw std::runtime_error(file + ": a number is missing or malformed");
    return value;
  };
  const auto fill = [&](auto&& matrix) {
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
      for (Eigen::Index c = 0; c < matrix.cols(); ++c) matrix(r, c) = number();
    }
  };
  const int N = static_cast<int>(number());
  if (number() != 8 || number() != 2)
    throw std::runtime_error(file + ": not an instance with 8 states and 2 inputs");
  OcpQp<8, 2> qp(N);
  const auto stages = std::span(qp.stages);
  fill(qp.x0);
  for (auto& s : stages.first(static_cast<std::size_t>(N))) {
    fill(s.A);
    fill(s.B);
    fill(s.c);
  }
  for (auto& s : stages) {
    fill(s.Q);
    fill(s.q);
  }
  for (auto& s : stages.first(static_cast<std::size_t>(N))) {
    fill(s.R);
    fill(s.r);
  }
  for (auto& s : stages) {
    for (int count = static_cast<int>(number()); count > 0; --count) {
      Eigen::Matrix<double, 8, 1> C;
      Eigen::Vector2d D;
      fill(C);
      fill(D);
      const double lo = number(), hi = number(), rho = number();
      if (!s.AddRow(C, D, lo < -1e19 ? -kNoBound : lo, hi > 1e19 ? kNoBound : hi, rho)) {
        throw std::runtime_error(file + ": too many rows in a stage");
      }
    }
  }
  return qp;
}

}  // namespace control::testing
