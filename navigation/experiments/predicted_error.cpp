#include "navigation/experiments/predicted_error.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "navigation/guidance/guidance.h"
#include "navigation/markers/planar_pose.h"
#include "navigation/simulator/script.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::experiments {

namespace {

using geometry::RigidTransform;
using geometry::TrackedPose;

// One sigma of what is wrong with a set-up.
struct SetupErrors {
  double tip_across_mm, tip_along_mm;  // a narrow cone leaves the shaft's length open
  double axis_point_mm, axis_direction_deg;
  double focal_share, xi, center_px;
};

SetupErrors errors_of(Setup setup) {
  constexpr SetupErrors kCareful{0.06, 0.12, 0.08, 0.15, 0.0008, 0.002, 0.4};
  constexpr SetupErrors kPoor{0.4, 1.0, 0.5, 1.0, 0.008, 0.02, 4};
  const bool poor_tools = setup == Setup::PoorTools || setup == Setup::PoorBoth;
  const bool poor_camera = setup == Setup::PoorCamera || setup == Setup::PoorBoth;
  const SetupErrors& tools = poor_tools ? kPoor : kCareful;
  const SetupErrors& camera = poor_camera ? kPoor : kCareful;
  return {tools.tip_across_mm, tools.tip_along_mm, tools.axis_point_mm, tools.axis_direction_deg,
          camera.focal_share,  camera.xi,          camera.center_px};
}

// Focal length and distortion are correlated, as in every calibration: a long lens with much barrel looks
// like a short one with little in the middle of the picture.
camera::CameraCovariance camera_covariance(const SetupErrors& errors, double focal_px) {
  constexpr double kCorrelation = 0.7;
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << errors.focal_share * focal_px, errors.xi, errors.center_px, errors.center_px, errors.center_px,
      errors.center_px;
  camera::CameraCovariance correlation = camera::CameraCovariance::Identity();
  correlation(0, 1) = correlation(1, 0) = kCorrelation;
  return sigma.asDiagonal() * correlation * sigma.asDiagonal();
}

// What all operations have in common: the phantom and the places at which things are held.
struct Stage {
  Stage() {
    simulation.knee = phantom::make_phantom_knee();
    simulation.camera = simulator::standard_camera();
    simulation.tools = tools::standard_tools();
    simulation.plan = simulation.knee.femoral_tunnel;
    surface = std::make_unique<geometry::Surface>(simulation.knee.femur.mesh);
    staging = simulator::stage_operation(simulation, *surface);
    index = std::make_unique<registration::SurfaceIndex>(simulation.knee.femur.mesh);
    strokes = simulator::scratch_script(simulation, staging);
  }
  simulator::SimulationOptions simulation;  // the truth
  std::unique_ptr<geometry::Surface> surface;
  std::unique_ptr<registration::SurfaceIndex> index;
  simulator::Staging staging;
  simulator::Script strokes;
};

class Operation {
 public:
  Operation(const Stage& stage, const PredictedErrorOptions& options, int number)
      : stage_(stage),
        corner_sigma_px_(options.corner_sigma_px),
        random_(options.seed * 100'003 + static_cast<std::uint64_t>(number)),
        errors_(errors_of(static_cast<Setup>(number % 4))) {
    outcome_.setup = static_cast<Setup>(number % 4);
    make_camera();
    make_tools();
  }

  OperationError run() {
    const auto registration = draw_and_register();
    outcome_.is_reliable = registration.reliable;
    if (registration.has_pose)
      guide(registration);
    else
      outcome_.offset_mm = outcome_.angle_deg = std::numeric_limits<double>::infinity();
    return outcome_;
  }

 private:
  double normal() { return normal_(random_); }
  Eigen::Vector3d normal3() {
    const double x = normal(), y = normal();
    return {x, y, normal()};
  }

  void make_camera() {
    const camera::Calibration& truth = stage_.simulation.camera;
    taken_ = truth;
    taken_.covariance = camera_covariance(errors_, truth.focal_px);
    Eigen::Matrix<double, 6, 1> draw;
    for (int i = 0; i < 6; ++i) draw[i] = normal();
    const Eigen::Matrix<double, 6, 1> error =
        Eigen::LLT<camera::CameraCovariance>(*taken_.covariance).matrixL() * draw;
    taken_.focal_px += error[0];
    taken_.distortion_xi += error[1];
    taken_.principal_point_px += error.segment<2>(2);
    taken_.rotation_center_px += error.segment<2>(4);
  }

  void make_tools() {
    probe_ = simulator::probe_of(stage_.simulation.tools);
    guide_ = simulator::guide_of(stage_.simulation);
    const Eigen::Vector3d shaft = probe_.tip_mm->normalized();
    const Eigen::Vector3d draw = normal3();
    const Eigen::Matrix3d along = shaft * shaft.transpose(), across = Eigen::Matrix3d::Identity() - along;
    *probe_.tip_mm += errors_.tip_across_mm * (across * draw) + errors_.tip_along_mm * (along * draw);
    probe_.tip_covariance_mm2 = errors_.tip_across_mm * errors_.tip_across_mm * across +
                                errors_.tip_along_mm * errors_.tip_along_mm * along;
    const Eigen::Vector3d direction = guide_.axis->direction;
    const Eigen::Matrix3d beside = Eigen::Matrix3d::Identity() - direction * direction.transpose();
    guide_.axis->point_mm += errors_.axis_point_mm * (beside * normal3());
    guide_.axis->direction =
        (direction + geometry::rad_from_deg(errors_.axis_direction_deg) * (beside * normal3())).normalized();
    guide_.axis_point_sigma_mm = errors_.axis_point_mm;
    guide_.axis_direction_sigma_deg = errors_.axis_direction_deg;
  }

  // A marker as the tracker gives it: from noisy corners, through the camera as it is taken to be.
  struct Seen {
    TrackedPose pose;
    guidance::TwistPerCameraError per_camera_error;
  };
  std::optional<Seen> see(const RigidTransform& camera_from_marker, double size_mm, double lens_rad) {
    const double index = stage_.simulation.refractive_index;
    const camera::CameraModel truth(stage_.simulation.camera, lens_rad, index),
        taken(taken_, lens_rad, index);
    markers::Corners corners;
    const auto square = markers::square_corners_mm(size_mm);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const auto pixel = truth.project(camera_from_marker * square[k]);
      if (!pixel) return std::nullopt;
      corners[k] = *pixel + corner_sigma_px_ * Eigen::Vector2d(normal(), normal());
    }
    const auto pose = markers::refine_square_pose(taken, corners, size_mm, camera_from_marker);
    if (!pose) return std::nullopt;
    const auto per_camera_error = guidance::twist_per_camera_error(pose->camera_from_marker, size_mm, taken);
    if (!per_camera_error) return std::nullopt;
    Seen seen;
    seen.pose = {pose->camera_from_marker, 0, true, markers::square_covariance(*pose, corner_sigma_px_)};
    seen.per_camera_error = *per_camera_error;
    return seen;
  }

