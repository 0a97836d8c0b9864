// The unconstrained optimum of an OcpQp (the optimum without its rows), by one Riccati recursion, and the factors that
// the active set's sweeps use.
//
// In deviations from this optimum the cost is purely quadratic and the dynamics have no constant:
//   min Σ ½ xᵀQx + ½ uᵀRu + Σ_soft ½ρε² + σε   s.t.  x_0 = 0, x' = A x + B u,  lo − ε ≤ C x + D u ≤ hi + ε
// with shifted bounds (shifted_bounds.hpp). The other methods work on these deviations, so that positions of hundreds
// of metres cost no digits.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "control/qp/largest_entry.hpp"
#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/riccati.hpp"

namespace control {

inline constexpr double kQpRoundOff = 1e-12;

template <int kNx, int kNu>
class Unconstrained {
 public:
  using Qp = OcpQp<kNx, kNu>;
  using Point = OcpQpPoint<kNx, kNu>;
  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  struct Stage {
    VectorX x, pi;
    VectorU u;
  };

  explicit Unconstrained(int horizon)
      : stages_(static_cast<std::size_t>(horizon) + 1),
        riccati_(stages_.size()),
        gradients_(stages_.size()) {}

  // False if no optimum is found that is stationary to the tolerance. Does not allocate.
  [[nodiscard]] bool Solve(const Qp& qp, double tolerance);
  // Computes the closed loop of each stage, which sweeps need. Must follow Solve.
  void CloseLoop(const Qp& qp);
  // Writes x, u, π, and zero for all multipliers and slacks.
  void Write(const Qp& qp, Point& point) const;

  [[nodiscard]] const Stage& operator[](std::size_t i) const { return stages_[i]; }
  [[nodiscard]] const std::vector<detail::RiccatiStage<kNx, kNu>>& riccati() const { return riccati_; }
  // The tolerance of Solve plus the round-off of the largest π.
  [[nodiscard]] double tolerance() const { return tolerance_; }
  [[nodiscard]] double stationarity_error() const { return stationarity_error_; }

  // The two forms of the recursion, public for benchmarks. False if a pivot is not positive.
  [[nodiscard]] bool Factorise(const Qp& qp);
  [[nodiscard]] bool FactoriseSafely(const Qp& qp);

 private:
  void RollOut(const Qp& qp);
  [[nodiscard]] double StationarityError(const Qp& qp) const;

