#include "control/qp/dual_active_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// This is far above round-off: a false ray proves nothing and does no harm, but a dependent row that joins L leaves λ
// without digits.
constexpr double kDependent = 1e-8;
constexpr double kDependentAfterRestart = 1e-13;
constexpr int kChangesPerRow = 10;

}  // namespace

DualActiveSet::DualActiveSet(int capacity)
    : capacity_(capacity),
      dependent_(kDependent),
      rows_(At(capacity)),
      free_(At(capacity)),
      g_0_(capacity),
      g_(capacity),
      lambda_(capacity),
      M_(capacity, capacity),
      L_(capacity, capacity),
      inverse_diagonal_(capacity),
      y_(capacity) {}

void DualActiveSet::Clear() {
  size_ = free_count_ = 0;
  dependent_ = kDependent;
}

void DualActiveSet::Restart() {
  free_count_ = 0;
  dependent_ = kDependentAfterRestart;
  for (int j = 0; j < size_; ++j) {
    rows_[At(j)].piece = Piece::kFixed;
    rows_[At(j)].place = -1;
    lambda_[j] = 0.0;
  }
}

int DualActiveSet::Add(double lo, double hi, double rho, double sigma, double value) {
  const int j = size_++;
  Row& row = rows_[At(j)] = {.lo = lo, .hi = hi, .rho = rho, .sigma = sigma};
  if (rho < 0.0) row.sigma = kInfinity;
  g_0_[j] = g_[j] = value;
  lambda_[j] = 0.0;
  return j;
}

DualActiveSet::Result DualActiveSet::Solve(double tolerance) {
  changes_ = 0;
  ComputeResiduals();
  for (;;) {
    if (!Settle()) return Result::kStuck;
    int worst = -1;
    double most = 0.0;
    for (int j = 0; j < size_; ++j) {
      const Row& row = rows_[At(j)];
      if (row.place >= 0) continue;
      ComputeValue(j);
      const double violation = Violation(j);
      if (violation <= tolerance) continue;
      // The gain of the dual if this row alone moves.
      const double gain = violation * violation / (M_(j, j) + (row.sigma > 0.0 ? 0.0 : 1.0 / row.rho));
      if (gain > most) {
        most = gain;
        worst = j;
      }
    }
    if (worst < 0) return Result::kSolved;
    const int before = changes_;
    const Result freed = Free(worst);
    if (freed != Result::kSolved) return freed;
    if (changes_ == before) {
      rows_[At(worst)].residual = Residual(worst);  // the others' are zero
    } else {
      ComputeResiduals();
    }
  }
}

// Sets the value at λ = 0 that, with M, yields this value at λ.
void DualActiveSet::Correct(int j, double value) {
  g_0_[j] = value + M_.row(j).head(size_).dot(lambda_.head(size_));
}

double DualActiveSet::Residual(int j) const {
  const Row& row = rows_[At(j)];
  const double slack = row.piece == Piece::kRelaxed ? (lambda_[j] - row.side * row.sigma) / row.rho : 0.0;
  return g_[j] - row.Bound() - slack;
}

// The distance by which g of a fixed row is outside the range that its λ allows.
double DualActiveSet::Violation(int j) const {
  const Row& row = rows_[At(j)];
  if (lambda_[j] == 0.0) return std::max(g_[j] - row.hi, row.lo - g_[j]);
  const double over = row.side * (g_[j] - row.Bound());
  return row.rho > 0.0 ? std::abs(over) : -over;
}

void DualActiveSet::ComputeValue(int j) {
  g_[j] = g_0_[j] - M_.row(j).head(size_).dot(lambda_.head(size_));
}

void DualActiveSet::ComputeResiduals() {
  for (int i = 0; i < free_count_; ++i) {
    const int j = free_[At(i)];
    ComputeValue(j);
    rows_[At(j)].residual = Residual(j);
  }
}

// Adds the row to the free ones. False if it depends on them; row free_count_ of L then holds its part of L.
bool DualActiveSet::Append(int j) {
  Row& row = rows_[At(j)];
  const int n = free_count_;
  auto l = L_.row(n);
  double square = 0.0;
  for (int i = 0; i < n; ++i) {
    l[i] = (M_(j, free_[At(i)]) - l.head(i).dot(L_.row(i).head(i))) * inverse_diagonal_[i];
    square += l[i] * l[i];
  }
  const double diagonal = M_(j, j) + row.Compliance();
  const double pivot = diagonal - square;
  if (!(pivot > dependent_ * diagonal)) return false;
  l[n] = std::sqrt(pivot);
  inverse_diagonal_[n] = 1.0 / l[n];
  free_[At(n)] = j;
  row.place = free_count_++;
  return true;
}

// Removes a row from L: the rows after it move up, and rotations of neighbouring columns restore the triangular form.
void DualActiveSet::Remove(int j) {
  Row& row = rows_[At(j)];
  const int q = row.place;
  row.place = -1;
  if (q < 0) return;
  --free_count_;
  for (int i = q; i < free_count_; ++i) {
    free_[At(i)] = free_[At(i) + 1];
    rows_[At(free_[At(i)])].place = i;
    L_.row(i).head(i + 2) = L_.row(i + 1).head(i + 2);
  }
  for (int c = q; c < free_count_; ++c) {
    const double radius = std::hypot(L_(c, c), L_(c, c + 1));
    const double cosine = L_(c, c) / radius, sine = L_(c, c + 1) / radius;
    L_(c, c) = radius;
    inverse_diagonal_[c] = 1.0 / radius;
    for (int i = c + 1; i < free_count_; ++i) {
      const double left = L_(i, c), right = L_(i, c + 1);
      L_(i, c) = cosine * left + sine * right;
      L_(i, c + 1) = cosine * right - sine * left;
    }
  }
}

