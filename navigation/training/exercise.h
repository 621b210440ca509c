// The exercises on the simulator, as data: what is to be reached, by which steps, what the simulator does
// against it, and what each part of the score asks. Another exercise is another row.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/simulator/hand_operation.h"
#include "planning/bones/bone.h"

namespace arthronaut::training {

enum class Goal {
  Calibrate,  // the camera is found from pictures of a board; no operation, no session
  Pivot,      // the probe's tip is found by turning it about its tip
  Register,   // the bone is drawn, found and verified
  Aim,        // the guide stands on the plan; where the bone lies is known
  Drill,      // all of it, and the tunnel
};

enum class Level { Easy, Medium, Hard };
[[nodiscard]] std::string_view to_text(Level level);  // "easy", ...
// Throws InvalidInput for what is none of them.
[[nodiscard]] Level level_from_text(std::string_view text);

// What a part of the score measures.
enum class Measure {
  Time,            // s, first picture to the trainee's "done"
  EntryOffset,     // mm, true: the guide's axis, or the tunnel, from the planned entry across the plan
  Angle,           // deg, true
  DepthError,      // mm, of the tunnel, too deep or too shallow
  TunnelError,     // mm, true: how far off the registration puts the planned entry
  TipError,        // mm, of the tip that the pivot finds
  CameraError,     // px, true: between the camera that was found and the one there is, over the view
  Uncovered,       // % of the view without corners, in the mean of the pictures taken
  Refused,         // pictures that were asked for and not taken: blurred, moved, not turned
  Verification,    // places short of a registration that touches have verified
  WastedTouches,   // refused, at a place touched before, or before there was anything to verify
  DrawnInAir,      // % of the drawn length off the bone
  OutOfView,       // % of the time in which the marker of bone or tool was not seen
  AlarmsIgnored,   // alarms that were dismissed, or drilled through
  ActedOnBadData,  // mm drilled while the screen's numbers were gone or wrong
  OffBone,         // mm, true: from the guide's point to the bone, at the end
};
[[nodiscard]] std::string_view to_text(Measure measure);  // "entry offset"
[[nodiscard]] std::string_view unit_of(Measure measure);  // "mm"; empty for a count

// Full points up to `good`, none from `limit` on, evenly between.
struct Mark {
  Measure measure;
  double good, limit;
  double points;
  // From `limit` on the whole score is no more than this, however good the rest was: what no surgeon may do
  // is not made up for by a straight tunnel. Empty: it costs its own points alone.
  std::optional<double> caps_at = std::nullopt;
};

struct Exercise {
  std::string_view id;     // "drill-femur"
  std::string_view title;  // "Drill the femoral tunnel"
  Goal goal = Goal::Register;
  bones::BoneKind bone = bones::BoneKind::Femur;
  std::string_view what;  // one sentence: what is reached
  std::vector<std::string_view> steps;
  std::vector<Mark> marks;  // their points add up to 100
  // Of its marks: goes up by one when they change. Scores by another rule are kept, and compared with none of
  // this one.
  int rule = 1;
};

// In the order of learning.
[[nodiscard]] const std::vector<Exercise>& exercises();
// Null: there is none of that name.
[[nodiscard]] const Exercise* find_exercise(std::string_view id);
// What the simulator does against it at this level; nothing where it is easy.
[[nodiscard]] std::vector<simulator::Fault> faults_of(const Exercise& exercise, Level level);
// What the joint shows beside bone and tools: nothing where it is easy, nor where a board is all there is.
[[nodiscard]] simulator::SurroundingsOptions surroundings_of(const Exercise& exercise, Level level);
// "bleeding, glare, soft tissue, motes"; "nothing goes wrong".
[[nodiscard]] std::string words_of_faults(const Exercise& exercise, Level level);

}  // namespace arthronaut::training
