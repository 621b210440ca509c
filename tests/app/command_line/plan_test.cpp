// plan: tunnels placed, checked, exported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "planning/cases/bone_doubts.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/plan_command.h"
#include "tests/resources/described.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// The same checks as the window's: the entry's place, the footprint, the graft between both tunnels.
TEST_F(PlanCommand, ChecksAllThatTheWindowChecks) {
  const auto result = run({"plan", "--bone", "femur"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("Entry: on the lateral wall of the notch"));
  EXPECT_THAT(result.output, HasSubstr("Footprint opened: "));
  EXPECT_THAT(result.output, HasSubstr("Graft length: "));
  EXPECT_THAT(result.output, Not(HasSubstr("not checked")));
}

// A wall of nothing, and a direction without a part along an axis, have no minus sign.
TEST_F(PlanCommand, SaysNoMinusNought) {
  tunnels::Tunnel& femoral = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  femoral.direction = Eigen::Vector3d(femoral.direction.x(), -1e-8, femoral.direction.z()).normalized();
  femoral.entry_mm.y() = -1e-5;
  save(knee_);
  const auto result = run({"plan", "--bone", "femur"});
  EXPECT_THAT(result.output, HasSubstr(", 0.00000, ")) << "of the direction";
  EXPECT_THAT(result.output, HasSubstr(", 0.000, ")) << "of the entry";
  EXPECT_THAT(result.output, Not(testing::ContainsRegex("-0\\.0+[^0-9]")));
}

// Grid and axes hang on the landmarks: one that was confirmed 18 mm off leaves no plan reliable. It was said
// in the window's list alone.
TEST_F(PlanCommand, Hazard53SaysThatALandmarkLiesFarFromTheShape) {
  const auto of_landmarks = [&] {
    auto tunnel = nlohmann::json::parse(run({"plan", "--bone", "femur", "--json"}).output);
    for (const auto& check : tunnel.at("checks"))
      if (check.at("name") == "Landmarks") tunnel["of_landmarks"] = check;
    return tunnel;
  };
  auto before = of_landmarks();
  EXPECT_TRUE(before.at("reliable").get<bool>()) << before.at("reasons");
  ASSERT_TRUE(before.contains("of_landmarks"));
  EXPECT_EQ(before.at("of_landmarks").at("verdict"), "fine");
  knee_.landmarks.at(bones::BoneKind::Femur).at("blumensaat_anterior") += Eigen::Vector3d(0, -18, 0);
  save(knee_);
  const auto after = of_landmarks();
  EXPECT_FALSE(after.at("reliable").get<bool>());
  ASSERT_TRUE(after.contains("of_landmarks"));
  const auto& check = after.at("of_landmarks");
  EXPECT_EQ(check.at("verdict"), "look");
  EXPECT_THAT(check.at("text"), HasSubstr("Blumensaat's line, anterior end: "));
  EXPECT_GT(check.at("value").get<double>(), 10);
  EXPECT_EQ(check.at("unit"), "mm");
  EXPECT_EQ(check.at("greatest"), 10);
  EXPECT_THAT(check.at("source"), HasSubstr("by choice"));
  EXPECT_THAT(after.at("reasons").dump(), HasSubstr("Landmarks: Blumensaat's line, anterior end: "));
  EXPECT_THAT(run({"plan", "--bone", "femur"}).output,
              HasSubstr("  ! Landmarks: Blumensaat's line, anterior end: "));
}

// An entry on the outer side of the medial condyle, straight across the femur.
TEST_F(PlanCommand, SaysThatAnAbsurdPlanIsWrong) {
  const geometry::Surface femur(made_.femur.mesh);
  // A right knee: medial is +x.
  const Eigen::Vector3d outer = femur.closest_point(made_.femur_landmarks.at("medial_epicondyle")).point_mm;
  knee_.plan.tunnels[bones::BoneKind::Femur].entry_mm = outer;
  knee_.plan.tunnels[bones::BoneKind::Femur].direction = -Eigen::Vector3d::UnitX();
  save(knee_);
  const auto result = run({"plan", "--bone", "femur"});
  EXPECT_THAT(result.output, HasSubstr("  x Entry: "));
  EXPECT_THAT(result.output, HasSubstr("  x Exit: into the notch"));
  const auto json = nlohmann::json::parse(run({"plan", "--bone", "femur", "--json"}).output);
  EXPECT_FALSE(json.at("reliable").get<bool>()) << "whoever shows it";
  EXPECT_THAT(json.at("reasons").dump(), HasSubstr("Exit: into the notch"));
}

TEST_F(PlanCommand, MakesADefaultPlanAndPrintsIt) {
  const auto result = run({"plan", "--bone", "tibia", "--default", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
  const auto tunnel = nlohmann::json::parse(result.output);
  EXPECT_EQ(tunnel.at("bone"), "tibia");
  EXPECT_TRUE(tunnel.at("reliable").get<bool>());
  const cases::Case saved = cases::load_case(folder_ / "knee.arthro");
  EXPECT_NEAR(saved.plan.tunnels.at(bones::BoneKind::Tibia).entry_mm.x(),
              tunnel.at("entry_mm").at(0).get<double>(), 1e-6);
}

// The grid that a default plan was made by is its landmarks': where these do not fit on the disk the plan,
// which is smaller, stays as it was.
TEST_F(PlanCommand, ADiskThatTakesNoLandmarksTakesNoPlan) {
  const auto plan = folder_ / "knee.arthro/plan.json", landmarks = folder_ / "knee.arthro/case.json";
  constexpr rlim_t kRoom = 2000;
  ASSERT_GT(std::filesystem::file_size(landmarks), kRoom);
  ASSERT_LT(std::filesystem::file_size(plan), kRoom / 2);
  const std::string before = files::read_text(plan);
  ::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
  rlimit whole{};
  ::getrlimit(RLIMIT_FSIZE, &whole);
  const rlimit full{kRoom, whole.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  const auto result = run({"plan", "--bone", "femur", "--default", "--diameter-mm", "7"});
  ::setrlimit(RLIMIT_FSIZE, &whole);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("case.json: cannot write"));
  EXPECT_EQ(files::read_text(plan), before);
}

// A diameter without a tunnel to place would be taken for a change of the one that is there; of a tunnel that
// is not planned it is said so; an export that cannot be written is refused before half a minute of drilling.
TEST_F(PlanCommand, WhatWouldDoNothingIsRefused) {
  const auto diameter = run({"plan", "--bone", "femur", "--diameter-mm", "5"});
  EXPECT_EQ(diameter.exit_code, 2);
  EXPECT_THAT(diameter.errors, HasSubstr("--default or --direction"));
  const auto nan = run({"plan", "--bone", "femur", "--default", "--diameter-mm", "nan"});
  EXPECT_EQ(nan.exit_code, 2);
  EXPECT_THAT(nan.errors, HasSubstr("--diameter-mm: \"nan\" must be a number, 3 to 15"));
  const auto two = run({"plan", "--bone", "femur", "--entry", "1,2", "--direction", "1,0,0"});
  EXPECT_EQ(two.exit_code, 2);
  EXPECT_THAT(two.errors, HasSubstr("--entry: \"1,2\" must be three numbers"));
  for (const char* large : {"1e9,0,0", "0,0,-1e999"}) {
    const auto beyond = run({"plan", "--bone", "femur", "--entry", large, "--direction", "1,0,0"});
    EXPECT_EQ(beyond.exit_code, 2) << large;
    EXPECT_THAT(beyond.errors, HasSubstr("must be numbers of -1000000 to 1000000")) << large;
  }
  EXPECT_THAT(run({"plan", "--take", "0"}).errors,
              HasSubstr("--take: \"0\" must be a whole number, 1 to 1000000"));
  EXPECT_EQ(run({"plan", "--bone", "femur", "--direction", "1,0,0"}).exit_code, 2);
  EXPECT_EQ(run({"plan", "--bone", "femur", "--at-footprint", "--direction", "0,0,0"}).exit_code, 2);
  EXPECT_THAT(run({"plan", "--bone", "femur", "--type", "am"}).output,
              HasSubstr("No femur tunnel is planned of type am."));
  const auto file = run({"plan", "--export", folder_ / "knee.arthro" / "plan.json"});
  EXPECT_EQ(file.exit_code, 3);
  EXPECT_THAT(file.errors, HasSubstr("plan.json: cannot be written: Not a directory"));
  const auto off = run({"plan", "--bone", "femur", "--entry", "500,0,0", "--direction", "1,0,0"});
  EXPECT_EQ(off.exit_code, 3);
  EXPECT_THAT(off.errors, HasSubstr("knee.arthro: femur: --entry lies"));
  EXPECT_THAT(run({"landmarks", "--set", "femur.notch_apex=500,0,0"}).errors,
              HasSubstr("knee.arthro: femur: --set femur.notch_apex lies"));
  EXPECT_EQ(run({"landmarks", "--roof", "flat"}).exit_code, 2) << "nothing is proposed";
  const auto set = run({"landmarks", "--set", "femur.notch_apex=1,2,nan"});
  EXPECT_EQ(set.exit_code, 2);
  EXPECT_THAT(set.errors, HasSubstr("--set: \"femur.notch_apex=1,2,nan\" is not BONE.NAME=x,y,z"));
}

// What takes seconds says so on a terminal.
TEST_F(PlanCommand, WhatTakesLongSaysWhatItDoes) {
  const std::string knee = folder_ / "knee.arthro";
  EXPECT_THAT(run_program({"landmarks", knee, "--propose"}, {.errors_on_terminal = true}).errors,
              HasSubstr("Looking for landmarks"));
  EXPECT_THAT(
      run_program({"plan", knee, "--bone", "femur", "--default"}, {.errors_on_terminal = true}).errors,
      HasSubstr("Making the default plan"));
}

// Hazard 46: on landmarks that somebody confirmed, a bone that was cut off is a doubtful one all the same.
TEST_F(PlanCommand, Hazard46SaysWhatSpokeAgainstTheBone) {
  cases::save_bone_doubts(folder_ / "knee.arthro", {{bones::BoneKind::Femur, {"the images end within it"}}});
  EXPECT_THAT(run({"plan", "--bone", "femur"}).output, HasSubstr("  ! Bone: the images end within it"));
  EXPECT_THAT(run({"plan", "--bone", "tibia"}).output, Not(HasSubstr("  ! Bone: ")));
  const auto json = nlohmann::json::parse(run({"plan", "--bone", "femur", "--json"}).output);
  EXPECT_EQ(json.at("bone_doubts").at(0), "the images end within it");
  EXPECT_FALSE(json.at("reliable").get<bool>());
  EXPECT_THAT(json.at("reasons").dump(), HasSubstr("the femur: the images end within it"));
  const auto made = run({"plan", "--bone", "femur", "--default"});
  EXPECT_EQ(made.exit_code, 4);
  EXPECT_THAT(made.errors, HasSubstr("the femur: the images end within it"));
}

// Where a tunnel leaves a bone that its images cut off nobody knows, nor how long it is.
TEST_F(PlanCommand, Hazard46ATunnelThatLeavesWhereTheImagesEndIsNotChecked) {
  const tunnels::Tunnel& tunnel = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  cases::save_bone_doubts(
      folder_ / "knee.arthro",
      {{bones::BoneKind::Femur,
        {bones::ImageCut{
            .at_mm = tunnel.entry_mm + 10 * tunnel.direction, .out = tunnel.direction, .area_mm2 = 500}}}});
  const std::string output = run({"plan", "--bone", "femur"}).output;
  EXPECT_THAT(output, HasSubstr("mm inside bone, as far as the images go"));
  EXPECT_THAT(output, HasSubstr("  ? Length: not checked: the tunnel leaves where the images end"));
  EXPECT_THAT(output, HasSubstr("  ? Exit: not checked: the tunnel leaves where the images end"));
}

// What is placed by hand is done as it was asked: that it cannot be drilled is said wherever it goes, and is
// no failure of the command.
TEST_F(PlanCommand, AWrongPlanIsToldHoweverItWasMade) {
  const auto placed =
      run({"plan", "--bone", "tibia", "--entry=" + entry_text(), "--direction", "0.8,-0.4,-0.3"});
  EXPECT_EQ(placed.exit_code, 0) << placed.errors;
  EXPECT_THAT(placed.output, HasSubstr("  x "));
  EXPECT_THAT(placed.errors,
              HasSubstr("The plan is wrong as it is, and kept as asked\n  - the tibia's tunnel: "));
  const auto as_json = run({"plan", "--bone", "tibia", "--json"});
  EXPECT_EQ(as_json.exit_code, 0);
  EXPECT_THAT(as_json.errors, HasSubstr("  - the tibia's tunnel: ")) << "a script that reads the output, too";
  EXPECT_EQ(run({"plan", "--bone", "femur"}).errors, "") << "nothing is wrong there";
  const auto exported = run({"plan", "--export", folder_ / "out"});
  EXPECT_EQ(exported.exit_code, 0) << exported.errors;
  EXPECT_THAT(exported.output, HasSubstr("Wrong, and exported all the same: tibia: "));
}

// A plan of the other knee leaves the case as one: it can be mended by nobody who gets it.
TEST_F(PlanCommand, APlanOfTheOtherKneeIsExportedAsUnreliable) {
  cases::save_bone_doubts(folder_ / "knee.arthro",
                          {{bones::BoneKind::Tibia, {cases::SideDoubt{.told = bones::Side::Left}}}});
  const auto exported = run({"plan", "--export", folder_ / "out"});
  EXPECT_EQ(exported.exit_code, 4);
  EXPECT_THAT(exported.output, HasSubstr("Wrong, and exported all the same: Side: the fibula lies on the"));
  EXPECT_THAT(exported.errors, HasSubstr("check the side"));
}

// An entry that lies off the bone is moved onto it, and whoever typed it is told how far that took the axis.
TEST_F(PlanCommand, AnEntryThatIsMovedOntoTheBoneIsTold) {
  const Eigen::Vector3d on_bone = knee_.plan.tunnels.at(bones::BoneKind::Tibia).entry_mm;
  const std::string direction = "0.3,-0.4,-0.8";
  const auto placed_at = [&](const Eigen::Vector3d& at) {
    std::ostringstream text;
    text << std::setprecision(12) << at.x() << ',' << at.y() << ',' << at.z();
    return std::vector<std::string>{"plan",        "--bone", "tibia", "--entry=" + text.str(),
                                    "--direction", direction};
  };
  EXPECT_THAT(run(placed_at(on_bone)).output, Not(HasSubstr("was moved")));
  const Eigen::Vector3d asked = on_bone + Eigen::Vector3d(0, 0, 3);
  EXPECT_THAT(run(placed_at(asked)).output, HasSubstr("off the bone and was moved to its nearest point"));
  auto as_json = placed_at(asked);
  as_json.emplace_back("--json");
  const auto told = nlohmann::json::parse(run(as_json).output);
  EXPECT_EQ(test::undescribed(told, "tunnel"), "");
  const Eigen::Vector3d planned(told["entry_mm"][0], told["entry_mm"][1], told["entry_mm"][2]);
  EXPECT_GT(told.at("entry_moved_mm").get<double>(), 0.5);
  EXPECT_NEAR(told.at("entry_moved_mm").get<double>(), (planned - asked).norm(), 1e-6);
}

// Markups that say themselves that they are of the other knee are refused; of another plan they are doubted.
TEST_F(PlanCommand, MarkupsOfAnotherKneeOrPlanAreNotTakenSilently) {
  ASSERT_EQ(run({"plan", "--export", folder_ / "out"}).exit_code, 0);
  const std::string file = folder_ / "out" / "plan.mrk.json";
  const std::string ours = files::read_text(file);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = ours;
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
    files::write_atomically(file, text);
    return run({"plan", "--from-markups", file});
  };
  const auto other_knee = with("right knee", "left knee");
  EXPECT_EQ(other_knee.exit_code, 3);
  EXPECT_THAT(other_knee.errors, HasSubstr("is of a left knee"));
  const auto other_plan = with(", plan ", ", plan 0");
  EXPECT_EQ(other_plan.exit_code, 0) << other_plan.errors;
  EXPECT_THAT(other_plan.output, HasSubstr("written of plan 0"));
  EXPECT_EQ(with("right knee", "right knee").exit_code, 0) << "taken once more";
}

TEST_F(PlanCommand, ExportsPlanAndDrilledBones) {
  const auto result = run({"plan", "--export", folder_ / "out"});
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
  for (const char* file : {"plan.json", "plan.csv", "plan.mrk.json", "femur_drilled.stl", "femur_drilled.ply",
                           "tibia_drilled.stl", "tibia_drilled.ply"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  // What another program reads is the document alone.
  const auto json = run({"plan", "--bone", "femur", "--json", "--export", folder_ / "again"});
  const auto document = nlohmann::json::parse(json.output);
  EXPECT_EQ(test::undescribed(document, "tunnel"), "");
  EXPECT_EQ(document.at("bone"), "femur");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "again" / "plan.csv"));
  // Versions are listed in words, and alone: what is asked for beside them would be left undone.
  for (const char* other : {"--json", "--keep", "--list"})
    EXPECT_EQ(run({"plan", "--versions", other}).exit_code, 2) << other;
  EXPECT_EQ(run({"plan", "--versions", "--export", folder_ / "never"}).exit_code, 2);
  // Read back, they are the same plan.
  EXPECT_EQ(run({"plan", "--from-markups", folder_ / "out" / "plan.mrk.json"}).exit_code, 0);
  const cases::Case saved = cases::load_case(folder_ / "knee.arthro");
  const auto& before = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  EXPECT_LT((saved.plan.tunnels.at(bones::BoneKind::Femur).entry_mm - before.entry_mm).norm(), 1e-3);
}

// Where no tunnel is planned the list is empty: never null.
TEST_F(PlanCommand, JsonSaysWhatItIs) {
  EXPECT_EQ(run({"plan", "--bone", "femur", "--remove"}).exit_code, 0);
  for (const auto& arguments :
       {std::vector<std::string>{"plan", "--json"}, {"plan", "--bone", "femur", "--json"}}) {
    const auto document = nlohmann::json::parse(run(arguments).output);
    EXPECT_EQ(test::undescribed(document, "tunnels"), "");
    EXPECT_EQ(document.at("tunnels").size(), arguments.size() == 2 ? 1U : 0U);
  }
}

// One bundle after the other gives two tunnels; none of them is ever shown or changed for the other.
TEST_F(PlanCommand, TwoBundlesArePlannedShownExportedAndRemoved) {
  const auto am = run({"plan", "--bone", "femur", "--default", "--type", "am", "--json"});
  ASSERT_EQ(am.exit_code, 0) << am.output << am.errors;
  const auto first = nlohmann::json::parse(am.output);
  EXPECT_EQ(first.at("bundle"), "am");
  EXPECT_EQ(first.at("diameter_mm"), 7.0);
  const auto pl = run({"plan", "--bone", "femur", "--default", "--type", "pl", "--json"});
  ASSERT_EQ(pl.exit_code, 0) << pl.output << pl.errors;
  EXPECT_EQ(nlohmann::json::parse(pl.output).at("bundle"), "pl");
  const auto both = nlohmann::json::parse(run({"plan", "--bone", "femur", "--json"}).output);
  ASSERT_EQ(both.at("tunnels").size(), 2U);
  EXPECT_EQ(both.at("tunnels").at(0).at("entry_mm"), first.at("entry_mm")) << "PL moved AM";
  const auto shown = run({"plan", "--bone", "femur", "--type", "pl"});
  EXPECT_THAT(shown.output, HasSubstr("femur PL tunnel, 6.0 mm"));
  EXPECT_THAT(shown.output, HasSubstr("Between the tunnels: "));
  EXPECT_THAT(shown.output, Not(HasSubstr("femur AM tunnel")));
  EXPECT_EQ(run({"plan", "--export", folder_ / "out"}).exit_code, 0);
  EXPECT_EQ(run({"plan", "--from-markups", folder_ / "out" / "plan.mrk.json"}).exit_code, 0);
  EXPECT_EQ(cases::load_case(folder_ / "knee.arthro").plan.of(bones::BoneKind::Femur).size(), 2U);
  const auto unnamed = run({"plan", "--bone", "femur", "--remove"});
  EXPECT_EQ(unnamed.exit_code, 3);
  EXPECT_THAT(unnamed.errors, HasSubstr("say by --type which"));
  EXPECT_EQ(run({"plan", "--bone", "femur", "--remove", "--type", "am"}).exit_code, 0);
  EXPECT_EQ(cases::load_case(folder_ / "knee.arthro").plan.of(bones::BoneKind::Femur).size(), 1U);
  const auto single = run({"plan", "--bone", "femur", "--default", "--type", "single"});
  EXPECT_THAT(single.output, HasSubstr("The tunnel femur PL is no longer planned"));
  // Markups of two bundles in place of it are no silent change either.
  EXPECT_THAT(run({"plan", "--from-markups", folder_ / "out" / "plan.mrk.json"}).output,
              HasSubstr("The tunnel femur is no longer planned"));
  EXPECT_EQ(run({"plan", "--bone", "femur", "--default", "--type", "single"}).exit_code, 0);
  const auto plan = cases::load_case(folder_ / "knee.arthro").plan;
  EXPECT_EQ(plan.of(bones::BoneKind::Femur), std::vector<tunnels::TunnelKey>{bones::BoneKind::Femur});
}

// Which of two is drilled is never guessed: refused before any work.
TEST_F(PlanCommand, Hazard38NavigateAsksWhichOfTwoTunnelsIsDrilled) {
  for (const char* bundle : {"am", "pl"})
    ASSERT_EQ(run({"plan", "--bone", "femur", "--default", "--type", bundle}).exit_code, 0);
  const auto unnamed = run({"navigate", "--video", "none.mkv"});
  EXPECT_EQ(unnamed.exit_code, 3);
  EXPECT_THAT(unnamed.errors, HasSubstr("say by --tunnel which one is drilled"));
  const auto single = run({"navigate", "--video", "none.mkv", "--tunnel", "single"});
  EXPECT_EQ(single.exit_code, 3);
  EXPECT_THAT(single.errors, HasSubstr("holds no tunnel femur"));
}

}  // namespace
}  // namespace arthronaut
