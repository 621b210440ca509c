#include "navigation/registration/online/coach.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/registration/verdict/confidence.h"
#include "navigation/registration/verdict/held_by_strokes.h"
#include "planning/files/format.h"

namespace arthronaut::registration {

namespace {

using geometry::cross_matrix;
using geometry::Matrix6d;
using geometry::Vector6d;

constexpr float kPatchSpacing_mm = 4.0f;  // patches are thinned to this
constexpr float kReach_mm = 18.0f;  // from the nearest touched point: the same portal still reaches there
constexpr float kTouchedWithin_mm = 3.0f;
constexpr float kStrokeRadius_mm = 4.0f;   // a stroke of 15 mm stays within this
constexpr double kStrokeMeasurements = 3;  // independent ones, that it makes
constexpr float kSpare_mm = 0.1f;          // beyond a bound, so that rounding drops nothing

double target_error_mm(const Matrix6d& information, const Eigen::Vector3d& arm_mm) {
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -cross_matrix(arm_mm);
  return std::sqrt((move * information.ldlt().solve(move.transpose())).trace());
}

class TouchedBox {
 public:
  explicit TouchedBox(const std::vector<Eigen::Vector3f>& points) {
    for (const Eigen::Vector3f& p : points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
  }
  [[nodiscard]] float distance_mm(const Eigen::Vector3f& p) const {
    return (p - p.cwiseMax(low_).cwiseMin(high_)).norm();
  }

 private:
  Eigen::Vector3f low_ = Eigen::Vector3f::Constant(1e9f), high_ = Eigen::Vector3f::Constant(-1e9f);
};

struct NearSample {
  const SurfaceSample* sample;
  bool may_be_reached;
};

// The parts of the bone within reach of what was touched, each with what a stroke of 15 mm there would do for
// the predicted error at the target.
std::vector<BonePatch> find_patches(const CoachFacts& facts) {
  const SurfaceIndex::Data& bone = facts.bone;
  const RefinedPose& pose = facts.pool.best();
  const WeightedPoints& points = facts.points;
  const Eigen::Vector3d& target_mm = facts.target_mm;
  std::vector<Eigen::Vector3f> touched;
  for (const Eigen::Vector3d& p : points.positions_mm)
    touched.push_back((pose.bone_from_marker * p).cast<float>());
  const Eigen::Vector3d pivot = pose.bone_from_marker * points.centroid_mm;
  const Matrix6d information =
      covariance_about(pose, points, bone, facts.pool.prior(), pivot).ldlt().solve(Matrix6d::Identity());
  const double before_mm = target_error_mm(information, target_mm - pivot);

  // What a stroke within reach may touch, and a little more: most of the bone is further off.
  const Eigen::Vector3f pivot_mm = pivot.cast<float>();
  const TouchedBox touched_box(touched);
  std::vector<NearSample> near;
  for (const SurfaceSample& sample : bone.pairs.samples()) {
    const float far = kReach_mm + 30, away = touched_box.distance_mm(sample.point_mm);
    if (away > kReach_mm + kStrokeRadius_mm + kSpare_mm) continue;
    if ((sample.point_mm - pivot_mm).squaredNorm() < far * far)
      near.push_back({&sample, away < kReach_mm + kSpare_mm});
  }
  std::vector<BonePatch> patches;
  std::vector<const SurfaceSample*> patch_samples;
  for (const NearSample& place : near) {
    if (!place.may_be_reached) continue;
    const SurfaceSample* const sample = place.sample;
    const bool is_new =
        std::none_of(patch_samples.begin(), patch_samples.end(), [&](const SurfaceSample* patch) {
          return (patch->point_mm - sample->point_mm).squaredNorm() < kPatchSpacing_mm * kPatchSpacing_mm &&
                 patch->normal.dot(sample->normal) > 0;
        });
    if (!is_new) continue;
    float nearest = kReach_mm * kReach_mm;
    for (const Eigen::Vector3f& p : touched)
      nearest = std::min(nearest, (p - sample->point_mm).squaredNorm());
    if (nearest >= kReach_mm * kReach_mm) continue;

    BonePatch patch;
    patch.point_in_bone_mm = sample->point_mm.cast<double>();
    patch.normal = sample->normal.cast<double>();
    patch.is_touched = nearest < kTouchedWithin_mm * kTouchedWithin_mm;
    Matrix6d stroke = Matrix6d::Zero();
    int count = 0;
    for (const NearSample& beside : near) {
      const SurfaceSample* const other = beside.sample;
      if ((other->point_mm - sample->point_mm).squaredNorm() > kStrokeRadius_mm * kStrokeRadius_mm) continue;
      Vector6d row;
      row << other->normal.cast<double>(),
          (other->point_mm.cast<double>() - pivot).cross(other->normal.cast<double>());
      stroke += row * row.transpose();
      ++count;
    }
    const double sigma_mm = std::max(pose.model.contact_sigma_mm, 0.1);
    const Matrix6d with_stroke = information + stroke * (kStrokeMeasurements / (count * sigma_mm * sigma_mm));
    patch.gain = std::clamp(1 - target_error_mm(with_stroke, target_mm - pivot) / before_mm, 0.0, 1.0);
    patches.push_back(patch);
    patch_samples.push_back(sample);
  }
  return patches;
}

// "the front and outer side": where a patch faces and lies in the words of the knee; LPS.
std::string describe_place(const BonePatch& patch, const Eigen::Vector3d& touched_centroid_in_bone_mm) {
  constexpr double kBeside_mm = 4.0;
  const Eigen::Vector3d away = patch.point_in_bone_mm - touched_centroid_in_bone_mm;
  // Patient axes: +x left, +y back, +z up.
  static constexpr std::array<std::array<const char*, 2>, 3> kWords{
      {{"to the patient's right", "to the patient's left"},
       {"further to the front", "further to the back"},
       {"nearer to the foot", "nearer to the hip"}}};
  std::string words;
  for (const std::size_t axis : {std::size_t{1}, std::size_t{2}, std::size_t{0}}) {
    const double distance = away[static_cast<int>(axis)];
    if (std::abs(distance) < std::max(kBeside_mm, 0.5 * away.cwiseAbs().maxCoeff())) continue;
    if (!words.empty()) words += " and ";
    words += kWords[axis][distance > 0 ? 1 : 0];
  }
  return words.empty() ? "beside what is drawn" : words;
}

}  // namespace

Coach advise(const OnlineResult& result, const CoachFacts& facts) {
  Coach coach;
  const RegistrationSummary& registration = result.registration;
  if (!registration.has_pose && result.length_mm < kMinLength_mm) {
    coach.missing.push_back(files::format("draw %.0f mm more", std::ceil(kMinLength_mm - result.length_mm)));
  }
  const double length_done = std::min(1.0, result.length_mm / kMinLength_mm);
  coach.missing.insert(coach.missing.end(), registration.reasons.begin(), registration.reasons.end());
  if (!registration.has_pose) {
    coach.progress = 0.3 * length_done;
    return coach;
  }
  const double wanted = facts.agreeing_solutions_wanted,
               agreeing = std::min<double>(wanted, facts.agreeing_solutions);
  if (agreeing < wanted) {
    coach.missing.push_back(
        files::format("draw %.0f mm more, to be sure", (wanted - agreeing) * facts.refine_every_mm));
  }
  const double error_done = std::min(1.0, kMaxError_mm / std::max(registration.predicted_tre_mm, 1e-3));
  coach.progress =
      0.3 * length_done + 0.3 * error_done + 0.2 * agreeing / wanted + (registration.reliable ? 0.2 : 0.0);
  coach.patches = find_patches(facts);
  const auto next = std::max_element(coach.patches.begin(), coach.patches.end(),
                                     [](const BonePatch& l, const BonePatch& r) { return l.gain < r.gain; });
  if (next != coach.patches.end() && next->gain > 0.02) coach.next_patch_in_bone_mm = next->point_in_bone_mm;
  if (result.state == OnlineState::Confirmed) {
    coach.message.clear();
    coach.progress = 1;
  } else if (coach.next_patch_in_bone_mm) {
    const Eigen::Vector3d touched_mm = facts.pool.best().bone_from_marker * facts.points.centroid_mm;
    coach.message = "Draw next " + describe_place(*next, touched_mm) + ".";
  }
  return coach;
}

}  // namespace arthronaut::registration
