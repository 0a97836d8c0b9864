// The optimum without rows, from which OcpQpSolver measures: definitions of the solver's SolveBase, what it calls, and
// CloseLoop.
#pragma once

#include <algorithm>
#include <cstddef>

#include "control/qp/ocp_qp_impl.hpp"
#include "control/qp/ocp_qp_riccati.hpp"
#include "control/qp/ocp_qp_solver.hpp"

namespace control {

// The optimum without rows. False if there is none that has its digits.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::SolveBase(const Qp& qp) {
  const auto accurate = [&] {
    FollowBase(qp);
    double largest_pi = 0.0;
    for (const auto& work : work_) largest_pi = std::max(largest_pi, work.base_pi.cwiseAbs().maxCoeff());
    tolerance_ = settings_.tolerance + kRoundOff * largest_pi;
    base_error_ = BaseError(qp);
    return base_error_ <= tolerance_;
  };
  return (FactoriseBase(qp) && accurate()) || (FactoriseBaseSafely(qp) && accurate());
}

// The recursion in its usual form, P = Q + AᵀP'A − H_xu H_uu⁻¹ H_ux, in which P waits for K at its very end. It costs
// half of Factorise, but its difference loses the digits of dynamics that grow by much over the horizon.
template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::FactoriseBase(const Qp& qp) {
  using detail::Product;
  const std::size_t N = work_.size() - 1;
  riccati_[N].P = qp.stages[N].Q.asDiagonal();
  sweep_[N].p = qp.stages[N].q;
  for (std::size_t i = N; i-- > 0;) {
    const auto& stage = qp.stages[i];
    auto& riccati = riccati_[i];
    const MatrixXX& P_next = riccati_[i + 1].P;
    riccati.A_transposed = stage.A.transpose();
    const MatrixXU PB = Product(P_next, stage.B);
    const MatrixXX PA = Product(P_next, stage.A);
    MatrixUU H_uu = Product(stage.B.transpose(), PB);
    H_uu.diagonal() += stage.R;
    if (!riccati.FactoriseInput(H_uu)) return false;
    const MatrixXU H_xu = Product(riccati.A_transposed, PB);
    const MatrixXU Y = Product(H_xu, riccati.L_inverse.transpose());
    const MatrixXU Y_D = Y * riccati.D_inverse.asDiagonal();
    riccati.K_transposed = -Product(Y_D, riccati.L_inverse);
    riccati.P = Product(riccati.A_transposed, PA);
    riccati.P -= Product(Y_D, Y.transpose());
    riccati.P.diagonal() += stage.Q;
    const VectorX p_next = sweep_[i + 1].p + Product(P_next, stage.c);
    const VectorU h_u = stage.r + Product(stage.B.transpose(), p_next);
    sweep_[i].k = riccati.SolveInput(h_u);
    sweep_[i].p = stage.q + Product(riccati.A_transposed, p_next) + Product(riccati.K_transposed, h_u);
  }
  return true;
}

template <int kNx, int kNu>
bool OcpQpSolver<kNx, kNu>::FactoriseBaseSafely(const Qp& qp) {
  using detail::Product;
  if (!Factorise(qp, false)) return false;
  sweep_.back().p = qp.stages.back().q;
  for (std::size_t i = work_.size() - 1; i-- > 0;) {
    const auto& stage = qp.stages[i];
    auto& riccati = riccati_[i];
    riccati.A_transposed = stage.A.transpose();
    const VectorX p_next = sweep_[i + 1].p + Product(riccati_[i + 1].P, stage.c);
    sweep_[i].k = riccati.SolveInput((stage.r + Product(stage.B.transpose(), p_next)).eval());
    sweep_[i].p = stage.q + Product(riccati.A_K_transposed, p_next) + Product(riccati.K_transposed, stage.r);
  }
  return true;
}

// x, u, π of the base.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::FollowBase(const Qp& qp) {
  using detail::Product;
  const std::size_t N = work_.size() - 1;
  work_[0].base_x = qp.x0;
  work_[0].base_pi.setZero();
  for (std::size_t i = 0; i < N; ++i) {
    const auto& stage = qp.stages[i];
    auto& work = work_[i];
    auto& next = work_[i + 1];
    work.base_u = sweep_[i].k + Product(riccati_[i].K_transposed.transpose(), work.base_x);
    next.base_x = stage.c + Product(stage.A, work.base_x) + Product(stage.B, work.base_u);
    next.base_pi = sweep_[i + 1].p + Product(riccati_[i + 1].P, next.base_x);
  }
  work_[N].base_u.setZero();
}

// The largest entry of the Lagrangian's gradient, of which own_x(i) and own_u(i) are what stage i has but for the
// dynamics of the stage after it, whose multiplier is pi(i + 1).
template <int kNx, int kNu>
template <typename OwnX, typename OwnU, typename Pi>
double OcpQpSolver<kNx, kNu>::LargestGradient(const Qp& qp, OwnX&& own_x, OwnU&& own_u, Pi&& pi) const {
  using detail::Product;
  detail::LargestEntry<kNx> of_x;
  detail::LargestEntry<kNu> of_u;
  const std::size_t N = work_.size() - 1;
  for (std::size_t i = 0; i < N; ++i) {
    const VectorX& pi_next = pi(i + 1);
    of_u.Add(own_u(i) + Product(qp.stages[i].B.transpose(), pi_next));
    // x_0 is given: its gradient is free.
    if (i > 0) of_x.Add(own_x(i) + Product(riccati_[i].A_transposed, pi_next));
  }
  of_x.Add(own_x(N));
  return std::max(of_x.Value(), of_u.Value());
}

template <int kNx, int kNu>
double OcpQpSolver<kNx, kNu>::BaseError(const Qp& qp) const {
  return LargestGradient(
      qp,
      [&](std::size_t i) -> VectorX {
        return qp.stages[i].Q.cwiseProduct(work_[i].base_x) + qp.stages[i].q - work_[i].base_pi;
      },
      [&](std::size_t i) -> VectorU { return qp.stages[i].R.cwiseProduct(work_[i].base_u) + qp.stages[i].r; },
      [&](std::size_t i) -> const VectorX& { return work_[i].base_pi; });
}

// The closed loop of the base's K, for the sweeps.
template <int kNx, int kNu>
void OcpQpSolver<kNx, kNu>::CloseLoop(const Qp& qp) {
  for (std::size_t i = 0; i + 1 < riccati_.size(); ++i) {
    const auto& stage = qp.stages[i];
    riccati_[i].A_K_transposed =
        (stage.A + detail::Product(stage.B, riccati_[i].K_transposed.transpose())).transpose();
  }
}

}  // namespace control
