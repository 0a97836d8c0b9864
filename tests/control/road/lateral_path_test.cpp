#include "control/road/lateral_path.hpp"

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

// A path of random bends.
LateralPath Winding(std::uint64_t seed) {
  testing::Random random(seed);
  LateralPath path{.stations = {.s_0 = 20.0, .spacing = 2.5}, .exists = true};
  const double ds = path.stations.spacing;
  path.offset[0] = 0.4;
  path.slope[0] = -0.1;
  for (std::size_t j = 0; j + 1 < kStations; ++j) {
    path.bend[j] = random.Uniform(-0.05, 0.05);
    path.offset[j + 1] = path.offset[j] + ds * path.slope[j] + 0.5 * ds * ds * path.bend[j];
    path.slope[j + 1] = path.slope[j] + ds * path.bend[j];
  }
  return path;
}

TEST(LateralPath, WithoutOneTheReferencePathIsMeant) {
  LateralPath path = Winding(1);
  path.exists = false;
  for (const double s : {-10.0, 20.0, 33.0, 500.0}) {
    EXPECT_EQ(path.At(s).offset, 0.0);
    EXPECT_EQ(path.At(s).slope, 0.0);
    EXPECT_EQ(path.At(s).bend, 0.0);
  }
}

TEST(LateralPath, IsContinuousWithItsSlopeAndTheBendIsTheSlopesDerivative) {
  const LateralPath path = Winding(2);
  constexpr double kStep = 1e-5;
  for (std::size_t j = 0; j + 1 < kStations; ++j) {
    const double s = path.stations.At(j);
    EXPECT_NEAR(path.At(s).offset, path.offset[j], 1e-12);
    if (j > 0) {
      EXPECT_NEAR(path.At(s - 1e-9).offset, path.At(s + 1e-9).offset, 1e-8);
      EXPECT_NEAR(path.At(s - 1e-9).slope, path.At(s + 1e-9).slope, 1e-8);
    }
    const LateralPoint before = path.At(s + 1.0 - kStep), at = path.At(s + 1.0),
                       after = path.At(s + 1.0 + kStep);
    EXPECT_NEAR((after.offset - before.offset) / (2.0 * kStep), at.slope, 1e-8);
    EXPECT_NEAR((after.slope - before.slope) / (2.0 * kStep), at.bend, 1e-8);
  }
}

TEST(LateralPath, BeyondItsEndsItGoesOn) {
  const LateralPath path = Winding(3);
  const double end = path.stations.At(kStations - 1);
  for (const double s : {end, end + 3.0, end + 1000.0}) {
    EXPECT_NEAR(path.At(s).offset, path.offset[kStations - 1], 1e-12);
    EXPECT_EQ(path.At(s).slope, 0.0);
  }
  // Straight on before the first station would differ by the bend alone.
  const LateralPoint before = path.At(19.0);
  EXPECT_NEAR(before.offset, path.offset[0] - path.slope[0], 0.5 * 0.05 + 1e-12);
}

}  // namespace
}  // namespace control
