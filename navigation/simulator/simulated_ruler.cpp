#include "navigation/simulator/simulated_ruler.h"

#include <cmath>

#include "navigation/simulator/renderer.h"
#include "navigation/simulator/script.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

constexpr double kHalfLengthMm = 30, kHalfWidthMm = 4.5;

}  // namespace

struct SimulatedRuler::State {
  RulerOptions options;
  Renderer renderer{nullptr, SensorOptions{}};
  sources::SourceInfo info;
  FrameTruth truth;
  std::int64_t next_index = 0;

  // The lens goes from one end to the other and back; the hand that holds the scope wanders and tilts.
  void set_truth(std::int64_t index) {
    const double share = static_cast<double>(index) / options.frame_count;
    const double frame = static_cast<double>(index);
    truth.frame_index = index;
    truth.mark_angle_deg =
        std::fmod(options.camera.reference_mark_angle_deg +
                      0.5 * options.rotation_deg * std::sin(2 * geometry::kPi * share) + 720,
                  360.0);
    const double tilt = geometry::rad_from_deg(24 + 9 * std::sin(2 * geometry::kPi * (1.7 * share + 0.1)));
    const double hinge = 2 * geometry::kPi * (0.8 * share + 0.15);
    const Eigen::Quaterniond facing(Eigen::AngleAxisd(geometry::kPi, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond tilted(
        Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(hinge), std::sin(hinge), 0)));
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(1.2 + 0.8 * std::sin(2 * geometry::kPi * share), Eigen::Vector3d::UnitZ()));
    const geometry::RigidTransform held{
        (tilted * facing * turned).normalized(),
        {1.2 * std::sin(9 * share), 1.2 * std::cos(7 * share), 19 + 1.5 * std::sin(11 * share)}};
    const geometry::RigidTransform camera_from_ruler = held * tremor(options.seed + 15, frame, 0.3, 0.6);
    const auto marker_at = [&](double x) {
      return camera_from_ruler * geometry::RigidTransform{Eigen::Quaterniond::Identity(), {x, 0, 0}};
    };
    truth.markers = {{options.first_id, marker_at(-0.5 * options.spacing_mm)},
                     {options.second_id, marker_at(0.5 * options.spacing_mm)}};
  }

  Scene scene() const {
    PlateShape ruler;
    ruler.half_size_mm = {kHalfLengthMm, kHalfWidthMm};
    ruler.tick_spacing_mm = 1;
    const Eigen::Vector2d first(-0.5 * options.spacing_mm, 0);
    const auto printed = [&](int id) { return options.printed ? options.printed(id) : marker_cells(id); };
    ruler.markers = {{first, options.size_mm, printed(options.first_id)},
                     {-first, options.size_mm, printed(options.second_id)}};
    // The ruler's frame lies half-way between its markers'.
    geometry::RigidTransform camera_from_ruler = truth.markers[0].camera_from_marker;
    camera_from_ruler.translation_mm = camera_from_ruler * Eigen::Vector3d(0.5 * options.spacing_mm, 0, 0);
    Scene scene;
    scene.exposure = static_cast<float>(0.85 * camera_from_ruler.translation_mm.squaredNorm());
    scene.solids.push_back(make_plate(camera_from_ruler, ruler));
    return scene;
  }
};

SimulatedRuler::SimulatedRuler(const RulerOptions& options) : state_(std::make_unique<State>()) {
  if (options.frame_count < 1 || options.frames_per_second < 1 || !(options.size_mm > 0) ||
      !(options.spacing_mm > 1.3 * options.size_mm)) {
    throw InvalidInput(
        "simulated ruler: frames, rate and size must be above 0, the spacing above 1.3 marker sizes");
  }
  if (options.first_id == options.second_id)
    throw InvalidInput("simulated ruler: its two markers must differ");
  state_->options = options;
  state_->info.name = "simulated ruler";
  state_->info.kind = sources::SourceKind::Simulation;
  state_->info.image_size_px = options.camera.image_size_px;
  state_->info.frames_per_second = options.frames_per_second;
  state_->info.frame_count = options.frame_count;
}

SimulatedRuler::~SimulatedRuler() = default;

const sources::SourceInfo& SimulatedRuler::info() const { return state_->info; }

camera::FramePtr SimulatedRuler::next() {
  State& state = *state_;
  const RulerOptions& options = state.options;
  if (state.next_index >= options.frame_count) return nullptr;
  const std::int64_t index = state.next_index++;
  state.set_truth(index);
  const double mark_angle_deg = state.truth.mark_angle_deg;
  const camera::CameraModel camera(options.camera, options.camera.lens_angle_rad(mark_angle_deg),
                                   options.refractive_index);
  const auto frame = std::make_shared<camera::Frame>();
  state.renderer.render(state.scene(), camera, mark_angle_deg,
                        options.seed * 1'000'003 + static_cast<std::uint64_t>(index), *frame);
  frame->index = index;
  frame->timestamp_ns = index * 1'000'000'000 / options.frames_per_second;
  return frame;
}

const FrameTruth& SimulatedRuler::truth() const { return state_->truth; }

geometry::RigidTransform SimulatedRuler::first_from_second() const {
  return {Eigen::Quaterniond::Identity(), {state_->options.spacing_mm, 0, 0}};
}

}  // namespace arthronaut::simulator
