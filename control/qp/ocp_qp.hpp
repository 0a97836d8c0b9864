// The optimal-control quadratic program that every controller here solves:
//
//   min   Σ_{i=0..N} ½ xᵢᵀ diag(Q_i) xᵢ + q_iᵀ xᵢ  +  Σ_{i=0..N-1} ½ uᵢᵀ diag(R_i) uᵢ + r_iᵀ uᵢ
//         +  Σ_soft ½ ρ ε² + σ ε
//   s.t.  x_0 given,   x_{i+1} = A_i xᵢ + B_i uᵢ + c_i
//         lo − ε ≤ C xᵢ + D uᵢ ≤ hi + ε     for every row of stage i; ε = 0 where the row is hard,
//                                           ε ≥ 0 where σ > 0
//
// A soft row has one slack ε, shared by both sides. Stage N has no input. With Q ⪰ 0 and R ≻ 0 it is convex.
//
// With σ = 0 a soft row gives way a little as soon as holding it costs anything. With σ > 0 the penalty is
// exact: an optimum with these rows hard whose multipliers λ_lo + λ_hi are each at most σ is the optimum with
// them soft, too. So no row that can hold is violated if σ is above them. In a violated row
// λ_lo + λ_hi = σ + ρ ε.
// Source: R. Fletcher, Practical Methods of Optimization, 2nd edition (1987), chapter 14 (exact penalty).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace control {

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();
inline constexpr int kMaxRows = 28;  // rows a stage can hold

template <int kNx, int kNu>
struct OcpQpRow {
  static constexpr int kGeneral = -1;

  Eigen::Matrix<double, kNx, 1> C = Eigen::Matrix<double, kNx, 1>::Zero();
  Eigen::Matrix<double, kNu, 1> D = Eigen::Matrix<double, kNu, 1>::Zero();
  double lo = -kNoBound;
  double hi = kNoBound;
  double rho = -1.0;   // ρ, weight of the slack's square; negative: hard row
  double sigma = 0.0;  // σ ≥ 0, weight of the slack in a soft row, cost per unit of the row: exact penalty
  bool holds_input = false;  // D ≠ 0
  int unit = kGeneral;       // index in [x; u] if the row bounds that variable alone, with coefficient 1

  [[nodiscard]] bool soft() const { return rho >= 0.0; }
  [[nodiscard]] bool exact() const { return soft() && sigma > 0.0; }  // its slack has the bound ε ≥ 0
  [[nodiscard]] bool weightless() const { return rho == 0.0 && sigma == 0.0; }  // costs nothing to violate
  [[nodiscard]] bool has_lo() const { return lo > -kNoBound; }
  [[nodiscard]] bool has_hi() const { return hi < kNoBound; }
};

template <int kNx, int kNu>
struct OcpQpStage {
  using Row = OcpQpRow<kNx, kNu>;

  Eigen::Matrix<double, kNx, kNx> A = Eigen::Matrix<double, kNx, kNx>::Zero();
  Eigen::Matrix<double, kNx, kNu> B = Eigen::Matrix<double, kNx, kNu>::Zero();
  Eigen::Matrix<double, kNx, 1> c = Eigen::Matrix<double, kNx, 1>::Zero();
  Eigen::Matrix<double, kNx, 1> Q = Eigen::Matrix<double, kNx, 1>::Zero();
  Eigen::Matrix<double, kNx, 1> q = Eigen::Matrix<double, kNx, 1>::Zero();
  Eigen::Matrix<double, kNu, 1> R = Eigen::Matrix<double, kNu, 1>::Zero();
  Eigen::Matrix<double, kNu, 1> r = Eigen::Matrix<double, kNu, 1>::Zero();
  std::array<Row, kMaxRows> rows;
  int row_count = 0;

