#include "navigation/training/trainee.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "navigation/simulator/random.h"
#include "navigation/training/board_trainee.h"

namespace arthronaut::training {

namespace {

using Eigen::Vector3d;
using simulator::HandInput;
using simulator::HandScene;
using simulator::HandState;
using simulator::Held;
using simulator::Press;

constexpr double kGain_1_s = 6;      // of speed over distance: a hand that neither hurries past nor creeps
constexpr double kAhead_mm = 3.5;    // how far along a stroke it looks
constexpr double kPressed_mm = 0.6;  // how far into the bone it aims while it draws
constexpr double kLift_mm = 4;
const simulator::HandLimits kLimits;  // those of the source that it moves

// One thing after the other.
struct Act {
  enum class Kind { Go, Stroke, Rest, Turn, Drill } kind = Kind::Go;
  Held held = Held::Probe;
  Vector3d point_mm = Vector3d::Zero(), handle = Vector3d::Zero();  // Go; a handle of zero: as it is
  bool is_pressed = false;                                          // Go, Rest: onto the bone
  std::vector<Vector3d> stroke = {};
  double seconds = 0;         // Rest, Turn
  Press press = Press::None;  // Rest: in its middle; else at its beginning
  double depth_mm = 0, cone_deg = 0;
};

class Trainee {
 public:
  Trainee(Goal goal, const Skill& skill) : goal_(goal), skill_(skill) {}

  std::optional<HandInput> push(const HandScene& scene, const HandState& state) {
    if (!is_planned_) plan(scene);
    while (!acts_.empty()) {
      HandInput input;
      if (go_on(acts_.front(), state, input)) return input;
      acts_.pop_front();
      is_begun_ = false;
    }
    return std::nullopt;
  }

 private:
  void plan(const HandScene& scene) {
    is_planned_ = true;
    switch (goal_) {
      case Goal::Calibrate:  // board_trainee.h
        return;
      case Goal::Pivot:
        add_go(Held::Probe, scene.dimple_mm, scene.dimple_handle, true);
        acts_.push_back({.kind = Act::Kind::Turn,
                         .point_mm = scene.dimple_mm,
                         .handle = scene.dimple_handle,
                         .seconds = 16,
                         .cone_deg = skill_.tilts_deg});
        add_rest(Held::Probe, 0.2, Press::Finish);
        return;
      case Goal::Register:
        draw(scene);
        touch(scene, false);
        add_rest(Held::Probe, 0.2, Press::Finish);
        return;
      case Goal::Aim:
        aim(scene);
        add_rest(Held::Guide, 0.2, Press::Finish);
        return;
      case Goal::Drill:
        draw(scene);
        touch(scene, true);
        aim(scene);
        acts_.push_back({.kind = Act::Kind::Drill,
                         .held = Held::Guide,
                         .depth_mm = scene.plan_length_mm + skill_.depth_error_mm});
        add_rest(Held::Guide, 0.6, Press::None);
        add_rest(Held::Guide, 0.4, Press::Drilled);
        add_rest(Held::Guide, 0.2, Press::Finish);
        return;
    }
  }

  void add_go(Held held, const Vector3d& point, const Vector3d& handle, bool is_pressed,
              Press press = Press::None) {
    acts_.push_back({.kind = Act::Kind::Go,
                     .held = held,
                     .point_mm = point,
                     .handle = handle,
                     .is_pressed = is_pressed,
                     .press = press});
  }
  void add_rest(Held held, double seconds, Press press) {
    acts_.push_back({.kind = Act::Kind::Rest, .held = held, .seconds = seconds, .press = press});
  }
  static Vector3d lifted(const HandScene& scene, const Vector3d& point) {
    return point + kLift_mm * (scene.start.bone_from_camera_probe.translation_mm - point).normalized();
  }

