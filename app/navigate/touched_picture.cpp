#include "app/navigate/touched_picture.h"

#include <algorithm>

#include "app/navigate/registration_words.h"

namespace arthronaut::navigate {

namespace {

constexpr std::size_t kMostPoints = 600;  // more would look the same
constexpr double kThin_mm = 0.7, kThick_mm = 1.1, kThickest_mm = 1.5, kSelectedBy_mm = 0.8;

struct Pen {
  scene::Color color;
  double diameter_mm;
  bool operator==(const Pen&) const = default;
};

Pen pen_of(double residual_mm, bool is_excluded, bool is_sure) {
  if (is_excluded) return {kExcludedColor, kThin_mm};
  switch (severity_of_residual(residual_mm)) {
    case widgets::Severity::Good:
      return {is_sure ? scene::kCurveColor : kDrawnColor, kThin_mm};
    case widgets::Severity::Caution:
      return {kDoubtColor, kThick_mm};
    default:
      return {kOffColor, kThickest_mm};
  }
}

}  // namespace

void TouchedPicture::add_strokes(scene::SceneContent& content, const operation::RegistrationState& state,
                                 const geometry::Surface& surface, int selected_curve) {
  const registration::RegistrationSummary* pose = nullptr;
  bool is_sure = false;
  const operation::RegistrationPtr& in_force = state.in_force.registration;
  if (in_force != nullptr && in_force->has_pose && state.in_force.standing != operation::Standing::Void) {
    pose = in_force.get();
    is_sure = state.in_force.standing == operation::Standing::Stands;
  } else if (state.online != nullptr && state.online->registration.has_pose) {
    pose = &state.online->registration;
    is_sure = state.online->state == registration::OnlineState::Confirmed;
  }
  if (pose == nullptr) return;
  const geometry::RigidTransform& marker_from_bone = pose->marker_from_bone;
  if (drawn_ != state.drawn || marker_from_bone.translation_mm != marker_from_bone_.translation_mm ||
      marker_from_bone.rotation.coeffs() != marker_from_bone_.rotation.coeffs()) {
    drawn_ = state.drawn;
    marker_from_bone_ = marker_from_bone;
    points_.clear();
    const geometry::RigidTransform bone_from_marker = marker_from_bone.inverse();
    const std::size_t stride = drawn_->size() / kMostPoints + 1;
    for (std::size_t i = 0; i < drawn_->size(); i += stride) {
      const Eigen::Vector3d in_bone_mm = bone_from_marker * (*drawn_)[i].position_mm;
      // A line needs no more than a point every 0.3 mm; nearer ones show the tip's noise.
      const bool goes_on = !points_.empty() && points_.back().curve == (*drawn_)[i].curve;
      if (goes_on && (in_bone_mm - points_.back().in_bone_mm).norm() < 0.3) continue;
      points_.push_back({(*drawn_)[i].curve, in_bone_mm, surface.signed_distance_mm(in_bone_mm)});
    }
  }
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point &from = points_[i - 1], &to = points_[i];
    if (from.curve != to.curve) continue;
    Pen pen = pen_of(to.residual_mm, state.excluded.contains(to.curve), is_sure);
    if (to.curve == selected_curve) pen.diameter_mm += kSelectedBy_mm;
    const bool goes_on = i > 1 && points_[i - 2].curve == to.curve && !content.lines.empty() &&
                         content.lines.back().points_mm.back() == from.in_bone_mm &&
                         Pen{content.lines.back().color, content.lines.back().diameter_mm} == pen;
    if (goes_on)
      content.lines.back().points_mm.push_back(to.in_bone_mm);
    else
      content.lines.push_back({{from.in_bone_mm, to.in_bone_mm}, pen.diameter_mm, false, pen.color, true});
  }
}

void add_patches(scene::SceneContent& content, const registration::Coach& coach) {
  // Above the drawn bone, which is coarser than the true one.
  constexpr double kLift_mm = -0.3, kThickness_mm = 1.0, kHelps = 0.02;
  for (const registration::BonePatch& patch : coach.patches) {
    const bool helps = !patch.is_touched && patch.gain > kHelps;
    const scene::Color color = patch.is_touched ? kDrawnColor
                               : helps          ? scene::kAchievedColor
                                                : kExcludedColor;
    const double diameter_mm = patch.is_touched ? 2.0 : helps ? 1.5 + 12 * std::min(patch.gain, 0.2) : 1.0;
    const Eigen::Vector3d foot = patch.point_in_bone_mm + kLift_mm * patch.normal;
    content.rods.push_back(
        {foot, foot + kThickness_mm * patch.normal, diameter_mm, diameter_mm, color, false});
  }
}

}  // namespace arthronaut::navigate
