#include "navigation/training/exercise.h"

#include <algorithm>

#include "planning/geometry/error.h"

namespace arthronaut::training {

namespace {

using bones::BoneKind;
using simulator::Fault;
using simulator::FaultKind;
using Trigger = simulator::Fault::Trigger;

// Who ignores an alarm, or drills while nothing guides, has failed at what the exercise teaches.
constexpr double kMostAfterDanger = 40;

// The limits follow what the operation itself asks: a touch is off from 1.5 mm on, a registration stands at
// 2 mm and below, a tunnel is taken for well placed within 2 mm and 3 degrees (docs/thresholds.md).
std::vector<Mark> drill_marks() {
  return {{Measure::EntryOffset, 1.0, 4.0, 20},
          {Measure::Angle, 1.5, 6.0, 15},
          {Measure::DepthError, 1.0, 5.0, 10},
          {Measure::TunnelError, 1.0, 3.0, 10},
          {Measure::Verification, 0, 3, 10},
          {Measure::WastedTouches, 0, 4, 5},
          {Measure::DrawnInAir, 5, 40, 5},
          {Measure::AlarmsIgnored, 0, 1, 5, kMostAfterDanger},
          // The drill goes 6 mm a second: 5 mm are more than a hand needs to let go.
          {Measure::ActedOnBadData, 0.2, 5.0, 10, kMostAfterDanger},
          {Measure::Time, 180, 600, 10}};
}

std::vector<Exercise> make_exercises() {
  std::vector<Exercise> all;
  // A camera is good enough while the overlay is off by no more than half a pixel of a picture 1920 px wide,
  // which is a quarter of one here. A picture that is less covered than the limit is refused.
  all.push_back({.id = "calibrate",
                 .title = "Calibrate the camera",
                 .goal = Goal::Calibrate,
                 .bone = BoneKind::Femur,
                 .what = "Pictures of a board, the lens turned in between, tell where the camera looks.",
                 .steps = {"Hold the board 12 to 22 mm before the lens, tilted, until it fills the view",
                           "Hold still and take the picture; what is refused says why",
                           "Turn the lens by 40 degrees or more, and take the next",
                           "Three or more, 100 degrees apart in all; then say that you are done"},
                 .marks = {{Measure::CameraError, 0.25, 1.0, 50},
                           {Measure::Uncovered, 10, 40, 15},
                           {Measure::Refused, 0, 4, 15},
                           {Measure::Time, 45, 180, 20}}});
  all.push_back(
      {.id = "pivot",
       .title = "Find the probe's tip",
       .goal = Goal::Pivot,
       .bone = BoneKind::Femur,
       .what = "The probe is turned about its tip, which rests on the bone, until its tip is known.",
       .steps = {"Set the tip on the bone and leave it there",
                 "Tilt the handle to all sides, slowly, as far as its marker can be seen",
                 "Say that you are done"},
       .marks = {{Measure::TipError, 0.1, 0.6, 60},
                 {Measure::OutOfView, 10, 50, 20},
                 {Measure::Time, 30, 120, 20}}});
  all.push_back({.id = "register",
                 .title = "Scratch and register the femur",
                 .goal = Goal::Register,
                 .bone = BoneKind::Femur,
                 .what = "The probe draws on the notch wall until the bone is found, and touches verify it.",
                 .steps = {"Draw strokes on the bone, spread out, the tip always on it",
                           "Wait for the registration to stand",
                           "Touch three places that are apart, and hold still at each"},
                 .marks = {{Measure::TunnelError, 0.8, 2.5, 35},
                           {Measure::Verification, 0, 3, 20},
                           {Measure::DrawnInAir, 5, 40, 10},
                           {Measure::WastedTouches, 0, 4, 10},
                           {Measure::OutOfView, 10, 50, 10},
                           {Measure::Time, 90, 300, 15}}});
  all.push_back({.id = "aim",
                 .title = "Aim the guide",
                 .goal = Goal::Aim,
                 .bone = BoneKind::Femur,
                 .what = "The guide stands on the bone, on the planned entry and along the plan.",
                 .steps = {"Set the guide's point on the bone, where the bullseye has its middle",
                           "Tilt the handle until the tail of the bullseye's dot is gone",
                           "Hold still on the plan, and say that you are done"},
                 // The drill bites within half a millimetre of the bone; 2 mm off it the point slides.
                 .marks = {{Measure::EntryOffset, 0.8, 4.0, 30},
                           {Measure::Angle, 1.5, 8.0, 25},
                           {Measure::OffBone, 0.5, 2.0, 15},
                           {Measure::ActedOnBadData, 0.2, 2.0, 10, kMostAfterDanger},
                           {Measure::OutOfView, 10, 50, 5},
                           {Measure::Time, 30, 120, 15}},
                 .rule = 2});
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia})
    all.push_back(
        {.id = bone == BoneKind::Femur ? "drill-femur" : "drill-tibia",
         .title = bone == BoneKind::Femur ? "Drill the femoral tunnel" : "Drill the tibial tunnel",
         .goal = Goal::Drill,
         .bone = bone,
         .what = "The whole way: strokes, registration, touches, the guide on the plan, the tunnel.",
         .steps = {"Draw, register, and verify by three touches",
                   "Touch the control point: it tells whether the marker moves later",
                   "Take the guide, bring it onto the plan",
                   "Drill to the planned depth, and never while the numbers are gone",
                   "Say that the tunnel is drilled"},
         .marks = drill_marks(),
         .rule = 2});
  return all;
}

}  // namespace

