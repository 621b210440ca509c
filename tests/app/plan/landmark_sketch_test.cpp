#include "app/plan/landmark_sketch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/geometry/error.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;
using bones::Side;
using Eigen::Vector2d;

constexpr int kSize_px = 200;

// Made once: the right and the left one.
const SchematicKnee& knee(Side side) {
  static const SchematicKnee right = make_schematic_knee(Side::Right), left = make_schematic_knee(Side::Left);
  return side == Side::Right ? right : left;
}

struct Rgb {
  int red, green, blue;
};
Rgb at(const LandmarkSketch& sketch, int x, int y) {
  const std::uint32_t bytes = sketch.rgba[static_cast<std::size_t>(y * sketch.size_px + x)];
  return {static_cast<int>(bytes & 255U), static_cast<int>(bytes >> 8U & 255U),
          static_cast<int>(bytes >> 16U & 255U)};
}
bool is_mark(const Rgb& c) { return c.blue > c.red + 60; }
bool is_bone(const Rgb& c) { return c.red > 60 && c.red > c.blue; }

// Of the pixels that are so: their corners.
template <typename Predicate>
Eigen::AlignedBox2d extent_of(const LandmarkSketch& sketch, const Predicate& is_so) {
  Eigen::AlignedBox2d extent;
  for (int y = 0; y < sketch.size_px; ++y)
    for (int x = 0; x < sketch.size_px; ++x)
      if (is_so(at(sketch, x, y))) extent.extend(Vector2d(x + 0.5, y + 0.5));
  return extent;
}

// Whatever landmark is asked for, of either bone and side: bone in the picture, the place within it, and the
// mark's own colour there.
TEST(LandmarkSketch, EveryLandmarkHasAPictureWithItsPlaceMarked) {
  for (const Side side : {Side::Right, Side::Left})
    for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia})
      for (const landmarks::LandmarkKind& kind : landmarks::known_landmarks(bone)) {
        SCOPED_TRACE(std::string(kind.name) + ", " + std::string(bones::to_text(side)));
        const LandmarkSketch sketch = sketch_landmark(knee(side), bone, kind.name, kSize_px);
        ASSERT_EQ(sketch.rgba.size(), static_cast<std::size_t>(kSize_px * kSize_px));
        const auto bone_pixels = std::ranges::count_if(sketch.rgba, [](std::uint32_t bytes) {
          return is_bone({static_cast<int>(bytes & 255U), static_cast<int>(bytes >> 8U & 255U),
                          static_cast<int>(bytes >> 16U & 255U)});
        });
        EXPECT_GT(bone_pixels, kSize_px * kSize_px / 20);
        ASSERT_TRUE((sketch.at_px.array() > 5).all() && (sketch.at_px.array() < kSize_px - 5).all())
            << sketch.at_px.transpose();
        EXPECT_TRUE(
            is_mark(at(sketch, static_cast<int>(sketch.at_px.x()), static_cast<int>(sketch.at_px.y()))));
        EXPECT_FALSE(sketch.left.empty());
        EXPECT_FALSE(sketch.right.empty());
      }
}

// A left knee's picture is a right one's in the mirror, and so are the words at its edges.
TEST(LandmarkSketch, ALeftKneesPictureIsTheMirrorImage) {
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia})
    for (const landmarks::LandmarkKind& kind : landmarks::known_landmarks(bone)) {
      const LandmarkSketch right = sketch_landmark(knee(Side::Right), bone, kind.name, kSize_px),
                           left = sketch_landmark(knee(Side::Left), bone, kind.name, kSize_px);
      EXPECT_NEAR(left.at_px.x(), kSize_px - right.at_px.x(), 1.5) << kind.name;
      EXPECT_NEAR(left.at_px.y(), right.at_px.y(), 1.5) << kind.name;
      EXPECT_EQ(left.left, right.right) << kind.name;
      EXPECT_EQ(left.right, right.left) << kind.name;
    }
}

