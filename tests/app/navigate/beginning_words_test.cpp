#include "app/navigate/beginning_words.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::navigate {
namespace {

using widgets::Severity;

const CardLine& line_of(const Card& card, const std::string& name) {
  const auto found = std::find_if(card.lines.begin(), card.lines.end(),
                                  [&](const CardLine& line) { return line.name == name; });
  if (found == card.lines.end()) throw std::runtime_error("no line " + name);
  return *found;
}

operation::PlannedTunnel plan() {
  operation::PlannedTunnel plan;
  plan.tunnel.diameter_mm = 8.5;
  plan.length_mm = 31.25;
  return plan;
}

// All that is read out stands on one card; whom nobody knows is told, not left out.
TEST(TimeOutCard, Hazard20NamesPatientKneePlanCameraToolsAndMedium) {
  auto source = std::make_shared<operation::SourceSetup>();
  source->calibration_in_short =
      "camera measured, 4 days old, NOT RELIABLE: no board of 2026-11-21; probe measured today";
  source->pipeline.side = bones::Side::Left;
  source->pipeline.refractive_index = 1.3345;
  operation::OperationState state;
  state.source = source;
  state.bone = bones::BoneKind::Tibia;
  state.plan = plan();
  const Card card = time_out_card(state, "Muster, Anna \u00B7 4711 \u00B7 1990-01-31", {});
  EXPECT_EQ(line_of(card, "Patient").text, "Muster, Anna \u00B7 4711 \u00B7 1990-01-31");
  EXPECT_EQ(line_of(card, "Knee").text, "left, tibia");
  EXPECT_EQ(line_of(card, "Plan").text, "8.5 mm wide, 31.2 mm long");
  const CardLine& camera = line_of(card, "");
  EXPECT_EQ(camera.topic, CardLine::Topic::CameraAndTools);
  EXPECT_EQ(camera.text, source->calibration_in_short) << "what is doubted keeps its dates";
  EXPECT_EQ(line_of(card, "Medium").text, "saline");
  EXPECT_EQ(line_of(card, "Medium").topic, CardLine::Topic::Medium);
  state.medium = {.fit = pipeline::MediumFit::Contradicts, .stated_index = 1.3345, .other_index = 1};
  const CardLine wrong = line_of(time_out_card(state, "", {}), "Medium");
  EXPECT_EQ(wrong.text, "saline, but the markers look as in air");
  EXPECT_EQ(wrong.severity, Severity::Bad);
  EXPECT_EQ(line_of(card, "Plan").topic, CardLine::Topic::Plan);
  // It is confirmed there, so it can be changed there, by the pedal that has nothing else to do then.
  EXPECT_EQ(time_out_card(state, "", {}).keys, "V: in air instead");
  EXPECT_EQ(line_of(time_out_card(state, "", {}), "Patient").severity, Severity::Caution);
  state.plan.reset();
  EXPECT_EQ(line_of(time_out_card(state, "", {}), "Plan").text, "none");
}

// What is confirmed was read: of what speaks against the plan nothing is counted in place of being said.
TEST(TimeOutCard, SaysAllThatSpeaksAgainstThePlan) {
  operation::OperationState state;
  state.source = std::make_shared<const operation::SourceSetup>();
  state.plan = plan();
  const plan_review::TunnelVerdict verdict{{"Wall: thin", "Length: short"},
                                           {"Grid: proposed", "Bone: rough"}};
  EXPECT_EQ(line_of(time_out_card(state, "", verdict), "Plan").text,
            "8.5 mm wide, 31.2 mm long; WRONG: thin wall; short tunnel; check: landmarks not confirmed; "
            "Bone: rough");
}

// A probe or a guide that nobody measured is marked.
TEST(TimeOutCard, MarksToolsThatNobodyMeasured) {
  auto source = std::make_shared<operation::SourceSetup>();
  source->pipeline.tools = tools::standard_tools();
  operation::OperationState state;
  state.source = source;
  const auto severity_of = [&](provenance::Origin probe, provenance::Origin guide, provenance::Origin other) {
    for (tools::Tool& tool : source->pipeline.tools.tools)
      tool.provenance.origin = tool.name == "probe" ? probe : tool.name == "femoral guide" ? guide : other;
    return line_of(time_out_card(state, "", {}), "").severity;
  };
  using provenance::Origin;
  EXPECT_EQ(severity_of(Origin::Measured, Origin::Measured, Origin::Nominal), Severity::Quiet);
  EXPECT_EQ(severity_of(Origin::Nominal, Origin::Measured, Origin::Measured), Severity::Caution);
  EXPECT_EQ(severity_of(Origin::Measured, Origin::Nominal, Origin::Measured), Severity::Caution);
}

// What its checks say of the plan is read out with it.
TEST(TimeOutCard, SaysWhatSpeaksAgainstThePlan) {
  operation::OperationState state;
  state.source = std::make_shared<operation::SourceSetup>();
  state.plan = plan();
  const CardLine wrong = line_of(
      time_out_card(state, "", {.wrong = {"Wall: -3.5 mm"}, .look = {"Bone: check the side"}}), "Plan");
  EXPECT_EQ(wrong.severity, Severity::Bad);
  EXPECT_EQ(wrong.text, "8.5 mm wide, 31.2 mm long; WRONG: thin wall; check: Bone: check the side");
  const CardLine look = line_of(time_out_card(state, "", {.look = {"Bone: check the side"}}), "Plan");
  EXPECT_EQ(look.severity, Severity::Caution);
  EXPECT_EQ(look.text, "8.5 mm wide, 31.2 mm long; check: Bone: check the side");
  EXPECT_EQ(line_of(time_out_card(state, "", {}), "Plan").severity, Severity::Quiet);
}

// What a press would put in force stands beside what it does, with all that speaks against it.
TEST(EditedPlan, Hazard5SaysWhatWouldBeTakenOver) {
  EXPECT_EQ(words_of_edited(plan(), {}), "now 8.5 mm wide, 31.2 mm long");
  EXPECT_EQ(words_of_edited(plan(), {.wrong = {"Wall: 0.3 mm: may break out"}}),
            "now 8.5 mm wide, 31.2 mm long; WRONG: may break out of the bone");
  EXPECT_EQ(words_of_edited(std::nullopt, {}), "now none is planned");
}

LeftBehind left_behind() {
  LeftBehind left;
  left.has_same_camera = left.has_same_tools = true;
  operation::ResumeOperation& was = left.found.operation;
  was.session = "0007-20260131-120000";
  was.plan = plan();
  was.registration.emplace().predicted_tre_mm = 0.42;
  was.stroke_count = 12;
  was.touches_mm = {Eigen::Vector3d::Zero()};
  was.control_point_mm = Eigen::Vector3d::Zero();
  left.found.drawn_length_mm = 412.3;
  left.found.was_verified = true;
  left.found.header.source_kind = sources::SourceKind::Live;
  left.found.header.source = "Scope 30";
  left.found.last_written = std::chrono::system_clock::time_point(std::chrono::hours(500'000));
  return left;
}

Card card_of(const LeftBehind& left, std::chrono::seconds later = std::chrono::seconds(245)) {
  return resume_card(left, plan(), {}, left.found.last_written + later);
}

// A plan that is wrong is as wrong where an operation is gone on with as where one begins.
TEST(ResumeCard, SaysWhatSpeaksAgainstThePlan) {
  const LeftBehind left = left_behind();
  const auto line = [&](const plan_review::TunnelVerdict& verdict) {
    return line_of(resume_card(left, plan(), verdict, left.found.last_written), "Plan");
  };
  EXPECT_EQ(line({}).severity, Severity::Quiet);
  EXPECT_EQ(line({.look = {"Bone: check the side"}}).severity, Severity::Caution);
  const CardLine wrong = line({.wrong = {"Wall: -3.5 mm"}, .look = {"Bone: check the side"}});
  EXPECT_EQ(wrong.severity, Severity::Bad);
  EXPECT_TRUE(wrong.text.ends_with("; WRONG: thin wall (and 1 to look at)")) << wrong.text;
}

// Of a tunnel that is drilled by word alone nobody else tells after a crash.
TEST(ResumeCard, SaysWhatIsDrilledByWordAlone) {
  LeftBehind left = left_behind();
  EXPECT_THROW((void)line_of(card_of(left), "Said to be drilled"), std::runtime_error);
  left.found.said_drilled = {{"femur", left.found.last_written - std::chrono::minutes(3)}};
  const std::string when =
      files::local_time_in_words(files::utc_of(left.found.said_drilled.front().when)).substr(11, 5);
  const CardLine line = line_of(card_of(left), "Said to be drilled");
  EXPECT_EQ(line.text, "femur, at " + when + "; by word alone, nothing shows where");
  EXPECT_EQ(line.severity, Severity::Caution);
}

// Which of two bundles' tunnels is there already: said, and in doubt where it is the one that would guide
// again.
TEST(ResumeCard, SaysWhichTunnelIsDrilled) {
  LeftBehind left = left_behind();
  left.found.drilled = {{bones::BoneKind::Femur, norms::Bundle::Anteromedial}};
  EXPECT_EQ(line_of(card_of(left), "Drilled already").text, "femur AM");
  EXPECT_EQ(line_of(card_of(left), "Drilled already").severity, Severity::Quiet);
  left.found.operation.plan->tunnel.bone = bones::BoneKind::Femur;
  left.found.operation.plan->tunnel.bundle = norms::Bundle::Anteromedial;
  EXPECT_EQ(line_of(card_of(left), "Drilled already").severity, Severity::Caution);
}

// What would be brought back, before it is: bone, time, source, registration, strokes, touches, plan, camera.
TEST(ResumeCard, Hazard12SaysAllThatWouldBeBroughtBack) {
  const Card card = card_of(left_behind());
  EXPECT_EQ(line_of(card, "Session").text, "7, femur, cut off 4 minutes ago");
  EXPECT_EQ(line_of(card, "Source").text, "live: Scope 30");
  EXPECT_EQ(line_of(card, "Registration").text,
            "\u00B1 0.4 mm, was verified; guides after one touch on the bone");
  EXPECT_EQ(line_of(card, "Registration").severity, Severity::Caution);
  EXPECT_EQ(line_of(card, "Kept as history").text, "12 strokes (412 mm), 1 touch, the control point");
  EXPECT_EQ(line_of(card, "Plan").severity, Severity::Quiet);
  EXPECT_EQ(line_of(card, "Camera and tools").text, "the case's");
  EXPECT_EQ(card.keys, "Page up or Esc: begin afresh");
}

// What differs from the case of now, and what is not brought back, stands out with its reason.
TEST(ResumeCard, Hazard16TellsWhatIsNotBroughtBackAndWhy) {
  LeftBehind left = left_behind();
  left.found.operation.registration.reset();
  left.found.refusal = "it was in doubt at the end: The control point has moved by 3.0 mm";
  left.found.operation.plan->length_mm += 1;
  left.found.operation.depth_stop_mm = 21.5;
  left.has_same_camera = false;
  left.found.was_finished = true;
  left.passed_over = {"0008/session.json: broken"};
  const Card card = card_of(left, std::chrono::hours(3 * 24));
  EXPECT_EQ(line_of(card, "Session").text, "7, femur, ended 3 days ago");
  EXPECT_EQ(line_of(card, "Registration").severity, Severity::Bad);
  EXPECT_EQ(line_of(card, "Registration").text,
            "is not brought back: it was in doubt at the end: The control point has moved by 3.0 mm");
  EXPECT_EQ(line_of(card, "Plan").severity, Severity::Caution);
  EXPECT_EQ(line_of(card, "Camera and tools").text, "the camera is not the case's of now");
  EXPECT_EQ(line_of(card, "Depth stop").text, "21.5 mm, as read");
  EXPECT_EQ(line_of(card, "Newer, cannot be read").text, "0008/session.json: broken");
}

// A reading is millimetres with a point or a comma; anything else is asked for again.
TEST(DepthStop, TakesMillimetresAndNothingElse) {
  EXPECT_EQ(depth_from_text("21.5"), 21.5);
  EXPECT_EQ(depth_from_text("21,5"), 21.5);
  EXPECT_EQ(depth_from_text("21.5mm"), 21.5);
  EXPECT_EQ(depth_from_text(" 30 "), 30);
  EXPECT_EQ(depth_from_text("0"), 0);
  for (const char* bad : {"", "-1", "151", "1e9", "nan", "inf", "2.1.5", "twenty"})
    EXPECT_FALSE(depth_from_text(bad)) << bad;
}

}  // namespace
}  // namespace arthronaut::navigate
