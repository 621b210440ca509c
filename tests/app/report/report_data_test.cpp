// The same report for other programs, and of images after the operation; the same bytes each time.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session_check.h"
#include "navigation/recording/session_marks.h"
#include "planning/cases/identity.h"
#include "planning/plan_review/plan_review.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/postop/achieved_file.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

// An attempt that found no pose is no registration: the one before it is told of, unless none did better.
TEST_F(Report, TakesASessionWhoseRegistrationFoundAPose) {
  const auto json_file = pdf().parent_path() / "report.json";
  const auto told = [&] {
    write(json_file);
    return nlohmann::json::parse(files::read_text(json_file)).at("session").at("id").get<std::string>();
  };
  const auto newest = [&] { return cases::session_folders(knee_folder()).back().filename().string(); };
  (void)text_of_session("live", {}, false);
  EXPECT_EQ(told(), newest());
  (void)text_of_session("live", {});
  const std::string found = newest();
  (void)text_of_session("live", {}, false);
  EXPECT_EQ(told(), found);
}

// Of a registration that found no pose no point fits or misses anything: it was told as 0 %.
TEST_F(Report, SaysNoFitOfARegistrationWithoutAPose) {
  const std::string text = text_of_session("live", {}, false);
  const auto at = text.find("Points that fit");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(text.substr(at, text.find('\n', at) - at).find('%'), std::string::npos);
  const auto json_file = pdf().parent_path() / "report.json";
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_TRUE(json.at("session").at("registration").at("inlier_fraction").is_null());
}

// The same numbers for other programs: whatever the table says, the document says.
TEST_F(Report, GivesTheSameNumbersAsJsonAndAsATable) {
  cases::save_identity(knee_folder(), {"Muster^Anna", "4711", "19900131"});
  (void)text_of_session("live", {{recording::kVerifiedEvent, ""}});
  const std::filesystem::path session = cases::session_folders(knee_folder()).back();
  recording::write_marks(session, {{3, 0, "a \"quoted\" note, with a comma"}});
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  auto measured = planned;
  measured.entry_mm += 1.25 * planned.direction.unitOrthogonal();
  operation::write_achieved_file(
      session / "achieved.json",
      {.planned = planned, .measured = measured, .depth_mm = 30, .pose_count = 42, .truth = {}});
  const auto json_file = pdf().parent_path() / "report.json", csv_file = pdf().parent_path() / "report.csv";
  write(json_file);
  write(csv_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(json.at("format"), "arthronaut.report");
  EXPECT_EQ(json.at("case").at("name"), "Knee of Ærø");
  EXPECT_FALSE(json.contains("patient"));
  EXPECT_NEAR(json.at("achieved").at(0).at("difference").at("entry_mm").get<double>(), 1.25, 1e-9);
  EXPECT_EQ(json.at("session").at("marks").at(0).at("note"), "a \"quoted\" note, with a comma");
  EXPECT_EQ(json.at("session").at("steps").size(), 2u);
  EXPECT_EQ(json.at("session").at("last_hash"), recording::chain_head(session));
  const plan_review::CaseReview review(cases::load_case(knee_folder()));
  EXPECT_EQ(json.at("tunnels").at(0).at("checks").size(), review.checks(bones::BoneKind::Femur).size());

  const auto strangers_file = pdf().parent_path() / "strangers.json";
  write(strangers_file, {.is_deidentified = true});
  EXPECT_EQ(
      nlohmann::json::parse(files::read_text(strangers_file)).at("session").at("marks").at(0).at("note"),
      "not told");

  const std::string csv = files::read_text(csv_file);
  EXPECT_TRUE(csv.starts_with("quantity,value\n"));
  expect_contains(csv, "session/marks/0/note,\"a \"\"quoted\"\" note, with a comma\"\n");
  std::size_t numbers = 0;
  const nlohmann::json flat = json.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (!value.is_number()) continue;
    ++numbers;
    expect_contains(csv, path.substr(1) + "," + value.dump() + "\n");
  }
  EXPECT_GT(numbers, 30u);
  write(json_file, {.with_identity = true});
  expect_contains(files::read_text(json_file), "Muster^Anna");
}

