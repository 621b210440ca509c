// Direct (photometric) alignment: the pose, the motion during the exposure and the light of a marker, from
// the grey levels around all of its edges at once. The printed code is looked at through the camera model at
// every moment of the exposure, smeared by the optics, lit with a gain and a bias that vary smoothly over the
// marker, and passed through the camera's tone curve; what is minimised is the difference in grey levels,
// where noise is even. Areas between edges carry nothing and are left out.
//
// Use it where edge profiles by themselves are ambiguous: a motion-blurred edge is a ramp of which each
// profile sees a part only. It needs a start within about a third of a cell, and cells of three pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/markers/exposed_code.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/pixel_blocks.h"

namespace arthronaut::markers {

// Where the fit starts, and what is known beforehand.
struct DirectStart {
  ExposedPose pose;
  double velocity_sigma_px = 4;  // how far the motion over the exposure may be wrong, at the marker's sides
  double change_sigma_px = 4;    // and how far its change
  double sigma_px = 1.2;         // smear of the optics
  double gamma = 1.6;            // grey level = light ^ (1 / gamma), as far as it is known
  // When the rows were exposed (row_timing.h), and the motion over one unit of that.
  Eigen::Vector2d delays = Eigen::Vector2d::Zero();
  geometry::Vector6d interval_motion = geometry::Vector6d::Zero();
};

struct DirectOptions {
  int max_iterations = 12;
  int max_pixels = 900;
  // Above 0: the first iterations see the code smeared by this share of a cell, so that a start that is off
  // by as much gets in.
  double coarse_cells = 0;
  double max_way_cells = 1.2;  // from the start to the result; farther away another cell may have answered
  int saturated_grey = 250;    // pixels of this grey and above say nothing
  double min_likeness = 0.9;   // to have converged at all
  // A fit is given up that at the rate at which it gets better would not leave less noise than this.
  double hopeless_noise_grey = 6;
  // What DirectPose::explains_picture asks for. Fits to something else reach a likeness of 0.99 and a noise
  // of 5 on recorded clips; good ones 0.998 and 4.
  double good_inlier_share = 0.65, good_likeness = 0.9975, good_noise_grey = 4.7;
  // The covariance is this much larger than what scatters, since what all edges have wrong together does not:
  // measured on path-traced and on drawn clips.
  double shared_errors = 2;
};

struct DirectPose {
  enum class Outcome {
    NotRun,
    Converged,
    OutOfView,   // too little of the marker can be looked at
    NotSettled,  // the iteration ran away, went too far or was still on its way at the end
    Unlike,      // the picture does not look like the marker there, nor was about to
  } outcome = Outcome::NotRun;
  ExposedPose pose;  // meaningful only if is_usable(), as all below
  // Body twist (v mm, w rad). From the scatter of what the marker's edges say one by one: what the pixels of
  // an edge have wrong together is in it.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  double sigma_px = 0, gamma = 0;
  double likeness = 0;      // correlation of picture and model over the pixels that are not covered
  double noise_grey = 0;    // robust scale of the residuals
  double inlier_share = 0;  // of the pixels
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Converged; }
  // The code and nothing else is what the picture shows there: good enough to stand for.
  [[nodiscard]] bool explains_picture() const { return is_usable() && is_good; }
  bool is_good = false;  // likeness, noise and share reach what DirectOptions calls good
};

// Keeps its memory from call to call.
class DirectFit {
 public:
  DirectFit();
  [[nodiscard]] DirectPose refine(const camera::GrayView& frame, const camera::CameraModel& camera,
                                  const MarkerCode& code, std::span<const EdgeSample> samples, double size_mm,
                                  const DirectStart& start, const DirectOptions& options = {});

 private:
  struct State;       // where the fit stands
  struct Linearised;  // the least squares there
  void take_pixels(const camera::GrayView& frame, const camera::CameraModel& camera, int cells,
                   std::span<const EdgeSample> samples, double size_mm, const DirectStart& start,
                   const DirectOptions& options, std::size_t first, std::size_t every);
  void guess_light(State& state);
  void linearise(const State& state, bool is_first, Linearised& result);
  // Of all unknowns, from how far the edges disagree; false when there are too few edges.
  bool scattered_covariance(const Linearised& at, double certainty, geometry::Matrix6d& covariance) const;

  static constexpr int kRow = 32;  // the unknowns, padded
  using Row = Eigen::Matrix<float, kRow, 1>;
  PixelBlocks pixels_;
  std::vector<SeenLevels> levels_;  // of the pixels, as the fit stands
  std::vector<float> residuals_, light_, sorted_;
  // What each pixel's light depends on, linearly: bias and gain as they vary over the marker.
  std::vector<Eigen::Matrix<float, DirectUnknowns::kLightTerms, 1>> light_rows_;
  std::vector<Row> edge_gradients_;  // by edge
};

}  // namespace arthronaut::markers
