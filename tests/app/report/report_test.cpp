// The report of a plan, and what it is printed on.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <tuple>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session_marks.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/identity.h"
#include "planning/cases/plan_file.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/plan_review.h"
#include "planning/postop/achieved_file.h"
#include "tests/app/report/page_edges.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

// A case that has only been planned: the plan's numbers, versions and what the software is not.
TEST_F(Report, OfAPlanAloneSaysThatNothingWasNavigated) {
  write(pdf());
  EXPECT_GE(page_count(pdf_info()), 2);
  const std::string text = pdf_text();
  expect_contains(text, "Knee of Ærø");
  expect_contains(text, "not a medical device");
  expect_contains(text, "No session with a registration");
  expect_contains(text, "femur");
  expect_contains(text, "OpenCV");
}

// Twenty seconds of drawing are not waited for without a word.
TEST_F(Report, TellsWhatGoesOn) {
  std::vector<std::string> parts;
  double share = 0;
  ReportOptions options;
  options.on_progress = [&](const std::string& what, double now) {
    if (parts.empty() || parts.back() != what) parts.push_back(what);
    EXPECT_GE(now, share);
    EXPECT_LE(now, 1);
    share = now;
  };
  write(pdf(), options);
  EXPECT_EQ(parts.front(), "Reading the case and its sessions");
  EXPECT_TRUE(std::ranges::count(parts, "Drawing the plan"));
  EXPECT_GT(share, 0.5);
}

// The verdict of the checks stands at the head of the first page, before any number.
TEST_F(Report, SaysFirstWhatIsWrongWithThePlan) {
  tunnels::Tunnel& femoral = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  femoral.direction = Eigen::Vector3d(-0.2, -0.1, 0.97).normalized();  // along the wall, out of it
  cases::save_case(knee_folder(), knee_);
  cases::save_bone_doubts(knee_folder(), {{bones::BoneKind::Tibia, {"the images end within it"}}});
  const plan_review::CaseReview review(cases::load_case(knee_folder()));
  ASSERT_FALSE(tunnels::wrong_in_words(review.checks(bones::BoneKind::Femur)).empty());
  write(pdf());
  const std::string text = pdf_text(), head = text.substr(0, text.find("Planned tunnels"));
  expect_contains(head, "Checks of the femur: WRONG: ");
  expect_contains(head, "Checks of the tibia: look: Bone: the images end within it");
}

// The sheet has every check of both tunnels, in words, and the percentages of the entries.
TEST_F(Report, HasThePlanOnOneSheet) {
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "The plan on one sheet");
  expect_contains(text, "True lateral view");
  expect_contains(text, "Entry at ");
  const plan_review::CaseReview review(cases::load_case(knee_folder()));
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    expect_contains(text, "Checks of the " + std::string(bones::to_text(kind)));
    for (const auto& check : review.checks(kind)) expect_contains(text, check.name + ":");
  }
}

// A plan of another program may begin before the bone: picture and checks say the same of it all the same.
TEST_F(Report, TheSheetsPicturesSayTheEntryThatTheChecksSay) {
  for (auto& [key, tunnel] : knee_.plan.tunnels)
    tunnel.entry_mm += -3 * tunnel.direction + Eigen::Vector3d(0, 0.4, 0);
  cases::save_case(knee_folder(), knee_);
  write(pdf());
  const std::string text = pdf_text();
  const plan_review::CaseReview review(cases::load_case(knee_folder()));
  const auto expect_said = [&](bones::BoneKind bone, const char* along, const char* across,
                               const std::string& words) {
    std::smatch said;
    ASSERT_TRUE(std::regex_search(text, said, std::regex(words))) << text;
    const auto checks = review.checks(bone);
    const char* const names[] = {along, across};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto check = std::ranges::find(checks, names[i], &tunnels::PlanCheck::name);
      ASSERT_NE(check, checks.end()) << names[i];
      EXPECT_NEAR(std::stod(said[i + 1]), *check->value, 0.051) << names[i];
    }
  };
  expect_said(bones::BoneKind::Femur, "Deep to shallow", "High to low",
              R"(Entry\s+at\s+([0-9.]+)\s+%\s+deep\s+to\s+shallow,\s+([0-9.]+)\s+%)");
  expect_said(bones::BoneKind::Tibia, "Anterior to posterior", "Medial to lateral",
              R"(Entry\s+at\s+([0-9.]+)\s+%\s+from\s+anterior,[\s\S]*?([0-9.]+)\s+%\s+from\s+medial)");
}

