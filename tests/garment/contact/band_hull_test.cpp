// How far points lie outside of a body whose hollows are bridged.
#include <gtest/gtest.h>

#include "garment/body/mannequin.h"
#include "garment/contact/solid.h"

namespace mssim {
namespace {

/// A round tube of 0.1 m from 0 to 1 m with a waist of 0.06 m at 0.5 m.
Surface waisted_tube() {
  Surface surface;
  add_tube(surface,
           {{0, -0.1, 0.1, -0.1, 0.1},
            {0.4, -0.1, 0.1, -0.1, 0.1},
            {0.5, -0.06, 0.06, -0.06, 0.06},
            {0.6, -0.1, 0.1, -0.1, 0.1},
            {1, -0.1, 0.1, -0.1, 0.1}},
           {180, 0.02});
  return surface;
}

TEST(BandHull, BridgesHollowsBetweenItsHeights) {
  const BandHull whole(waisted_tube(), 0.2, 0.8);
  EXPECT_NEAR(whole.distance({0.11, 0.5, 0}), 0.01, 1e-4);
  EXPECT_NEAR(whole.distance({0, 0.3, -0.13}), 0.03, 1e-4);
  EXPECT_EQ(whole.distance({0.09, 0.5, 0}), 0) << "in the hollow";
  const BandHull waist(waisted_tube(), 0.499, 0.501);
  EXPECT_NEAR(waist.distance({0.11, 0.5, 0}), 0.05, 1e-3) << "which is no hollow of so low a band";
}

}  // namespace
}  // namespace mssim