// y := L⁻ᵀ y over the free rows.
void DualActiveSet::SolveTransposed() {
  for (int i = free_count_; i-- > 0;) {
    y_[i] *= inverse_diagonal_[i];
    y_.head(i) -= y_[i] * L_.row(i).head(i).transpose();
  }
}

// Frees a fixed row at its present λ.
DualActiveSet::Result DualActiveSet::Free(int j) {
  Row& row = rows_[At(j)];
  if (lambda_[j] == 0.0) row.side = g_[j] > row.hi ? 1.0 : -1.0;
  const double sign = g_[j] > row.Bound() ? 1.0 : -1.0;  // sign of λ's change
  if (lambda_[j] == 0.0) {
    row.piece = row.sigma > 0.0 ? Piece::kHeld : Piece::kRelaxed;
  } else {
    row.piece = sign == row.side ? Piece::kRelaxed : Piece::kHeld;
  }
  while (!Append(j)) {
    if (++changes_ > kChangesPerRow * capacity_) return Result::kStuck;
    // The free rows compensate this one completely: g stays the same while λ moves along the ray.
    for (int i = 0; i < size_; ++i) rows_[At(i)].direction = 0.0;
    y_.head(free_count_) = -sign * L_.row(free_count_).head(free_count_).transpose();
    SolveTransposed();
    for (int i = 0; i < free_count_; ++i) {
      Row& compensating = rows_[At(free_[At(i)])];
      // A relaxed row's part in a ray is only round-off.
      if (compensating.piece == Piece::kHeld) compensating.direction = y_[i];
    }
    row.direction = sign;
    const Step step = Advance(kInfinity, j);
    if (step.blocking < 0) return Result::kInfeasible;
    CrossBreakpoint(step.blocking);
    if (row.piece == Piece::kFixed || row.place >= 0) break;
  }
  return Result::kSolved;
}

// Brings the residuals of the free rows to zero. False if that takes too many changes.
bool DualActiveSet::Settle() {
  while (free_count_ > 0) {
    if (++changes_ > kChangesPerRow * capacity_) return false;
    int from = 0;
    for (; from < free_count_ && rows_[At(free_[At(from)])].residual == 0.0; ++from) y_[from] = 0.0;
    for (int i = from; i < free_count_; ++i) {
      const double dot = y_.segment(from, i - from).dot(L_.row(i).segment(from, i - from));
      y_[i] = (rows_[At(free_[At(i)])].residual - dot) * inverse_diagonal_[i];
    }
    SolveTransposed();
    for (int i = 0; i < free_count_; ++i) rows_[At(free_[At(i)])].direction = y_[i];
    const Step step = Advance(1.0, -1);
    const double left = step.blocking < 0 ? 0.0 : 1.0 - step.length;
    for (int i = 0; i < free_count_; ++i) rows_[At(free_[At(i)])].residual *= left;
    if (step.blocking < 0) return true;
    CrossBreakpoint(step.blocking);
  }
  return true;
}

// Moves λ of the free rows, and of the joining one, along their directions up to the limit or the first breakpoint.
DualActiveSet::Step DualActiveSet::Advance(double limit, int joining) {
  Step step{.length = limit, .blocking = -1};
  double end = 0.0;
  const auto check = [&](int j) {
    const Row& row = rows_[At(j)];
    const double size = row.side * lambda_[j], change = row.side * row.direction;
    if (change == 0.0) return;
    const bool hold = row.piece == Piece::kHeld;
    const double towards = change < 0.0 ? (hold ? 0.0 : row.sigma) : (hold ? row.sigma : kInfinity);
    const double length = std::max(0.0, (towards - size) / change);
    if (length < step.length) {
      step = {.length = length, .blocking = j};
      end = row.side * towards;
    }
  };
  for (int i = 0; i < free_count_; ++i) check(free_[At(i)]);
  if (joining >= 0) check(joining);
  if (step.length == kInfinity) return step;
  const auto move = [&](int j) { lambda_[j] += step.length * rows_[At(j)].direction; };
  for (int i = 0; i < free_count_; ++i) move(free_[At(i)]);
  if (joining >= 0) move(joining);
  if (step.blocking >= 0) lambda_[step.blocking] = end;
  return step;
}

// λ_j has reached a breakpoint: it continues on the next piece, or stays fixed there.
void DualActiveSet::CrossBreakpoint(int j) {
  Row& row = rows_[At(j)];
  const bool falling = row.side * row.direction < 0.0;
  if (falling && lambda_[j] == 0.0 && row.lo == row.hi) {
    row.side = -row.side;
    return;
  }
  Remove(j);
  const Piece before = row.piece;
  row.piece = Piece::kFixed;
  if (lambda_[j] == 0.0) return;
  if (before == Piece::kHeld && row.rho == 0.0) return;
  row.piece = before == Piece::kHeld ? Piece::kRelaxed : Piece::kHeld;
  if (!Append(j)) row.piece = Piece::kFixed;
}

}  // namespace control
