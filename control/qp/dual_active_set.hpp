// The dual of a quadratic program in a few of its rows, solved exactly by an active set:
//
//   min over λ   ½ λᵀM λ − g_0ᵀλ + Σ_j ψ_j(λ_j)
//
// g_0 holds the rows' values at λ = 0, g = g_0 − M λ those at λ; M = G H⁻¹ Gᵀ with the rows G and the primal's
// Hessian H. λ_j is positive where the row is active at hi, negative where it is active at lo. ψ_j is the convex
// conjugate of the row's penalty: λ hi (λ lo where λ < 0), plus (|λ| − σ)² / (2ρ) where |λ| > σ (soft rows); a
// hard row has σ = ∞. So soft rows need no variables of their own: they add 1/ρ to M's diagonal where they are
// relaxed. The conditions of optimality are
//   λ = 0: lo ≤ g ≤ hi;   0 < λ < σ: g = hi;   λ ≥ σ: g = hi + (λ − σ) / ρ;   and the like on lo.
//
// λ moves through pieces on which ψ is quadratic. For the rows that are free to move, the factor
// L Lᵀ = M + diag(1/ρ) is kept and updated one row at a time. Every step lowers the cost, until a λ meets a
// breakpoint, the end of its piece. A row without curvature left yields a ray: if no breakpoint blocks it, no point
// satisfies the rows, and the ray's λ prove that.
//
// Source: D. Goldfarb, A. Idnani, A numerically stable dual method for solving strictly convex quadratic
// programs (1983); here with bounds and pieces in the dual, and with M already known.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace control {

class DualActiveSet {
 public:
  enum class Result : std::uint8_t {
    kSolved,
    kInfeasible,  // ray() proves it
    kStuck,       // too many changes of the set, because of round-off
  };

  explicit DualActiveSet(int capacity);

  void Clear();
  // Sets λ = 0, and from now on treats nearly dependent rows as independent: their λ have few digits, but this is worth
  // a try if the ray proves nothing.
  void Restart();
  [[nodiscard]] int size() const { return size_; }

  // Adds a row with λ = 0 and returns its index. `value` is its entry of g_0; its entries of M must be set by SetM
  // before anything else is called. ρ < 0: hard.
  int Add(double lo, double hi, double rho, double sigma, double value);
  void SetM(int i, int j, double value) { M_(i, j) = M_(j, i) = value; }
  // Rows violated by no more than the tolerance count as satisfied.
  Result Solve(double tolerance);

  [[nodiscard]] double lambda(int j) const { return lambda_[j]; }
  // Sets the row's value at the present λ, which M yields less accurately, for the next Solve.
  void Correct(int j, double value);
  [[nodiscard]] double ray(int j) const { return rows_[At(j)].direction; }
  [[nodiscard]] int changes() const { return changes_; }

 private:
  enum class Piece : std::uint8_t {
    kFixed,    // λ stays at 0 or at ±σ
    kHeld,     // |λ| in [0, σ]
    kRelaxed,  // |λ| in [σ, ∞)
  };
  struct Row {
    double lo, hi, rho, sigma;  // sigma = ∞: hard
    double direction = 0.0, residual = 0.0;
    double side = 1.0;  // 1: at hi, −1: at lo
    Piece piece = Piece::kFixed;
    int place = -1;  // index among the free rows; −1: not free

    [[nodiscard]] double Bound() const { return side > 0.0 ? hi : lo; }
    [[nodiscard]] double Compliance() const { return piece == Piece::kRelaxed ? 1.0 / rho : 0.0; }
  };
  struct Step {
    double length;
    int blocking;  // the row that met a breakpoint; −1: none
  };
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] static std::size_t At(int j) { return static_cast<std::size_t>(j); }
  [[nodiscard]] double Residual(int j) const;
  [[nodiscard]] double Violation(int j) const;
  void ComputeValue(int j);
  void ComputeResiduals();
  [[nodiscard]] bool Append(int j);
  void Remove(int j);
  void SolveTransposed();
  [[nodiscard]] Result Free(int j);
  [[nodiscard]] bool Settle();
  Step Advance(double limit, int joining);
  void CrossBreakpoint(int j);

  int capacity_, size_ = 0, free_count_ = 0, changes_ = 0;
  double dependent_;  // a pivot below this share of its diagonal entry counts as round-off
  std::vector<Row> rows_;
  std::vector<int> free_;  // the free rows, in the order of L's rows
  Vector g_0_, g_, lambda_;
  Matrix M_, L_;
  Vector inverse_diagonal_;  // 1 / diagonal entries of L
  Vector y_;                 // workspace of the triangular solves over the free rows
};

}  // namespace control
