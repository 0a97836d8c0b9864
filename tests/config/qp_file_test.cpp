#include "config/qp_file.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "tests/support/temp_dir.hpp"

namespace {

using Qp = control::OcpQp<8, 2>;

std::string Text(const Qp& qp) {
  std::ostringstream out;
  config::WriteQpFile(qp, out);
  return out.str();
}

TEST(QpFile, WhatIsWrittenReadsBackTheSame) {
  Qp qp = config::QpFile(LPVMPC_TEST_DATA "/qp/s7trN15_0044.qp").Build();
  EXPECT_EQ(qp.horizon(), 15);
  const test_support::TempDir folder;
  const auto file = folder.path() / "a.qp";
  for (const double sigma : {0.0, 0.1}) {
    ASSERT_TRUE(qp.stages[3].AddStateBound(2, -control::kNoBound, 1.0 / 3.0, 10.0, sigma));
    std::ofstream(file) << Text(qp);
    const Qp again = config::QpFile(file).Build();
    EXPECT_EQ(Text(again), Text(qp));
    const auto& row = again.stages[3].rows[static_cast<std::size_t>(again.stages[3].row_count) - 1];
    EXPECT_FALSE(row.has_lo());
    EXPECT_EQ(row.hi, 1.0 / 3.0);
    EXPECT_EQ(row.sigma, sigma);
    EXPECT_EQ(row.unit, 2);
  }
}

}  // namespace
