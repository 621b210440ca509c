// compare on the built-in knee, drilled and scanned, as a user types it.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "planning/bones/mesh_file.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/images/volume_writer.h"
#include "planning/phantom/phantom_case.h"
#include "planning/plan_export/drilled_bone.h"
#include "planning/postop/achieved_file.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/postop/postop_ct.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using bones::BoneKind;
using nlohmann::json;
using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;

class CompareCommand : public ::testing::Test {
 protected:
  CompareCommand() {
    knee_.plan.tunnels.erase(BoneKind::Tibia);
    cases::save_case(folder_ / "knee.arthro", knee_);
  }
  // A scan of the femur with this tunnel, or without any.
  void scan(const std::string& name, const std::optional<tunnels::Tunnel>& tunnel) const {
    std::vector<test::Drilled> drilled;
    if (tunnel) drilled.push_back({.tunnel = *tunnel});
    images::write_volume(folder_ / name,
                         test::postop_ct({made_.femur.mesh}, drilled, lying_, test::half_fine()));
  }
  [[nodiscard]] test::ProgramResult compare(const std::string& source, const std::string& output) const {
    return run_program({"compare", folder_ / "knee.arthro", "--postop", folder_ / source, "-o",
                        output == "-" ? output : (folder_ / output).string()});
  }
  [[nodiscard]] json read(const std::string& name) const {
    return json::parse(files::read_text(folder_ / name));
  }

  [[nodiscard]] static const phantom::PhantomKnee& made() {
    static const auto knee = phantom::make_phantom_knee({.edge_length_mm = 2});
    return knee;
  }

  const test::TemporaryFolder folder_;
  const phantom::PhantomKnee& made_ = made();
  cases::Case knee_ = phantom::case_of(made_, "Phantom");
  const geometry::RigidTransform lying_ = test::lying(25, {1, -1, 2}, {20, 40, -30});
};

Eigen::Vector3d vector_of(const json& values) {
  return {values.at(0).get<double>(), values.at(1).get<double>(), values.at(2).get<double>()};
}

}  // namespace

// The case keeps one comparison: two programs do not write it at once.
TEST_F(CompareCommand, Hazard15WritesNothingIntoACaseThatAnotherProgramHolds) {
  test::write_file(folder_ / "postop.nrrd", "is not even looked at");
  const cases::CaseLock lock(folder_ / "knee.arthro");
  ASSERT_TRUE(lock.is_held()) << lock.refusal();
  const auto result = compare("postop.nrrd", "knee.arthro/achieved.json");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("process " + std::to_string(::getpid())));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "knee.arthro/achieved.json"));
}

// The file is what the interface says, the numbers are the truth's.
TEST_F(CompareCommand, WritesWhatWasAchieved) {
  const auto tunnel =
      test::moved_tunnel(made_.femoral_tunnel, geometry::Surface(made_.femur.mesh), {3, -2}, {6, 5});
  scan("postop.nrrd", tunnel);
  const auto result = compare("postop.nrrd", "achieved.json");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("off the plan"), HasSubstr("achieved.json")));
  const json achieved = read("achieved.json");
  ASSERT_EQ(achieved.at("tunnels").size(), 1U);
  const json& found = achieved.at("tunnels").at(0);
  EXPECT_EQ(found.at("bone"), "femur");
  EXPECT_TRUE(found.at("reliable").get<bool>());
  EXPECT_TRUE(found.at("reasons").empty());
  EXPECT_LT((vector_of(found.at("entry_mm")) - tunnel.entry_mm).norm(), 0.3);
  EXPECT_GT(vector_of(found.at("direction")).dot(tunnel.direction), std::cos(geometry::rad_from_deg(0.6)));
  EXPECT_NEAR(found.at("diameter_mm").get<double>(), 9, 0.3);
  EXPECT_NEAR(found.at("offset_mm").get<double>(), (tunnel.entry_mm - made_.femoral_tunnel.entry_mm).norm(),
              0.3);
  EXPECT_NEAR(
      found.at("angle_deg").get<double>(),
      geometry::deg_from_rad(geometry::angle_between_rad(tunnel.direction, made_.femoral_tunnel.direction)),
      0.6);
  EXPECT_GT(found.at("length_mm").get<double>(), 25);
  const json& bone = achieved.at("bones").at(0);
  EXPECT_TRUE(bone.at("reliable").get<bool>());
  EXPECT_LT(bone.at("rms_mm").get<double>(), 0.3);
  const json& pose = bone.at("plan_from_postop");
  const json& q = pose.at("q_wxyz");
  const geometry::RigidTransform plan_from_postop{
      Eigen::Quaterniond(q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(),
                         q.at(3).get<double>()),
      vector_of(pose.at("t_mm"))};
  EXPECT_LT((plan_from_postop * (lying_ * tunnel.entry_mm) - tunnel.entry_mm).norm(), 0.1);
}

