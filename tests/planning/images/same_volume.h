// Whether two volumes are the same: voxels, and where they lie in the patient.
#pragma once

#include <gtest/gtest.h>

#include "planning/images/volume.h"

namespace arthronaut::test {

inline void expect_same(const images::Volume& found, const images::Volume& expected) {
  ASSERT_EQ(found.size, expected.size);
  // 32-bit headers carry the affine to about 1e-5 mm at 130 mm.
  EXPECT_LT((found.lps_from_index.matrix() - expected.lps_from_index.matrix()).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(found.values, expected.values);
}

}  // namespace arthronaut::test
