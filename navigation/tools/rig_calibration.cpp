#include "navigation/tools/rig_calibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "navigation/tools/grouped_scatter.h"
#include "navigation/tools/rig_problem.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::tools {

namespace {

using geometry::Matrix6d;
using geometry::RigidTransform;
using Outcome = RigSummary::Outcome;

// The wave is compared before and after these moments, as shares of its frames.
constexpr double kMoments[] = {0.25, 0.5, 0.75};
constexpr std::size_t kMostFrames = 1500;       // a longer wave is thinned out
constexpr std::size_t kMostFramesOfPart = 150;  // of what is compared
constexpr std::size_t kLeastFramesOfPart = 15;
constexpr double kChangeSigmas = 5;

void check(const RigOptions& options) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw InvalidInput("rig: " + what);
  };
  require(options.markers.size() >= 2, "a body of several markers has two at least");
  for (std::size_t i = 0; i < options.markers.size(); ++i) {
    const auto& [id, size_mm] = options.markers[i];
    require(size_mm > 0 && std::isfinite(size_mm),
            "the size of marker " + std::to_string(id) + " must be above 0");
    for (std::size_t k = 0; k < i; ++k)
      require(options.markers[k].first != id, "marker " + std::to_string(id) + " is named twice");
  }
  const auto is_reference = [&](const auto& marker) { return marker.first == options.reference_id; };
  require(!options.reference_id || std::any_of(options.markers.begin(), options.markers.end(), is_reference),
          "the reference is none of the body's markers");
  for (const double limit :
       {options.min_step_deg, options.min_cone_deg, options.max_rms_mm, options.max_sigma_mm,
        options.max_sigma_deg, options.min_inlier_share, options.max_change_mm, options.max_change_deg})
    require(limit > 0, "every limit must be above 0");
}

// Which marker of the options stands at which place of the problem, the reference first.
std::vector<std::size_t> order_of(const RigOptions& options) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < options.markers.size(); ++i) {
    order.push_back(i);
    if (options.markers[i].first == options.reference_id) std::swap(order.front(), order.back());
  }
  return order;
}

// The frames in which two or more of the markers are seen.
RigProblem problem_of(std::span<const RigSighting> sightings, const RigOptions& options) {
  const std::vector<std::size_t> order = order_of(options);
  RigProblem problem;
  std::map<int, std::size_t> place_of;
  for (const std::size_t i : order) {
    place_of[options.markers[i].first] = problem.size_mm.size();
    problem.size_mm.push_back(options.markers[i].second);
  }
  for (std::size_t first = 0; first < sightings.size();) {
    std::size_t end = first;
    std::map<std::size_t, RigView> views;  // by marker
    for (; end < sightings.size() && sightings[end].frame == sightings[first].frame; ++end) {
      const auto place = place_of.find(sightings[end].marker_id);
      if (place == place_of.end()) continue;
      RigView view{problem.frame_count(), place->second, sightings[end].camera_from_marker, {}};
      const auto corners_mm = rig_corners_mm(problem.size_mm[view.marker]);
      bool is_in_front = true;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto pixel = rig_project(view.camera_from_marker * corners_mm[k]);
        is_in_front = is_in_front && pixel.has_value();
        view.corners_px[k] = pixel.value_or(Eigen::Vector2d::Zero());
      }
      if (is_in_front) views.emplace(view.marker, view);
    }
    if (views.size() >= 2) {
      problem.time_s.push_back(sightings[first].time_s);
      for (const auto& [marker, view] : views) problem.views.push_back(view);
    }
    first = end;
  }
  return problem;
}

// Frames [first, end) of a problem, thinned out to so many at most.
RigProblem part_of(const RigProblem& whole, std::size_t first, std::size_t end, std::size_t most) {
  RigProblem part;
  part.size_mm = whole.size_mm;
  const std::size_t step = std::max<std::size_t>(1, (end - first + most - 1) / most);
  std::size_t last = whole.frame_count();
  for (const RigView& view : whole.views) {
    if (view.frame < first || view.frame >= end || (view.frame - first) % step != 0) continue;
    if (view.frame != last) part.time_s.push_back(whole.time_s[view.frame]);
    last = view.frame;
    part.views.push_back(view);
    part.views.back().frame = part.frame_count() - 1;
  }
  return part;
}