// Not drilled: written, with the reasons, and exit code 4. What is not known is null.
TEST_F(CompareCommand, AWholeBoneIsSaid) {
  scan("postop.nrrd", std::nullopt);
  const auto result = compare("postop.nrrd", "achieved.json");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("no tunnel is seen"));
  const json found = read("achieved.json").at("tunnels").at(0);
  EXPECT_FALSE(found.at("reliable").get<bool>());
  EXPECT_FALSE(found.at("reasons").empty());
  EXPECT_TRUE(found.at("entry_mm").is_null());
}

// Both bones planned and one of them in the images: the other one is named, and the answer is written and not
// relied on.
TEST_F(CompareCommand, SaysWhichOfTwoBonesIsNotSeen) {
  cases::save_case(folder_ / "knee.arthro", phantom::case_of(made_, "Phantom"));
  scan("femur.nrrd", knee_.plan.tunnels.at(BoneKind::Femur));
  const auto result = compare("femur.nrrd", "achieved.json");
  EXPECT_EQ(result.exit_code, 4) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("tibia: "));
  const json achieved = read("achieved.json");
  ASSERT_EQ(achieved.at("tunnels").size(), 2U);
  for (const json& tunnel : achieved.at("tunnels"))
    if (tunnel.at("bone") == "tibia") {
      EXPECT_FALSE(tunnel.at("reliable").get<bool>());
      EXPECT_FALSE(tunnel.at("reasons").empty());
    }
}

// Another knee's plan, and images that name another patient.
TEST_F(CompareCommand, AnotherPatientIsNotReliable) {
  scan("postop.nrrd", made_.femoral_tunnel);
  auto other = phantom::case_of(phantom::make_phantom_knee({.seed = 7, .edge_length_mm = 2}), "Another");
  other.plan.tunnels.erase(BoneKind::Tibia);
  cases::save_case(folder_ / "other.arthro", other);
  const auto result = run_program({"compare", folder_ / "other.arthro", "--postop", folder_ / "postop.nrrd",
                                   "-o", folder_ / "achieved.json"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("another patient"));
  const json achieved = read("achieved.json");
  EXPECT_FALSE(achieved.at("tunnels").at(0).at("reliable").get<bool>());
  EXPECT_FALSE(achieved.at("bones").at(0).at("reliable").get<bool>());
}

// Images that name somebody else: said, and to whom it may concern; but not kept, since what is kept goes out
// with reports that name nobody.
TEST_F(CompareCommand, WhoElseTheImagesAreOfIsSaidAndNotKept) {
  test::write_dicom_series(folder_ / "ct",
                           test::postop_ct({made_.femur.mesh}, {}, lying_, test::half_fine()));
  cases::save_identity(folder_ / "knee.arthro", {"Beispiel^Bert", "1234", "19500101"});
  // Not sought to the end before it is said.
  const auto refused = compare("ct", "achieved.json");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("4711"), HasSubstr("not compared; --another-patient")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "achieved.json"));
  const auto result = run_program({"compare", folder_ / "knee.arthro", "--postop", folder_ / "ct", "-o",
                                   folder_ / "achieved.json", "--another-patient"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("of another patient than the case"), HasSubstr("4711")));
  const std::string kept = files::read_text(folder_ / "achieved.json");
  EXPECT_THAT(kept, AllOf(HasSubstr("of another patient than the case"), ::testing::Not(HasSubstr("4711"))));
  // What the case itself keeps of its own patient stays, here none.
  const auto into_case = compare("ct", "knee.arthro/achieved.json");
  EXPECT_EQ(into_case.exit_code, 3);
  EXPECT_THAT(into_case.errors, AllOf(HasSubstr("4711"), HasSubstr("nothing is written into the case")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "knee.arthro/achieved.json"));
}

// The other knee of the same patient, or one that was marked wrongly: to be looked at before it is relied on.
TEST_F(CompareCommand, ImagesThatAreMarkedAsOfTheOtherSideAreDoubted) {
  test::DicomSeriesForm form;
  const bool is_left = knee_.side == bones::Side::Left;
  form.change = [&](DcmDataset& dataset, int) {
    ASSERT_TRUE(dataset.putAndInsertString(DCM_Laterality, is_left ? "R" : "L").good());
  };
  test::write_dicom_series(folder_ / "ct", test::postop_ct({made_.femur.mesh}, {}, lying_, test::half_fine()),
                           form);
  const auto result = compare("ct", "achieved.json");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr(std::string("the images are marked as those of a ") +
                                       (is_left ? "right" : "left") + " knee"));
}

