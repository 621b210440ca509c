#include "navigation/registration/search/cartilage_offset.h"

#include <gtest/gtest.h>

#include "navigation/registration/bone/surface_index.h"
#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::registration {

// What counts is the place on the bone: a tip that is lifted, or rides on cartilage, or would be inside, is
// over it too.
TEST(CartilageMap, JudgesThePlaceUnderThePoint) {
  const PhantomBone& bone = phantom_bone();
  const geometry::SurfacePoint place = bone.surface->closest_point(bone.target_mm);
  const CartilageMap map(bone.prepared->data(), {{place.point_mm}, 4});
  const Eigen::Vector3d across = place.normal.unitOrthogonal();
  for (const double height_mm : {-2.0, 0.0, 3.0}) {
    EXPECT_TRUE(map.covers(place.point_mm + height_mm * place.normal)) << height_mm;
    EXPECT_TRUE(map.covers(place.point_mm + 3 * across + height_mm * place.normal)) << height_mm;
    EXPECT_FALSE(map.covers(place.point_mm + 6 * across + height_mm * place.normal)) << height_mm;
  }
}

// A region of nothing, or within reach of nothing, covers nothing; and a point that is no point is not
// covered.
TEST(CartilageMap, CoversNothingWithoutARegion) {
  const PhantomBone& bone = phantom_bone();
  EXPECT_FALSE(CartilageMap(bone.prepared->data(), {{}, 4}).covers(bone.target_mm));
  EXPECT_FALSE(CartilageMap(bone.prepared->data(), {{bone.target_mm}, 0}).covers(bone.target_mm));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(CartilageMap(bone.prepared->data(), {{bone.target_mm}, 4}).covers({nan, 0, 0}));
}

}  // namespace arthronaut::registration
