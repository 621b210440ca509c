#include "app/start/import_questions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/start/import_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::start {
namespace {

using bones::BoneKind;

std::vector<importing::FoundLabel> three_labels() {
  std::vector<importing::FoundLabel> labels(3);
  for (int i = 0; i < 3; ++i) {
    labels[static_cast<std::size_t>(i)].label = 2 * i + 1;
    labels[static_cast<std::size_t>(i)].volume_cm3 = 10 + i;
    labels[static_cast<std::size_t>(i)].highest_mm = {70, 60, 50};
  }
  return labels;
}

// By one key through all that are free, none at last, and from the beginning.
TEST(ImportQuestions, GoThroughTheLabelsThatAreNotTheOtherBones) {
  const auto labels = three_labels();
  std::map<BoneKind, int> chosen{{BoneKind::Femur, 1}, {BoneKind::Tibia, 3}};
  choose_next_label(labels, chosen, BoneKind::Femur);
  EXPECT_EQ(chosen.at(BoneKind::Femur), 5);
  choose_next_label(labels, chosen, BoneKind::Femur);
  EXPECT_FALSE(chosen.contains(BoneKind::Femur));
  EXPECT_EQ(chosen_label(labels, chosen, BoneKind::Femur), "none of the labels");
  choose_next_label(labels, chosen, BoneKind::Femur);
  EXPECT_EQ(chosen.at(BoneKind::Femur), 1);
  EXPECT_EQ(chosen.at(BoneKind::Tibia), 3);
  EXPECT_EQ(chosen_label(labels, chosen, BoneKind::Tibia), "label 3: 11 cm\u00B3, 70 x 60 x 50 mm");
}

// Only the units in which it would be a bone are offered, each with its size and its key.
TEST(ImportQuestions, SayHowLargeAMeshWouldBe) {
  const std::string words =
      unit_question("Mesh: femur.stl", {.size_in_file = 0.462, .units = {bones::LengthUnit::Metre}});
  EXPECT_THAT(words, testing::AllOf(testing::HasSubstr("0.462 mm"), testing::HasSubstr("462 mm: press M"),
                                    testing::Not(testing::HasSubstr("inches"))));
}

// Cartilage of the femur is no femur, and nobody needs to give the patella another name.
TEST(ImportQuestions, AreNotAskedOfWhatIsNoBoneOfThePlan) {
  const test::TemporaryFolder folder;
  for (const char* name : {"femur_bone.stl", "femur_cartilage.stl", "part_3.stl", "patella.stl"})
    std::ofstream(folder / name) << "solid";
  const auto found = import_sources(folder.path(), {}).sources;
  ASSERT_EQ(found.size(), 4U);
  EXPECT_TRUE(found[0].can_be_imported());
  EXPECT_EQ(found[1].refusal, "cartilage by its name: nothing is planned on it");
  EXPECT_THAT(found[2].refusal, testing::HasSubstr("press F or T"));
  EXPECT_EQ(found[3].refusal, "patella by its name: nothing is planned on it");
}

}  // namespace
}  // namespace arthronaut::start