// A lateral view is called true where the condyles tell it, here as on the screen.
TEST_F(Report, SaysWhereTheLateralViewIsNotTrue) {
  auto& marks = knee_.landmarks.at(bones::BoneKind::Femur);
  for (const char* side : {"lateral", "medial"})
    for (const char* part : {"center", "posterior"}) marks.erase(std::string(side) + "_condyle_" + part);
  cases::save_case(knee_folder(), knee_);
  write(pdf());
  EXPECT_EQ(pdf_text().find("True lateral view"), std::string::npos);
  expect_contains(pdf_text(), "Lateral view along the scanner");  // lines break after that
}

// Hazard 46: whoever reads the sheet alone reads what whoever imported the bone read.
TEST_F(Report, Hazard46SaysWhatSpokeAgainstABone) {
  cases::save_bone_doubts(knee_folder(), {{bones::BoneKind::Tibia, {"the images end within it"}}});
  write(pdf());
  expect_contains(pdf_text(), "Bone: the images end within it");
  const auto json = knee_folder().parent_path() / "report.json";
  write(json);
  expect_contains(files::read_text(json), R"("bone_doubts": {
    "tibia": [
      "the images end within it"
    ]
  })");
}

// The report is written, and is not one to rely on.
TEST_F(Report, OfAPlanOfTheOtherKneeSaysSo) {
  cases::save_bone_doubts(knee_folder(),
                          {{bones::BoneKind::Tibia, {cases::SideDoubt{.told = bones::Side::Left}}}});
  const auto said = write_report(knee_folder(), knee_folder().parent_path() / "report.csv", {});
  ASSERT_EQ(said.size(), 1U);
  expect_contains(said[0], "the plan is wrong, and reported all the same: the fibula lies on the left");
}

// One bone is a case too: neither page asks for a picture of the other.
TEST_F(Report, OfOneBoneAlone) {
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    auto one = knee_;
    std::erase_if(one.bones, [&](const auto& bone) { return bone.first != kind; });
    std::erase_if(one.plan.tunnels, [&](const auto& tunnel) { return tunnel.first != kind; });
    const auto folder = knee_folder().parent_path() / (std::string(bones::to_text(kind)) + ".arthro");
    cases::save_case(folder, one);
    write_report(folder, pdf(), {.picture_px_per_mm = 1});
    EXPECT_GE(page_count(pdf_info()), 2);
    expect_contains(pdf_text(), std::string(bones::to_text(kind)));
  }
}

// Hazard 19: nobody is named unless that was asked for.
TEST_F(Report, Hazard19NamesThePatientOnlyWhenAsked) {
  cases::save_identity(knee_folder(), {"Muster^Anna", "4711", "19900131"});
  write(pdf());
  for (const char* word : {"Muster", "4711", "1990"})
    EXPECT_EQ((pdf_text() + pdf_info()).find(word), std::string::npos) << word;
  write(pdf(), {.with_identity = true});
  expect_contains(pdf_text(), "Muster, Anna");
  expect_contains(pdf_text(), "1990-01-31");
}