  void draw(const HandScene& scene) {
    double drawn_mm = 0;
    for (std::size_t i = 0; i < scene.strokes.size() && drawn_mm < skill_.draws_mm; ++i) {
      const auto& stroke = scene.strokes[i];
      if (skill_.stops_drawing) add_rest(Held::Probe, 0.07, Press::StopDrawing);
      add_go(Held::Probe, lifted(scene, stroke.front()), scene.handles[i].front(), false);
      add_go(Held::Probe, stroke.front(), Vector3d::Zero(), true);
      if (skill_.stops_drawing) add_rest(Held::Probe, 0.07, Press::Draw);
      acts_.push_back({.kind = Act::Kind::Stroke, .held = Held::Probe, .stroke = stroke});
      drawn_mm += 0.5 * static_cast<double>(stroke.size());
      if (skill_.stops_drawing) add_rest(Held::Probe, 0.07, Press::StopDrawing);
      add_go(Held::Probe, lifted(scene, stroke.back()), Vector3d::Zero(), false);
    }
    add_rest(Held::Probe, 0.3, Press::Register);
    add_rest(Held::Probe, 0.5, Press::None);
  }

  struct Place {
    Vector3d point_mm, handle;
  };
  // Each as far from those before as can be.
  static std::vector<Place> places(const HandScene& scene, int count) {
    std::vector<Place> all;
    for (std::size_t i = 0; i < scene.strokes.size(); ++i)
      for (std::size_t k = 0; k < scene.strokes[i].size(); k += 4)
        all.push_back({scene.strokes[i][k], scene.handles[i][k]});
    std::vector<Place> chosen{all[all.size() / 2]};
    while (std::ssize(chosen) < count) {
      const auto nearest = [&](const Place& place) {
        double mm = 1e9;
        for (const Place& other : chosen) mm = std::min(mm, (other.point_mm - place.point_mm).norm());
        return mm;
      };
      chosen.push_back(*std::max_element(
          all.begin(), all.end(), [&](const Place& a, const Place& b) { return nearest(a) < nearest(b); }));
    }
    return chosen;
  }

  void touch(const HandScene& scene, bool has_control_point) {
    const auto at = places(scene, std::max(1, skill_.touches + 1));
    const auto rest_at = [&](const Place& place, Press press) {
      add_go(Held::Probe, lifted(scene, place.point_mm), place.handle, false);
      add_go(Held::Probe, place.point_mm, Vector3d::Zero(), true);
      acts_.push_back({.kind = Act::Kind::Rest, .is_pressed = true, .seconds = 1.4, .press = press});
    };
    for (int i = 0; i < skill_.touches; ++i) rest_at(at[static_cast<std::size_t>(i)], Press::Touch);
    for (int i = 0; i < skill_.useless_touches; ++i)
      acts_.push_back({.kind = Act::Kind::Rest, .is_pressed = true, .seconds = 1.0, .press = Press::Touch});
    if (has_control_point && skill_.touches > 0) rest_at(at.back(), Press::ControlPoint);
    add_go(Held::Probe, lifted(scene, at.back().point_mm), Vector3d::Zero(), false);
  }

  void aim(const HandScene& scene) {
    simulator::Random random(skill_.seed * 17 + 3);
    const Vector3d axis = scene.plan.direction, side = axis.unitOrthogonal(), up = axis.cross(side);
    const auto around = [&] {
      const double angle = random.between(0, 2 * geometry::kPi);
      return Vector3d(std::cos(angle) * side + std::sin(angle) * up);
    };
    const Vector3d beside = skill_.offset_mm * around();
    const Vector3d direction = Eigen::AngleAxisd(geometry::rad_from_deg(skill_.angle_deg), around()) * axis;
    add_rest(Held::Guide, 1.4, Press::None);  // until the scope has followed
    add_go(Held::Guide, scene.plan.entry_mm + beside - 4 * axis, -direction, false);
    // Onto the bone, and not pressed: on a slope the point would slide away.
    add_go(Held::Guide, scene.plan.entry_mm + beside + 0.1 * axis, -direction, false);
    add_rest(Held::Guide, skill_.looks_s, Press::None);
  }