// Markers that no chain of frames, shared often enough, leads to from the reference.
std::vector<std::size_t> unreached(const RigProblem& problem, int min_shared_frames) {
  const std::size_t count = problem.marker_count();
  std::vector<std::vector<int>> shared(count, std::vector<int>(count, 0));
  for (std::size_t a = 0; a < problem.views.size(); ++a)
    for (std::size_t b = a + 1; b < problem.views.size() && problem.views[b].frame == problem.views[a].frame;
         ++b) {
      ++shared[problem.views[a].marker][problem.views[b].marker];
      ++shared[problem.views[b].marker][problem.views[a].marker];
    }
  std::vector<char> is_reached(count, 0);
  is_reached[0] = 1;
  for (std::size_t round = 0; round < count; ++round)
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b)
        if (is_reached[a] && shared[a][b] >= min_shared_frames) is_reached[b] = 1;
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < count; ++i)
    if (!is_reached[i]) missing.push_back(i);
  return missing;
}

// From where the body was seen, in its own frame, and how it was turned about that: unit directions.
void measure_coverage(const RigSolution& solution, const RigOptions& options, RigSummary& summary) {
  std::vector<RigidTransform> views;
  std::vector<Eigen::Vector3d> directions;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const RigidTransform& pose : solution.camera_from_body) {
    directions.push_back((pose.rotation.conjugate() * -pose.translation_mm).normalized());
    mean += directions.back();
    const bool is_new = std::all_of(views.begin(), views.end(), [&](const RigidTransform& known) {
      return geometry::rotation_angle_rad(known.rotation.conjugate() * pose.rotation) >
             geometry::rad_from_deg(options.min_step_deg);
    });
    if (is_new) views.push_back(pose);
  }
  std::vector<double> angles;
  for (const Eigen::Vector3d& direction : directions)
    angles.push_back(geometry::deg_from_rad(geometry::angle_between_rad(direction, mean)));
  summary.distinct_views = static_cast<int>(views.size());
  summary.cone_deg = geometry::quantile(std::move(angles), 0.9, 0);
}

void fill_places(const RigProblem& problem, const RigSolution& solution, const RigOptions& options,
                 RigSummary& summary) {
  const Eigen::MatrixXd covariance = rig_covariance(problem, solution);
  const std::vector<std::size_t> order = order_of(options);
  summary.places.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    RigSummary::Place& place = summary.places[order[i]];
    place.marker_id = options.markers[order[i]].first;
    place.size_mm = options.markers[order[i]].second;
    place.reference_from_marker = solution.reference_from_marker[i];
    for (const RigView& view : problem.views) place.frame_count += view.marker == i ? 1 : 0;
    if (i == 0) continue;
    const auto first = static_cast<Eigen::Index>(6 * (i - 1));
    place.covariance = covariance.block<6, 6>(first, first);
    const auto largest = [](const Eigen::Matrix3d& part) {
      return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(part).eigenvalues()[2]));
    };
    place.sigma_mm = std::hypot(largest(place.covariance.topLeftCorner<3, 3>()), kSystematic_mm);
    place.sigma_deg = std::hypot(geometry::deg_from_rad(largest(place.covariance.bottomRightCorner<3, 3>())),
                                 kSystematic_deg);
  }
}

// Whether a place is another one before a moment than after it. In words of the largest change.
bool look_for_moved_marker(const RigProblem& problem, const RigOptions& options, RigSummary& summary) {
  const std::vector<std::size_t> order = order_of(options);
  bool has_moved = false;
  double worst = 0;
  for (const double moment : kMoments) {
    const auto at = static_cast<std::size_t>(moment * static_cast<double>(problem.frame_count()));
    const RigProblem parts[] = {part_of(problem, 0, at, kMostFramesOfPart),
                                part_of(problem, at, problem.frame_count(), kMostFramesOfPart)};
    if (std::min(parts[0].frame_count(), parts[1].frame_count()) < kLeastFramesOfPart) continue;
    if (!unreached(parts[0], 1).empty() || !unreached(parts[1], 1).empty()) continue;
    const auto before = solve_rig(parts[0]), after = solve_rig(parts[1]);
    if (!before || !after) continue;
    const Eigen::MatrixXd error = rig_covariance(parts[0], *before) + rig_covariance(parts[1], *after);
    for (std::size_t i = 1; i < order.size(); ++i) {
      const geometry::Vector6d change =
          geometry::log(before->reference_from_marker[i].inverse() * after->reference_from_marker[i]);
      const auto first = static_cast<Eigen::Index>(6 * (i - 1));
      const Matrix6d of_change = error.block<6, 6>(first, first);
      const double mm = change.head<3>().norm(), deg = geometry::deg_from_rad(change.tail<3>().norm());
      const double sigma_mm = std::sqrt(of_change.topLeftCorner<3, 3>().trace());
      const double sigma_deg = geometry::deg_from_rad(std::sqrt(of_change.bottomRightCorner<3, 3>().trace()));
      has_moved = has_moved || mm > std::max(options.max_change_mm, kChangeSigmas * sigma_mm) ||
                  deg > std::max(options.max_change_deg, kChangeSigmas * sigma_deg);
      const double size = std::max(mm / options.max_change_mm, deg / options.max_change_deg);
      if (size <= worst) continue;
      worst = size;
      summary.change_mm = mm;
      summary.change_deg = deg;
      summary.changed_id = options.markers[order[i]].first;
    }
  }
  return has_moved;
}

