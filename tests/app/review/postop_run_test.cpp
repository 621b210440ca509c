#include "app/review/postop_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "planning/postop/achieved_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A decoder that crashes on what a hospital's disc holds ends the process that reads, and that is told.
TEST(PostopRun, Hazard18AFileThatEndsItsReaderEndsNothingElse) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "disc");
  std::ofstream(folder / "disc/IM0001") << "no image";
  std::ofstream(folder / "reader") << "#!/bin/sh\nkill -SEGV $$\n";
  fs::permissions(folder / "reader", fs::perms::owner_all);
  PostopRun run(
      folder / "Knee.arthro", folder / "disc", "", false, [] {}, folder / "reader");
  for (int i = 0; i < 3000 && !run.has_ended(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(run.has_ended());
  EXPECT_THAT(run.error(), HasSubstr("ended the importing process"));
}

// A CT that names nobody, of somebody else: its verdict stood in the place of a good comparison.
class ForeignImages : public ::testing::Test {
 protected:
  static Comparisons comparisons(bool has_bone) {
    Comparisons made;
    postop::Comparison& femur = made[bones::BoneKind::Femur];
    femur.bone.is_found = femur.bone.reliable = has_bone;
    femur.bone.reasons = {"nothing in the images looks like it"};
    if (has_bone) femur.bone.reasons.clear();
    return made;
  }
  static std::shared_ptr<open_case::PostopAnswer> answer(bool has_bone) {
    auto made = std::make_shared<open_case::PostopAnswer>();
    made->comparisons = comparisons(has_bone);
    return made;
  }
};

TEST_F(ForeignImages, TakeNothingAwayFromWhatIsShown) {
  PostopShown shown;
  shown.comparisons = comparisons(true);
  EXPECT_FALSE(take_answer(answer(false), shown));
  EXPECT_EQ(shown.answer, nullptr);
  EXPECT_TRUE(shown.comparisons.at(bones::BoneKind::Femur).bone.is_found);
  EXPECT_EQ(shown.not_its_bones, "femur: nothing in the images looks like it");
  EXPECT_TRUE(take_answer(answer(true), shown));
  EXPECT_EQ(shown.not_its_bones, "");
}

TEST_F(ForeignImages, TakeNothingAwayFromWhatTheCaseKeeps) {
  const test::TemporaryFolder folder;
  const auto kept_bone = [&] {
    return postop::read_achieved_file(achieved_file(folder.path())).at(bones::BoneKind::Femur).bone.reliable;
  };
  EXPECT_TRUE(keep(*answer(false), folder.path())) << "where nothing is kept";
  EXPECT_FALSE(kept_bone());
  EXPECT_TRUE(keep(*answer(true), folder.path()));
  EXPECT_FALSE(keep(*answer(false), folder.path()));
  EXPECT_TRUE(kept_bone());
}

// A second CT, a poorer one: the good comparison of before was gone without a word.
TEST(PostopRun, ATunnelThatIsReliedOnStaysKept) {
  const test::TemporaryFolder folder;
  const auto answer = [](bool is_reliable) {
    open_case::PostopAnswer made;
    postop::Comparison& femur = made.comparisons[bones::BoneKind::Femur];
    femur.bone.is_found = femur.bone.reliable = true;
    femur.tunnel.is_found = true;
    femur.tunnel.reliable = is_reliable;
    femur.tunnel.tunnel.diameter_mm = is_reliable ? 9 : 8;
    femur.tunnel.reasons.clear();
    return made;
  };
  const auto kept_mm = [&] {
    return postop::read_achieved_file(achieved_file(folder.path()))
        .at(bones::BoneKind::Femur)
        .tunnel.tunnel.diameter_mm;
  };
  EXPECT_TRUE(keep(answer(false), folder.path()));
  EXPECT_EQ(better_kept(answer(true), folder.path()), "");
  EXPECT_TRUE(keep(answer(true), folder.path()));
  EXPECT_FALSE(keep(answer(false), folder.path()));
  EXPECT_EQ(kept_mm(), 9);
  EXPECT_EQ(better_kept(answer(false), folder.path()),
            "the case keeps a comparison that is reliable for femur, as this is not");
  EXPECT_TRUE(keep(answer(true), folder.path()));
  // Of an earlier plan it tells nothing of this one.
  open_case::PostopAnswer of_another_plan = answer(false);
  of_another_plan.planned[bones::BoneKind::Femur].entry_mm = {0, 0, 5};
  EXPECT_TRUE(keep(of_another_plan, folder.path()));
}

}  // namespace
}  // namespace arthronaut::review