  void ClearRows() { row_count = 0; }
  // lo ≤ x[index] ≤ hi and lo ≤ u[index] ≤ hi. False, and nothing added, if the stage is full.
  [[nodiscard]] bool AddStateBound(int index, double lo, double hi, double rho = -1.0, double sigma = 0.0);
  [[nodiscard]] bool AddInputBound(int index, double lo, double hi, double rho = -1.0, double sigma = 0.0);
  // lo ≤ C x + D u ≤ hi.
  [[nodiscard]] bool AddRow(const Eigen::Matrix<double, kNx, 1>& C, const Eigen::Matrix<double, kNu, 1>& D,
                            double lo, double hi, double rho = -1.0, double sigma = 0.0);
};

// Stages 0..N; everything is sized at construction.
template <int kNx, int kNu>
struct OcpQp {
  explicit OcpQp(int horizon) : stages(static_cast<std::size_t>(horizon) + 1) {}
  [[nodiscard]] int horizon() const { return static_cast<int>(stages.size()) - 1; }

  Eigen::Matrix<double, kNx, 1> x0 = Eigen::Matrix<double, kNx, 1>::Zero();
  std::vector<OcpQpStage<kNx, kNu>> stages;
};

// Multipliers of a row: λ_lo of C x + D u + ε ≥ lo, λ_hi of C x + D u − ε ≤ hi; both ≥ 0. That
// of ε ≥ 0, where σ > 0, follows from them: λ_ε = ρ ε + σ − λ_lo − λ_hi.
struct RowMultiplier {
  double lo = 0.0;
  double hi = 0.0;

  // Of λ_hi − λ_lo, where one of them is zero.
  [[nodiscard]] static RowMultiplier OfDifference(double lambda) {
    return {.lo = std::max(0.0, -lambda), .hi = std::max(0.0, lambda)};
  }
  // More than an interior point leaves of a multiplier whose row does not.
  [[nodiscard]] bool Presses() const { return std::max(lo, hi) > 1e-6; }
};

// A primal-dual point. π_i is the multiplier of the dynamics that give x_i (i ≥ 1); π_0 is unused.
template <int kNx, int kNu>
struct OcpQpPoint {
  struct Stage {
    Eigen::Matrix<double, kNx, 1> x = Eigen::Matrix<double, kNx, 1>::Zero();
    Eigen::Matrix<double, kNu, 1> u = Eigen::Matrix<double, kNu, 1>::Zero();
    Eigen::Matrix<double, kNx, 1> pi = Eigen::Matrix<double, kNx, 1>::Zero();
    std::array<RowMultiplier, kMaxRows> lambda{};
    std::array<double, kMaxRows> slack{};  // ε
  };
  explicit OcpQpPoint(int horizon) : stages(static_cast<std::size_t>(horizon) + 1) {}
  // A guess for the problem one stage later. The last two stages keep their own: the rows of stage N are not those of
  // stage N − 1.
  void Shift() { std::copy(stages.begin() + 1, stages.end() - 1, stages.begin()); }

  std::vector<Stage> stages;
};

// The largest violation, in absolute terms, of each of the conditions of optimality (Karush, Kuhn, Tucker).
struct KktResidual {
  double stationarity = 0.0;     // gradient of the Lagrangian with respect to x, u and, where σ = 0, ε
  double dynamics = 0.0;         // x_0 and x_{i+1} = A x + B u + c
  double rows = 0.0;             // lo − ε ≤ C x + D u ≤ hi + ε, and ε ≥ 0 where σ > 0
  double multipliers = 0.0;      // λ ≥ 0, λ_ε among them
  double complementarity = 0.0;  // λ times its row's distance to the bound

  [[nodiscard]] double Max() const {
    return std::max({stationarity, dynamics, rows, multipliers, complementarity});
  }
};

template <int kNx, int kNu>
[[nodiscard]] KktResidual EvaluateKkt(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point);

template <int kNx, int kNu>
[[nodiscard]] double EvaluateCost(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point);

// True if the multipliers λ ≥ 0 of the hard rows prove that no input sequence satisfies them all (Farkas'
// lemma): the λ-weighted sum of the rows, reduced to the inputs alone by the adjoint of the dynamics, is
// negative for every input within its own hard bounds.
template <int kNx, int kNu>
[[nodiscard]] bool ProvesInfeasible(const OcpQp<kNx, kNu>& qp, const OcpQpPoint<kNx, kNu>& point);

}  // namespace control
