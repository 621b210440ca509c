// A trainee's hands, moment by moment: what mouse, keyboard, gamepad or a script push, and where probe, guide
// and scope go by it. Pure: start, pushes and time steps in, poses out; the same in, the same out, to the
// last bit.
//
// Motion is velocity-limited and settles like a hand's: a push is a speed that is wanted, reached in about
// HandLimits::settle_s. Directions are the picture's: right, down, forward (away from the lens), whatever the
// scope looks at. What the hand holds never goes through bone: the probe's tip and the guide's point stop at
// the surface and slide along it, the scope stops short of it. While the drill is in the bone the guide
// stands still.
//
// Poses in the bone's frame (LPS, mm).
#pragma once

#include <Eigen/Core>

#include "navigation/tools/tool_set.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"

namespace arthronaut::simulator {

enum class Held { Probe, Guide, Board };

// What a trainee asks of the operation with the pedal, where a script stands at it.
enum class Press {
  None,
  Touch,
  ControlPoint,
  Register,
  Draw,
  StopDrawing,
  MarkerAnew,
  Drilled,
  Finish,
  Picture,      // of the board: take it
  DropPicture,  // the one taken last
};

// What is pushed now. Every axis from -1 to 1; more is cut off, what is no number is 0.
struct HandInput {
  Held held = Held::Probe;
  bool moves_scope = false;                        // move and tilt go to the scope, not to the tool
  Eigen::Vector3d move = Eigen::Vector3d::Zero();  // right, down, forward
  // Where the handle's end is pushed, the tip staying: right, down, forward. Of the scope: the view pans
  // right, tilts down, and rolls. Of the board: the side that faces the lens; the third axis rolls it.
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();
  double turn_lens = 0;  // clockwise on the screen
  double drill = 0;      // 0 to 1: how fast it goes in
  Press press = Press::None;
  // In real time: for how long the hand was held up before it gave this, as while something covers its
  // screen. No time passes for the scene meanwhile.
  double held_up_s = 0;
};

struct HandLimits {
  double tool_mm_s = 25, tool_deg_s = 50;
  double scope_mm_s = 12, scope_deg_s = 25, lens_deg_s = 60;
  double drill_mm_s = 6;
  double settle_s = 0.12;       // time constant from one speed to another
  double scope_clear_mm = 5;    // the lens comes no nearer to the bone
  double drill_reach_mm = 0.5;  // the guide's point must be so near to the bone for the drill to bite
  double longest_step_s = 0.1;  // a longer gap between two frames moves nothing further
};

// Where everything is before the first push. The scope has a place for each tool, and goes there at the
// scope's speed when the tool changes hands.
struct HandStart {
  geometry::RigidTransform bone_from_camera_probe, bone_from_camera_guide;
  double mark_angle_deg = 0;
  Eigen::Vector3d probe_tip_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d probe_handle = Eigen::Vector3d::UnitZ();  // unit, from the tip to the handle
  Eigen::Vector3d guide_point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d guide_direction = -Eigen::Vector3d::UnitZ();  // unit, of drilling
  Held held = Held::Probe;
};

struct HandState {
  Held held = Held::Probe;
  geometry::RigidTransform bone_from_camera;
  double mark_angle_deg = 0;
  Eigen::Vector3d probe_tip_mm = Eigen::Vector3d::Zero(), probe_handle = Eigen::Vector3d::Zero();
  Eigen::Vector3d guide_point_mm = Eigen::Vector3d::Zero(), guide_direction = Eigen::Vector3d::Zero();
  geometry::RigidTransform camera_from_board;  // where the calibration board is what is held (hand_board.h)
  bool touches_bone = false;                   // the tip, or the point, of what is held
  double off_bone_mm = 0;                      // how far it is from the bone's surface; 0 before a step
  double drilled_depth_mm = 0;                 // beyond the guide's point
  double time_s = 0;                           // of all steps
};

class HandControl {
 public:
  // Throws InvalidInput when a limit is not above 0. The bone must outlive this.
  HandControl(const HandStart& start, const geometry::Surface& bone, const HandLimits& limits = {});
  // Goes on by dt_s, which is cut to [0, longest_step_s].
  const HandState& step(const HandInput& input, double dt_s);
  [[nodiscard]] const HandState& state() const { return state_; }
  [[nodiscard]] const HandLimits& limits() const { return limits_; }

 private:
  struct Speeds {
    Eigen::Vector3d tool = Eigen::Vector3d::Zero(), scope = Eigen::Vector3d::Zero();
    Eigen::Vector3d tool_tilt = Eigen::Vector3d::Zero(), scope_tilt = Eigen::Vector3d::Zero();
    double lens = 0;
  };
  void take(Held held);
  void move_tool(double dt_s);
  void move_scope(double dt_s);
  void follow_staged_view(double dt_s);
  void drill(double share, double dt_s);
  [[nodiscard]] Eigen::Vector3d kept_out(const Eigen::Vector3d& from_mm,
                                         const Eigen::Vector3d& step_mm) const;

  const geometry::Surface& bone_;
  HandLimits limits_;
  HandStart start_;
  HandState state_;
  Speeds speeds_;
  double glide_share_ = 1;  // of the way to the staged view; 1: there, the hand alone moves the scope
  geometry::RigidTransform glide_from_;
};

}  // namespace arthronaut::simulator