// One bone alone would take the other one's place in the same file.
TEST_F(CompareCommand, OneBoneTakesNotTheOthersAway) {
  postop::Comparison of_tibia;
  postop::write_achieved_file(folder_ / "achieved.json", {{tunnels::TunnelKey(BoneKind::Tibia), of_tibia}},
                              {});
  const std::string before = files::read_text(folder_ / "achieved.json");
  test::write_file(folder_ / "postop.nrrd", "is not even looked at");
  const auto result = run_program({"compare", folder_ / "knee.arthro", "--postop", folder_ / "postop.nrrd",
                                   "--bone", "femur", "-o", folder_ / "achieved.json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("achieved.json: holds the comparison of the tibia"));
  EXPECT_EQ(files::read_text(folder_ / "achieved.json"), before);
}

// A poorer comparison took a good one's place without a word. The case's own stays; in another file it is
// replaced, and that is said.
TEST_F(CompareCommand, AGoodComparisonIsNotLostWithoutAWord) {
  scan("postop.nrrd", std::nullopt);
  postop::Comparison good;
  good.tunnel.is_found = good.tunnel.reliable = good.bone.is_found = good.bone.reliable = true;
  good.tunnel.tunnel = knee_.plan.tunnels.at(BoneKind::Femur);
  good.tunnel.reasons.clear();
  for (const std::string file : {"knee.arthro/achieved.json", "achieved.json"}) {
    const bool is_cases = file != "achieved.json";
    postop::write_achieved_file(folder_ / file, {{tunnels::TunnelKey(BoneKind::Femur), good}});
    const std::string before = files::read_text(folder_ / file);
    const auto result = compare("postop.nrrd", file);
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_EQ(files::read_text(folder_ / file) == before, is_cases);
    EXPECT_THAT(result.errors,
                AllOf(HasSubstr("femur: "), HasSubstr("achieved.json held one that is reliable"),
                      HasSubstr(is_cases ? "the case keeps; this one is not written" : "has replaced")));
    EXPECT_EQ(result.output.find("Wrote") == std::string::npos, is_cases);
  }
}

// The drilled bone as a mesh, as the plan's own export makes it. The case has no landmarks: what its shape
// proposes gives the percentages, and is said to be proposed.
TEST_F(CompareCommand, TakesAMeshOfTheDrilledBone) {
  knee_.landmarks.clear();
  cases::save_case(folder_ / "knee.arthro", knee_);
  const auto drilled = plan_export::drill(made_.femur.mesh, made_.femoral_tunnel);
  ASSERT_TRUE(drilled.is_usable());
  bones::write_mesh_stl(folder_ / "drilled.stl", drilled.mesh);
  const auto result = compare("drilled.stl", "-");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const json found = json::parse(result.output).at("tunnels").at(0);
  EXPECT_LT(found.at("offset_mm").get<double>(), 0.2);
  EXPECT_LT(found.at("angle_deg").get<double>(), 0.3);
  EXPECT_EQ(found.at("landmarks"), "proposed");
  EXPECT_EQ(found.at("grid").size(), 2U);
  EXPECT_NEAR(found.at("diameter_mm").get<double>(), 9, 0.2);
}

// A full disk, and a folder that nothing may be written into, are told before minutes of work.
TEST_F(CompareCommand, WhatCannotBeWrittenIsToldBeforeTheWork) {
  test::write_file(folder_ / "postop.nrrd", "is not even looked at");
  std::filesystem::create_directory(folder_ / "out");
  const std::vector<std::string> words{"compare",  folder_ / "knee.arthro",
                                       "--postop", folder_ / "postop.nrrd",
                                       "-o",       folder_ / "out/achieved.json"};
  for (const test::ProgramLimits& limits :
       {test::ProgramLimits{.file_size_bytes = 1000}, test::ProgramLimits{.as_nobody = true}}) {
    if (limits.as_nobody && ::geteuid() != 0) continue;  // not root: the folder is the tester's own
    const auto result = run_program(words, limits);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.errors, AllOf(HasSubstr("out/achieved.json: cannot be written: "),
                                     HasSubstr(limits.as_nobody ? "Permission denied" : "File too large")));
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out"));
  }
}

// Refused with file and reason, before any work; nothing is written.
TEST_F(CompareCommand, RefusesWhatCannotBeCompared) {
  test::write_file(folder_ / "broken.nrrd", "NRRD0004\ntype: short\n");
  const auto broken = compare("broken.nrrd", "achieved.json");
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.errors, HasSubstr("broken.nrrd"));
  EXPECT_EQ(compare("none.nrrd", "achieved.json").exit_code, 3);

  images::Volume soft;
  soft.size = {30, 30, 30};
  soft.modality_in_file = "CT";
  soft.values.assign(27000, 40.0F);
  images::write_volume(folder_ / "soft.nrrd", soft);
  const auto nothing = compare("soft.nrrd", "achieved.json");
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_THAT(nothing.errors, AllOf(HasSubstr("soft.nrrd"), HasSubstr("no bone")));

  const auto no_tibia = run_program({"compare", folder_ / "knee.arthro", "--postop", folder_ / "soft.nrrd",
                                     "--bone", "tibia", "-o", folder_ / "achieved.json"});
  EXPECT_EQ(no_tibia.exit_code, 3);
  EXPECT_THAT(no_tibia.errors, AllOf(HasSubstr("plan.json"), HasSubstr("tibia")));
  knee_.plan = {};
  cases::save_case(folder_ / "knee.arthro", knee_);
  const auto no_plan = compare("soft.nrrd", "achieved.json");
  EXPECT_EQ(no_plan.exit_code, 3);
  EXPECT_THAT(no_plan.errors, AllOf(HasSubstr("plan.json"), HasSubstr("no tunnel")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "achieved.json"));
}

}  // namespace arthronaut
