// A nonlinear program with sparse derivatives, in the form that a solver requires (ipopt_solver.hpp):
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
    std::vector<double> lo, hi;  // ±∞ where there is no bound
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
  // Entries that may be non-zero, each once; for the Hessian, those of the lower triangle. Values come in the same
  // order.
  [[nodiscard]] virtual const std::vector<Entry>& jacobian_pattern() const = 0;
  [[nodiscard]] virtual const std::vector<Entry>& hessian_pattern() const = 0;

  // Sizes: x and gradient variables(), g and λ rows(), values one for each entry of the pattern.
  [[nodiscard]] virtual double Cost(std::span<const double> x) const = 0;
  virtual void Gradient(std::span<const double> x, std::span<double> gradient) const = 0;
  virtual void Rows(std::span<const double> x, std::span<double> g) const = 0;
  virtual void Jacobian(std::span<const double> x, std::span<double> values) const = 0;
  // The Hessian of σ f + λᵀ g.
  virtual void Hessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                       std::span<double> values) const = 0;
};

// The vector that begins at x[i].
template <typename Vector>
[[nodiscard]] Eigen::Map<const Vector> At(std::span<const double> x, int i) {
  return Eigen::Map<const Vector>(x.subspan(static_cast<std::size_t>(i), Vector::SizeAtCompileTime).data());
}

}  // namespace control