// In memory it is the same document as in a file; it is the same at any time unless told when it is made.
TEST_F(Report, CanBeTheSameBytesEachTime) {
  const std::string report = made({});
  EXPECT_EQ(report.substr(0, 5), "%PDF-");
  EXPECT_EQ(report, made({}));
  write(pdf());
  EXPECT_EQ(report, files::read_text(pdf()));
  EXPECT_EQ(pdf_text().find("Report made"), std::string::npos);
  write(pdf(), {.made_utc = "2026-01-31T12:00:00Z"});
  expect_contains(pdf_text(), "Report made");
  expect_contains(pdf_text(), "2026-01-31 12:00:00 UTC");
  write(pdf(), {.is_deidentified = true, .made_utc = "2026-01-31T12:00:00Z"});
  EXPECT_EQ(pdf_text().find("Report made"), std::string::npos) << "strangers are told no date";
}

// What a CT after the operation showed, of both bones: a reliable one, and one in doubt with every reason; in
// the PDF and, the same numbers, for other programs.
TEST_F(Report, ComparesWithImagesAfterTheOperation) {
  const auto achieved_file = knee_folder() / "achieved.json";
  std::map<tunnels::TunnelKey, postop::Comparison> comparisons;
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const tunnels::Tunnel& plan = knee_.plan.tunnels.at(kind);
    postop::Comparison& comparison = comparisons[plan.key()];
    comparison.bone = {.is_found = true,
                       .plan_from_postop = {},
                       .rms_mm = 0.21,
                       .on_edge_share = 0.9,
                       .in_view_share = 1,
                       .reliable = true,
                       .reasons = {}};
    postop::AchievedTunnel& found = comparison.tunnel;
    found.is_found = found.reliable = true;
    found.reasons.clear();
    found.tunnel = plan;
    found.offset_mm = kind == bones::BoneKind::Femur ? 1.37 : 2.46;
    found.tunnel.entry_mm += found.offset_mm * plan.direction.unitOrthogonal();
    found.tunnel.diameter_mm = 8.4;
    found.length_mm = 27.3;
    found.entry_sigma_mm = 0.08;
    found.direction_sigma_rad = geometry::rad_from_deg(0.25);
    found.widths = {{2, 8.4, 0.1}, {12, 9.6, 0.1}};
  }
  postop::AchievedTunnel& doubted = comparisons.at(bones::BoneKind::Tibia).tunnel;
  doubted.reliable = false;
  doubted.metal_share = 0.37;
  doubted.reasons = {"metal hides most of the wall"};
  postop::write_achieved_file(achieved_file, comparisons);
  write(pdf());
  std::string text = pdf_text();
  for (const char* const part :
       {"CT after the operation", "1.37 mm", "2.46 mm", "0.08", "8.4 mm; planned", "8.4 to 9.6 mm",
        "27.3 mm, a socket", "Which way", "deep to shallow", "Least wall", "0.21 mm", "37 %", "NOT RELIABLE",
        "tibia: metal hides most of the wall", "Banded: as the CT after the operation"})
    expect_contains(text, part);
  const auto json_file = pdf().parent_path() / "report.json";
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file)).at("postoperative");
  ASSERT_EQ(json.size(), 2U);
  EXPECT_NEAR(json[0].at("offset_mm").get<double>(), 1.37, 1e-9);
  EXPECT_EQ(json[0].at("grid").at(0).at("name"), "Deep to shallow");
  const auto& off = json[0].at("off_plan");
  EXPECT_NEAR(std::hypot(off.at("anterior_mm").get<double>(), off.at("proximal_mm").get<double>(),
                         off.at("lateral_mm").get<double>()),
              1.37, 1e-9);
  EXPECT_TRUE(json[0].at("reliable").get<bool>());
  EXPECT_FALSE(json[1].at("reliable").get<bool>());
  EXPECT_EQ(json[1].at("reasons").at(0), "metal hides most of the wall");
  const auto csv_file = pdf().parent_path() / "report.csv";
  write(csv_file);
  expect_contains(files::read_text(csv_file), "postoperative/1/achieved/diameter_mm,8.4\n");
  // What is known by itself is named, and each other number says that it is not.
  doubted.known = {tunnels::Quantity::Entry, tunnels::Quantity::Direction};
  postop::write_achieved_file(achieved_file, comparisons);
  write(pdf());
  text = pdf_text();
  for (const char* const part : {"RELIABLE IN PART: entry and", "NOT RELIABLE"}) expect_contains(text, part);
  write(json_file);
  const auto part = nlohmann::json::parse(files::read_text(json_file)).at("postoperative").at(1);
  EXPECT_EQ(part.at("verdict"), "reliable in part");
  EXPECT_FALSE(part.at("reliable").get<bool>());
  EXPECT_EQ(part.at("reliable_quantities"), nlohmann::json({"entry", "direction"}));
  // Without landmarks the same percentages as everywhere, by what the shape proposes, and that is said.
  const auto placed = knee_.landmarks;
  knee_.landmarks.clear();
  cases::save_case(knee_folder(), knee_);
  write(json_file);
  const auto bare = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(bare.at("proposed_landmarks"), nlohmann::json({"femur", "tibia"}));
  const auto& by_shape = bare.at("postoperative").at(0);
  EXPECT_EQ(by_shape.at("landmarks"), "proposed");
  plan_review::propose_landmarks(knee_, plan_review::Proposing::WithoutGrid);
  const tunnels::TunnelKey femur = bones::BoneKind::Femur;
  const auto place = postop::place_of(comparisons.at(femur).tunnel, knee_.plan.tunnels.at(femur),
                                      plan_review::CaseReview(knee_).bone(femur.bone).surroundings,
                                      plan_review::state_of_grid(knee_, femur.bone));
  EXPECT_NEAR(by_shape.at("off_plan").at("anterior_mm").get<double>(), place.off_mm.x(), 1e-9);
  EXPECT_NEAR(by_shape.at("grid").at(0).at("achieved_percent").get<double>(),
              place.grid.at(0).achieved_percent, 1e-9);
  write(pdf());
  text = pdf_text();
  expect_contains(text, "proposed landmarks)");
  expect_contains(text, "Grid: landmarks proposed");
  knee_.landmarks = placed;
  knee_.landmark_states.clear();
  // The plan goes elsewhere: the differences are not those to it.
  tunnels::Tunnel moved = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  moved.entry_mm += 3 * moved.direction.unitOrthogonal();
  knee_.plan.put(moved, "");
  cases::save_case(knee_folder(), knee_);
  write(pdf());
  text = pdf_text();
  expect_contains(text, "of an earlier plan");
  EXPECT_EQ(text.find("Banded: as the CT"), std::string::npos) << "drawn beside another plan";
  // Nothing was found: no number is shown.
  comparisons.at(bones::BoneKind::Femur).tunnel = {};
  postop::write_achieved_file(achieved_file, comparisons);
  write(pdf());
  expect_contains(pdf_text(), "no tunnel found");
  EXPECT_EQ(pdf_text().find("1.37 mm"), std::string::npos);
  files::write_atomically(achieved_file, "{");
  write(pdf());
  expect_contains(pdf_text(), "NOT READABLE: achieved.json");
  std::filesystem::remove(achieved_file);
  write(pdf());
  expect_contains(pdf_text(), "No comparison with images after the operation");
}

}  // namespace
}  // namespace arthronaut::report
