#include "navigation/training/score.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "planning/files/format.h"

namespace arthronaut::training {

namespace {

using files::format;

double share_percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

// What an exercise is for.
bool is_of_goal(Measure measure, Goal goal) {
  switch (goal) {
    case Goal::Calibrate:
      return measure == Measure::CameraError;
    case Goal::Pivot:
      return measure == Measure::TipError;
    case Goal::Register:
      return measure == Measure::TunnelError;
    case Goal::Aim:
    case Goal::Drill:
      return measure == Measure::EntryOffset || measure == Measure::Angle || measure == Measure::DepthError;
  }
  return false;
}

// Not what was reached, but how.
bool tells_how(Measure measure) {
  switch (measure) {
    case Measure::Time:
    case Measure::Uncovered:
    case Measure::Refused:
    case Measure::WastedTouches:
    case Measure::DrawnInAir:
    case Measure::OutOfView:
    case Measure::AlarmsIgnored:
    case Measure::ActedOnBadData:
    case Measure::OffBone:
      return true;
    default:
      return false;
  }
}

std::optional<double> value_of(Measure measure, const ExerciseFacts& facts) {
  switch (measure) {
    case Measure::Time:
      return facts.time_s;
    case Measure::EntryOffset:
      return facts.entry_offset_mm;
    case Measure::Angle:
      return facts.angle_deg;
    case Measure::DepthError:
      return facts.depth_error_mm ? std::optional(std::abs(*facts.depth_error_mm)) : std::nullopt;
    case Measure::TunnelError:
      return facts.tunnel_error_mm;
    case Measure::TipError:
      return facts.tip_error_mm;
    case Measure::CameraError:
      return facts.camera_error_px;
    case Measure::Uncovered:
      if (facts.coverage.empty()) return std::nullopt;
      return 100 - share_percent(std::accumulate(facts.coverage.begin(), facts.coverage.end(), 0.0),
                                 static_cast<double>(facts.coverage.size()));
    case Measure::Refused:
      // Who takes no picture has none refused either.
      return facts.coverage.empty() ? std::nullopt : std::optional<double>(facts.refused_pictures);
    case Measure::Verification:
      return facts.verifying_touches_missing;
    case Measure::WastedTouches:
      return facts.wasted_touches;
    case Measure::DrawnInAir:
      // Who draws nothing draws nothing well.
      return facts.drawn_mm > 0 ? std::optional(share_percent(facts.drawn_in_air_mm, facts.drawn_mm))
                                : std::nullopt;
    case Measure::OutOfView:
      return facts.frames > 0 ? std::optional(share_percent(facts.unseen_s, facts.time_s)) : std::nullopt;
    case Measure::AlarmsIgnored:
      return facts.alarms_ignored;
    case Measure::ActedOnBadData:
      return facts.bad_data_mm;
    case Measure::OffBone:
      return facts.off_bone_mm;
  }
  return std::nullopt;
}

std::string number(double value, Measure measure) {
  const std::string_view unit = unit_of(measure);
  if (unit.empty()) return format("%.0f", value);
  const bool is_whole = measure == Measure::Time || unit == "%";
  const char* const digits = is_whole ? "%.0f" : measure == Measure::CameraError ? "%.2f" : "%.1f";
  return format(digits, value) + (unit == "deg" ? "\u00B0" : unit == "%" ? " %" : " " + std::string(unit));
}

// "all points at 1.0 mm or less, no points from 4.0 mm on".
std::string in_words(const Mark& mark) {
  const std::string best = number(mark.good, mark.measure);
  return "all points at " + (mark.good > 0 ? best + " or less" : best) + ", no points from " +
         number(mark.limit, mark.measure) + " on";
}

std::string what_was_found(Measure measure, double value, const ExerciseFacts& facts) {
  const std::string said = number(value, measure);
  switch (measure) {
    case Measure::Time:
      return "It took " + said;
    case Measure::EntryOffset:
      return "The axis passes " + said + " beside the planned entry";
    case Measure::Angle:
      return "The axis is " + said + " off the plan's";
    case Measure::DepthError:
      return "The tunnel is " + said + (facts.depth_error_mm.value_or(0) > 0 ? " too deep" : " too short");
    case Measure::TunnelError:
      return "The registration puts the entry " + said + " from where it truly is";
    case Measure::TipError:
      return "The tip that was found is " + said + " from the true one";
    case Measure::CameraError:
      return "The camera that was found is off by " + said + " over the view";
    case Measure::Uncovered:
      return said + " of the view had no corners, in the mean of the pictures";
    case Measure::Refused:
      return format("Pictures taken: %d, refused: %d", static_cast<int>(facts.coverage.size()),
                    facts.refused_pictures);
    case Measure::Verification:
      return facts.verifying_touches_missing == 0 && !facts.verification_was_skipped
                 ? std::string("Touches have verified the registration")
                 : (facts.verification_was_skipped ? "The verification was skipped; v" : "V") +
                       ("erifying touches missing: " + said);
    case Measure::WastedTouches:
      return format("Touches: %d, of which told nothing: %d", facts.touches, facts.wasted_touches);
    case Measure::DrawnInAir:
      return said + " of what was drawn was off the bone";
    case Measure::OutOfView:
      return "The tool's pose was unknown for " + said + " of the time";
    case Measure::AlarmsIgnored:
      if (facts.alarms == 0) return "No alarm came";
      if (facts.alarms_ignored == 0) return format("Alarms: %d, and none was ignored", facts.alarms);
      return format("Alarms: %d, of which you dismissed or drilled through: %d", facts.alarms,
                    facts.alarms_ignored);
    case Measure::ActedOnBadData:
      if (value <= 0) return "Nothing was done while the numbers on the screen were gone or wrong";
      return "You drilled " + said + " while the numbers on the screen were gone or wrong" +
             (facts.worst_bad_error_mm > 0 ? format(" (by up to %.1f mm)", facts.worst_bad_error_mm) : "");
    case Measure::OffBone:
      return value < 0.05 ? "The guide's point stands on the bone"
                          : "The guide's point ended " + said + " off the bone";
  }
  return "";
}

std::string never_came_to_that(Measure measure, Goal goal, const ExerciseFacts& facts) {
  switch (measure) {
    case Measure::EntryOffset:
    case Measure::Angle:
    case Measure::DepthError:
      return goal == Goal::Aim ? "No guide was held" : "No tunnel was drilled";
    case Measure::OffBone:
      return "No guide was held";
    case Measure::TunnelError:
      return "At the end there was no registration that the program would guide by";
    case Measure::TipError:
      return "No tip was found: " + facts.tip_trouble;
    case Measure::CameraError:
      return "No camera that may be used was found: " + facts.camera_trouble;
    case Measure::Uncovered:
      return "No picture was taken that could cover the view";
    case Measure::Refused:
      return "No picture was taken, whatever was refused";
    case Measure::DrawnInAir:
      return "Nothing was drawn";
    default:
      return "It never came to that";
  }
}

std::string advice_for(Measure measure, Goal goal, const ExerciseFacts& facts) {
  const bool drills = goal == Goal::Drill;
  switch (measure) {
    case Measure::Time:
      return "Work more fluently: the same steps, with fewer stops between them.";
    case Measure::EntryOffset:
      if (drills && !facts.entry_offset_mm)
        return "Drill the tunnel: set the guide's point on the bone, where the drill bites, and hold F.";
      return "Bring the bullseye's dot into its middle before you let the guide stand.";
    case Measure::Angle:
      if (drills && !facts.angle_deg) return "";  // said once
      return "Once the point stands on the bone, tilt the handle until the tail of the bullseye's dot is "
             "gone.";
    case Measure::DepthError:
      if (drills && !facts.depth_error_mm) return "";
      return facts.depth_error_mm.value_or(0) > 0
                 ? "Stop earlier: read the depth that is planned before you drill."
                 : "Drill on to the planned depth before you say that you are done.";
    case Measure::TunnelError:
      return facts.marker_was_bumped
                 ? "The marker was pushed: touch the control point before you drill, and register anew."
                 : "Draw longer strokes in several directions, also across the notch's edge.";
    case Measure::TipError:
      return "Keep the tip where it is and tilt further to all sides.";
    case Measure::CameraError:
      if (facts.coverage.size() < 3) return "Take three or more pictures, the lens turned in between.";
      return "Tilt the board by 20 to 35 degrees, fill the view with it, and turn the lens further.";
    case Measure::Uncovered:
      return "Hold the board nearer and less aslant, and wait until no glare lies on it.";
    case Measure::Refused:
      return "Look at the picture before you take it: sharp, at rest, the lens turned by 40 degrees.";
    case Measure::Verification:
      return "Touch three places that lie apart, and hold still at each, before you take the guide.";
    case Measure::WastedTouches:
      return "Touch after the registration stands, at a new place each time, the tip at rest.";
    case Measure::DrawnInAir:
      return "Keep the tip on the bone while you draw, as the line below the picture says, and stop drawing "
             "before you lift it: strokes in the air find no bone.";
    case Measure::OutOfView:
      return "Hold the tool so that its marker faces the lens, or move the scope along.";
    case Measure::AlarmsIgnored:
      return "Stop at an alarm: the marker may have moved. Register anew.";
    case Measure::ActedOnBadData:
      return facts.worst_bad_error_mm > 0
                 ? "The numbers were there and wrong: touch the control point before you drill."
                 : "Let go of the drill whenever the numbers are gone: nothing guides then.";
    case Measure::OffBone:
      return "Push the guide forward until the line below the picture says that it stands on the bone.";
  }
  return "";
}

// Nothing is drilled there: what was done without a number is that it was said to be done.
void tell_of_aiming_blindly(ScorePart& part) {
  part.reason = "You said that you were done while no number was shown, or a wrong one.";
  part.advice =
      "Say that you are done while the numbers stand: without them nothing tells where the guide is.";
}

ScorePart part_of(const Mark& mark, Goal goal, const ExerciseFacts& facts) {
  ScorePart part;
  part.measure = mark.measure;
  part.good = mark.good;
  part.limit = mark.limit;
  part.most_points = mark.points;
  part.value = value_of(mark.measure, facts);
  if (part.value && !std::isfinite(*part.value)) part.value.reset();
  if (!part.value) {
    part.reason = never_came_to_that(mark.measure, goal, facts) + ".";
  } else {
    const double share = std::clamp((mark.limit - *part.value) / (mark.limit - mark.good), 0.0, 1.0);
    part.points = mark.points * share;
    part.reason = what_was_found(mark.measure, *part.value, facts);
    if (share >= 1)
      part.reason += ": all points.";
    else
      part.reason += " (" + in_words(mark) + ").";
    if (share <= 0) part.caps_at = mark.caps_at;
  }
  // What never began is not to be done better, but to be done.
  if (part.points < part.most_points && (part.value || !tells_how(mark.measure)))
    part.advice = advice_for(mark.measure, goal, facts);
  return part;
}

// Who says at once that he is done was quick, and ignored no alarm: that earns nothing where nothing was
// reached.
void count_how_only_where_reached(Goal goal, const ExerciseFacts& facts, std::vector<ScorePart>& parts) {
  const bool is_reached = std::any_of(parts.begin(), parts.end(), [&](const ScorePart& part) {
    return is_of_goal(part.measure, goal) && part.points > 0;
  });
  if (is_reached) return;
  for (ScorePart& part : parts) {
    if (!tells_how(part.measure) || !part.value) continue;
    part.points = 0;
    part.reason =
        what_was_found(part.measure, *part.value, facts) + ": no points, as the goal was not reached.";
  }
}

// What was drawn in the air is worth few points itself; where most of it was, it is why there is no bone
// found, and is told before that.
double cost_of(const ScorePart& part, const std::vector<ScorePart>& parts) {
  double cost = part.most_points - part.points;
  if (part.caps_at) cost += 100 - *part.caps_at;
  if (part.measure != Measure::DrawnInAir || part.value.value_or(0) < part.limit) return cost;
  for (const ScorePart& other : parts)
    if (other.measure == Measure::TunnelError || other.measure == Measure::Verification)
      cost += other.most_points - other.points;
  return cost;
}

}  // namespace

bool is_of_session(const Score& score, const std::string& session, const std::string& case_name,
                   const std::string& case_created_utc) {
  if (score.session.empty() || score.session != session) return false;
  const bool is_known = !score.case_created_utc.empty() && !case_created_utc.empty();
  return is_known ? score.case_created_utc == case_created_utc : score.knee == case_name;
}

bool is_by_earlier_rule(const Score& score) {
  const Exercise* const exercise = find_exercise(score.exercise);
  return exercise != nullptr && score.rule != exercise->rule;
}

Score score_of(const Exercise& exercise, Level level, const ExerciseFacts& facts) {
  constexpr std::size_t kMostAdvice = 3;
  Score score;
  score.exercise = exercise.id;
  score.level = level;
  score.is_done = facts.is_done;
  score.rule = exercise.rule;
  for (const Mark& mark : exercise.marks) score.parts.push_back(part_of(mark, exercise.goal, facts));
  count_how_only_where_reached(exercise.goal, facts, score.parts);
  for (ScorePart& part : score.parts)
    if (exercise.goal == Goal::Aim && part.measure == Measure::ActedOnBadData && facts.bad_data_mm > 0)
      tell_of_aiming_blindly(part);
  double sum = 0, most = 100;
  for (ScorePart& part : score.parts) {
    sum += part.points;
    if (!part.caps_at) continue;
    most = std::min(most, *part.caps_at);
    part.reason += format(" This alone holds the whole score at %.0f of 100 or less.", *part.caps_at);
  }
  // Whoever stops half-way has made no mistakes either.
  score.points = facts.is_done ? std::round(std::min(sum, most)) : 0;
  std::vector<const ScorePart*> costly;
  for (const ScorePart& part : score.parts)
    if (!part.advice.empty()) costly.push_back(&part);
  std::stable_sort(costly.begin(), costly.end(), [&](const ScorePart* a, const ScorePart* b) {
    return cost_of(*a, score.parts) > cost_of(*b, score.parts);
  });
  if (!facts.is_done)
    score.better.emplace_back("Go on to the end and say that you are done: half an exercise counts nothing.");
  for (const ScorePart* part : costly)
    if (score.better.size() < kMostAdvice && part->most_points - part->points >= 1)
      score.better.push_back(part->advice);
  return score;
}

}  // namespace arthronaut::training
