#include "navigation/calibration/fluid_check.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "navigation/calibration/plane_pose.h"
#include "navigation/camera/medium.h"
#include "navigation/markers/planar_pose.h"
#include "planning/files/format.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {
namespace {

using geometry::RigidTransform;

struct FrameErrors {
  std::vector<double> square_px, mm, deg, distance_mm;
};

// One frame under one camera: both markers by themselves, then the ruler as one body.
void add_errors(const RulerSighting& seen, const Ruler& ruler, const camera::CameraModel& model,
                FrameErrors& errors) {
  const auto corners = markers::square_corners_mm(ruler.size_mm);
  const auto first = solve_plane_pose(corners, seen.first_px, model);
  const auto second = solve_plane_pose(corners, seen.second_px, model);
  if (!first || !second) return;
  const RigidTransform off =
      ruler.first_from_second.inverse() * (first->camera_from_plane.inverse() * second->camera_from_plane);
  errors.distance_mm.push_back(
      (first->camera_from_plane.translation_mm - second->camera_from_plane.translation_mm).norm());
  errors.mm.push_back(off.translation_mm.norm());
  errors.deg.push_back(geometry::deg_from_rad(geometry::rotation_angle_rad(off.rotation)));

  std::vector<Eigen::Vector3d> points(corners.begin(), corners.end());
  std::vector<Eigen::Vector2d> pixels(seen.first_px.begin(), seen.first_px.end());
  for (const Eigen::Vector3d& corner : corners) points.push_back(ruler.first_from_second * corner);
  pixels.insert(pixels.end(), seen.second_px.begin(), seen.second_px.end());
  if (const auto whole = refine_pose(points, pixels, model, first->camera_from_plane))
    errors.square_px.push_back(whole->rms_px * whole->rms_px);
}

FrameErrors errors_under(std::span<const RulerSighting> sightings, const Ruler& ruler,
                         const camera::Calibration& calibration, double index, camera::FluidModel fluid) {
  FrameErrors errors;
  for (const RulerSighting& seen : sightings) {
    const camera::CameraModel model(calibration, calibration.lens_angle_rad(seen.mark_angle_deg), index,
                                    fluid);
    add_errors(seen, ruler, model, errors);
  }
  return errors;
}

// The median resists frames with a corner in glare. What no frame can be solved with fits worst of all.
double misfit_px(const FrameErrors& errors) {
  constexpr double kNoFit_px = 1e9;
  return errors.square_px.empty() ? kNoFit_px : std::sqrt(geometry::quantile(errors.square_px, 0.5));
}

FluidCheckSummary::Row row_of(FluidHypothesis hypothesis, const FrameErrors& errors) {
  return {hypothesis,
          errors.square_px.empty() ? -1 : misfit_px(errors),
          geometry::quantile(errors.mm, 0.5, -1),
          geometry::quantile(errors.deg, 0.5, -1),
          geometry::quantile(errors.mm, 0.95, -1),
          geometry::quantile(errors.deg, 0.95, -1)};
}

// Golden section over the working medium's index. The misfit has one valley between air and glass.
double best_index(const std::function<double(double)>& misfit, double low, double high) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = misfit(a), at_b = misfit(b);
  while (high - low > 1e-3) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - ratio * (high - low);
      at_a = misfit(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + ratio * (high - low);
      at_b = misfit(b);
    }
  }
  return 0.5 * (low + high);
}

// The index is looked for in so many frames at most, spread over all: more would tell little and take
// seconds.
constexpr std::size_t kFramesForIndex = 60;

std::vector<RulerSighting> spread(std::span<const RulerSighting> sightings) {
  const std::size_t count = std::min(sightings.size(), kFramesForIndex);
  std::vector<RulerSighting> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(sightings[i * sightings.size() / count]);
  return chosen;
}

// From the curvature of the sum of squares about its least value, over two steps of 0.03. Eight corners a
// frame, six of whose sixteen coordinates the ruler's pose takes up. A frame that fits badly (a corner in
// glare, a pose that went astray) counts as much as three sigmas, no more.
double index_sigma(const std::function<FrameErrors(double)>& under, double index, std::size_t frames) {
  constexpr double kStep = 0.03;
  const double usual = geometry::quantile(under(index).square_px, 0.5);
  if (!(usual > 0)) return -1;
  const auto mean_at = [&](double at) {
    const FrameErrors errors = under(at);
    double sum = 9 * usual * static_cast<double>(frames - errors.square_px.size());
    for (const double square : errors.square_px) sum += std::min(square, 9 * usual);
    return sum / static_cast<double>(frames);
  };
  // Where the steps lead most frames to their limit, smaller ones.
  for (double step = kStep; step > 1e-3; step /= 2) {
    const double least = mean_at(index), below = mean_at(index - step), above = mean_at(index + step);
    if (std::min(below, above) > 4 * usual && step > 2e-3) continue;
    const double curvature = 8 * static_cast<double>(frames) * (below + above - 2 * least) / (step * step);
    return curvature > 0 ? std::sqrt(2 * (0.8 * least) / curvature) : -1;
  }
  return -1;
}

