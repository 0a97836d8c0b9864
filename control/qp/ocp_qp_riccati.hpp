// The Riccati recursion's results and its sweeps: an unconstrained linear-quadratic problem once its matrices
// are factorised (ocp_qp_base.hpp, ocp_qp_newton.hpp), for one gradient or for several side by side.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "control/qp/ocp_qp.hpp"

namespace control {

namespace detail {

// The product of small matrices of known sizes, unrolled: Eigen's own choice from 8 × 8 on is the blocked
// product for large ones, which costs several times as much here.
template <typename Left, typename Right>
auto Product(const Left& left, const Right& right) {
  return left.lazyProduct(right);
}

template <int kNx, int kNu>
struct RiccatiStage {
  Eigen::Matrix<double, kNx, kNx> P;               // cost-to-go ½ xᵀP x
  Eigen::Matrix<double, kNx, kNx> A_transposed;    // whose product needs no sums across a vector
  Eigen::Matrix<double, kNx, kNx> A_K_transposed;  // of A + B K
  Eigen::Matrix<double, kNx, kNu> K_transposed;    // u = k + K x
  // H_uu = L D Lᵀ, L with ones on its diagonal. Beside a w of 1e10 the inverse of H_uu itself has few digits.
  Eigen::Matrix<double, kNu, kNu> L_inverse;
  Eigen::Matrix<double, kNu, 1> D_inverse;

  // False if a pivot is not positive.
  [[nodiscard]] bool FactoriseInput(Eigen::Matrix<double, kNu, kNu> H) {
    L_inverse.setIdentity();
    for (int j = 0; j < kNu; ++j) {
      if (!(H(j, j) > 0.0)) return false;
      D_inverse[j] = 1.0 / H(j, j);
      for (int i = j + 1; i < kNu; ++i) {
        const double l = H(i, j) * D_inverse[j];
        for (int m = j + 1; m <= i; ++m) H(i, m) -= l * H(m, j);
        L_inverse.row(i) -= l * L_inverse.row(j);
      }
    }
    return true;
  }
  // −H_uu⁻¹ h
  template <typename Right>
  [[nodiscard]] auto SolveInput(const Right& h) const {
    const auto y = (D_inverse.asDiagonal() * Product(L_inverse, h)).eval();
    return (-Product(L_inverse.transpose(), y)).eval();
  }
};

// kCols gradients, and the trajectories from x_0 = 0 that minimise with them.
template <int kNx, int kNu, int kCols>
struct SweepStage {
  static constexpr int kOrder = kCols > 1 ? Eigen::RowMajor : Eigen::ColMajor;

  Eigen::Matrix<double, kNx, kCols, kOrder> p;  // before the sweep g_x, after it the cost-to-go's gradient
  Eigen::Matrix<double, kNu, kCols, kOrder> k;  // before the sweep g_u, after it the feedforward
  Eigen::Matrix<double, kNx, kCols, kOrder> dx;
  Eigen::Matrix<double, kNu, kCols, kOrder> du;
};

// The gradients of stages 0..last to zero.
template <int kNx, int kNu, int kCols>
void ClearGradients(std::size_t last, std::vector<SweepStage<kNx, kNu, kCols>>& sweep) {
  for (std::size_t i = 0; i <= last; ++i) {
    sweep[i].p.setZero();
    sweep[i].k.setZero();
  }
}

// min Σ ½ dxᵀQ dx + ½ duᵀR du + g_xᵀdx + g_uᵀdu with the factorised matrices; g is zero after stage `last`.
template <int kNx, int kNu, int kCols>
void SweepRiccati(const OcpQp<kNx, kNu>& qp, const std::vector<RiccatiStage<kNx, kNu>>& riccati,
                  std::size_t last, std::vector<SweepStage<kNx, kNu, kCols>>& sweep) {
  const std::size_t N = riccati.size() - 1;
  for (std::size_t i = last + 1; i-- > 0;) {
    if (i == N) continue;
    const auto& at = riccati[i];
    auto& s = sweep[i];
    Eigen::Matrix<double, kNu, kCols, SweepStage<kNx, kNu, kCols>::kOrder> h_u = s.k;
    s.p += Product(at.K_transposed, s.k);
    if (i < last) {
      const auto& p_next = sweep[i + 1].p;
      s.p += Product(at.A_K_transposed, p_next);
      h_u += Product(qp.stages[i].B.transpose(), p_next);
    }
    s.k = at.SolveInput(h_u);
  }
  sweep[0].dx.setZero();
  sweep[N].du.setZero();
  for (std::size_t i = 0; i < N; ++i) {
    const auto& at = riccati[i];
    auto& s = sweep[i];
    s.du = Product(at.K_transposed.transpose(), s.dx);
    if (i <= last) s.du += s.k;
    // Not by A_K: the dynamics hold to round-off, however large K is.
    sweep[i + 1].dx = Product(qp.stages[i].A, s.dx) + Product(qp.stages[i].B, s.du);
  }
}

}  // namespace detail

}  // namespace control