// In all pictures of one view the marks stand to each other as the landmarks do, seen along the bone's axes:
// the scale is read off two of them, all others are held against it.
TEST(LandmarkSketch, TheMarksStandWhereTheLandmarksAreProjected) {
  for (const Side side : {Side::Right, Side::Left}) {
    const auto check = [&](BoneKind kind, const char* from, const char* to, const auto& right_of,
                           const auto& up_of, std::initializer_list<const char*> names) {
      const SchematicBone& bone = knee(side).bones.at(kind);
      const auto pixel_of = [&](const char* name) {
        return sketch_landmark(knee(side), kind, name, kSize_px).at_px;
      };
      const auto plane = [&](const char* name) {
        const Eigen::Vector3d& at = bone.landmarks.at(name);
        return Vector2d(at.dot(right_of(bone.axes)), -at.dot(up_of(bone.axes)));
      };
      const double px_per_mm = (pixel_of(to) - pixel_of(from)).norm() / (plane(to) - plane(from)).norm();
      EXPECT_GT(px_per_mm, 0.5);
      for (const char* name : names) {
        const Vector2d expected = pixel_of(from) + px_per_mm * (plane(name) - plane(from));
        EXPECT_LT((pixel_of(name) - expected).norm(), 1) << name << ", " << bones::to_text(side);
      }
    };
    using landmarks::AnatomicalAxes;
    const auto anterior = [](const AnatomicalAxes& axes) { return axes.anterior; };
    const auto proximal = [](const AnatomicalAxes& axes) { return axes.proximal; };
    // What is lateral is at the right of a right knee's plateau, and at the left of one from in front.
    const double sign = side == Side::Right ? 1 : -1;
    const auto to_right_above = [=](const AnatomicalAxes& axes) -> Eigen::Vector3d {
      return sign * axes.lateral;
    };
    const auto to_right_in_front = [=](const AnatomicalAxes& axes) -> Eigen::Vector3d {
      return -sign * axes.lateral;
    };
    // From the medial side of a right knee anterior is at the left.
    const auto to_right_medially = [=](const AnatomicalAxes& axes) -> Eigen::Vector3d {
      return -sign * axes.anterior;
    };
    check(BoneKind::Tibia, "plateau_medial", "plateau_lateral", to_right_above, anterior,
          {"plateau_lateral", "plateau_anterior", "plateau_posterior", "native_footprint"});
    check(BoneKind::Femur, "lateral_epicondyle", "medial_epicondyle", to_right_in_front, proximal,
          {"medial_epicondyle"});
    check(BoneKind::Femur, "blumensaat_posterior", "blumensaat_anterior", to_right_medially, proximal,
          {"blumensaat_anterior", "notch_apex", "lateral_condyle_deep", "lateral_condyle_shallow",
           "lateral_condyle_low", "native_footprint"});
    check(BoneKind::Femur, "medial_condyle_center", "medial_condyle_posterior", to_right_medially, proximal,
          {"medial_condyle_posterior"});
  }
}

// They are those of the built-in knee as it was made: what defines each agrees with what its maker knows.
TEST(LandmarkSketch, TheLandmarksAreThePhantomsOwn) {
  for (const Side side : {Side::Right, Side::Left}) {
    const phantom::PhantomKnee phantom = phantom::make_phantom_knee({.side = side, .edge_length_mm = 2});
    // What the shape proposes and what is known by construction are defined a little differently.
    constexpr double kTolerance_mm = 4;
    const auto expect_same = [&](BoneKind kind, const char* name, const Eigen::Vector3d& along) {
      const auto& own = kind == BoneKind::Femur ? phantom.femur_landmarks : phantom.tibia_landmarks;
      EXPECT_NEAR(knee(side).bones.at(kind).landmarks.at(name).dot(along), own.at(name).dot(along),
                  kTolerance_mm)
          << name << ", " << bones::to_text(side);
    };
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                          z = Eigen::Vector3d::UnitZ();
    for (const char* name : {"lateral_epicondyle", "medial_epicondyle", "notch_apex"})
      expect_same(BoneKind::Femur, name, x);
    for (const char* name : {"lateral_condyle_posterior", "medial_condyle_posterior"})
      expect_same(BoneKind::Femur, name, y);
    for (const char* name : {"blumensaat_anterior", "blumensaat_posterior"})
      expect_same(BoneKind::Femur, name, x);
    for (const char* name : {"plateau_medial", "plateau_lateral", "medial_eminence", "lateral_eminence"})
      expect_same(BoneKind::Tibia, name, x);
    for (const char* name : {"plateau_anterior", "plateau_posterior", "tuberosity"})
      expect_same(BoneKind::Tibia, name, y);
    for (const char* name : {"medial_eminence", "lateral_eminence"}) expect_same(BoneKind::Tibia, name, z);
    expect_same(BoneKind::Femur, "native_footprint", z);
  }
}

// What is outermost is marked at the drawn bone's very edge.
TEST(LandmarkSketch, AnOutermostPlaceLiesAtTheDrawnEdge) {
  const auto edge_of = [](BoneKind bone, const char* name) {
    const LandmarkSketch sketch = sketch_landmark(knee(Side::Right), bone, name, kSize_px);
    return std::pair{sketch.at_px, extent_of(sketch, is_bone)};
  };
  constexpr double kNear_px = 6;  // the mark itself hides the outermost pixels
  const auto [anterior, above] = edge_of(BoneKind::Tibia, "plateau_anterior");
  EXPECT_NEAR(anterior.y(), above.min().y(), kNear_px);
  const auto [posterior, below] = edge_of(BoneKind::Tibia, "plateau_posterior");
  EXPECT_NEAR(posterior.y(), below.max().y(), kNear_px);
  const auto [behind, condyle] = edge_of(BoneKind::Femur, "lateral_condyle_posterior");
  EXPECT_LT(std::min(std::abs(behind.x() - condyle.min().x()), std::abs(behind.x() - condyle.max().x())),
            kNear_px);
}

TEST(LandmarkSketch, RefusesWhatTheBoneHasNot) {
  EXPECT_THROW((void)sketch_landmark(knee(Side::Right), BoneKind::Femur, "tuberosity", kSize_px),
               InvalidInput);
  EXPECT_THROW((void)sketch_landmark(knee(Side::Right), BoneKind::Femur, "notch_apex", 4), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::plan