// Whose index the pictures show, where it is not the stated one's.
double shown_index(const FluidCheckSummary& summary, const FluidCheckOptions& options) {
  if (summary.index_sigma < 0 || summary.index_sigma > options.most_index_sigma) return 0;
  if (std::abs(summary.best_index - options.refractive_index) <= options.most_index_error) return 0;
  for (const double index : {camera::kAirIndex, camera::kSalineIndex})
    if (std::abs(summary.best_index - index) <= options.most_index_error) return index;
  return 0;
}

std::vector<std::string> reasons_against(const FluidCheckSummary& summary, const FluidCheckOptions& options) {
  std::vector<std::string> reasons;
  // Before all that follows from it.
  if (summary.shown_index > 0)
    reasons.push_back(
        "the pictures are of " + camera::medium_to_text(summary.shown_index) + ", not of " +
        camera::medium_to_text(options.refractive_index) +
        files::format(" (they show a refractive index of %.2f): is the medium right, and the port flat?",
                      summary.best_index));
  const std::size_t fewest_frames = std::max<std::size_t>(options.fewest_frames, 1);
  if (summary.frame_count < fewest_frames)
    reasons.push_back(files::format("the ruler could be measured in %zu frames only (needs %zu)",
                                    summary.frame_count, fewest_frames));
  if (summary.rows.front().rms_px < 0) return reasons;
  const auto& flat = *std::find_if(
      summary.rows.begin(), summary.rows.end(),
      [](const FluidCheckSummary::Row& row) { return row.hypothesis == FluidHypothesis::FlatPort; });
  if (flat.median_mm > options.most_median_mm || flat.median_deg > options.most_median_deg)
    reasons.push_back(files::format("the ruler comes out wrong by %.2f mm and %.1f degrees", flat.median_mm,
                                    flat.median_deg));
  const auto& best = summary.rows.front();
  if (best.hypothesis != FluidHypothesis::FlatPort && best.rms_px < 0.8 * flat.rms_px)
    reasons.push_back(std::string(to_text(best.hypothesis)) +
                      files::format(" explains the frames better: the ruler fits to %.2f px, not %.2f",
                                    best.rms_px, flat.rms_px));
  if (summary.index_sigma < 0 || summary.index_sigma > options.most_index_sigma)
    reasons.push_back(
        "the ruler was held where the models hardly differ: bring it nearer, tilt it, move it towards the "
        "rim");
  else if (summary.shown_index == 0 &&
           std::abs(summary.best_index - options.refractive_index) > options.most_index_error)
    reasons.push_back(files::format(
        "the pictures look like a refractive index of %.2f, not %.3f: another medium, or a port that "
        "is not flat",
        summary.best_index, options.refractive_index));
  return reasons;
}

}  // namespace

std::string_view to_text(FluidHypothesis hypothesis) {
  switch (hypothesis) {
    case FluidHypothesis::FlatPort:
      return "flat port";
    case FluidHypothesis::FocalRule:
      return "focal length times index";
    case FluidHypothesis::NoRefraction:
      return "no refraction";
  }
  return "unknown";
}

FluidCheckSummary check_fluid(std::span<const RulerSighting> sightings, const Ruler& ruler,
                              const camera::Calibration& calibration, const FluidCheckOptions& options) {
  FluidCheckSummary summary;
  const auto under = [&](double index, camera::FluidModel fluid) {
    return errors_under(sightings, ruler, calibration, index, fluid);
  };
  using camera::FluidModel;
  const FrameErrors stated = under(options.refractive_index, FluidModel::FlatPort);
  summary.frame_count = stated.square_px.size();
  summary.distance_mm = geometry::quantile(stated.distance_mm, 0.5, -1);
  if (!stated.distance_mm.empty())
    summary.distance_spread_mm =
        0.5 * (geometry::quantile(stated.distance_mm, 0.84) - geometry::quantile(stated.distance_mm, 0.16));
  summary.rows = {
      row_of(FluidHypothesis::FlatPort, stated),
      row_of(FluidHypothesis::FocalRule, under(options.refractive_index, FluidModel::FocalRule)),
      row_of(FluidHypothesis::NoRefraction, under(calibration.refractive_index, FluidModel::FlatPort))};
  std::stable_sort(summary.rows.begin(), summary.rows.end(), [](const auto& a, const auto& b) {
    return (a.rms_px < 0 ? 1e9 : a.rms_px) < (b.rms_px < 0 ? 1e9 : b.rms_px);
  });
  if (!sightings.empty()) {
    const std::vector<RulerSighting> chosen = spread(sightings);
    const auto flat_port = [&](double index) {
      return errors_under(chosen, ruler, calibration, index, FluidModel::FlatPort);
    };
    summary.best_index = best_index([&](double index) { return misfit_px(flat_port(index)); }, 1.0, 1.5);
    summary.index_sigma = index_sigma(flat_port, summary.best_index, chosen.size());
  }
  summary.shown_index = shown_index(summary, options);
  summary.reasons = reasons_against(summary, options);
  return summary;
}

}  // namespace arthronaut::calibration
