// The Riccati recursion for an unconstrained linear-quadratic problem: the factorisation of its matrices, and sweeps
// for one gradient or for several at once.
//
//   min Σ ½ xᵀQx + ½ uᵀRu + Σ ½ w (Cx + Du)² + g_xᵀx + g_uᵀu   s.t.  x' = A x + B u
//
// with the curvature w ≥ 0 of each row. It is written with the closed loop A_K = A + B K and C_K = C + KᵀD, as a sum of
// positive semidefinite terms: the usual difference of large terms loses all digits where w → ∞ in a row with D ≠ 0.
//   P = Q + KᵀRK + A_Kᵀ P' A_K + Σ w C_K C_Kᵀ,   K = −H_uu⁻¹ H_ux,
//   H_uu = R + BᵀP'B + Σ w DDᵀ,                  H_ux = BᵀP'A + Σ w DCᵀ,
//   p = g_x + Kᵀg_u + A_Kᵀ p',                   k = −H_uu⁻¹ (g_u + Bᵀp')
// A row that bounds only an input adds to R, a row with D = 0 adds to Q.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "control/qp/largest_entry.hpp"
#include "control/qp/problem.hpp"

namespace control {

namespace detail {

// The unrolled product of small matrices of fixed sizes. From 8 × 8 on, Eigen would choose its blocked product for
// large matrices, which costs several times as much here.
template <typename Left, typename Right>
auto Product(const Left& left, const Right& right) {
  return left.lazyProduct(right);
}

template <int kNx, int kNu>
struct RiccatiStage {
  Eigen::Matrix<double, kNx, kNx> P;               // cost-to-go ½ xᵀP x
  Eigen::Matrix<double, kNx, kNx> A_transposed;    // its products need no sums across vector registers
  Eigen::Matrix<double, kNx, kNx> A_K_transposed;  // (A + B K)ᵀ
  Eigen::Matrix<double, kNx, kNu> K_transposed;    // u = k + K x
  // H_uu = L D Lᵀ, L with ones on its diagonal. With w around 1e10 the inverse of H_uu itself would have few digits.
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

// kCols gradients, and for each the optimal trajectory from x_0 = 0.
template <int kNx, int kNu, int kCols>
struct SweepStage {
  static constexpr int kOrder = kCols > 1 ? Eigen::RowMajor : Eigen::ColMajor;

