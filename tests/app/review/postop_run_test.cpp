#include "app/review/postop_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"
#include "planning/postop/achieved_file.h"
#include "tests/full_disk.h"
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

// What a newer program compared was written over without a word.
TEST(PostopRun, AComparisonByANewerProgramIsNotReplaced) {
  const test::TemporaryFolder folder;
  open_case::PostopAnswer answer;
  answer.comparisons[bones::BoneKind::Femur].bone.is_found = true;
  const std::string newer = R"({"format": "arthronaut.achieved", "version": 2, "knees": []})";
  files::write_atomically(achieved_file(folder.path()), newer);
  EXPECT_THROW((void)keep(answer, folder.path()), InvalidInput);
  EXPECT_EQ(files::read_text(achieved_file(folder.path())), newer);
  files::write_atomically(achieved_file(folder.path()), "{");
  EXPECT_TRUE(keep(answer, folder.path())) << "broken ones are";
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

// What is relied on in part stays before what is relied on in less.
TEST(PostopRun, APartThatIsReliedOnStaysKept) {
  using enum tunnels::Quantity;
  const test::TemporaryFolder folder;
  const auto answer = [](const tunnels::Quantities& known) {
    open_case::PostopAnswer made;
    postop::Comparison& femur = made.comparisons[bones::BoneKind::Femur];
    femur.bone.is_found = femur.bone.reliable = femur.tunnel.is_found = true;
    femur.tunnel.known = known;
    return made;
  };
  EXPECT_TRUE(keep(answer({Entry, Direction}), folder.path()));
  EXPECT_FALSE(keep(answer({}), folder.path()));
  EXPECT_FALSE(keep(answer({Entry, Length}), folder.path()));
  EXPECT_TRUE(keep(answer({Entry, Direction, Length}), folder.path()));
}

// Before minutes of work, not after them.
TEST(PostopRun, AFullDiskIsToldBeforeTheImagesAreRead) {
  const test::TemporaryFolder folder;
  {
    const test::FullDisk full;
    PostopRun run(folder.path(), folder / "is not even looked for", "1.2.3", true, [] {});
    while (!run.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_THAT(run.error(), HasSubstr("achieved.json: cannot be written"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Images that name somebody else were searched to their end before that was said.
TEST(PostopRun, ImagesOfAnotherPatientAreNotSearched) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Phantom"));
  cases::save_identity(folder.path(), {"Beispiel^Bert", "1234", "19500101"});
  open_case::PostopQuestion question{.case_folder = folder.path(), .source = "ct"};
  question.refuses_another_patient = true;
  question.read = [](const postop::PostopSourceOptions&) {
    images::Volume volume;  // not even large enough for a bone: a search would throw
    volume.size = {8, 8, 8};
    volume.values.assign(512, 0.0F);
    volume.patient = {"Muster^Anna", "4711", "19900131"};
    return volume;
  };
  const open_case::PostopAnswer answer = open_case::compare_with_postop(question);
  EXPECT_THAT(answer.other_patient, HasSubstr("Muster"));
  EXPECT_TRUE(answer.comparisons.empty());
  question.refuses_another_patient = false;
  EXPECT_THROW((void)open_case::compare_with_postop(question), InvalidInput);
}

// One poorer tunnel kept a whole comparison out of the case, the good one beside it, too.
TEST(PostopRun, WhatStaysKeptKeepsNothingElseOut) {
  const test::TemporaryFolder folder;
  const tunnels::TunnelKey am{bones::BoneKind::Femur, norms::Bundle::Anteromedial},
      pl{bones::BoneKind::Femur, norms::Bundle::Posterolateral};
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Phantom");
  tunnels::Tunnel planned = knee.plan.tunnels.at(bones::BoneKind::Femur);
  const std::string mesh = bones::mesh_sha256(knee.bones.at(bones::BoneKind::Femur).mesh);
  for (const tunnels::TunnelKey& key : {am, pl}) {
    planned.bundle = key.bundle;
    knee.plan.put(planned, mesh);
    planned.entry_mm.y() += 8;
  }
  cases::save_case(folder.path(), knee);
  const auto answer = [&](double bone_x_mm, bool am_is_reliable, bool pl_is_reliable) {
    open_case::PostopAnswer made;
    for (const auto& [key, is_reliable] : {std::pair(am, am_is_reliable), std::pair(pl, pl_is_reliable)}) {
      postop::Comparison& one = made.comparisons[key];
      one.bone.is_found = one.bone.reliable = one.tunnel.is_found = true;
      one.bone.reasons.clear();
      one.bone.plan_from_postop.translation_mm = {bone_x_mm, 0, 0};
      one.tunnel.tunnel = knee.plan.tunnels.at(key);
      one.tunnel.length_mm = 30;
      one.tunnel.reliable = is_reliable;
      one.tunnel.reasons = {"not straight"};
      if (is_reliable) one.tunnel.reasons.clear();
    }
    return made;
  };
  const auto kept = [&] { return postop::read_achieved_file(achieved_file(folder.path())); };
  ASSERT_TRUE(keep(answer(1, true, false), folder.path()));
  const open_case::PostopAnswer newer = answer(2, false, true);
  EXPECT_EQ(
      better_kept(newer, folder.path()),
      "the case keeps a comparison that is reliable for femur AM, as this is not: femur AM: not straight");
  EXPECT_TRUE(keep(newer, folder.path()));
  EXPECT_TRUE(kept().at(am).tunnel.reliable);
  EXPECT_TRUE(kept().at(pl).tunnel.reliable);
  EXPECT_EQ(kept().at(am).kept_because, "newer images show it less well: not straight");
  EXPECT_EQ(kept().at(pl).kept_because, "");
  // Each bone as the tunnel's own images showed it.
  EXPECT_EQ(kept().at(am).bone.plan_from_postop.translation_mm.x(), 1);
  EXPECT_EQ(kept().at(pl).bone.plan_from_postop.translation_mm.x(), 2);
  const auto file = nlohmann::json::parse(files::read_text(achieved_file(folder.path())));
  EXPECT_EQ(file.at("bones").size(), 1U);
  EXPECT_EQ(file.at("bones").at(0).at("plan_from_postop").at("t_mm").at(0), 2);
  EXPECT_TRUE(file.at("tunnels").at(0).contains("off_plan")) << "where it lies is told of what stays, too";
  // Newer and good: nothing is of before any more.
  EXPECT_TRUE(keep(answer(3, true, true), folder.path()));
  EXPECT_EQ(kept().at(am).kept_because, "");
  EXPECT_EQ(kept().at(am).bone.plan_from_postop.translation_mm.x(), 3);
}

}  // namespace
}  // namespace arthronaut::review