// On either paper there are four pages at most, every page is of that paper, has its foot, and nothing comes
// near an edge: neither words that have no space to be broken at, nor a list that is longer than a page,
// whose middle is left to the report as JSON.
TEST_F(Report, FitsA4AndLetter) {
  knee_.name = std::string(160, 'W');
  cases::save_case(knee_folder(), knee_);
  (void)text_of_session("live",
                        {{recording::kVerifiedEvent, ""}, {recording::kVoidEvent, std::string(300, 'x')}});
  recording::SessionMarks marks;
  for (std::int64_t i = 0; i < 90; ++i) marks.push_back({i, i * 1'000'000'000, "mark " + std::to_string(i)});
  recording::write_marks(cases::session_folders(knee_folder()).back(), marks);
  for (const auto& [paper, width_pt, height_pt] :
       {std::tuple(Paper::A4, 595.28, 841.89), std::tuple(Paper::Letter, 612.0, 792.0)}) {
    SCOPED_TRACE(to_text(paper));
    write_report(knee_folder(), pdf(), {.paper = paper});
    const auto pages = test::pages_of(pdf());
    EXPECT_EQ(pages.size(), 4U);
    for (const test::Page& page : pages) {
      EXPECT_NEAR(page.width_pt, width_pt, 0.1);
      EXPECT_NEAR(page.height_pt, height_pt, 0.1);
      EXPECT_GT(page.words, 0);
      EXPECT_TRUE(page.words_lie_within(10)) << page.outermost;
      EXPECT_TRUE(page.has_empty_edge);
    }
    const std::string text = pdf_text();
    for (std::size_t page = 1; page <= pages.size(); ++page)
      expect_contains(text, "page " + std::to_string(page) + " \u00B7 research software");
    for (const int i : {0, 1, 88, 89}) expect_contains(text, "mark " + std::to_string(i) + " ");
    EXPECT_EQ(text.find("mark 45 "), std::string::npos);
    expect_contains(text, "more here: the report as JSON has them all");
  }
  const auto json = pdf().parent_path() / "report.json";
  write(json);
  EXPECT_EQ(nlohmann::json::parse(files::read_text(json)).at("session").at("marks").size(), 90U);
}

// Whatever there is to be told: navigation and a CT after it, of both bones. Two grafts have two sheets, and
// twice the tunnels.
TEST_F(Report, HasTwoToFourPages) {
  for (const bool is_double : {false, true}) {
    if (is_double) {
      const cases::Plan single = knee_.plan;
      for (const auto& [key, tunnel] : single.tunnels)
        for (const auto bundle : {norms::Bundle::Anteromedial, norms::Bundle::Posterolateral}) {
          tunnels::Tunnel one = tunnel;
          one.bundle = bundle;
          one.diameter_mm = 6;
          if (bundle == norms::Bundle::Posterolateral) one.entry_mm += 8 * one.direction.unitOrthogonal();
          const auto mesh = single.mesh_sha256.find(key.bone);
          knee_.plan.put(one, mesh == single.mesh_sha256.end() ? "" : mesh->second);
        }
      cases::save_case(knee_folder(), knee_);
    }
    std::map<tunnels::TunnelKey, postop::Comparison> comparisons;
    std::vector<std::pair<std::string_view, std::string>> steps;
    for (int i = 0; i < 40; ++i)
      steps.emplace_back(recording::kAlarmEvent, i % 2 ? "" : "The control point has moved");
    (void)text_of_session("live", steps);
    for (const auto& [key, tunnel] : knee_.plan.tunnels) {
      postop::Comparison& comparison = comparisons[key];
      comparison.bone.is_found = comparison.bone.reliable = true;
      comparison.tunnel.is_found = comparison.tunnel.reliable = true;
      comparison.tunnel.reasons.clear();
      comparison.tunnel.tunnel = tunnel;
      operation::write_achieved_file(
          cases::session_folders(knee_folder()).back() / operation::achieved_file_name(key),
          {.planned = tunnel, .measured = tunnel, .depth_mm = 30, .pose_count = 42, .truth = {}});
    }
    postop::write_achieved_file(knee_folder() / "achieved.json", comparisons);
    for (const Paper paper : {Paper::A4, Paper::Letter}) {
      SCOPED_TRACE(std::string(to_text(paper)) + (is_double ? ", double bundle" : ""));
      write(pdf(), {.paper = paper});
      const auto pages = test::pages_of(pdf());
      EXPECT_GE(pages.size(), 2U);
      EXPECT_LE(pages.size(), is_double ? 6U : 4U);
      for (const test::Page& page : pages) EXPECT_TRUE(page.words_lie_within(10)) << page.outermost;
    }
  }
}

// Whose hash it is can be searched for, on either paper; and of two builds of one version which made it.
TEST_F(Report, NamesPlanAndBuildWhole) {
  for (const Paper paper : {Paper::A4, Paper::Letter}) {
    write(pdf(), {.paper = paper});
    expect_contains(pdf_text(),
                    cases::plan_sha256(cases::with_named_meshes(cases::load_case(knee_folder()))));
    expect_contains(pdf_text(), ", build " + recording::build_identity().substr(0, 12));
  }
}

// Hazard 21: a plan of another mesh is no valid plan, and the report says so.
TEST_F(Report, Hazard21SaysThatThePlanIsOfAnotherMesh) {
  write(pdf());
  EXPECT_EQ(pdf_text().find("NOT VALID"), std::string::npos);
  cases::Plan plan = cases::load_case(knee_folder()).plan;
  plan.mesh_sha256[bones::BoneKind::Femur] = std::string(64, '0');
  cases::save_plan(knee_folder(), plan);
  write(pdf());
  expect_contains(pdf_text(), "NOT VALID");
}

// The document's title, as a reader's window shows it, was read byte by byte.
TEST_F(Report, IsCalledAsTheCaseIs) {
  write(pdf());
  expect_contains(pdf_info(), "Arthronaut report: Knee of \u00C6r\u00F8\n");
}

TEST_F(Report, LeavesNothingBehindWhenItFails) {
  EXPECT_THROW(write_report(knee_folder() / "nothing", pdf()), IoError);
  EXPECT_THROW(write("/nowhere/report.pdf"), IoError);
  EXPECT_FALSE(std::filesystem::exists(pdf()));
}

}  // namespace
}  // namespace arthronaut::report
