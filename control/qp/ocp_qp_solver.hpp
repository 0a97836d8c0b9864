// Solves an OcpQp by the cheapest of three ways that will do:
//   1. The optimum without rows, by one Riccati recursion: the base. If it violates no row, it is the answer.
//   2. A dual active set on the rows that matter, whose columns are sweeps of the base's recursion: O(N) for each row
//      (ocp_qp_active_set.hpp, dual_active_set.hpp).
//   3. Where that knows too many rows or loses its digits, and where a soft row presses on both of its bounds, a
//      primal-dual interior point with Mehrotra's predictor and corrector, whose Newton systems are Riccati recursions:
//      O(N) for each iteration (ocp_qp_newton.hpp).
//
// Sources: C. V. Rao, S. J. Wright, J. B. Rawlings, Application of interior-point methods to model predictive control
// (1998), for the recursion and 3; D. Goldfarb, A. Idnani, A numerically stable dual method for solving strictly convex
// quadratic programs (1983), for 2; S. Mehrotra, On the implementation of a primal-dual interior point method (1992).
//
// Example:
//   OcpQpSolver<8, 2> solver(horizon);
//   const QpResult result = solver.Solve(qp);            // cold, or solver.Solve(qp, &guess)
//   if (result.status == SolverStatus::kSolved) use(solver.solution().stages[0].u);
//
// Instantiated for <8, 2> (the controllers); include ocp_qp_solver_impl.hpp for other sizes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "control/qp/dual_active_set.hpp"
#include "control/qp/ocp_qp.hpp"
#include "control/qp/ocp_qp_riccati.hpp"
#include "control/qp/status.hpp"

namespace control {

struct OcpQpKernels;

struct QpSettings {
  // Largest KKT residual of a solved problem, absolute, in the problem's units. On stationarity and complementarity
  // comes on top, for round-off, 1e-12 of the largest multiplier π of the problem without rows, and λ times 1e-12 of its
  // row's value. Where rows that nearly depend on each other have a λ whose round-off is above that: 1e-12 of the largest
  // λ on stationarity, and complementarity counts relative to its λ.
  double tolerance = 1e-8;
  int max_iterations = 60;  // of the interior point
  int max_known_rows = 96;  // that the active set may look at; 0: the interior point alone
};

enum class QpMethod : std::uint8_t { kBase, kActiveSet, kInteriorPoint };

// Asked before each iteration, and each time the active set takes rows; false ends the solve. The caller's, as time is.
using TimeLeft = std::function<bool()>;

struct QpResult {
  SolverStatus status = SolverStatus::kNumericalFailure;
  QpMethod method = QpMethod::kBase;  // that gave the answer
  int iterations = 0;                 // changes of the active set, or iterations of the interior point
  double kkt_residual = 0.0;          // of a solved problem
  bool feasible = false;              // solution() satisfies the dynamics and the hard rows

  // solution() tells the next problem something: a base has no multipliers.
  [[nodiscard]] bool MakesGuess() const {
    return status == SolverStatus::kSolved && method != QpMethod::kBase;
  }
};

template <int kNx, int kNu>
class OcpQpSolver {
 public:
  using Qp = OcpQp<kNx, kNu>;
  using Point = OcpQpPoint<kNx, kNu>;

  explicit OcpQpSolver(int horizon, const QpSettings& settings = {});  // horizon ≥ 1

  // `qp` and the guess must have the solver's horizon. Where nothing is violated by the optimum without any row, that is
  // the answer, after 0 iterations. A guess, which must not be solution() itself, tells which rows to look at first,
  // and where the interior point starts. Does not allocate.
  //   kSolved            solution() satisfies the conditions of optimality to the tolerance (in deviations from
  //                      the optimum without rows, whose own round-off comes on top)
  //   kInfeasible        solution()'s multipliers prove it (ProvesInfeasible)
  //   kIterationLimit    neither within max_iterations, or while time was left. solution() is the cheaper of the
  //                      last iterate and the guess's inputs among those that are feasible, if one is; else the last
  //                      iterate. So ends also a contradiction by little between rows whose inputs have no hard bounds
  //   kNumericalFailure  data not finite or so large that they overflow, σ < 0, or a factorisation broke down; solution()
  //                      is meaningless
  QpResult Solve(const Qp& qp, const Point* guess = nullptr, const TimeLeft* time_left = nullptr);

  [[nodiscard]] const Point& solution() const { return point_; }

 private:
  friend struct OcpQpKernels;                           // benchmarks
  static constexpr double kDualRegularisation = 1e-10;  // δ
  static constexpr double kRoundOff = 1e-12;
  static constexpr int kBatch = 4;  // rows whose responses share a sweep

  using VectorX = Eigen::Matrix<double, kNx, 1>;
  using VectorU = Eigen::Matrix<double, kNu, 1>;
  using MatrixXX = Eigen::Matrix<double, kNx, kNx>;
  using MatrixXU = Eigen::Matrix<double, kNx, kNu>;
  using MatrixUU = Eigen::Matrix<double, kNu, kNu>;

