// Ipopt's answer to an OcpQp, to hold ours against: another method (filter line search on the sparse problem, slacks
// as variables of their own, no Riccati recursion).
#pragma once

#include <limits>
#include <vector>

#include "control/qp/problem.hpp"

namespace control::testing {

// min ½ xᵀ diag(H) x + gᵀx  s.t.  lo ≤ A x ≤ hi, A as triplets.
struct SparseQp {
  struct Entry {
    int row;
    int column;
    double value;
  };
  std::vector<double> H, g, lo, hi;
  std::vector<Entry> A;

  int AddVariable(double curvature, double gradient) {
    H.push_back(curvature);
    g.push_back(gradient);
    return static_cast<int>(H.size()) - 1;
  }
  int AddRow(double lower, double upper) {
    lo.push_back(lower);
    hi.push_back(upper);
    return static_cast<int>(lo.size()) - 1;
  }
  void Add(int row, int column, double value) {
    if (value != 0.0) A.push_back({row, column, value});
  }
};

struct IpoptResult {
  bool solved = false;
  std::vector<double> x;
};

[[nodiscard]] IpoptResult SolveWithIpopt(const SparseQp& qp);

// x_0 is a constant; the variables are u_0, x_1, u_1, x_2, ... in this order, each stage's slacks after it.
template <int kNx, int kNu>
SparseQp Flatten(const OcpQp<kNx, kNu>& qp) {
  SparseQp flat;
  int x = -1;  // index of x_i's first entry, -1 of the given x_0
  const int N = qp.horizon();
  for (int i = 0; i <= N; ++i) {
    const auto& stage = qp.stages[static_cast<std::size_t>(i)];
    const bool terminal = i == N;
    const int u = static_cast<int>(flat.H.size());
    for (int k = 0; k < kNu && !terminal; ++k) flat.AddVariable(stage.R[k], stage.r[k]);
    // Adds C x_i to a row and returns what of it is constant.
    const auto add_state = [&](int row, const auto& C) {
      if (x < 0) return C.dot(qp.x0);
      for (int k = 0; k < kNx; ++k) flat.Add(row, x + k, C[k]);
      return 0.0;
    };
    for (int j = 0; j < stage.row_count; ++j) {
      const auto& row = stage.rows[static_cast<std::size_t>(j)];
      const auto add = [&](double lo, double hi, int slack, double sign) {
        const int index = flat.AddRow(lo, hi);
        const double constant = add_state(index, row.C);
        flat.lo.back() -= constant;
        flat.hi.back() -= constant;
        for (int k = 0; k < kNu && !terminal; ++k) flat.Add(index, u + k, row.D[k]);
        if (slack >= 0) flat.Add(index, slack, sign);
      };
      if (row.soft()) {
        const int slack = flat.AddVariable(row.rho, row.sigma);
        if (row.exact()) flat.Add(flat.AddRow(0.0, kNoBound), slack, 1.0);
        if (row.has_lo()) add(row.lo, kNoBound, slack, 1.0);
        if (row.has_hi()) add(-kNoBound, row.hi, slack, -1.0);
      } else {
        add(row.lo, row.hi, -1, 0.0);
      }
    }
    if (terminal) break;
    const auto& next = qp.stages[static_cast<std::size_t>(i) + 1];
    const int x_next = static_cast<int>(flat.H.size());
    for (int k = 0; k < kNx; ++k) flat.AddVariable(next.Q[k], next.q[k]);
    for (int k = 0; k < kNx; ++k) {
      const int index = flat.AddRow(-stage.c[k], -stage.c[k]);
      const double constant = add_state(index, stage.A.row(k));
      flat.lo.back() -= constant;
      flat.hi.back() -= constant;
      for (int l = 0; l < kNu; ++l) flat.Add(index, u + l, stage.B(k, l));
      flat.Add(index, x_next + k, -1.0);
    }
    x = x_next;
  }
  return flat;
}

}  // namespace control::testing