void refuse(RigSummary& summary, Outcome outcome, std::string reason) {
  if (summary.reasons.empty()) summary.outcome = outcome;
  summary.reasons.push_back(std::move(reason));
}

void judge(const RigProblem& problem, const RigOptions& options, RigSummary& summary) {
  const double share = static_cast<double>(summary.inlier_count) / std::max(1, summary.sighting_count);
  if (share < options.min_inlier_share)
    refuse(summary, Outcome::TooManyOutliers,
           files::format(
               "only %.0f %% of the poses fit one rigid body, at least %.0f %% are needed: did a marker "
               "move on it?",
               100 * share, 100 * options.min_inlier_share));
  if (look_for_moved_marker(problem, options, summary))
    refuse(summary, Outcome::MarkerMoved,
           files::format(
               "marker %d moved on the body during the wave, against the reference, by %.2f mm and %.2f "
               "degrees",
               summary.changed_id, summary.change_mm, summary.change_deg));
  if (summary.distinct_views < options.min_distinct_views || summary.cone_deg < options.min_cone_deg)
    refuse(summary, Outcome::TooFewViews,
           files::format(
               "too little motion: %d distinct views (%d are needed) within a cone of %.1f degrees (%.0f "
               "are needed)",
               summary.distinct_views, options.min_distinct_views, summary.cone_deg, options.min_cone_deg));
  if (summary.rms_mm > options.max_rms_mm)
    refuse(summary, Outcome::ResidualTooLarge,
           files::format(
               "the markers' corners lie %.3f mm from a rigid body's, %.2f mm are allowed: are their sizes "
               "right?",
               summary.rms_mm, options.max_rms_mm));
  for (const RigSummary::Place& place : summary.places)
    if (!(place.sigma_mm <= options.max_sigma_mm && place.sigma_deg <= options.max_sigma_deg))
      refuse(
          summary, Outcome::PlacesUncertain,
          files::format(
              "marker %d is known to %.3f mm and %.2f degrees only, %.2f mm and %.1f degrees are needed: "
              "wave it longer",
              place.marker_id, place.sigma_mm, place.sigma_deg, options.max_sigma_mm, options.max_sigma_deg));
}

}  // namespace

RigSummary calibrate_rig(std::span<const RigSighting> sightings, const RigOptions& options) {
  check(options);
  RigSummary summary;
  RigProblem problem = problem_of(sightings, options);
  const auto finish = [&]() -> RigSummary& {
    if (summary.reasons.empty()) summary.outcome = Outcome::Ok;
    summary.message = summary.reasons.empty() ? "" : summary.reasons.front();
    return summary;
  };
  int seen_count = 0;
  for (const auto& [id, size_mm] : options.markers)
    seen_count += std::any_of(sightings.begin(), sightings.end(),
                              [&, wanted = id](const RigSighting& one) { return one.marker_id == wanted; });
  if (seen_count < 2) {
    refuse(summary, Outcome::TooFewMarkers,
           files::format("of the body's %d markers %d are ever seen",
                         static_cast<int>(options.markers.size()), seen_count));
    return finish();
  }
  const std::vector<std::size_t> order = order_of(options);
  for (const std::size_t missing : unreached(problem, options.min_shared_frames))
    refuse(summary, Outcome::NeverTogether,
           files::format(
               "marker %d is not seen together with the others: in %d frames at least, beside one whose "
               "place follows from them",
               options.markers[order[missing]].first, options.min_shared_frames));
  if (!summary.reasons.empty()) return finish();
  problem = part_of(problem, 0, problem.frame_count(), kMostFrames);
  summary.frame_count = static_cast<int>(problem.frame_count());
  const auto solution = solve_rig(problem);
  if (!solution) {
    refuse(summary, Outcome::NoSolution, "the poses fit no rigid body");
    return finish();
  }
  summary.sighting_count = static_cast<int>(problem.views.size());
  summary.inlier_count =
      static_cast<int>(std::count(solution->is_inlier.begin(), solution->is_inlier.end(), 1));
  summary.rms_mm = rig_rms_mm(problem, *solution);
  measure_coverage(*solution, options, summary);
  fill_places(problem, *solution, options, summary);
  judge(problem, options, summary);
  return finish();
}

}  // namespace arthronaut::tools
