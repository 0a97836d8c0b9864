// A nonlinear program with sparse derivatives, as a solver asks for it (ipopt_solver.hpp):
//
//   min f(x)   s.t.  lo ≤ g(x) ≤ hi,  lo ≤ x ≤ hi
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace control {

class NonlinearProgram {
 public:
  struct Bounds {
    std::vector<double> lo, hi;  // ±∞ where there is none
  };
  struct Entry {
    int row;
    int column;
  };

  virtual ~NonlinearProgram() = default;

  [[nodiscard]] virtual int variables() const = 0;
  [[nodiscard]] virtual int rows() const = 0;
  [[nodiscard]] virtual const Bounds& variable_bounds() const = 0;
  [[nodiscard]] virtual const Bounds& row_bounds() const = 0;
  // Places that may differ from zero, each once; of the Hessian those of the lower triangle. Values come in their
  // order.
  [[nodiscard]] virtual const std::vector<Entry>& jacobian_pattern() const = 0;
  [[nodiscard]] virtual const std::vector<Entry>& hessian_pattern() const = 0;

  // x, gradient: variables(); g, λ: rows(); values: one for each place of the pattern.
  [[nodiscard]] virtual double Cost(std::span<const double> x) const = 0;
  virtual void Gradient(std::span<const double> x, std::span<double> gradient) const = 0;
  virtual void Rows(std::span<const double> x, std::span<double> g) const = 0;
  virtual void Jacobian(std::span<const double> x, std::span<double> values) const = 0;
  // Of σ f + λᵀ g.
  virtual void Hessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                       std::span<double> values) const = 0;
};

// The vector that begins at x[i].
template <typename Vector>
[[nodiscard]] Eigen::Map<const Vector> At(std::span<const double> x, int i) {
  return Eigen::Map<const Vector>(x.subspan(static_cast<std::size_t>(i), Vector::SizeAtCompileTime).data());
}

}  // namespace control
