#include "tools/falsify/cross_entropy.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace {

using tools::CrossEntropy;
using Points = std::vector<CrossEntropy::Point>;

template <typename Function>
CrossEntropy::Point Minimise(const Function& function, std::size_t dimensions, int generations,
                             std::uint64_t seed) {
  CrossEntropy method(dimensions, seed);
  CrossEntropy::Point best;
  for (int g = 0; g < generations; ++g) {
    Points points;
    for (int i = 0; i < 100; ++i) points.push_back(method.Draw());
    std::ranges::sort(points, {}, function);
    best = points.front();
    method.Learn(std::span(points).first(10));
  }
  return best;
}

TEST(CrossEntropy, DrawsUniformlyBeforeItHasLearnt) {
  CrossEntropy method(3, 1);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 4000; ++i) {
    for (const double value : method.Draw()) {
      ASSERT_GE(value, 0.0);
      ASSERT_LT(value, 1.0);
      sum += value;
      squares += value * value;
    }
  }
  EXPECT_NEAR(sum / 12000.0, 0.5, 0.01);
  EXPECT_NEAR(squares / 12000.0, 1.0 / 3.0, 0.01);
}

TEST(CrossEntropy, FindsTheLowestPointOfABowl) {
  const auto bowl = [](const CrossEntropy::Point& point) {
    double sum = 0.0;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double wanted = 0.1 + 0.08 * static_cast<double>(i);
      sum += (point[i] - wanted) * (point[i] - wanted);
    }
    return sum;
  };
  EXPECT_LT(bowl(Minimise(bowl, 10, 20, 3)), 10 * 0.03 * 0.03);
}

TEST(CrossEntropy, FindsACornerAndStaysInside) {
  const auto corner = [](const CrossEntropy::Point& point) { return point[0] - point[1]; };
  const CrossEntropy::Point best = Minimise(corner, 2, 20, 4);
  EXPECT_LT(best[0], 0.02);
  EXPECT_GT(best[1], 0.98);
  EXPECT_GE(best[0], 0.0);
  EXPECT_LT(best[1], 1.0);
}

TEST(CrossEntropy, KeepsDrawingApartAfterItHasLearntEqualPoints) {
  CrossEntropy method(1, 5);
  const Points equal(10, {0.4});
  for (int i = 0; i < 50; ++i) method.Learn(equal);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double off = method.Draw()[0] - 0.4;
    sum += off;
    squares += off * off;
  }
  EXPECT_NEAR(sum / 4000.0, 0.0, 0.002);
  EXPECT_NEAR(std::sqrt(squares / 4000.0), 0.02, 0.002);
}

TEST(CrossEntropy, LearnsNothingFromOnePoint) {
  CrossEntropy taught(2, 6), untaught(2, 6);
  taught.Learn(Points{{0.9, 0.9}});
  EXPECT_EQ(taught.Draw(), untaught.Draw());
}

TEST(CrossEntropy, EachSeedHasItsOwnDraws) {
  CrossEntropy a(4, 7), b(4, 7), c(4, 8);
  const CrossEntropy::Point first = a.Draw();
  EXPECT_EQ(first, b.Draw());
  EXPECT_NE(first, c.Draw());
}

}  // namespace
