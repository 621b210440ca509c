// Walks over the table of operation_parts.h: what each event ends of what an operation knows, and what it
// leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

const experiments::Trial& table_trial() {
  static const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  return trial;
}

SourceSetup table_source() {
  SourceSetup source = test::scripted_source();
  source.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Nominal;
  return source;
}

PlannedTunnel moved_plan() {
  PlannedTunnel plan = test::phantom_plan();
  plan.tunnel.entry_mm.x() += 0.5;
  return plan;
}

// One whose guide stands where it must be while a tunnel is drilled, and where everything of the table is
// known; without a control point what does not need one.
void fill(PhantomOperation& run, bool with_control_point = true) {
  const SourceSetup source = table_source();
  run.start(source);
  run.show(run.frame());
  strokes::Curves stroke = table_trial().curves;
  std::erase_if(stroke, [&](const auto& point) { return point.curve != stroke.front().curve; });
  run.draw(stroke);
  run.apply(test::true_registration(table_trial(), run.operation().now()));
  if (with_control_point) run.touch(test::on_bone(table_trial(), 2), TouchControlPoint{});
  for (const double dx_mm : {0.0, 4.0, -4.0}) run.touch(test::on_bone(table_trial(), dx_mm));
  const tools::ToolAxis axis = *source.pipeline.tools.tools.back().axis;
  run.wait(1);
  for (int i = 0; i < 20; ++i) {  // the guide's tip on the control point
    pipeline::FrameResult frame = run.frame();
    frame.tools.back().world_from_tool.is_valid = true;
    frame.tools.back().world_from_tool.target_from_source.translation_mm =
        test::on_bone(table_trial(), 2) - axis.point_mm;
    run.show(frame);
  }
  run.apply(CheckGuide{});
  for (int i = 0; i < 60; ++i) run.show_guide(0.2);
  run.apply(TunnelDrilled{});
  run.apply(ReadDepthStop{24});
  run.apply(ExcludeStroke{run.operation().points().front().curve});
  run.apply(RegisterStrokes{});  // none is in use: nothing comes of it
  for (int i = 0; i < 60; ++i) run.show_guide(0.2);
  run.operation().tell_bone_looks({true});
  run.apply(TakeTouch{});  // no tip is seen
  run.apply(Draw{});
}

// Of each row, whether it is known.
struct Row {
  std::string name;
  std::function<bool(const OperationState&)> holds;
  bool with_control_point = true;
};
const std::vector<Row>& rows() {
  static const std::vector<Row> kRows{
      {"numbers of the newest picture", [](const auto& s) { return s.frame.guidance.is_valid(); }},
      {"guidance a moment ago", [](const auto& s) { return s.guided_lately; }},
      {"how good the numbers are", [](const auto& s) { return s.grades.offset != Grade::None; }},
      {"what was seen of guide and drill", [](const auto& s) { return s.drilled.has_evidence; }},
      {"what the depth stop reads", [](const auto& s) { return s.depth_stop_mm.has_value(); }},
      {"the word that it is drilled",
       [](const auto& s) { return s.drilled.outcome == DrilledState::Outcome::Recorded; }},
      {"a registration that stands",
       [](const auto& s) { return s.registration->in_force.standing == Standing::Stands; }},
      {"that touches verified it", [](const auto& s) { return s.verification == Verification::ByTouches; }},
      {"the same, without a control point",
       [](const auto& s) { return s.verification == Verification::ByTouches; }, false},
      {"touches", [](const auto& s) { return s.registration->touches.count() > 0; }},
      {"the control point", [](const auto& s) { return s.registration->touches.has_control_point(); }},
      {"that the bone looks otherwise",
       [](const auto& s) {
         return s.control_point_due == ControlPointDue::CheckLooks ||
                s.control_point_due == ControlPointDue::CannotCheckLooks;
       }},
      {"strokes", [](const auto& s) { return s.registration->point_count > 0; }},
      {"which strokes were tried", [](const auto& s) { return s.registration->strokes_were_tried; }},
      {"what is found while drawing", [](const auto& s) { return s.registration->online != nullptr; }},
      {"the time-out's confirmation", [](const auto& s) { return s.time_out == TimeOut::Confirmed; }},
      {"the check of a nominal guide",
       [](const auto& s) { return s.guide_check.standing == GuideStanding::Checked; }},
      {"why no touch was taken", [](const auto& s) { return s.touch_refusal != TouchRefusal::None; }},
      {"that the probe draws", [](const auto& s) { return s.draws; }},
  };
  return kRows;
}

