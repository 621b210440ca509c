#include "navigation/simulator/hand_board.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/frame_pace.h"
#include "navigation/simulator/hand_push.h"
#include "navigation/simulator/random.h"
#include "navigation/simulator/renderer.h"
#include "navigation/sources/exercise_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

using Eigen::Vector3d;

constexpr double kNearestBoard_mm = 7, kFurthestBoard_mm = 50, kBoardAside_mm = 12;
constexpr double kMostAslant_deg = 75;

// Facing the lens, turned in its plane anyhow, further off than pictures are taken.
HandState board_start(const SimulationOptions& options) {
  Random random(options.seed * 29 + 7);
  HandState start;
  start.held = Held::Board;
  start.mark_angle_deg = options.camera.reference_mark_angle_deg;
  const Eigen::AngleAxisd facing_lens(geometry::kPi, Vector3d::UnitX());
  const Eigen::AngleAxisd in_plane(random.between(-3, 3), Vector3d::UnitZ());
  start.camera_from_board = {Eigen::Quaterniond(facing_lens * in_plane),
                             {random.between(-4, 4), random.between(-4, 4), 30}};
  return start;
}

}  // namespace

struct HandBoard::State {
  SimulationOptions options;
  HandOptions hand;
  camera::Calibration camera;  // with fewer pixels
  Renderer renderer;
  sources::SourceInfo info;
  FramePace pace;
  FaultPlay faults;
  HandScene scene;
  HandState now;
  Vector3d speed_mm_s = Vector3d::Zero(), turning_rad_s = Vector3d::Zero();
  double lens_deg_s = 0;
  HandTruth truth;
  std::int64_t next_index = 0;

  State(const SimulationOptions& o, HandOptions h)
      : options(o),
        hand(std::move(h)),
        camera(with_fewer_pixels(o.camera, hand.picture_share)),
        renderer(nullptr, SensorOptions{.blur_sigma_px = std::max(0.5, hand.picture_share)}),
        pace(o.frames_per_second, hand.in_real_time),
        faults(hand.faults, o.seed),
        now(board_start(o)) {
    if (options.frames_per_second < 1) throw InvalidInput("simulator: frames_per_second must be above 0");
    if (!(options.square_mm > 0)) throw InvalidInput("simulator: square_mm must be above 0");
    if (!hand.hand) throw InvalidInput("simulator: there is no hand");
    scene.start.held = Held::Board;
    scene.start.mark_angle_deg = now.mark_angle_deg;
    info.name = sources::kExerciseSource;
    info.kind = sources::SourceKind::Simulation;
    info.image_size_px = camera.image_size_px;
    info.frames_per_second = options.frames_per_second;
  }

  // Whether it does: it is not held more aslant than a hand holds it.
  bool turn(const Eigen::Quaterniond& by) {
    const Eigen::Quaterniond turned = (by * now.camera_from_board.rotation).normalized();
    const double aslant = geometry::angle_between_rad(turned * Vector3d::UnitZ(), -Vector3d::UnitZ());
    if (aslant > geometry::rad_from_deg(kMostAslant_deg)) return false;
    now.camera_from_board.rotation = turned;
    return true;
  }

  // The hand does not hold it any more as it did.
  void slip(double by_deg) {
    Random random(options.seed + 89);
    const double where = random.between(0, 2 * geometry::kPi);
    const Eigen::Quaterniond by(
        Eigen::AngleAxisd(geometry::rad_from_deg(by_deg), Vector3d(std::cos(where), std::sin(where), 0)));
    if (!turn(by)) turn(by.conjugate());  // it was held aslant that way already
  }

  void push(const HandInput& input, double dt_s) {
    const double dt = std::clamp(dt_s, 0.0, hand.limits.longest_step_s);
    const double share = 1 - std::exp(-dt / hand.limits.settle_s);
    const double way = input.moves_scope ? -1 : 1;
    const Vector3d tilt = geometry::rad_from_deg(hand.limits.tool_deg_s) * cut_all(input.tilt);
    const Vector3d facing = now.camera_from_board.rotate(Vector3d::UnitZ());
    speed_mm_s += share * (way * hand.limits.tool_mm_s * cut_all(input.move) - speed_mm_s);
    turning_rad_s += share * (way * tilt - turning_rad_s);
    lens_deg_s += share * (hand.limits.lens_deg_s * cut(input.turn_lens) - lens_deg_s);
    Vector3d& at = now.camera_from_board.translation_mm;
    at += dt * speed_mm_s;
    const Vector3d least(-kBoardAside_mm, -kBoardAside_mm, kNearestBoard_mm);
    const Vector3d most(kBoardAside_mm, kBoardAside_mm, kFurthestBoard_mm);
    at = at.cwiseMax(least).cwiseMin(most);
    const Vector3d sideways(turning_rad_s.x(), turning_rad_s.y(), 0);
    turn(Eigen::Quaterniond(turn_of_push(facing, dt * sideways)));
    turn(Eigen::Quaterniond(Eigen::AngleAxisd(dt * turning_rad_s.z(), Vector3d::UnitZ())));
    now.mark_angle_deg = std::fmod(now.mark_angle_deg + dt * lens_deg_s + 720, 360.0);
    now.held = input.held;
    now.time_s += dt_s;
  }

  camera::FramePtr render() {
    truth.faults = faults.advance(
        now.time_s, [](const Fault&) { return false; },
        [this](const Fault& fault) {
          if (fault.kind == FaultKind::SlippedBoard) slip(fault.strength);
        });
    truth.frame = next_index;
    truth.time_s = now.time_s;
    truth.hand = now;
    if (hand.log) hand.log->add(truth);

    // A white square before the lens stays below saturation.
    constexpr double kBrightest = 0.85, kNearerSide = 0.8;
    const double nearest_mm =
        kNearerSide * std::clamp(now.camera_from_board.translation_mm.norm(), 10.0, 40.0);
    Scene picture;
    picture.exposure = static_cast<float>(kBrightest * nearest_mm * nearest_mm);
    picture.solids.push_back(make_checkerboard(now.camera_from_board, options.square_mm));
    const camera::CameraModel model(camera, camera.lens_angle_rad(now.mark_angle_deg), 1.0);
    const auto frame = std::make_shared<camera::Frame>();
    const std::uint64_t noise_seed = options.seed * 1'000'003 + static_cast<std::uint64_t>(next_index);
    renderer.render(picture, model, now.mark_angle_deg, noise_seed, *frame);
    faults.spoil(*frame, noise_seed);
    frame->index = next_index++;
    frame->timestamp_ns = static_cast<std::int64_t>(std::llround(now.time_s * 1e9));
    return frame;
  }
};

HandBoard::HandBoard(const SimulationOptions& options, HandOptions hand)
    : state_(std::make_unique<State>(options, std::move(hand))) {}
HandBoard::~HandBoard() = default;

const sources::SourceInfo& HandBoard::info() const { return state_->info; }

camera::FramePtr HandBoard::next() {
  const double dt_s = state_->pace.next_s();
  const auto input = state_->hand.hand(state_->scene, state_->now);
  if (!input) return nullptr;
  state_->pace.leave_out(input->held_up_s);
  state_->push(*input, dt_s);
  state_->truth.input = *input;
  return state_->render();
}

const camera::Calibration& HandBoard::camera() const { return state_->camera; }

}  // namespace arthronaut::simulator
