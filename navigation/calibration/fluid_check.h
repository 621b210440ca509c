// The five-second self-check in fluid: a ruler with two markers whose relative pose is known is held before
// the lens, and each model of the fluid's effect is asked how well it explains what is seen. Tells a wrong
// medium, a port that is not flat, a dry calibration that was changed since.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/calibration/ruler.h"
#include "navigation/camera/camera_model.h"

namespace arthronaut::calibration {

// One frame with both markers: raw pixels in the order of markers::MarkerObservation (top-left, top-right,
// bottom-right, bottom-left), and the mark angle of that frame.
struct RulerSighting {
  double mark_angle_deg = 0;
  std::array<Eigen::Vector2d, 4> first_px, second_px;
};

enum class FluidHypothesis {
  FlatPort,      // exact refraction at a flat window, the medium's index as given
  FocalRule,     // focal length times the index
  NoRefraction,  // a dome port, or air after all
};
[[nodiscard]] std::string_view to_text(FluidHypothesis hypothesis);

struct FluidCheckSummary {
  struct Row {
    FluidHypothesis hypothesis = FluidHypothesis::FlatPort;
    double rms_px = -1;                      // of all eight corners, the ruler's pose solved in each frame
    double median_mm = -1, median_deg = -1;  // of the markers' relative pose, each marker solved by itself
    double worst_mm = -1, worst_deg = -1;    // of 95 % of the frames
  };
  std::vector<Row> rows;        // best (least rms_px) first
  std::size_t frame_count = 0;  // in which the ruler could be measured, in the stated medium
  double best_index = 0;        // the working medium's index that a flat port explains the frames best with
  // One sigma of it by the corners' scatter alone; -1: not known. Large where the ruler was held so that
  // every index looks alike: small, in the middle of the view, facing the lens.
  double index_sigma = -1;
  // The medium, air or a fluid (as saline), that the pictures show in place of the stated one; 0: none. Then
  // it is the first of the reasons.
  double shown_index = 0;
  // Between the two markers' centres, each marker solved by itself behind a flat port: median over the
  // frames, and half of what 68 % of them lie within. -1: not known.
  double distance_mm = -1, distance_spread_mm = -1;
  std::vector<std::string> reasons = {
      "the check was not run"};  // why the given medium can't be trusted; empty: it can
  [[nodiscard]] bool is_trusted() const { return reasons.empty(); }
};

struct FluidCheckOptions {
  double refractive_index = 1.3345;  // of the medium that is said to be there
  std::size_t fewest_frames = 20;
  double most_median_mm = 0.15, most_median_deg = 1.5;
  double most_index_error = 0.03;  // of best_index from refractive_index
  double most_index_sigma = 0.01;
};

// Does not throw on poor sightings: read the summary. Throws InvalidInput for an unusable calibration or
// index.
[[nodiscard]] FluidCheckSummary check_fluid(std::span<const RulerSighting> sightings, const Ruler& ruler,
                                            const camera::Calibration& calibration,
                                            const FluidCheckOptions& options);

}  // namespace arthronaut::calibration