  struct Both {
    Seen world, tool;
    [[nodiscard]] TrackedPose relative() const { return compose(inverse(world.pose), tool.pose); }
    [[nodiscard]] guidance::TwistPerCameraError per_camera_error() const {
      return guidance::relative_twist_per_camera_error(relative().target_from_source, world.per_camera_error,
                                                       tool.per_camera_error);
    }
  };
  std::optional<Both> see_both(const simulator::Moment& moment, const RigidTransform& bone_from_tool,
                               double tool_size_mm) {
    const RigidTransform camera_from_bone = moment.bone_from_camera.inverse();
    const double lens_rad = stage_.simulation.camera.lens_angle_rad(moment.mark_angle_deg);
    const double world_size_mm = simulator::world_marker_of(stage_.simulation).size_mm;
    const auto world = see(camera_from_bone * stage_.staging.bone_from_world_marker, world_size_mm, lens_rad);
    const auto tool = see(camera_from_bone * bone_from_tool, tool_size_mm, lens_rad);
    if (!world || !tool) return std::nullopt;
    return Both{*world, *tool};
  }

  registration::RegistrationSummary draw_and_register() {
    strokes::Curves curves;
    guidance::BiasSums sums;
    int curve = 0;
    bool touched = false;
    for (const simulator::Moment& moment : stage_.strokes) {
      if (!moment.tip_touches_bone || !moment.bone_from_probe) {
        curve += touched ? 1 : 0;
        touched = false;
        continue;
      }
      touched = true;
      const auto both = see_both(moment, *moment.bone_from_probe, probe_.size_mm);
      if (!both) continue;
      const TrackedPose world_from_probe = both->relative();
      guidance::TipSensitivity tip;
      tip.tip_mm = world_from_probe.target_from_source * *probe_.tip_mm;
      tip.per_tip_error = world_from_probe.target_from_source.matrix();
      Eigen::Matrix<double, 3, 6> move;
      move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(tip.tip_mm);
      tip.per_camera_error = move * both->per_camera_error();
      sums.add(tip);
      curves.push_back({curve, std::nullopt, tip.tip_mm});
      note_tip(moment, world_from_probe, tip);
    }
    known_.camera = *taken_.covariance;
    known_.probe_tip_mm2 = tools::tip_error_mm2(probe_);
    known_.registration = sums.bias();
    registration::RegistrationOptions options;
    options.target_in_bone_mm = options.plan_entry_in_bone_mm = stage_.simulation.plan.entry_mm;
    return registration::register_curves(*stage_.index, curves, options);
  }

