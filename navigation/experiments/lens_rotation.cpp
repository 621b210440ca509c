#include "navigation/experiments/lens_rotation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "navigation/calibration/calibration.h"
#include "navigation/camera/medium.h"
#include "navigation/pipeline/view_tracker.h"
#include "navigation/simulator/simulated_ruler.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::experiments {

namespace {

pipeline::ViewTracker make_view_tracker(const camera::Calibration& camera, const RulerInFluid& seen,
                                        LensMode mode) {
  pipeline::ViewTrackerOptions options;
  options.calibration = camera;
  options.refractive_index = seen.refractive_index;
  options.follow_lens = mode != LensMode::NotFollowing;
  if (mode == LensMode::FocalRule) options.fluid_model = camera::FluidModel::FocalRule;
  const std::array<markers::DeclaredMarker, 2> declared{
      markers::DeclaredMarker{seen.ruler.first_id, seen.ruler.size_mm},
      markers::DeclaredMarker{seen.ruler.second_id, seen.ruler.size_mm}};
  return {options, markers::make_tracker(declared)};
}

std::optional<RulerError> error_of(const pipeline::PictureObservation& view,
                                   const calibration::Ruler& ruler) {
  const auto &first = view.markers[0], &second = view.markers[1];
  if (!view.stands_for(first) || !view.stands_for(second)) return std::nullopt;
  const auto measured = first.camera_from_marker.inverse() * second.camera_from_marker;
  const auto& truth = ruler.first_from_second;
  return RulerError{
      (measured.translation_mm - truth.translation_mm).norm(),
      geometry::deg_from_rad(geometry::rotation_angle_rad(truth.rotation.conjugate() * measured.rotation))};
}

void summarise(LensRotationResult& result) {
  double least = 1e9, most = -1e9;
  for (const LensRotationFrame& frame : result.frames) {
    if (!frame.lens_angle_deg) continue;
    least = std::min(least, *frame.lens_angle_deg);
    most = std::max(most, *frame.lens_angle_deg);
  }
  result.rotation_deg = std::max(0.0, most - least);
  for (std::size_t mode = 0; mode < kLensModes.size(); ++mode) {
    std::vector<double> mm, deg;
    for (const LensRotationFrame& frame : result.frames) {
      if (!frame.errors[mode]) continue;
      mm.push_back(frame.errors[mode]->translation_mm);
      deg.push_back(frame.errors[mode]->rotation_deg);
    }
    result.modes[mode] = {static_cast<int>(mm.size()), geometry::quantile(mm, 0.5, 0),
                          geometry::quantile(mm, 0.95, 0), geometry::quantile(deg, 0.5, 0),
                          geometry::quantile(deg, 0.95, 0)};
  }
}

camera::Calibration calibrate_on_stills(const simulator::SimulationOptions& options) {
  simulator::SimulatedOperation stills(options, simulator::Phase::Calibrate);
  std::vector<calibration::CalibrationPicture> pictures;
  std::vector<std::uint8_t> gray;
  while (const camera::FramePtr frame = stills.next()) {
    camera::gray_from(*frame, gray);
    auto picture = calibration::observe_picture("still " + std::to_string(frame->index),
                                                {gray.data(), frame->width, frame->height, frame->width});
    // A still on which the board is not found would be taken again.
    if (picture.board.found()) pictures.push_back(std::move(picture));
  }
  calibration::CalibrationOptions calibration_options;
  calibration_options.square_mm = options.square_mm;
  calibration_options.leave_one_out = false;
  const auto summary = calibration::calibrate(pictures, calibration_options);
  if (!summary.is_usable()) throw InvalidInput("experiment: the simulator's stills do not calibrate");
  return summary.record.calibration;
}

}  // namespace

std::string_view to_text(LensMode mode) {
  switch (mode) {
    case LensMode::Following:
      return "following the lens";
    case LensMode::NotFollowing:
      return "not following";
    case LensMode::FocalRule:
      return "paper's focal rule";
  }
  return "?";
}

