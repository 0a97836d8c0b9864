// `lpvmpc bench qp`: time of the QP solver on recorded problems (config/qp_file.hpp), cold and warm, without
// and with building the problem from its numbers.
#pragma once

#include <filesystem>
#include <ostream>

namespace tools {

struct BenchQpOptions {
  std::filesystem::path folder;  // its *.qp files are read in the order of their names
  int repeat = 20;               // consecutive solves of each problem
  bool json = false;
};

// Writes, for each horizon, cold and warm: how many problems were solved, proven infeasible (the multipliers are
// checked here) or neither; median, p99 and maximum of all times [µs]; mean iterations; the largest KKT residual of the
// solved problems, evaluated independently of the solver. A warm solve starts from the solution of the previous file of
// its series (the name up to the last '_'), unless that file was not solved or its solution is the unconstrained
// optimum. On bad input, throws an exception with a one-line message before anything is written.
void BenchQp(const BenchQpOptions& options, std::ostream& out);

}  // namespace tools
