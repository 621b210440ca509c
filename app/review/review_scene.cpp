// The bone of a recorded session at the moment that is looked at, with what was planned, touched and drilled.
#include <algorithm>
#include <span>

#include "app/review/review_view.h"
#include "app/widgets/controls.h"
#include "navigation/operation/touches.h"

namespace arthronaut::review {

namespace {

constexpr scene::Color kDrawnColor{0.85F, 0.88F, 0.92F}, kOffColor{1.0F, 0.44F, 0.36F};

}  // namespace

void ReviewView::draw_scene(const widgets::Ui& ui, const widgets::Rect& area) {
  const SessionReview& review = open_->review;
  if (!model_->has_bone(review.session->header.bone)) return;
  if (open_->shown_frame != open_->playback.frame) {
    show_scene();
    open_->shown_frame = open_->playback.frame;
  }
  pane_.draw(ui, "review.view", area);
  const bool is_femur = review.session->header.bone == bones::BoneKind::Femur;
  ui.log.note_state("review_points", std::to_string(open_->shown_points));
  ui.log.note_state("review_strokes", shows_strokes_alone() ? "alone" : "on the bone");
  if (shows_strokes_alone())
    return widgets::caption(ui, area, widgets::kCaution,
                            "Strokes as they were drawn, without the bone: no registration found it");
  const auto& plan = open_->standing().plan.plan;
  if (is_of_another_surface()) {
    ui.log.note_state("review_bone", "another surface");
    return widgets::caption(
        ui, area, widgets::kCaution,
        std::string(is_femur ? "Femur" : "Tibia") +
            " of now: the session was of another surface, and nothing of it is drawn here");
  }
  ui.log.note_state("review_bone", "the session's");
  const bool shows_drilled = !review.drilled_at(open_->glance().index).empty();
  const std::string planned = !plan ? ""
                              : plan->bundle == norms::Bundle::Whole
                                  ? ". Blue: planned"
                                  : ". Blue: planned " + tunnels::name_of(plan->key());
  widgets::caption(ui, area, widgets::kText,
                   std::string(is_femur ? "Femur" : "Tibia") + planned +
                       (shows_drilled ? ". Banded: achieved" : "") +
                       (open_->shows_off_bone ? ". Red strokes: off the bone" : ""));
}

bool ReviewView::shows_strokes_alone() const {
  return !is_of_another_surface() && !open_->review.has_pose() && !open_->review.session->curves.empty();
}

// Where the strokes lie by this registration; over two hours the same one stands for thousands of frames.
const ReviewView::LaidStrokes& ReviewView::laid_by(
    const std::shared_ptr<const registration::RegistrationSummary>& registration) {
  if (laid_ && laid_->by == registration) return *laid_;
  LaidStrokes& laid = laid_.emplace();
  laid.by = registration;
  const recording::SessionOverview& session = *open_->review.session;
  const auto surface = model_->shared_surface(session.header.bone);
  const geometry::RigidTransform bone_from_marker = registration->marker_from_bone.inverse();
  const double off_mm = operation::TouchLimits{}.max_touch_error_mm;
  for (const strokes::CurvePoint& point : session.curves) {
    const Eigen::Vector3d in_bone_mm = bone_from_marker * point.position_mm;
    const bool is_off = surface != nullptr && std::abs(surface->signed_distance_mm(in_bone_mm)) > off_mm;
    laid.points.push_back({in_bone_mm, is_off});
  }
  return laid;
}

bool ReviewView::is_of_another_surface() const {
  const recording::SessionHeader& header = open_->review.session->header;
  return recording::is_of_another_surface(header, model_->mesh_sha256(header.bone));
}

void ReviewView::show_scene() {
  const SessionReview& review = open_->review;
  const recording::RecordedFrame& frame = open_->timeline().frame(open_->playback.frame);
  const bones::BoneKind bone = review.session->header.bone;
  // What was drawn after the moment that is looked at was not there.
  const auto drawn = review.drawn_until(open_->glance().timestamp_ns);
  open_->shown_points = drawn.size();
  open_->shows_off_bone = false;
  scene::SceneContent content;
  if (shows_strokes_alone()) {
    std::vector<Eigen::Vector3d> points_mm;
    for (const strokes::CurvePoint& point : drawn) points_mm.push_back(point.position_mm);
    scene::add_curve_points(content, points_mm);
    for (auto& line : content.lines) line.color = kDrawnColor;
    if (frame.tip_is_valid) content.balls.push_back({frame.tip_in_world_mm, 2.5, scene::kGuideColor, false});
    return pane_.show(content);
  }
  content.bones.push_back({model_->drawn_mesh(bone), scene::kBoneColor, 1.0});
  if (is_of_another_surface()) return pane_.show(content);
  const Standing& standing = open_->standing();
  const recording::RecordedSession::PlanChange& plan = standing.plan;
  if (plan.plan) scene::add_planned_tunnel(content, *plan.plan, plan.planned_length_mm);
  for (const DrilledTunnel* const drilled : review.drilled_at(frame.index))
    scene::add_achieved_tunnel(content, drilled->achieved.measured, drilled->length_mm);
  if (standing.registration != nullptr && standing.registration->has_pose) {
    const geometry::RigidTransform bone_from_marker = standing.registration->marker_from_bone.inverse();
    std::vector<Eigen::Vector3d> on_bone, off_bone;
    for (const LaidStrokes::Point& point :
         std::span(laid_by(standing.registration).points).first(drawn.size()))
      (point.is_off_bone ? off_bone : on_bone).push_back(point.in_bone_mm);
    scene::add_curve_points(content, on_bone);
    const std::size_t on_bone_lines = content.lines.size();
    scene::add_curve_points(content, off_bone);
    for (std::size_t i = on_bone_lines; i < content.lines.size(); ++i) content.lines[i].color = kOffColor;
    open_->shows_off_bone = !off_bone.empty();
    if (frame.tip_is_valid)
      content.balls.push_back({bone_from_marker * frame.tip_in_world_mm, 2.5, scene::kGuideColor, false});
  }
  if (frame.guidance.is_valid())
    scene::add_guide(content, frame.guidance.guide_point_mm, frame.guidance.guide_direction,
                     frame.guidance.drill ? std::max(frame.guidance.drill->remaining_mm, 5.0)
                                          : std::max(plan.planned_length_mm, 5.0));
  pane_.show(content);
}

}  // namespace arthronaut::review
