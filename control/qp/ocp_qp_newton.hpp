// The Newton system of OcpQpSolver and its solution: definitions of the solver's Factorise and Step.
//
// Each bound is an equation with a distance t ≥ 0 and a multiplier λ ≥ 0,
//   C x + D u + ε − lo = t_lo,   hi + ε − C x − D u = t_hi,   ε = t_ε,   λ t = target,
// the third in soft rows with σ > 0, and a soft row's slack has the stationarity
//   ρ ε + σ − λ_lo − λ_hi − λ_ε = 0.
// Eliminating dt, dλ and dε from the Newton equations leaves, for each row, a curvature on C dx + D du,
//   w = w_lo + w_hi − (w_lo − w_hi)² / s,   s = ρ + w_lo + w_hi + w_ε,
//   w_lo = λ_lo / (t_lo + δ λ_lo), w_hi and w_ε likewise
// (the quotient in soft rows only, where w is computed as (4 w_lo w_hi + (ρ + w_ε) (w_lo + w_hi)) / s, which
// cancels no digits; w_ε = 0 where σ = 0), and a gradient term. δ regularises the step alone,
// dt = C dx + D du + dε + residual + δ dλ: it keeps w ≤ 1/δ and so the digits of P, and vanishes with dλ.
// What remains is
//   min ½ dxᵀ(Q + Σ w CCᵀ)dx + duᵀ(Σ w DCᵀ)dx + ½ duᵀ(R + Σ w DDᵀ)du + g_xᵀdx + g_uᵀdu,  dx' = A dx + B du,
// which the Riccati recursion solves. It is written with the closed loop A_K = A + B K and C_K = C + KᵀD, as
// a sum of positive semidefinite terms: the usual difference of large terms loses all digits where w → ∞ in a
// row with D ≠ 0.
//   P = Q + KᵀRK + A_Kᵀ P' A_K + Σ w C_K C_Kᵀ,   K = −H_uu⁻¹ H_ux,
//   H_uu = R + BᵀP'B + Σ w DDᵀ,                  H_ux = BᵀP'A + Σ w DCᵀ,
//   p = r_x + Σ γ C + Kᵀ(r_u + Σ γ D) + A_Kᵀ p',  k = −H_uu⁻¹ h_u,    h_u = r_u + Σ γ D + Bᵀp'
// with the gradient γ of each row; r_x, r_u are the gradients of the Lagrangian at the iterate. A row that bounds an
// input alone is a term of R, one with D = 0 is one of Q.
#pragma once

#include "control/qp/ocp_qp_riccati.hpp"
#include "control/qp/ocp_qp_rows.hpp"
#include "control/qp/ocp_qp_solver.hpp"

namespace control {

// Row weights and the matrices of the Riccati recursion. False if a pivot is not positive.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::Factorise(const Qp& qp, bool with_rows) {
  using detail::Product;
  for (std::size_t i = work_.size(); i-- > 0;) {
    const auto& stage = qp.stages[i];
    auto& work = work_[i];
    const bool terminal = i + 1 == work_.size();
    const std::size_t row_count = with_rows ? static_cast<std::size_t>(stage.row_count) : 0;
    for (std::size_t j = 0; j < row_count; ++j) {
      RowWork& at = work.rows[j];
      const auto side = [](Side& s) {
        if (!s.present) return;
        s.inverse_t = 1.0 / (s.t + kDualRegularisation * s.lambda);
        s.w = s.lambda * s.inverse_t;
      };
      side(at.lo);
      side(at.hi);
      side(at.slack);
      at.w = at.lo.w + at.hi.w;
      if (!stage.rows[j].soft()) continue;
      const double slack_w = stage.rows[j].rho + at.slack.w;
      const double s = slack_w + at.w;
      at.inverse_s = s > 0.0 ? 1.0 / s : 0.0;
      at.w = (4.0 * at.lo.w * at.hi.w + slack_w * at.w) * at.inverse_s;
    }

    auto& riccati = riccati_[i];
    MatrixXX& P = riccati.P;
    if (terminal) {
      P = stage.Q.asDiagonal();
    } else {
      const MatrixXX& P_next = riccati_[i + 1].P;
      const MatrixXU PB = Product(P_next, stage.B);
      MatrixUU H_uu = Product(stage.B.transpose(), PB);
      H_uu.diagonal() += stage.R;
      MatrixXU H_xu = Product(stage.A.transpose(), PB);
      VectorU R = stage.R;
      for (std::size_t j = 0; j < row_count; ++j) {
        const auto& row = stage.rows[j];
        if (row.unit >= kNx) {
          H_uu(row.unit - kNx, row.unit - kNx) += work.rows[j].w;
          R[row.unit - kNx] += work.rows[j].w;
        } else if (row.holds_input) {
          const VectorU wD = work.rows[j].w * row.D;
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
    for (std::size_t j = 0; j < row_count; ++j) {
      const auto& row = stage.rows[j];
      const double w = work.rows[j].w;
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

// The Newton step towards λ t = target, with Mehrotra's second-order term of the step before it if asked for.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::Step(const Qp& qp, double target, bool second_order) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const auto& stage = qp.stages[i];
    auto& work = work_[i];
    auto& sweep = sweep_[i];
    sweep.p = work.r_x;
    sweep.k = work.r_u;
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      RowWork& at = work.rows[j];
      const auto side = [&](Side& s) {
        if (!s.present) return;
        const double cross = second_order ? s.dt * s.dlambda : 0.0;
        s.y = (target - cross - s.lambda * s.t) * s.inverse_t - s.w * s.residual;
      };
      side(at.lo);
      side(at.hi);
      side(at.slack);
      at.y = at.lo.y + at.hi.y + at.slack.y - at.r_epsilon;
      const double gradient = at.hi.y - at.lo.y + (at.lo.w - at.hi.w) * at.y * at.inverse_s;
      detail::AddRowGradient(row, gradient, sweep.p, sweep.k);
    }
  }
  detail::SweepRiccati(qp, riccati_, work_.size() - 1, sweep_);
  longest_ = kNoBound;
  first_order_ = second_order_ = 0.0;
  detail::ForEachRow(qp, [&](const auto& row, std::size_t i, std::size_t j) {
    RowWork& at = work_[i].rows[j];
    const double dg = detail::RowValue(row, sweep_[i].dx, sweep_[i].du);
    at.depsilon = (at.y - (at.lo.w - at.hi.w) * dg) * at.inverse_s;
    const auto side = [&](Side& s, double distance_step) {
      if (!s.present) return;
      s.dlambda = s.y - s.w * distance_step;
      s.dt = distance_step + s.residual + kDualRegularisation * s.dlambda;
      if (s.t + longest_ * s.dt < 0.0) longest_ = -s.t / s.dt;
      if (s.lambda + longest_ * s.dlambda < 0.0) longest_ = -s.lambda / s.dlambda;
      first_order_ += s.t * s.dlambda + s.lambda * s.dt;
      second_order_ += s.dt * s.dlambda;
    };
    side(at.lo, dg + at.depsilon);
    side(at.hi, -dg + at.depsilon);
    side(at.slack, at.depsilon);
  });
}

}  // namespace control