  void note_tip(const simulator::Moment& moment, const TrackedPose& world_from_probe,
                const guidance::TipSensitivity& tip) {
    const Eigen::Vector3d& in_probe = *probe_.tip_mm;
    const Eigen::Vector3d truth =
        stage_.staging.bone_from_world_marker.inverse() *
        (*moment.bone_from_probe * *simulator::probe_of(stage_.simulation.tools).tip_mm);
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(in_probe);
    jacobian = world_from_probe.target_from_source.matrix() * jacobian;
    const Eigen::Matrix3d covariance =
        jacobian * world_from_probe.covariance * jacobian.transpose() +
        tip.per_tip_error * tools::tip_error_mm2(probe_) * tip.per_tip_error.transpose() +
        tip.per_camera_error * *taken_.covariance * tip.per_camera_error.transpose();
    outcome_.tip_mm = (tip.tip_mm - truth).norm();
    outcome_.predicted_tip_mm = std::sqrt(covariance.trace());
  }

  void guide(const registration::RegistrationSummary& registration) {
    tunnels::Tunnel aim = stage_.simulation.plan;
    aim.entry_mm += 1.0 * normal3();
    aim.direction = (aim.direction + geometry::rad_from_deg(3) * normal3()).normalized();
    const simulator::Script script = simulator::drill_script(stage_.simulation, stage_.staging, aim, 30);
    const simulator::Moment& moment = script[script.size() / 2];
    const auto both = see_both(moment, *moment.bone_from_guide, guide_.size_mm);
    if (!both) throw InvalidInput("the guide is not in view: the stage does not suit this experiment");

    registration::RegistrationSummary forced = registration;
    forced.reliable = true;  // what is predicted of a doubted one is judged too
    guidance::GuidanceInput input;
    input.plan = &stage_.simulation.plan;
    input.registration = &forced;
    input.axes = landmarks::scanner_axes(stage_.simulation.knee.side);
    input.camera_from_world_marker = both->world.pose;
    input.camera_from_guide = both->tool.pose;
    input.axis = &*guide_.axis;
    const guidance::GuidanceNumbers plain = guidance::compute_guidance(input);
    input.known_errors = &known_;
    input.axis_error = tools::axis_error(guide_);
    input.world_marker_per_camera_error = both->world.per_camera_error;
    input.guide_per_camera_error = both->tool.per_camera_error;
    const guidance::GuidanceNumbers said = guidance::compute_guidance(input);

    // The same with nothing wrong.
    registration::RegistrationSummary exact;
    exact.has_pose = exact.reliable = true;
    exact.marker_from_bone = stage_.staging.bone_from_world_marker.inverse();
    input.registration = &exact;
    input.camera_from_world_marker.target_from_source = RigidTransform{};
    input.camera_from_guide.target_from_source = exact.marker_from_bone * *moment.bone_from_guide;
    input.axis = &*simulator::guide_of(stage_.simulation).axis;
    const guidance::GuidanceNumbers truth = guidance::compute_guidance(input);
    outcome_.offset_mm = std::hypot(said.offset_anterior_mm - truth.offset_anterior_mm,
                                    said.offset_proximal_mm - truth.offset_proximal_mm,
                                    said.offset_lateral_mm - truth.offset_lateral_mm);
    outcome_.angle_deg =
        geometry::deg_from_rad(geometry::angle_between_rad(said.guide_direction, truth.guide_direction));
    outcome_.predicted_offset_mm = said.sigma_offset_mm;
    outcome_.predicted_angle_deg = said.sigma_angle_deg;
    outcome_.plain_offset_mm = plain.sigma_offset_mm;
    outcome_.plain_angle_deg = plain.sigma_angle_deg;
  }

