#include "planning/import/case_side.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;
using bones::Side;
using cases::SideWitness;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class CaseSide : public testing::Test {
 protected:
  CaseSide() {
    cases::Case knee;
    knee.name = "A knee";
    knee.side = Side::Right;
    knee.bones[BoneKind::Femur] = {BoneKind::Femur, test::ellipsoid({40, 30, 25}, 2), "bone.stl"};
    knee.landmarks[BoneKind::Femur] = {{"lateral_condyle_center", {-20, 0, 0}}};
    knee.plan.tunnels = {{BoneKind::Femur, {.entry_mm = {10, 0, 0}, .diameter_mm = 9}}};
    cases::save_case(folder_.path(), knee);
  }
  void doubt(SideWitness witness, Side told, Side said) const {
    cases::save_bone_doubts(folder_.path(),
                            {{BoneKind::Femur, {"cut off above", cases::SideDoubt{witness, told, said}}}});
  }
  [[nodiscard]] std::vector<std::string> doubts() const {
    auto all = cases::load_bone_doubts(folder_.path());
    return words_of(all[BoneKind::Femur]);
  }
  const test::TemporaryFolder folder_;
};

// The side that the fibula tells: what was placed and planned as of the other one is gone, and so is the
// doubt.
TEST_F(CaseSide, Hazard52OfTheOtherSideNothingIsLeftOfTheFirst) {
  doubt(SideWitness::Fibula, Side::Left, Side::Right);
  const SaidSide said = say_side_of_case(folder_.path(), Side::Left);
  EXPECT_TRUE(said.is_changed);
  EXPECT_THAT(said.lines, ElementsAre("it is a left knee now; it was a right one",
                                      HasSubstr("the plan of the right knee is put aside"),
                                      "nothing is planned of the left knee", HasSubstr("proposed anew")));
  const cases::Case left = cases::load_case(folder_.path());
  EXPECT_EQ(left.side, Side::Left);
  EXPECT_TRUE(left.landmarks.empty());
  EXPECT_TRUE(left.plan.tunnels.empty());
  EXPECT_THAT(doubts(), ElementsAre("cut off above"));
  // And back: as it was, but that somebody has looked at what speaks against it.
  const SaidSide back = say_side_of_case(folder_.path(), Side::Right);
  EXPECT_THAT(back.lines, testing::Contains("the plan that it had as a right knee is back"));
  const cases::Case right = cases::load_case(folder_.path());
  EXPECT_EQ(right.side, Side::Right);
  EXPECT_EQ(right.plan.tunnels.size(), 1U);
  EXPECT_EQ(right.landmarks.size(), 1U);
  EXPECT_THAT(doubts(), ElementsAre("cut off above",
                                    AllOf(HasSubstr("as in a left knee"), HasSubstr("and says that it is"))));
}

// Where nothing had spoken for the side that is said now, that is not passed over in silence.
TEST_F(CaseSide, ASideThatNothingTellsIsADoubt) {
  (void)say_side_of_case(folder_.path(), Side::Left);
  EXPECT_THAT(doubts(), ElementsAre(AllOf(HasSubstr("it was a right knee, and nothing that its bones"),
                                          HasSubstr("somebody says that it is a left knee"))));
}

// Whoever has looked and finds the side right is not asked again, and what spoke against it stays to be read.
TEST_F(CaseSide, ASideThatWasCheckedIsNotAskedForAgain) {
  for (const SideWitness witness :
       {SideWitness::Fibula, SideWitness::OneShape, SideWitness::BothShapes, SideWitness::ImageMark}) {
    doubt(witness, Side::Left, Side::Right);
    ASSERT_NE(plan_review::side_doubt(cases::load_bone_doubts(folder_.path())), "");
    EXPECT_FALSE(say_side_of_case(folder_.path(), Side::Right).is_changed);
    EXPECT_EQ(plan_review::side_doubt(cases::load_bone_doubts(folder_.path())), "");
    EXPECT_THAT(doubts(), ElementsAre("cut off above", HasSubstr("somebody looked on ")));
    EXPECT_EQ(cases::load_case(folder_.path()).plan.tunnels.size(), 1U);
    // It tells the other side all the same, to whoever comes to see it so.
    EXPECT_TRUE(say_side_of_case(folder_.path(), Side::Left).is_changed);
    EXPECT_THAT(doubts(), ElementsAre("cut off above"));
    (void)say_side_of_case(folder_.path(), Side::Right);
  }
  doubt(SideWitness::ShapesAlone, Side::Right, Side::Right);
  (void)say_side_of_case(folder_.path(), Side::Right);
  EXPECT_THAT(doubts(), ElementsAre("cut off above"));
}

// Where the shapes alone had told the side that it had, nothing tells the one that is said: that stays a
// doubt.
TEST_F(CaseSide, WhatToldTheOldSideIsNoWordForTheNewOne) {
  doubt(SideWitness::ShapesAlone, Side::Right, Side::Right);
  EXPECT_TRUE(say_side_of_case(folder_.path(), Side::Left).is_changed);
  EXPECT_THAT(doubts(), ElementsAre("cut off above", HasSubstr("it was a right knee")));
}

// Of another side it is no word any more; said once more of the same one it is as little borne out as before.
TEST_F(CaseSide, ASideThatWasOnlySaidStaysOnlySaid) {
  doubt(SideWitness::PersonAlone, Side::Right, Side::Right);
  (void)say_side_of_case(folder_.path(), Side::Right);
  EXPECT_THAT(doubts(), ElementsAre("cut off above", HasSubstr("a right knee, as said")));
  (void)say_side_of_case(folder_.path(), Side::Left);
  EXPECT_THAT(doubts(), ElementsAre("cut off above", HasSubstr("somebody says that it is a left knee")));
}

// What a CT after the operation showed is of the plan that would go.
TEST_F(CaseSide, ACaseThatWasComparedKeepsItsSide) {
  files::write_atomically(folder_ / "achieved.json", "{}");
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)say_side_of_case(folder_.path(), Side::Left); }),
              HasSubstr("its side stays. Import the bones into another case, as a left knee"));
  EXPECT_EQ(cases::load_case(folder_.path()).side, Side::Right);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "sides.json"));
}

}  // namespace
}  // namespace arthronaut::importing