RulerInFluid read_ruler_file(const std::filesystem::path& file) {
  const files::JsonObject document = files::read_json(file, "arthronaut-acceptance.ruler", 1);
  const std::vector<double> ids = document.numbers("markers");
  if (ids.size() != 2) document.fail("markers", "must be two ids");
  RulerInFluid seen;
  calibration::Ruler& ruler = seen.ruler;
  ruler.first_id = static_cast<int>(ids[0]);
  ruler.second_id = static_cast<int>(ids[1]);
  ruler.size_mm = document.positive_number("size_mm");
  ruler.first_from_second = document.rigid_transform("marker" + std::to_string(ruler.first_id) +
                                                     "_from_marker" + std::to_string(ruler.second_id));
  seen.refractive_index = camera::refractive_index_from_text(document.text("medium"));
  return seen;
}

LensRotationResult run_lens_rotation(sources::FrameSource& source, const camera::Calibration& camera,
                                     const RulerInFluid& seen, const std::function<void(int)>& progress) {
  // One view tracker a mode, in the order of kLensModes.
  std::array trackers{make_view_tracker(camera, seen, LensMode::Following),
                      make_view_tracker(camera, seen, LensMode::NotFollowing),
                      make_view_tracker(camera, seen, LensMode::FocalRule)};
  LensRotationResult result;
  pipeline::PictureObservation view;
  // The mark's angle jumps from 360 to 0; the lens's does not.
  double unwrapped_deg = 0;
  while (const camera::FramePtr frame = source.next()) {
    LensRotationFrame row;
    row.index = frame->index;
    for (std::size_t mode = 0; mode < kLensModes.size(); ++mode) {
      trackers[mode].observe(*frame, view);
      row.errors[mode] = error_of(view, seen.ruler);
      if (mode == 0 && view.lens.has_angle()) {
        const double angle_deg = geometry::deg_from_rad(camera.lens_angle_rad(view.lens.mark_angle_deg));
        unwrapped_deg += std::remainder(angle_deg - unwrapped_deg, 360.0);
        row.lens_angle_deg = unwrapped_deg;
      }
    }
    result.frames.push_back(row);
    if (progress) progress(static_cast<int>(result.frames.size()));
  }
  summarise(result);
  return result;
}

SimulatedLensRotation simulate_lens_rotation(int frame_count, std::uint64_t seed,
                                             const std::function<void(int)>& progress) {
  SimulatedLensRotation simulated;
  simulated.truth = simulator::standard_camera();
  simulator::SimulationOptions stills;
  stills.camera = simulated.truth;
  stills.tools = tools::standard_tools();
  stills.knee = phantom::make_phantom_knee();
  stills.plan = stills.knee.femoral_tunnel;
  stills.seed = seed;
  simulated.calibrated = calibrate_on_stills(stills);
  simulator::RulerOptions scene;
  scene.camera = simulated.truth;
  scene.seed = seed;
  scene.frame_count = frame_count;
  simulator::SimulatedRuler source(scene);
  const RulerInFluid ruler{{scene.first_id, scene.second_id, scene.size_mm, source.first_from_second()},
                           scene.refractive_index};
  simulated.result = run_lens_rotation(source, simulated.calibrated, ruler, progress);
  return simulated;
}

void write_lens_rotation_table(const std::filesystem::path& file, const LensRotationResult& result) {
  std::string text = "frame,lens_angle_deg";
  for (const char* mode : {"following", "not_following", "focal_rule"}) {
    text += std::string(",") + mode + "_mm," + mode + "_deg";
  }
  text += "\n";
  char number[40];
  const auto append = [&](bool known, double value) {
    text += ",";
    if (!known) return;
    std::snprintf(number, sizeof number, "%.6f", value);
    text += number;
  };
  for (const LensRotationFrame& frame : result.frames) {
    text += std::to_string(frame.index);
    append(frame.lens_angle_deg.has_value(), frame.lens_angle_deg.value_or(0));
    for (const auto& error : frame.errors) {
      append(error.has_value(), error ? error->translation_mm : 0);
      append(error.has_value(), error ? error->rotation_deg : 0);
    }
    text += "\n";
  }
  files::write_atomically(file, std::string_view(text));
}

}  // namespace arthronaut::experiments