  const Stage& stage_;
  double corner_sigma_px_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  SetupErrors errors_;
  camera::Calibration taken_;
  tools::Tool probe_, guide_;
  guidance::KnownErrors known_;
  OperationError outcome_;
};

template <typename Chosen>
ErrorRatios ratios_of(const std::vector<OperationError>& operations, const Chosen& chosen) {
  std::vector<double> offset, angle, tip, plain_offset, plain_angle, offset_mm, angle_deg;
  int above_offset = 0, above_angle = 0;
  for (const OperationError& o : operations) {
    if (!chosen(o)) continue;
    offset.push_back(o.offset_mm / o.predicted_offset_mm);
    angle.push_back(o.angle_deg / o.predicted_angle_deg);
    tip.push_back(o.tip_mm / o.predicted_tip_mm);
    plain_offset.push_back(o.offset_mm / o.plain_offset_mm);
    plain_angle.push_back(o.angle_deg / o.plain_angle_deg);
    offset_mm.push_back(o.offset_mm);
    angle_deg.push_back(o.angle_deg);
    above_offset += offset.back() > 2 ? 1 : 0;
    above_angle += angle.back() > 2 ? 1 : 0;
  }
  ErrorRatios ratios;
  ratios.count = static_cast<int>(offset.size());
  const double count = std::max(ratios.count, 1);
  ratios.offset = geometry::median(offset);
  ratios.angle = geometry::median(angle);
  ratios.tip = geometry::median(tip);
  ratios.plain_offset = geometry::median(plain_offset);
  ratios.plain_angle = geometry::median(plain_angle);
  ratios.median_offset_mm = geometry::median(offset_mm);
  ratios.median_angle_deg = geometry::median(angle_deg);
  ratios.offset_above_two = above_offset / count;
  ratios.angle_above_two = above_angle / count;
  return ratios;
}

}  // namespace

const char* to_text(Setup setup) {
  switch (setup) {
    case Setup::Careful:
      return "careful";
    case Setup::PoorTools:
      return "poor tools";
    case Setup::PoorCamera:
      return "poor camera";
    case Setup::PoorBoth:
      return "poor tools and camera";
  }
  return "unknown";
}

ErrorRatios PredictedErrorResult::all() const {
  return ratios_of(operations, [](const OperationError&) { return true; });
}

ErrorRatios PredictedErrorResult::of(Setup setup) const {
  return ratios_of(operations, [&](const OperationError& o) { return o.setup == setup; });
}

PredictedErrorResult run_predicted_error(const PredictedErrorOptions& options,
                                         const std::function<void(int)>& progress) {
  if (options.operation_count < 1) throw InvalidInput("predicted error: operation_count must be above 0");
  if (!(options.corner_sigma_px > 0)) throw InvalidInput("predicted error: corner_sigma_px must be above 0");
  const Stage stage;
  PredictedErrorResult result;
  for (int i = 0; i < options.operation_count; ++i) {
    result.operations.push_back(Operation(stage, options, i).run());
    if (progress) progress(i + 1);
  }
  return result;
}

void write_predicted_error_table(const std::filesystem::path& file, const PredictedErrorResult& result) {
  std::string text =
      "operation,setup,reliable,offset_mm,predicted_offset_mm,plain_offset_mm,angle_deg,predicted_angle_deg,"
      "plain_angle_deg,tip_mm,predicted_tip_mm\n";
  for (std::size_t i = 0; i < result.operations.size(); ++i) {
    const OperationError& o = result.operations[i];
    text +=
        files::format("%zu,%s,%d,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f\n", i, to_text(o.setup),
                      o.is_reliable ? 1 : 0, o.offset_mm, o.predicted_offset_mm, o.plain_offset_mm,
                      o.angle_deg, o.predicted_angle_deg, o.plain_angle_deg, o.tip_mm, o.predicted_tip_mm);
  }
  files::write_atomically(file, text);
}

}  // namespace arthronaut::experiments