  std::vector<Stage> stages_;
  std::vector<detail::RiccatiStage<kNx, kNu>> riccati_;
  std::vector<detail::SweepStage<kNx, kNu, 1>> gradients_;
  double tolerance_ = 0.0;
  double stationarity_error_ = 0.0;
};

template <int kNx, int kNu>
bool Unconstrained<kNx, kNu>::Solve(const Qp& qp, double tolerance) {
  const auto accurate = [&] {
    RollOut(qp);
    double largest_pi = 0.0;
    for (const Stage& stage : stages_) largest_pi = std::max(largest_pi, stage.pi.cwiseAbs().maxCoeff());
    tolerance_ = tolerance + kQpRoundOff * largest_pi;
    stationarity_error_ = StationarityError(qp);
    return stationarity_error_ <= tolerance_;
  };
  return (Factorise(qp) && accurate()) || (FactoriseSafely(qp) && accurate());
}

// The recursion in its usual form, P = Q + AᵀP'A − H_xu H_uu⁻¹ H_ux, in which only the last term of P waits for K. It
// costs half as much as FactoriseRiccati, but its difference loses digits if the dynamics grow much over the horizon.
// Flattened, since GCC otherwise leaves some of the 8 × 8 products as calls, at 5 to 15 % of a solve.
template <int kNx, int kNu>
[[gnu::flatten]] bool Unconstrained<kNx, kNu>::Factorise(const Qp& qp) {
  using detail::Product;
  using MatrixXX = Eigen::Matrix<double, kNx, kNx>;
  using MatrixXU = Eigen::Matrix<double, kNx, kNu>;
  const std::size_t N = stages_.size() - 1;
  riccati_[N].P = qp.stages[N].Q.asDiagonal();
  gradients_[N].p = qp.stages[N].q;
  for (std::size_t i = N; i-- > 0;) {
    const auto& stage = qp.stages[i];
    auto& riccati = riccati_[i];
    const MatrixXX& P_next = riccati_[i + 1].P;
    riccati.A_transposed = stage.A.transpose();
    const MatrixXU PB = Product(P_next, stage.B);
    const MatrixXX PA = Product(P_next, stage.A);
    Eigen::Matrix<double, kNu, kNu> H_uu = Product(stage.B.transpose(), PB);
    H_uu.diagonal() += stage.R;
    if (!riccati.FactoriseInput(H_uu)) return false;
    const MatrixXU H_xu = Product(riccati.A_transposed, PB);
    const MatrixXU Y = Product(H_xu, riccati.L_inverse.transpose());
    const MatrixXU Y_D = Y * riccati.D_inverse.asDiagonal();
    riccati.K_transposed = -Product(Y_D, riccati.L_inverse);
    riccati.P = Product(riccati.A_transposed, PA);
    riccati.P -= Product(Y_D, Y.transpose());
    riccati.P.diagonal() += stage.Q;
    const VectorX p_next = gradients_[i + 1].p + Product(P_next, stage.c);
    const VectorU h_u = stage.r + Product(stage.B.transpose(), p_next);
    gradients_[i].k = riccati.SolveInput(h_u);
    gradients_[i].p = stage.q + Product(riccati.A_transposed, p_next) + Product(riccati.K_transposed, h_u);
  }
  return true;
}

template <int kNx, int kNu>
bool Unconstrained<kNx, kNu>::FactoriseSafely(const Qp& qp) {
  using detail::Product;
  const auto no_rows = [](std::size_t) { return std::size_t{0}; };
  const auto no_curvature = [](std::size_t, std::size_t) { return 0.0; };
  if (!detail::FactoriseRiccati(qp, no_rows, no_curvature, riccati_)) return false;
  gradients_.back().p = qp.stages.back().q;
  for (std::size_t i = stages_.size() - 1; i-- > 0;) {
    const auto& stage = qp.stages[i];
    auto& riccati = riccati_[i];
    riccati.A_transposed = stage.A.transpose();
    const VectorX p_next = gradients_[i + 1].p + Product(riccati_[i + 1].P, stage.c);
    gradients_[i].k = riccati.SolveInput((stage.r + Product(stage.B.transpose(), p_next)).eval());
    gradients_[i].p =
        stage.q + Product(riccati.A_K_transposed, p_next) + Product(riccati.K_transposed, stage.r);
  }
  return true;
}

// Computes x, u, π of the optimal inputs.
template <int kNx, int kNu>
[[gnu::flatten]] void Unconstrained<kNx, kNu>::RollOut(const Qp& qp) {
  using detail::Product;
  const std::size_t N = stages_.size() - 1;
  stages_[0].x = qp.x0;
  stages_[0].pi.setZero();
  for (std::size_t i = 0; i < N; ++i) {
    const auto& stage = qp.stages[i];
    Stage& at = stages_[i];
    Stage& next = stages_[i + 1];
    at.u = gradients_[i].k + Product(riccati_[i].K_transposed.transpose(), at.x);
    next.x = stage.c + Product(stage.A, at.x) + Product(stage.B, at.u);
    next.pi = gradients_[i + 1].p + Product(riccati_[i + 1].P, next.x);
  }
  stages_[N].u.setZero();
}

template <int kNx, int kNu>
double Unconstrained<kNx, kNu>::StationarityError(const Qp& qp) const {
  return detail::LargestGradient(
      qp, riccati_,
      [&](std::size_t i) -> VectorX {
        return qp.stages[i].Q.cwiseProduct(stages_[i].x) + qp.stages[i].q - stages_[i].pi;
      },
      [&](std::size_t i) -> VectorU { return qp.stages[i].R.cwiseProduct(stages_[i].u) + qp.stages[i].r; },
      [&](std::size_t i) -> const VectorX& { return stages_[i].pi; });
}

template <int kNx, int kNu>
void Unconstrained<kNx, kNu>::CloseLoop(const Qp& qp) {
  for (std::size_t i = 0; i + 1 < riccati_.size(); ++i) {
    const auto& stage = qp.stages[i];
    riccati_[i].A_K_transposed =
        (stage.A + detail::Product(stage.B, riccati_[i].K_transposed.transpose())).transpose();
  }
}

template <int kNx, int kNu>
void Unconstrained<kNx, kNu>::Write(const Qp& qp, Point& point) const {
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    auto& at = point.stages[i];
    at.x = stages_[i].x;
    at.u = stages_[i].u;
    at.pi = stages_[i].pi;
    std::fill_n(at.lambda.begin(), qp.stages[i].row_count, RowMultiplier{});
    std::fill_n(at.slack.begin(), qp.stages[i].row_count, 0.0);
  }
}

}  // namespace control
