// The optimal-control quadratic program:
//
//   min   Σ_{i=0..N} ½ xᵢᵀ diag(Q_i) xᵢ + q_iᵀ xᵢ  +  Σ_{i=0..N-1} ½ uᵢᵀ diag(R_i) uᵢ + r_iᵀ uᵢ
//         +  Σ_soft ½ ρ ε² + σ ε
//   s.t.  x_0 given,   x_{i+1} = A_i xᵢ + B_i uᵢ + c_i
//         lo − ε ≤ C xᵢ + D uᵢ ≤ hi + ε     for every row of stage i; ε = 0 where the row is hard,
//                                           ε ≥ 0 where σ > 0
//
// A soft row has one slack ε, shared by both sides. Stage N has no input. With Q ⪰ 0 and R ≻ 0 the problem is convex.
//
// With σ = 0 a soft row is violated a little as soon as satisfying it costs anything. With σ > 0 the penalty is
// exact: an optimum with these rows hard is also the optimum with them soft if each row's λ_lo + λ_hi is at most
// σ. So, if σ is large enough, no row is violated that can be satisfied. In a violated row λ_lo + λ_hi = σ + ρ ε.
// Source: R. Fletcher, Practical Methods of Optimization, 2nd edition (1987), chapter 14 (exact penalty).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace control {

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();
inline constexpr int kMaxRows = 28;  // largest number of rows in a stage

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
  [[nodiscard]] bool exact() const { return soft() && sigma > 0.0; }  // ε ≥ 0 is a bound of its own
  [[nodiscard]] bool has_zero_penalty() const { return rho == 0.0 && sigma == 0.0; }
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
  // Add lo ≤ x[index] ≤ hi or lo ≤ u[index] ≤ hi. All three return false and add nothing if the stage is full.
  [[nodiscard]] bool AddStateBound(int index, double lo, double hi, double rho = -1.0, double sigma = 0.0);
  [[nodiscard]] bool AddInputBound(int index, double lo, double hi, double rho = -1.0, double sigma = 0.0);
  // Adds lo ≤ C x + D u ≤ hi.
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

template <int kNx, int kNu>
bool OcpQpStage<kNx, kNu>::AddStateBound(int index, double lo, double hi, double rho, double sigma) {
  if (row_count == kMaxRows) return false;
  Row& row = rows[static_cast<std::size_t>(row_count++)];
  row = Row{.lo = lo, .hi = hi, .rho = rho, .sigma = sigma, .unit = index};
  row.C[index] = 1.0;
  return true;
}

template <int kNx, int kNu>
bool OcpQpStage<kNx, kNu>::AddInputBound(int index, double lo, double hi, double rho, double sigma) {
  if (row_count == kMaxRows) return false;
  Row& row = rows[static_cast<std::size_t>(row_count++)];
  row = Row{.lo = lo, .hi = hi, .rho = rho, .sigma = sigma, .unit = kNx + index};
  row.D[index] = 1.0;
  row.holds_input = true;
  return true;
}

template <int kNx, int kNu>
bool OcpQpStage<kNx, kNu>::AddRow(const Eigen::Matrix<double, kNx, 1>& C,
                                  const Eigen::Matrix<double, kNu, 1>& D, double lo, double hi, double rho,
                                  double sigma) {
  if (row_count == kMaxRows) return false;
  Row& row = rows[static_cast<std::size_t>(row_count++)];
  row = Row{.C = C, .D = D, .lo = lo, .hi = hi, .rho = rho, .sigma = sigma};
  row.holds_input = !D.isZero(0.0);
  int entries = 0;
  for (int k = 0; k < kNx + kNu; ++k) {
    const double entry = k < kNx ? C[k] : D[k - kNx];
    if (entry != 0.0) row.unit = ++entries == 1 && entry == 1.0 ? k : Row::kGeneral;
  }
  return true;
}

// True if every number is finite, except the infinite bounds that mean "no bound", and no σ is negative. Comparisons
// alone would not suffice: a NaN bound looks like no bound, a NaN weight like that of a hard row.
template <int kNx, int kNu>
[[nodiscard]] bool HasFiniteData(const OcpQp<kNx, kNu>& qp) {
  // Sums of zero times each number are zero or NaN. Several sums run in parallel, so that none waits for another.
  Eigen::Matrix<double, kNx, 1> zero_x = 0.0 * qp.x0, zero_a = Eigen::Matrix<double, kNx, 1>::Zero();
  Eigen::Matrix<double, kNu, 1> zero_u = Eigen::Matrix<double, kNu, 1>::Zero();
  double zero = 0.0;
  bool ordered = true;
  for (std::size_t i = 0; i < qp.stages.size(); ++i) {
    const auto& stage = qp.stages[i];
    zero_x += 0.0 * stage.Q + 0.0 * stage.q;
    if (i + 1 < qp.stages.size()) {
      for (int k = 0; k < kNx; k += 2) {
        zero_a += 0.0 * stage.A.col(k);
        if (k + 1 < kNx) zero_x += 0.0 * stage.A.col(k + 1);
      }
      for (int k = 0; k < kNu; ++k) zero_a += 0.0 * stage.B.col(k);
      zero_x += 0.0 * stage.c;
      zero_u += 0.0 * stage.R + 0.0 * stage.r;
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(stage.row_count); ++j) {
      const auto& row = stage.rows[j];
      ordered = ordered && (row.lo < kNoBound) && (row.hi > -kNoBound) && (row.sigma >= 0.0);
      zero += 0.0 * row.rho + 0.0 * row.sigma;
      zero_a += 0.0 * row.C;
      zero_u += 0.0 * row.D;
    }
  }
  return ordered && zero + zero_x.sum() + zero_a.sum() + zero_u.sum() == 0.0;
}

extern template struct OcpQpStage<8, 2>;
extern template struct OcpQpStage<2, 1>;

}  // namespace control