  // One bound of a row or of its slack: the distance to the bound as a variable t > 0 of its own, and the
  // Newton step.
  struct Side {
    bool present = false;
    double bound = 0.0;  // for deviations from the base
    double t = 1.0;
    double lambda = 0.0;
    double inverse_t = 0.0;  // 1 / (t + δ λ)
    double w = 0.0;          // λ / (t + δ λ)
    double residual = 0.0;   // distance − t
    double y = 0.0;          // the part of dλ that does not depend on dx, du, dε
    double dt = 0.0;
    double dlambda = 0.0;
  };
  struct RowWork {
    Side lo, hi;
    Side slack;  // ε ≥ 0, present where σ > 0
    double epsilon = 0.0;
    double r_epsilon = 0.0;  // gradient of the Lagrangian with respect to ε
    double inverse_s = 0.0;  // 1 / (ρ + w_lo + w_hi + w_ε); 0 of a hard row
    double y = 0.0;          // y_lo + y_hi + y_ε − r_epsilon
    double w = 0.0;
    double depsilon = 0.0;
  };
  struct RowPlace {
    std::size_t stage, row;
    double priority;
  };
  // The base, the optimum without rows, and deviations from it.
  struct StageWork {
    VectorX base_x, base_pi, x, pi, r_x;
    VectorU base_u, u, r_u;
    std::array<double, kMaxRows> lo, hi;  // bounds for deviations
    std::array<int, kMaxRows> known;      // the row's index in the dual; −1: not there
    std::array<RowWork, kMaxRows> rows;
  };

  bool SolveBase(const Qp& qp);
  bool FactoriseBase(const Qp& qp);
  bool FactoriseBaseSafely(const Qp& qp);
  void FollowBase(const Qp& qp);
  template <typename OwnX, typename OwnU, typename Pi>
  [[nodiscard]] double LargestGradient(const Qp& qp, OwnX&& own_x, OwnU&& own_u, Pi&& pi) const;
  [[nodiscard]] double BaseError(const Qp& qp) const;
  void CloseLoop(const Qp& qp);
  double ShiftRows(const Qp& qp);
  std::optional<SolverStatus> SolveByActiveSet(const Qp& qp, const Point* guess, const TimeLeft* time_left,
                                               QpResult& result);
  [[nodiscard]] double RowTolerance() const { return 0.1 * settings_.tolerance; }
  template <typename Visit>
  void ForEachKnown(const Qp& qp, Visit&& visit) const;
  [[nodiscard]] static double SlackOf(const OcpQpRow<kNx, kNu>& row, double lambda, double violation);
  bool FindViolated(const Qp& qp, const Point* guess);
  bool AddRows(const Qp& qp);
  void MoveToMultipliers(const Qp& qp);
  void CorrectValues(const Qp& qp);
  double StationarityError(const Qp& qp);
  bool ProveByRay(const Qp& qp);
  void WriteActiveSet(const Qp& qp);

  QpResult SolveByInteriorPoint(const Qp& qp, const Point* guess, const TimeLeft* time_left);
  void StartRows(const Qp& qp);
  void StartCold(const Qp& qp);
  bool StartFrom(const Qp& qp, const Point& guess);
  void StartRow(const OcpQpRow<kNx, kNu>& row, RowWork& work, const VectorX& x, const VectorU& u,
                double share, double mu, const RowMultiplier& at_least);
  double Residuals(const Qp& qp);
  bool Factorise(const Qp& qp, bool with_rows);
  void Step(const Qp& qp, double target, bool second_order);
  // The largest α ≤ 1 that leaves of every t and λ at least the fraction 1 − keep.
  [[nodiscard]] double StepLength(double keep) const { return std::min(1.0, keep * longest_); }
  // μ after a step of length α.
  [[nodiscard]] double ComplementarityAfter(double alpha) const {
    return mu_ + alpha * (first_order_ + alpha * second_order_) / std::max(sides_, 1);
  }
  void Move(const Qp& qp, double alpha);
  void WriteBase(const Qp& qp);
  void WriteWeightlessSlacks(const Qp& qp);
  void WriteSolution(const Qp& qp);
  bool SettleForFeasible(const Qp& qp, const Point* guess);
  double FillSlacks(const Qp& qp, Point& point) const;

  QpSettings settings_;
  Point point_;
  Point rollout_;  // of a guess
  std::vector<StageWork> work_;
  std::vector<detail::RiccatiStage<kNx, kNu>> riccati_;
  std::vector<detail::SweepStage<kNx, kNu, 1>> sweep_;
  std::vector<detail::SweepStage<kNx, kNu, kBatch>> responses_;
  DualActiveSet dual_;
  std::vector<RowPlace> known_;       // the dual's rows
  std::vector<RowPlace> candidates_;  // to be added to them, at most kBatch

  double tolerance_ = 0.0;   // with what round-off needs
  double base_error_ = 0.0;  // largest entry of the gradient at the base
  bool has_weightless_rows_ = false;
  // At x, u, λ: by how much a row is violated (of the interior point: |distance − t|); λ times its row's distance; and
  // the same with λ of 1 at most.
  double row_error_ = 0.0, complementarity_error_ = 0.0, distance_error_ = 0.0;
  // Of the interior point.
  double mu_ = 0.0;                                // mean complementarity
  double longest_ = 0.0;                           // the step of this length brings the first t or λ to zero
  double first_order_ = 0.0, second_order_ = 0.0;  // of the sum of all λ t, in the step's length
  int sides_ = 0;                                  // finite bounds, those of slacks among them
};

}  // namespace control