  // False: it is over.
  bool go_on(Act& act, const HandState& state, HandInput& input) {
    if (!is_begun_) {
      is_begun_ = true;
      began_s_ = state.time_s;
      at_ = 0;
      pressed_ = false;
      held_point_mm_ = state.probe_tip_mm;
    }
    input.held = act.held;
    const double since_s = state.time_s - began_s_;
    const bool is_probe = act.held == Held::Probe;
    const Vector3d point = is_probe ? state.probe_tip_mm : state.guide_point_mm;
    const Vector3d handle = is_probe ? state.probe_handle : Vector3d(-state.guide_direction);
    switch (act.kind) {
      case Act::Kind::Go: {
        constexpr double kNear_mm = 0.15, kNear_deg = 0.4, kPatience_s = 6;
        const Vector3d wanted = act.handle.isZero() ? handle : act.handle;
        const bool is_there = (point - act.point_mm).norm() < kNear_mm ||
                              (act.is_pressed && state.touches_bone && (point - act.point_mm).norm() < 0.9);
        const bool is_turned =
            geometry::angle_between_rad(handle, wanted) < geometry::rad_from_deg(kNear_deg);
        if ((is_there && is_turned) || since_s > kPatience_s) return false;
        push_towards(state, act.point_mm, act.is_pressed, wanted, point, handle, input);
        return true;
      }
      case Act::Kind::Stroke: {
        const auto& stroke = act.stroke;
        while (at_ + 1 < stroke.size() && (stroke[at_] - point).norm() < kAhead_mm) ++at_;
        if (at_ + 1 >= stroke.size() && (stroke.back() - point).norm() < 1) return false;
        if (since_s > 20) return false;
        push_towards(state, stroke[at_], true, handle, point, handle, input);
        return true;
      }
      case Act::Kind::Rest: {
        if (since_s > act.seconds) return false;
        if (act.is_pressed) push_towards(state, held_point_mm_, true, handle, point, handle, input);
        if (!pressed_ && since_s >= act.seconds / 2) {
          input.press = act.press;
          pressed_ = true;
        }
        return true;
      }
      case Act::Kind::Turn: {
        if (since_s > act.seconds) return false;
        const double turn = 2 * geometry::kPi * since_s / (act.seconds / 2);
        const double cone = geometry::rad_from_deg(act.cone_deg) * (0.75 + 0.25 * std::cos(turn / 2));
        const Vector3d side = act.handle.unitOrthogonal(), up = act.handle.cross(side);
        const Vector3d wanted =
            std::cos(cone) * act.handle + std::sin(cone) * (std::cos(turn) * side + std::sin(turn) * up);
        push_towards(state, point, false, wanted, point, handle, input);
        return true;
      }
      case Act::Kind::Drill:
        if (state.drilled_depth_mm >= act.depth_mm || since_s > 60) return false;
        // Slower towards the end, as one does who wants to stop in time.
        input.drill = std::clamp((act.depth_mm - state.drilled_depth_mm) / 2, 0.15, skill_.pace);
        return true;
    }
    return false;
  }

  void push_towards(const HandState& state, const Vector3d& to_mm, bool is_pressed, const Vector3d& to_handle,
                    const Vector3d& point_mm, const Vector3d& handle, HandInput& input) const {
    const Eigen::Quaterniond picture_from_bone = state.bone_from_camera.rotation.conjugate();
    Vector3d way = picture_from_bone * (to_mm - point_mm);
    if (is_pressed) way.z() += kPressed_mm;
    const auto limited = [&](const Vector3d& axis) {
      return axis.norm() > skill_.pace ? Vector3d(axis * (skill_.pace / axis.norm())) : axis;
    };
    input.move = limited(kGain_1_s / kLimits.tool_mm_s * way);
    const Vector3d turn = picture_from_bone * (to_handle - handle);
    input.tilt = limited(kGain_1_s / geometry::rad_from_deg(kLimits.tool_deg_s) * turn);
  }

  Goal goal_;
  Skill skill_;
  std::deque<Act> acts_;
  bool is_planned_ = false, is_begun_ = false, pressed_ = false;
  double began_s_ = 0;
  std::size_t at_ = 0;
  Vector3d held_point_mm_ = Vector3d::Zero();
};

}  // namespace

Skill careful(std::uint64_t seed) { return {.seed = seed}; }

Skill hasty(std::uint64_t seed) {
  return {.seed = seed,
          .pace = 1,
          .offset_mm = 2.5,
          .angle_deg = 4,
          .depth_error_mm = 3,
          .draws_mm = 120,
          .stops_drawing = false,
          .touches = 1,
          .useless_touches = 2,
          .tilts_deg = 18,
          .looks_s = 0.3,
          .pictures = 4,
          .turns_lens_deg = 25,
          .rests_s = 0};
}

simulator::Hand make_trainee(Goal goal, const Skill& skill) {
  if (goal == Goal::Calibrate) return make_board_trainee(skill);
  return [trainee = std::make_shared<Trainee>(goal, skill)](const HandScene& scene, const HandState& state) {
    return trainee->push(scene, state);
  };
}

}  // namespace arthronaut::training
