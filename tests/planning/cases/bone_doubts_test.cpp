#include "planning/cases/bone_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using bones::Side;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(BoneDoubts, ComeBackAndWithoutAnyTheFileGoes) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(load_bone_doubts(folder.path()).empty());
  const BoneDoubts doubts{
      {BoneKind::Femur, {"12 cm2 are missing", "no \"condyles\""}},
      {BoneKind::Tibia,
       {"too short",
        FilledHoles{{{.at_mm = {1.0 / 3, -2, 3}, .across_mm = 12.25}, {.at_mm = {4, 5, 6}, .across_mm = 9}}},
        bones::ImageCut{.at_mm = {1, 1.0 / 3, 2}, .out = {0, -1, 0}, .area_mm2 = 1234.5},
        bones::ImageCut{.at_mm = {7, 8, 9}, .out = {-1, 0, 0}, .area_mm2 = 101}, SurfaceLookedAt{},
        SideDoubt{SideWitness::Fibula, Side::Left, Side::Right},
        SideDoubt{SideWitness::ShapesAlone, Side::Left, Side::Left},
        SideDoubt{SideWitness::PersonAlone, Side::Left, Side::Left},
        SideDoubt{SideWitness::ImageMark, Side::Right, Side::Left, "2026-01-31"}}}};
  save_bone_doubts(folder.path(), doubts);
  EXPECT_EQ(load_bone_doubts(folder.path()), doubts);
  save_bone_doubts(folder.path(), {{BoneKind::Femur, {}}});
  EXPECT_TRUE(folder.names().empty());
}

// A case of before the side's doubts were data asks for the side all the same; a sentence that only sounds
// like one stays a sentence, as does one of today's files.
TEST(BoneDoubts, OfVersionOneTheSentencesOfTheSideAreRead) {
  const test::TemporaryFolder folder;
  const auto put = [&](int version, const char* more) {
    files::write_atomically(bone_doubts_file(folder.path()),
                            R"({"format": "arthronaut.bone_doubts", "version": )" + std::to_string(version) +
                                R"(, "bones": [{"kind": "femur", "doubts": [
      "the fibula lies on the left of the tibia, as in a left knee, but the side is right: check the side",
      "by the shape of both bones it is a right knee, but the side is left; somebody looked on 2026-01-31 and says that it is",
      "that it is a left knee is told by the shape of its bones alone: check the side",
      "by the shape of the bone it is a left knee, but the side is unclear: check the side"])" +
                                more + "}]}");
    return load_bone_doubts(folder.path()).at(BoneKind::Femur);
  };
  EXPECT_EQ(put(1, ""),
            (std::vector<BoneDoubt>{
                SideDoubt{SideWitness::Fibula, Side::Left, Side::Right},
                SideDoubt{SideWitness::BothShapes, Side::Right, Side::Left, "2026-01-31"},
                SideDoubt{SideWitness::ShapesAlone, Side::Left, Side::Left},
                "by the shape of the bone it is a left knee, but the side is unclear: check the side"}));
  const auto today = put(2, R"(, "side_doubts": [])");
  EXPECT_TRUE(
      std::ranges::none_of(today, std::holds_alternative<SideDoubt, std::string, SideDoubt, FilledHoles,
                                                         bones::ImageCut, SurfaceLookedAt>));
}

TEST(BoneDoubts, AFileThatIsNoneIsRefusedByPlace) {
  const test::TemporaryFolder folder;
  files::write_atomically(
      bone_doubts_file(folder.path()),
      R"({"format": "arthronaut.bone_doubts", "version": 1, "bones": [{"kind": "fibula"}]})");
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_bone_doubts(folder.path()); }),
              AllOf(HasSubstr("bone_doubts.json: bones[0].kind"), HasSubstr("femur or tibia")));
}

// Which parts of a bone nobody has seen: of one that was imported before that was recorded, nobody knows. A
// cut that is not wide, and that the surface was looked at, are no doubts.
TEST(BoneDoubts, SayWhereABoneIsUnseenAndWhetherAnybodyLooked) {
  const bones::ImageCut narrow{.at_mm = {1, 2, 3}, .out = {0, 0, 1}, .area_mm2 = 60};
  const bones::FilledHole hole{.at_mm = {4, 5, 6}, .across_mm = 9};
  const bones::Bone imported{.kind = BoneKind::Femur, .mesh = {}, .source = "femur.stl"},
      made{.mesh = {}, .source = "phantom knee"};
  const BoneDoubts doubts{{BoneKind::Femur, {FilledHoles{{hole}}, narrow, SurfaceLookedAt{}}}};
  EXPECT_EQ(unseen_parts_of(doubts, imported),
            (bones::UnseenParts{.image_cuts = {narrow}, .filled_holes = {hole}}));
  EXPECT_TRUE(is_note(narrow));
  EXPECT_FALSE(is_note(bones::ImageCut{.area_mm2 = 120}));
  EXPECT_TRUE(is_note(SurfaceLookedAt{}));
  EXPECT_FALSE(unseen_parts_of({}, imported).was_looked_for);
  EXPECT_FALSE(unseen_parts_of({{BoneKind::Femur, {narrow}}}, imported).was_looked_for);
  EXPECT_TRUE(unseen_parts_of({}, made).was_looked_for) << "there is nothing to look for";
}

// A direction that is none would say of every place that the images end there, or of none.
TEST(BoneDoubts, ACutWithoutADirectionIsRefusedByPlace) {
  const test::TemporaryFolder folder;
  for (const char* out : {"[0, 0, 0]", "[0, 0, 2]"}) {
    files::write_atomically(
        bone_doubts_file(folder.path()),
        std::string(R"({"format": "arthronaut.bone_doubts", "version": 3, "bones": [{"kind": "femur",
            "doubts": [], "side_doubts": [], "image_cuts": [{"at_mm": [1, 2, 3], "area_mm2": 500, "out": )") +
            out + "}]}]}");
    EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_bone_doubts(folder.path()); }),
                HasSubstr("bone_doubts.json: bones[0].image_cuts[0].out: is no unit vector"));
  }
}

}  // namespace
}  // namespace arthronaut::cases