void show_through_wrong_medium(PhantomOperation& run) {
  pipeline::FrameResult frame = run.frame();
  frame.camera_from_world.is_valid = false;
  frame.guidance.state = guidance::GuidanceState::WrongMedium;
  run.show(frame);
}

// Each column's letter, and what happens.
const std::vector<std::pair<char, std::function<void(PhantomOperation&)>>>& events() {
  using Event = std::function<void(PhantomOperation&)>;
  static const std::vector<std::pair<char, Event>> kEvents{
      {'S', [](PhantomOperation& run) { run.start_unconfirmed(table_source()); }},
      {'O',
       [](PhantomOperation& run) {
         SourceSetup other = table_source();
         other.pipeline.refractive_index = 1.3345;
         run.start_unconfirmed(other);
       }},
      {'E', [](PhantomOperation& run) { run.operation().end_source(); }},
      {'P',
       [](PhantomOperation& run) {
         run.apply(OfferPlan{moved_plan()});
         run.apply(TakePlanOver{});
       }},
      {'R',
       [](PhantomOperation& run) {
         GiveRegistration other = test::true_registration(table_trial(), run.operation().now());
         other.registration.marker_from_bone.translation_mm.x() += 0.1;
         run.apply(other);
       }},
      {'C', [](PhantomOperation& run) { run.apply(ClearStrokes{}); }},
      {'A',
       [](PhantomOperation& run) {
         run.operation().tell_bone_moved({2.0});
         ASSERT_EQ(run.in_force().standing, Standing::Alarm);
         run.apply(ClearStrokes{});
       }},
      {'M', [](PhantomOperation& run) { run.apply(MarkerPlacedAnew{}); }},
      {'W', show_through_wrong_medium},
      {'D',
       [](PhantomOperation& run) {
         show_through_wrong_medium(run);
         run.operation().tell_medium_wrong({});
       }},
      {'L',
       [](PhantomOperation& run) {
         run.wait(40);
         run.show(run.frame());
       }},
  };
  return kEvents;
}

// What the header says: of each row, the letters of the events that end it.
std::map<std::string, std::string> table_of_header() {
  std::ifstream header(ARTHRONAUT_OPERATION_PARTS);
  std::map<std::string, std::string> table;
  std::string columns;
  for (std::string line; std::getline(header, line);) {
    const std::size_t bar = line.find('|');
    if (!line.starts_with("//   ") || bar == std::string::npos) continue;
    std::string name = line.substr(5, bar - 5), cells = line.substr(bar + 1);
    name.erase(name.find_last_not_of(' ') + 1);
    std::erase(cells, ' ');
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), columns.size()) << name;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i] == 'x') table[name] += columns[i];
  }
  std::string known;
  for (const auto& [letter, event] : events()) known += letter;
  EXPECT_EQ(columns, known);
  return table;
}

TEST(WhatEnds, IsAsTheTableSays) {
  const std::map<std::string, std::string> table = table_of_header();
  EXPECT_EQ(table.size(), rows().size());
  for (const auto& [letter, event] : events()) {
    for (const bool with_control_point : {true, false}) {
      PhantomOperation run;
      fill(run, with_control_point);
      std::vector<Row> rows_of_run;
      std::ranges::copy_if(rows(), std::back_inserter(rows_of_run),
                           [&](const Row& row) { return row.with_control_point == with_control_point; });
      for (const Row& row : rows_of_run)
        ASSERT_TRUE(row.holds(*run.state())) << row.name << " before " << letter;
      event(run);
      for (const Row& row : rows_of_run) {
        ASSERT_TRUE(table.contains(row.name)) << row.name;
        const bool ends = table.at(row.name).find(letter) != std::string::npos;
        EXPECT_EQ(row.holds(*run.state()), !ends)
            << letter << (ends ? " has to end " : " has to leave ") << row.name;
      }
    }
  }
}

}  // namespace
}  // namespace arthronaut::operation
