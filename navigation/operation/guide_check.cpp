#include "navigation/operation/guide_check.h"

namespace arthronaut::operation {

TouchRefusal refusal_of(SteadyTip::Reason reason) {
  return reason == SteadyTip::Reason::TipUnknown ? TouchRefusal::TipUnknown : TouchRefusal::TipMoves;
}

bool GuideCheck::is_same(const Subject& a, const Subject& b) {
  const bool is_same_guide = a.guide.marker_id == b.guide.marker_id && a.guide.size_mm == b.guide.size_mm &&
                             tools::are_same(a.guide.markers, b.guide.markers) &&
                             a.guide.axis->point_mm == b.guide.axis->point_mm &&
                             a.guide.axis->direction == b.guide.axis->direction;
  // A marker that was placed anew changes nothing of the guide.
  return is_same_guide && !registration::mismatch_but_placement(a.of, b.of);
}

void GuideCheck::begin(const pipeline::PipelineOptions& options, const registration::Provenance& now,
                       bool is_live) {
  tip_.clear();
  now_ns_ = held_ns_ = std::numeric_limits<std::int64_t>::min();
  const tools::Tool* const guide = options.tools.find_tool(options.guide_name);
  const auto is_measured = [&] {
    const tools::NominalParts nominal = tools::nominal_parts(*guide);
    return guide->provenance.origin == provenance::Origin::Measured && !nominal.axis && !nominal.end;
  };
  const bool is_asked = is_live && guide != nullptr && guide->axis && !is_measured();
  if (!is_asked) {
    subject_.reset();
    state_ = {};
    return;
  }
  const Subject next{*guide, now};
  if (!subject_ || !is_same(*subject_, next)) state_ = {GuideStanding::Due};
  subject_ = next;
  place_in_frame_ = static_cast<std::size_t>(guide - options.tools.tools.data());
}

void GuideCheck::add(const pipeline::FrameResult& frame) {
  if (!subject_) return;
  now_ns_ = frame.timestamp_ns;
  const double time_s = static_cast<double>(frame.timestamp_ns) * 1e-9;
  std::optional<Eigen::Vector3d> tip_mm;
  if (*place_in_frame_ < frame.tools.size() && frame.tools[*place_in_frame_].world_from_tool.is_valid)
    tip_mm =
        frame.tools[*place_in_frame_].world_from_tool.target_from_source * subject_->guide.axis->point_mm;
  tip_.add(time_s, tip_mm);
}

TouchRefusal GuideCheck::check(const std::optional<Eigen::Vector3d>& control_point_mm,
                               const TouchLimits& limits) {
  if (!subject_) return TouchRefusal::None;
  if (!control_point_mm) return TouchRefusal::NoControlPoint;
  const auto tip_mm = tip_.position_mm();
  if (!tip_mm) return refusal_of(tip_.why_not());
  state_.error_mm = (*tip_mm - *control_point_mm).norm();
  state_.standing =
      state_.error_mm <= limits.max_guide_error_mm ? GuideStanding::Checked : GuideStanding::Off;
  held_ns_ = now_ns_;
  return TouchRefusal::None;
}

void GuideCheck::forget_since(std::int64_t time_ns) {
  const bool was_held = state_.standing == GuideStanding::Checked || state_.standing == GuideStanding::Off;
  if (was_held && held_ns_ > time_ns) state_ = {GuideStanding::Due};
}

void GuideCheck::forget_point() {
  if (state_.standing == GuideStanding::Off) state_ = {GuideStanding::Due};
}

void GuideCheck::trust() {
  if (!state_.may_guide()) state_ = {GuideStanding::Trusted};
}

}  // namespace arthronaut::operation
