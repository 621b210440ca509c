#include "app/scene/notch_cut.h"

#include <gtest/gtest.h>

#include "app/scene/plan_picture.h"
#include "planning/geometry/surface.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::scene {
namespace {

const cases::Case& knee() {
  static const cases::Case made =
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 1.5}), "test");
  return made;
}

landmarks::AnatomicalAxes axes_of(const cases::Case& of) {
  return landmarks::anatomical_axes(bones::BoneKind::Femur, of.side, of.landmarks.at(bones::BoneKind::Femur),
                                    of.bones.at(bones::BoneKind::Femur).mesh);
}

// Nothing that is left stands between the eye and the ligament's footprint on the lateral wall: the first
// bone that a ray from the cut meets is the footprint itself. Without landmarks the same, within the few
// millimetres by which the two planes differ.
TEST(NotchCut, BaresTheFootprintOnTheLateralWall) {
  const auto& femur = knee().bones.at(bones::BoneKind::Femur).mesh;
  const geometry::Surface surface(femur);
  const Eigen::Vector3d footprint = knee().landmarks.at(bones::BoneKind::Femur).at("native_footprint");
  const landmarks::AnatomicalAxes axes = axes_of(knee());
  const landmarks::Landmarks nothing;
  for (const auto* named : {&knee().landmarks.at(bones::BoneKind::Femur), &nothing}) {
    const auto cut = notch_cut(femur, axes, *named);
    ASSERT_TRUE(cut);
    EXPECT_FALSE(cut->cuts_away(footprint));
    EXPECT_TRUE(cut->cuts_away(knee().landmarks.at(bones::BoneKind::Femur).at("medial_epicondyle")));
    const double to_plane = cut->normal.dot(cut->point_mm - footprint);
    const auto hit = surface.first_hit(footprint + to_plane * cut->normal, -cut->normal);
    ASSERT_TRUE(hit);
    EXPECT_LT((hit->point_mm - footprint).norm(), 0.1);
  }
}

TEST(NotchCut, AnEmptyMeshHasNone) { EXPECT_FALSE(notch_cut({}, {}, {})); }

// In the picture, too: the footprint's ball is seen in the notch view and hidden in the medial one, which is
// the same view of the whole bone. A plan's entry ring is drawn over the bone, so the picture is asked for
// its section instead.
TEST(NotchCut, ThePictureShowsASection) {
  PictureRequest request;
  request.knee = &knee();
  request.width = 320;
  request.height = 240;
  const auto section = [&](ViewDirection view) {
    request.view = view;
    request.only_bone = bones::BoneKind::Femur;
    const Image image = render_plan_picture(request);
    int count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      const auto is = [&](std::size_t channel, float value) {
        return std::abs(image.rgb[i + channel] - 255 * value) < 3;
      };
      count += is(0, kSectionColor.red) && is(1, kSectionColor.green) && is(2, kSectionColor.blue) ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(section(ViewDirection::Notch), 1000);
  EXPECT_EQ(section(ViewDirection::Medial), 0);
}

}  // namespace
}  // namespace arthronaut::scene
