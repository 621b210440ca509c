#include "app/start/side_slices.h"

#include <gtest/gtest.h>

namespace arthronaut::start {
namespace {

// 100 mm each way; a bright rod along the leg at the patient's left and behind the middle.
images::Volume volume_with_rod() {
  images::Volume volume;
  volume.size = {50, 50, 50};
  volume.lps_from_index.linear() = 2.0 * Eigen::Matrix3d::Identity();
  volume.values.assign(50 * 50 * 50, 0);
  for (int k = 0; k < 50; ++k)
    for (int j = 30; j < 36; ++j)
      for (int i = 36; i < 42; ++i) volume.values[volume.index(i, j, k)] = 100;
  volume.modality = images::Modality::Mr;
  return volume;
}

long brightness(const SideSlice& slice, bool is_left) {
  long sum = 0;
  const int half = slice.size_px.x() / 2;
  for (int y = 0; y < slice.size_px.y(); ++y)
    for (int x = is_left ? 0 : half; x < (is_left ? half : slice.size_px.x()); ++x)
      sum += slice.grey[static_cast<std::size_t>(y * slice.size_px.x() + x)];
  return sum;
}

// The patient's right is at the left of every picture, as its letters say, and so what lies at his left shows
// at the right. Without a tibia no name tells of a joint.
TEST(SideSlices, ShowThePatientsLeftAtTheRight) {
  const auto slices = side_slices(volume_with_rod(), std::nullopt, 100);
  ASSERT_EQ(slices.size(), 4U);
  for (const SideSlice& slice : slices) {
    SCOPED_TRACE(slice.words);
    EXPECT_EQ(slice.letters[0], "R");
    EXPECT_EQ(slice.letters[1], "L");
    ASSERT_EQ(slice.grey.size(), static_cast<std::size_t>(slice.size_px.x() * slice.size_px.y()));
    if (slice.words != slices.front().words) {  // the middle is in front of the rod
      EXPECT_GT(brightness(slice, false), 2 * brightness(slice, true));
    }
    EXPECT_EQ(slice.words.find("joint"), std::string::npos);
  }
  EXPECT_EQ(slices[0].letters[2], "H");
  EXPECT_EQ(slices[2].letters[2], "A");
  EXPECT_EQ(slices[2].letters[3], "P");
}

importing::ImportedBone box_bone(bones::BoneKind kind, const Eigen::Vector3d& low,
                                 const Eigen::Vector3d& high) {
  importing::ImportedBone bone;
  bone.bone.kind = kind;
  for (int corner = 0; corner < 8; ++corner)
    bone.bone.mesh.vertices_mm.emplace_back((corner & 1) != 0 ? high.x() : low.x(),
                                            (corner & 2) != 0 ? high.y() : low.y(),
                                            (corner & 4) != 0 ? high.z() : low.z());
  return bone;
}

// A leg of which no more than 30 mm lie below the joint, near the lower end of images of 200 mm, with another
// leg beside it; its fibula, thin and at the patient's left, begins 12 mm below the joint and behind the
// tibia's middle.
struct Leg {
  images::Volume volume;
  importing::BoneImport import;
};
Leg short_leg() {
  Leg leg;
  leg.volume.size = {100, 60, 100};
  leg.volume.lps_from_index.linear() = 2.0 * Eigen::Matrix3d::Identity();
  leg.volume.values.assign(100 * 60 * 100, -1000);  // air
  leg.volume.modality = images::Modality::Ct;
  for (int k = 0; k < 100; ++k)  // the other leg
    for (int j = 15; j < 50; ++j)
      for (int i = 0; i < 20; ++i) leg.volume.values[leg.volume.index(i, j, k)] = 1000;
  for (int k = 0; k <= 9; ++k)  // up to 18 mm; the joint lies at 30 mm
    for (int j = 38; j < 44; ++j)
      for (int i = 84; i < 89; ++i) leg.volume.values[leg.volume.index(i, j, k)] = 1000;
  leg.import.bones = {box_bone(bones::BoneKind::Femur, {100, 40, 30}, {170, 84, 198}),
                      box_bone(bones::BoneKind::Tibia, {100, 40, 0}, {170, 84, 38})};
  return leg;
}

// The places follow the bones that were found, and their names say where they are: across the leg a fibula
// shows that begins far below a quarter of the images, and from in front it does at the tibia's back alone.
TEST(SideSlices, Hazard52ShowTheFibulaWhereTheTibiaWasFound) {
  const Leg leg = short_leg();
  const auto tibia = found_tibia(leg.import);
  ASSERT_TRUE(tibia);
  const auto slices = side_slices(leg.volume, tibia, 200);
  ASSERT_EQ(slices.size(), 4U);
  EXPECT_EQ(slices[2].words, "Across, 16 mm below the joint");  // 0.6 of what there is
  EXPECT_EQ(slices[3].words, "Across, 27 mm below the joint");
  EXPECT_EQ(brightness(slices[0], false), 0) << slices[0].words;
  for (const std::size_t shown : {1U, 2U, 3U}) {
    EXPECT_GT(brightness(slices[shown], false), 0) << slices[shown].words;
    EXPECT_EQ(brightness(slices[shown], true), 0) << slices[shown].words;
  }
  // The other leg is not in the picture: 70 mm of tibia and 30 mm on either side, cut off by the images.
  EXPECT_NEAR(static_cast<double>(slices[2].size_px.x()) / slices[2].size_px.y(), 128.0 / 93.0, 0.02);
}

// Without a femur it is the tibia's top that they are counted from; of a tibia that is hardly in view there
// is no place below the joint.
TEST(SideSlices, NameNothingThatIsNotShown) {
  Leg leg = short_leg();
  leg.import.bones.erase(leg.import.bones.begin());
  EXPECT_EQ(side_slices(leg.volume, found_tibia(leg.import), 200)[2].words,
            "Across, 21 mm below the tibia's top");
  leg.import.bones.back() = box_bone(bones::BoneKind::Tibia, {100, 40, 0}, {170, 84, 9});
  EXPECT_FALSE(found_tibia(leg.import));
  leg.import.bones.clear();
  EXPECT_FALSE(found_tibia(leg.import));
}

}  // namespace
}  // namespace arthronaut::start
