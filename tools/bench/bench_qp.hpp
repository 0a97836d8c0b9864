// `lpvmpc bench qp`: time of the QP solver on recorded problems (tools/bench/qp_instance.hpp), cold and warm, without and with
// building the problem of its numbers.
#pragma once

#include <filesystem>
#include <ostream>

namespace tools {

struct BenchQpOptions {
  std::filesystem::path folder;  // its files *.qp, by name
  int repeat = 20;               // solves of each, one after the other
  bool json = false;
};

// For each horizon, cold and warm: how many were solved, proven infeasible (by their multipliers, checked here) or neither;
// median, p99 and maximum of all times [µs]; mean iterations; the largest KKT residual of a solved one, evaluated by
// itself. A warm solve starts from the solution of the file before it in its series, which is the name up to the last
// '_'. Throws one line at bad input, before anything is written.
void BenchQp(const BenchQpOptions& options, std::ostream& out);

}  // namespace tools
