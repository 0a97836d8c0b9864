// A controller's quadratic problem as text, numbers separated by white space:
//   N nx nu                            preceded by the word "sigma" if the rows have σ
//   x_0
//   A_i B_i c_i                        i = 0..N−1, row-major
//   Q_i q_i                            i = 0..N, Q_i its diagonal
//   R_i r_i                            i = 0..N−1, R_i its diagonal
//   n_i, and n_i times C D lo hi ρ     i = 0..N; followed by σ if the rows have it
// A bound beyond ±1e19 is absent; ρ < 0 marks a hard row. control/qp/problem.hpp explains the symbols.
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

#include "control/qp/problem.hpp"

namespace config {

// The numbers of a file, from which a problem can be built repeatedly.
class QpFile {
 public:
  // Throws std::runtime_error "FILE:LINE: what is wrong" if the file is unreadable, contains a word that is not a
  // number, too few or too many numbers, has other than 8 states and 2 inputs, N outside 1..1000, or more rows in a
  // step than control::kMaxRows.
  explicit QpFile(const std::filesystem::path& file);

  [[nodiscard]] int horizon() const { return horizon_; }
  // `qp` must have the same horizon. Does not allocate.
  void Build(control::OcpQp<8, 2>& qp) const;
  [[nodiscard]] control::OcpQp<8, 2> Build() const;

 private:
  bool sigma_ = false;
  int horizon_ = 0;
  std::vector<double> numbers_;  // everything after N nx nu
};

// Writes all digits, so that the problem reads back unchanged.
void WriteQpFile(const control::OcpQp<8, 2>& qp, std::ostream& out);

}  // namespace config
