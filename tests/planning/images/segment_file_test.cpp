// 3D Slicer's .seg.nrrd: named segments, layers that overlap, and files that are broken anywhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "tests/message_of.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

// Two layers of 3 x 2 x 2 voxels: in the first a femur (1), in the second a tibia (1) that overlaps it.
std::string layered() {
  std::string text =
      "NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 3 2 2\n"
      "space directions: none (0.5,0,0) (0,0.5,0) (0,0,2)\nkinds: list domain domain domain\nencoding: raw\n"
      "space origin: (1,2,3)\nSegment0_Name:=Femur\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
      "Segment1_Name:=Tibia\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n\n";
  for (int v = 0; v < 12; ++v) {
    text += v < 8 ? '\1' : '\0';
    text += v >= 6 ? '\1' : '\0';
  }
  return text;
}

TEST(SegmentFile, LayersBecomeOneLabelMap) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "knee.seg.nrrd", layered());
  const Volume volume = read_volume(folder / "knee.seg.nrrd");
  EXPECT_EQ(volume.size, Eigen::Vector3i(3, 2, 2));
  EXPECT_EQ(volume.spacing_mm(), Eigen::Vector3d(0.5, 0.5, 2));
  ASSERT_EQ(volume.segments.size(), 2U);
  EXPECT_EQ(volume.segments[1].name, "Tibia");
  EXPECT_EQ(volume.segments[1].label, 2);
  for (std::size_t v = 0; v < 12; ++v) EXPECT_EQ(volume.values[v], v < 6 ? 1.0F : 2.0F) << v;
}

TEST(SegmentFile, ALayerThatIsNotThereIsNamed) {
  const TemporaryFolder folder;
  std::string text = layered();
  text.replace(text.find("Layer:=1"), 8, "Layer:=7");
  test::write_bytes(folder / "knee.seg.nrrd", text);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)read_volume(folder / "knee.seg.nrrd"); }),
              HasSubstr("Segment1_Layer"));
}

// A file that was changed or cut off anywhere is read or refused, and never does anything else.
TEST(SegmentFile, BrokenAnywhereItIsReadOrRefused) {
  const TemporaryFolder folder;
  const std::string whole = layered();
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    std::string text = whole;
    for (unsigned change = 0; change < 1 + random() % 4; ++change)
      text[random() % text.size()] =
          static_cast<char>(random() % 4 == 0 ? random() % 256 : '0' + random() % 10);
    if (random() % 4 == 0) text.resize(random() % text.size());
    test::write_bytes(folder / "knee.seg.nrrd", text);
    try {
      const Volume volume = read_volume(folder / "knee.seg.nrrd", {.series = {}, .most_bytes = 1 << 20});
      EXPECT_EQ(volume.values.size(), static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()));
    } catch (const InvalidInput&) {
    } catch (const IoError&) {
    }
  }
}

}  // namespace
}  // namespace arthronaut::images