  Eigen::Matrix<double, kNx, kCols, kOrder> p;  // g_x before the sweep, the cost-to-go's gradient after it
  Eigen::Matrix<double, kNu, kCols, kOrder> k;  // g_u before the sweep, the feedforward after it
  Eigen::Matrix<double, kNx, kCols, kOrder> dx;
  Eigen::Matrix<double, kNu, kCols, kOrder> du;
};

// Sets the gradients of stages 0..last to zero.
template <int kNx, int kNu, int kCols>
void ClearGradients(std::size_t last, std::vector<SweepStage<kNx, kNu, kCols>>& sweep) {
  for (std::size_t i = 0; i <= last; ++i) {
    sweep[i].p.setZero();
    sweep[i].k.setZero();
  }
}

// Solves min Σ ½ dxᵀQ dx + ½ duᵀR du + g_xᵀdx + g_uᵀdu with the factorised matrices; g is zero after stage `last`.
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
    // Without A_K the dynamics hold to round-off, however large K is.
    sweep[i + 1].dx = Product(qp.stages[i].A, s.dx) + Product(qp.stages[i].B, s.du);
  }
}

// Factorises the problem with curvature(i, j) for the first row_count(i) rows j of each stage i. Does not write
// A_transposed. False if a pivot is not positive.
template <int kNx, int kNu, typename RowCount, typename Curvature>
[[nodiscard]] bool FactoriseRiccati(const OcpQp<kNx, kNu>& qp, const RowCount& row_count,
                                    const Curvature& curvature, std::vector<RiccatiStage<kNx, kNu>>& stages) {
  using MatrixXX = Eigen::Matrix<double, kNx, kNx>;
  using MatrixXU = Eigen::Matrix<double, kNx, kNu>;
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  for (std::size_t i = stages.size(); i-- > 0;) {
    const auto& stage = qp.stages[i];
    const bool terminal = i + 1 == stages.size();
    const std::size_t rows = row_count(i);
    auto& riccati = stages[i];
    MatrixXX& P = riccati.P;
    if (terminal) {
      P = stage.Q.asDiagonal();
    } else {
      const MatrixXX& P_next = stages[i + 1].P;
      const MatrixXU PB = Product(P_next, stage.B);
      Eigen::Matrix<double, kNu, kNu> H_uu = Product(stage.B.transpose(), PB);
      H_uu.diagonal() += stage.R;
      MatrixXU H_xu = Product(stage.A.transpose(), PB);
      VectorU R = stage.R;
      for (std::size_t j = 0; j < rows; ++j) {
        const auto& row = stage.rows[j];
        const double w = curvature(i, j);
        if (row.unit >= kNx) {
          H_uu(row.unit - kNx, row.unit - kNx) += w;
          R[row.unit - kNx] += w;
        } else if (row.holds_input) {
          const VectorU wD = w * row.D;
          H_xu += Product(row.C, wD.transpose());
          H_uu += Product(wD, row.D.transpose());
        }
      }
      if (!riccati.FactoriseInput(H_uu)) return false;
      riccati.K_transposed = riccati.SolveInput(H_xu.transpose()).transpose();
      const MatrixXX A_K = stage.A + Product(stage.B, riccati.K_transposed.transpose());
      riccati.A_K_transposed = A_K.transpose();
      const MatrixXX PA_K = Product(P_next, A_K);
      const MatrixXU KR = riccati.K_transposed * R.asDiagonal();
      P = Product(riccati.A_K_transposed, PA_K) + Product(KR, riccati.K_transposed.transpose());
      P = (0.5 * (P + P.transpose())).eval();
      P.diagonal() += stage.Q;
    }
    for (std::size_t j = 0; j < rows; ++j) {
      const auto& row = stage.rows[j];
      const double w = curvature(i, j);
      if (row.unit >= kNx) continue;
      if (row.unit >= 0) {
        P(row.unit, row.unit) += w;
        continue;
      }
      VectorX C_K = row.C;
      if (row.holds_input && !terminal) C_K += Product(riccati.K_transposed, row.D);
      const VectorX wC_K = w * C_K;
      P += Product(wC_K, C_K.transpose());
    }
  }
  return true;
}

// Returns the largest entry of the Lagrangian's gradient. own_x(i) and own_u(i) are stage i's gradient without the term
// of the dynamics to the next stage, whose multiplier is pi(i + 1).
template <int kNx, int kNu, typename OwnX, typename OwnU, typename Pi>
[[nodiscard]] double LargestGradient(const OcpQp<kNx, kNu>& qp,
                                     const std::vector<RiccatiStage<kNx, kNu>>& riccati, OwnX&& own_x,
                                     OwnU&& own_u, Pi&& pi) {
  LargestEntry<kNx> of_x;
  LargestEntry<kNu> of_u;
  const std::size_t N = riccati.size() - 1;
  for (std::size_t i = 0; i < N; ++i) {
    const Eigen::Matrix<double, kNx, 1>& pi_next = pi(i + 1);
    of_u.Add(own_u(i) + Product(qp.stages[i].B.transpose(), pi_next));
    // x_0 is given: its gradient need not vanish.
    if (i > 0) of_x.Add(own_x(i) + Product(riccati[i].A_transposed, pi_next));
  }
  of_x.Add(own_x(N));
  return std::max(of_x.Value(), of_u.Value());
}

}  // namespace detail

}  // namespace control
