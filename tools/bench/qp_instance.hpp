// A controller's quadratic problem as text, numbers separated by white space:
//   N nx nu                            with the word "sigma" before, where rows have σ
//   x_0
//   A_i B_i c_i                        i = 0..N−1, row-major
//   Q_i q_i                            i = 0..N, Q_i its diagonal
//   R_i r_i                            i = 0..N−1, R_i its diagonal
//   n_i, and n_i times C D lo hi ρ     i = 0..N; with σ at the end, where rows have it
// A bound beyond ±1e19 is absent; ρ < 0 marks a hard row. For the symbols see control/qp/problem.hpp.
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

#include "control/qp/problem.hpp"

namespace tools {

// The numbers of a file, of which a problem can be built again and again.
class QpInstance {
 public:
  // Throws std::runtime_error "FILE:LINE: what is wrong": unreadable, not a number, a number too few or too many, not 8
  // states and 2 inputs, N outside 1..1000, more rows in a step than there is room for.
  explicit QpInstance(const std::filesystem::path& file);

  [[nodiscard]] int horizon() const { return horizon_; }
  // Into a problem of the same horizon. Does not allocate.
  void Build(control::OcpQp<8, 2>& qp) const;
  [[nodiscard]] control::OcpQp<8, 2> Build() const;

 private:
  bool sigma_ = false;
  int horizon_ = 0;
  std::vector<double> numbers_;  // all after N nx nu
};

// With all digits, so that it reads back the same.
void WriteQpInstance(const control::OcpQp<8, 2>& qp, std::ostream& out);

}  // namespace tools