std::string_view to_text(Level level) {
  return level == Level::Easy ? "easy" : level == Level::Medium ? "medium" : "hard";
}

Level level_from_text(std::string_view text) {
  for (const Level level : {Level::Easy, Level::Medium, Level::Hard})
    if (text == to_text(level)) return level;
  throw InvalidInput("\"" + std::string(text) + "\" is no level: easy, medium or hard");
}

std::string_view to_text(Measure measure) {
  switch (measure) {
    case Measure::Time:
      return "time";
    case Measure::EntryOffset:
      return "entry offset";
    case Measure::Angle:
      return "angle";
    case Measure::DepthError:
      return "depth error";
    case Measure::TunnelError:
      return "registration error at the entry";
    case Measure::TipError:
      return "tip error";
    case Measure::CameraError:
      return "camera error over the view";
    case Measure::Uncovered:
      return "view without corners";
    case Measure::Refused:
      return "pictures refused";
    case Measure::Verification:
      return "verifying touches missing";
    case Measure::WastedTouches:
      return "wasted touches";
    case Measure::DrawnInAir:
      return "drawn in the air";
    case Measure::OutOfView:
      return "markers out of view";
    case Measure::AlarmsIgnored:
      return "alarms ignored";
    case Measure::ActedOnBadData:
      return "acted on bad data";
    case Measure::OffBone:
      return "guide off the bone";
  }
  return "";
}

std::string_view unit_of(Measure measure) {
  switch (measure) {
    case Measure::Time:
      return "s";
    case Measure::Angle:
      return "deg";
    case Measure::EntryOffset:
    case Measure::DepthError:
    case Measure::TunnelError:
    case Measure::TipError:
    case Measure::ActedOnBadData:
    case Measure::OffBone:
      return "mm";
    case Measure::CameraError:
      return "px";
    case Measure::Uncovered:
    case Measure::DrawnInAir:
    case Measure::OutOfView:
      return "%";
    case Measure::Refused:
    case Measure::Verification:
    case Measure::WastedTouches:
    case Measure::AlarmsIgnored:
      return "";
  }
  return "";
}

const std::vector<Exercise>& exercises() {
  static const std::vector<Exercise> all = make_exercises();
  return all;
}

const Exercise* find_exercise(std::string_view id) {
  const auto& all = exercises();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Exercise& e) { return e.id == id; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<Fault> faults_of(const Exercise& exercise, Level level) {
  if (level == Level::Easy) return {};
  const bool is_hard = level == Level::Hard;
  const auto over_probe = [](FaultKind kind, double after_mm, double duration_s, double strength) {
    return Fault{kind, Trigger::ProbeDrawn, after_mm, duration_s, strength};
  };
  const auto over_guide = [](FaultKind kind, double within_mm, double duration_s, double strength) {
    return Fault{kind, Trigger::GuideNear, within_mm, duration_s, strength};
  };
  const auto over_board = [](FaultKind kind, double at_s, double duration_s, double strength) {
    return Fault{kind, Trigger::AtTime, at_s, duration_s, strength};
  };
  switch (exercise.goal) {
    case Goal::Calibrate:
      if (!is_hard) return {over_board(FaultKind::Glare, 4, 8, 0.6)};
      return {over_board(FaultKind::FoggedLens, 3, 6, 0.7), over_board(FaultKind::SlippedBoard, 12, 0, 45),
              over_board(FaultKind::Glare, 16, 20, 0.9)};
    case Goal::Pivot:
      return {{FaultKind::Glare, Trigger::AtTime, 3, is_hard ? 15.0 : 6.0, is_hard ? 0.6 : 0.4}};
    case Goal::Register:
      if (!is_hard) return {over_probe(FaultKind::Bleeding, 40, 8, 0.5)};
      return {over_probe(FaultKind::Bleeding, 30, 15, 0.8), over_probe(FaultKind::LostSource, 90, 3, 1)};
    case Goal::Aim:
      if (!is_hard) return {over_guide(FaultKind::Bleeding, 5, 6, 0.5)};
      return {over_guide(FaultKind::Bleeding, 6, 10, 0.8), over_guide(FaultKind::Glare, 3, 8, 0.5)};
    case Goal::Drill:
      if (!is_hard)
        return {over_probe(FaultKind::Bleeding, 60, 8, 0.5), over_guide(FaultKind::Glare, 5, 5, 0.4)};
      // The marker is pushed while the guide comes: who touches the control point before drilling sees it.
      return {over_probe(FaultKind::Bleeding, 60, 12, 0.8), over_guide(FaultKind::BumpedMarker, 9, 0, 2.5),
              over_guide(FaultKind::LostSource, 3, 3, 1)};
  }
  return {};
}

simulator::SurroundingsOptions surroundings_of(const Exercise& exercise, Level level) {
  if (level == Level::Easy || exercise.goal == Goal::Calibrate) return {};
  return {.soft_tissue = true, .motes = true, .other_hand = level == Level::Hard};
}

std::string words_of_faults(const Exercise& exercise, Level level) {
  std::string words;
  const auto add = [&](std::string_view word) { words += (words.empty() ? "" : ", ") + std::string(word); };
  for (const Fault& fault : faults_of(exercise, level)) add(to_text(fault.kind));
  for (const std::string_view word : simulator::words_of(surroundings_of(exercise, level))) add(word);
  return words.empty() ? "nothing goes wrong" : words;
}

}  // namespace arthronaut::training
