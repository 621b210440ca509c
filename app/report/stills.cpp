#include "app/report/stills.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "app/report/session_rows.h"
#include "app/scene/image.h"
#include "app/scene/overlay_picture.h"
#include "app/scene/plan_overlay.h"
#include "app/scene/tool_clearance.h"
#include "navigation/recording/counting_registration.h"
#include "navigation/recording/of_drilled.h"
#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/told_events.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::report {

namespace {

constexpr int kStill_px = 560;

struct Moment {
  std::size_t frame = 0;  // its place in the session
  std::string caption;
};

// What guidance was computed from at a frame.
struct InForce {
  recording::RecordedSession::PlanChange plan;
  std::optional<registration::RegistrationSummary> registration;
};

InForce in_force(const recording::RecordedSession& session, std::int64_t frame_index) {
  InForce at;
  for (const recording::SessionEvent& event : session.events()) {
    if (event.after_frame >= frame_index) break;
    if (event.kind == recording::kPlanEvent) at.plan = session.plan_of(event);
    if (recording::is_registration(event))
      at.registration = registrations_of(session)(event);  // one that cannot be read is drawn by nowhere
    if (event.kind == recording::kVoidEvent) at.registration.reset();
  }
  return at;
}

// Of a world marker or a tool, as far as the picture shows it; of one of several markers, of all of them.
template <typename MarkerOrTool>
std::optional<geometry::RigidTransform> camera_from(const MarkerOrTool& declared,
                                                    const recording::RecordedFrame& frame) {
  if (!frame.intrinsics_are_known || frame.is_frozen) return std::nullopt;
  for (const auto& body : frame.bodies)
    if (body.id == declared.marker_id) return body.camera_from_body;
  if (!declared.markers.empty()) return std::nullopt;
  for (const auto& pose : frame.poses)
    if (pose.marker_id == declared.marker_id) return pose.camera_from_marker;
  return std::nullopt;
}

std::optional<geometry::RigidTransform> camera_from_world(const pipeline::PipelineOptions& options,
                                                          const recording::RecordedFrame& frame) {
  const auto* world = options.tools.find_world_marker(options.bone);
  return world == nullptr ? std::nullopt : camera_from(*world, frame);
}

// Where the bone was seen first by the pose that counts, whatever the verdict became later; where nobody saw
// it by that one, as by the last pose of a session whose pictures have ended, by the newest that was seen.
std::optional<std::size_t> registered_in(const recording::RecordedSession& session,
                                         const pipeline::PipelineOptions& options) {
  recording::CountingRegistration registration;
  for (const recording::SessionEvent& event : session.events()) registration.follow(event);
  auto poses = recording::poses_in_force(session.events(), registrations_of(session));
  std::reverse(poses.begin(), poses.end());
  std::stable_partition(poses.begin(), poses.end(), [&](const recording::PoseInForce& pose) {
    return std::find(pose.files.begin(), pose.files.end(), registration.counts().file) != pose.files.end();
  });
  const auto& frames = session.frames();
  for (const recording::PoseInForce& pose : poses)
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (frames[i].index > pose.after_frame &&
          frames[i].index <= pose.until_frame.value_or(frames[i].index) &&
          camera_from_world(options, frames[i]))
        return i;
  return std::nullopt;
}

// Registered: as above. Closest: the least distance of the
// guide's axis from the entry, an angle of one degree counted as half a millimetre (as far as it leads astray
// over 30 mm of bone). Drilled: the last frame before the event in which the guide was seen.
std::vector<Moment> key_moments(const recording::RecordedSession& session,
                                const pipeline::PipelineOptions& options) {
  const auto& frames = session.frames();
  recording::OfDrilled<std::int64_t> drilled_in;
  for (const recording::SessionEvent& event : session.events()) drilled_in.follow(event, event.after_frame);
  const std::int64_t drilled_after = drilled_in.newest() != nullptr ? *drilled_in.newest() : -1;
  const std::optional<std::size_t> registered = registered_in(session, options);
  std::optional<std::size_t> closest, drilled;
  const auto miss = [&](std::size_t i) {
    return frames[i].guidance.axis_to_entry_mm + 0.5 * frames[i].guidance.angle_deg;
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].guidance.is_valid()) continue;
    if (!closest || miss(i) < miss(*closest)) closest = i;
    if (frames[i].index <= drilled_after) drilled = i;
  }
  const auto clock = [&](std::size_t i) {
    return recording::clock_text(time_s(session, frames[i].timestamp_ns));
  };
  std::vector<Moment> moments;
  if (registered) moments.push_back({*registered, clock(*registered) + ": registered"});
  if (closest)
    moments.push_back({*closest, clock(*closest) + files::format(": aimed closest, %.1f mm, %.1f\u00B0",
                                                                 frames[*closest].guidance.axis_to_entry_mm,
                                                                 frames[*closest].guidance.angle_deg)});
  if (drilled) moments.push_back({*drilled, clock(*drilled) + ": drilled"});
  return moments;
}

// The square about the round view.
scene::FrameCut cut_of(const recording::RecordedFrame& frame, const camera::Calibration& calibration) {
  const camera::Boundary& view = frame.lens.circle.radius_px > 1 ? frame.lens.circle : calibration.boundary;
  const double half_px = view.radius_px > 1 ? view.radius_px : 0.5 * calibration.image_size_px.minCoeff();
  const Eigen::Vector2d middle =
      view.radius_px > 1 ? view.center_px : (0.5 * calibration.image_size_px.cast<double>()).eval();
  return {middle - Eigen::Vector2d::Constant(half_px), 2 * half_px / kStill_px};
}

// The mean of the pixels below each of the still's; black beyond the picture.
scene::Image still_of(const camera::Frame& frame, const scene::FrameCut& cut) {
  std::vector<std::uint8_t> made;
  const std::vector<std::uint8_t>& bgr = camera::bgr_of(frame, made);
  scene::Image still{kStill_px, kStill_px, std::vector<std::uint8_t>(3UL * kStill_px * kStill_px, 0)};
  const int across = std::max(1, static_cast<int>(std::lround(cut.scale)));
  for (int y = 0; y < kStill_px; ++y) {
    for (int x = 0; x < kStill_px; ++x) {
      const int x0 = static_cast<int>(std::floor(cut.corner_px.x() + x * cut.scale)),
                y0 = static_cast<int>(std::floor(cut.corner_px.y() + y * cut.scale));
      std::array<int, 3> sum{};
      for (int dy = 0; dy < across; ++dy)
        for (int dx = 0; dx < across; ++dx) {
          if (x0 + dx < 0 || y0 + dy < 0 || x0 + dx >= frame.width || y0 + dy >= frame.height) continue;
          const std::size_t from =
              3 * (static_cast<std::size_t>(y0 + dy) * static_cast<std::size_t>(frame.width) +
                   static_cast<std::size_t>(x0 + dx));
          for (std::size_t c = 0; c < 3; ++c) sum.at(c) += bgr[from + 2 - c];
        }
      const std::size_t to = 3 * (static_cast<std::size_t>(y) * kStill_px + static_cast<std::size_t>(x));
      for (std::size_t c = 0; c < 3; ++c)
        still.rgb[to + c] = static_cast<std::uint8_t>(sum.at(c) / (across * across));
    }
  }
  return still;
}

class Drawer {
 public:
  explicit Drawer(const Content& content)
      : session_(*content.session), options_(session_.pipeline_options()) {
    const auto bone = content.knee.bones.find(session_.header().bone);
    if (bone == content.knee.bones.end() || content.is_of_another_surface) return;
    mesh_ = &bone->second.mesh;
    surface_ = std::make_shared<geometry::Surface>(*mesh_);
  }

  // Without a picture where the video has none of this frame.
  std::optional<scene::Image> still(recording::RecordedPictures& pictures, std::size_t place) {
    const recording::RecordedFrame& frame = session_.frames().at(place);
    const camera::FramePtr picture = pictures.picture(frame.index, frame.timestamp_ns);
    if (picture == nullptr) return std::nullopt;
    const scene::FrameCut cut = cut_of(frame, options_.calibration);
    scene::Image still = still_of(*picture, cut);
    const InForce at = in_force(session_, frame.index);
    const auto pose = camera_from_world(options_, frame);
    if (!pose || surface_ == nullptr || !at.registration || !at.registration->has_pose) return still;
    const scene::OverlayModel overlay(surface_, *mesh_, at.plan.plan, at.plan.planned_length_mm);
    const camera::CameraModel camera = camera_at(place);
    // As over the live picture: what is done with a tool is seen, no line lies over it.
    const auto clear = scene::clear_discs_of(
        camera, options_.tools, [&frame](const tools::Tool& tool) { return camera_from(tool, frame); });
    scene::draw_overlay(still, overlay.project(camera, *pose * at.registration->marker_from_bone, clear),
                        cut);
    return still;
  }
  [[nodiscard]] bool has_overlay() const { return surface_ != nullptr; }

 private:
  // As the tracker has it: the lens' angle counts from the first mark on.
  [[nodiscard]] camera::CameraModel camera_at(std::size_t place) const {
    const auto& frames = session_.frames();
    const bool is_known =
        options_.follow_lens &&
        std::any_of(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(place) + 1,
                    [](const auto& frame) { return frame.lens.mark == lens::MarkState::Found; });
    const double angle_rad =
        is_known ? options_.calibration.lens_angle_rad(frames[place].lens.mark_angle_deg) : 0;
    return {options_.calibration, angle_rad, options_.refractive_index, options_.fluid_model};
  }

  const recording::RecordedSession& session_;
  pipeline::PipelineOptions options_;
  const geometry::TriangleMesh* mesh_ = nullptr;
  std::shared_ptr<const geometry::Surface> surface_;
};

}  // namespace

Stills take_stills(const Content& content) {
  constexpr const char* kUnreadable =
      "The session's video is not there, or cannot be read: there are no pictures of it.";
  Stills stills;
  std::size_t wanted = 0;
  Drawer drawer(content);
  stills.has_overlay = drawer.has_overlay();
  try {
    if (content.session->video().empty()) {
      stills.why_none = "The session keeps no video: there are no pictures of it.";
      return stills;
    }
    recording::RecordedPictures pictures(recording::read_overview(content.session->folder()));
    const auto moments = key_moments(*content.session, content.session->pipeline_options());
    wanted = moments.size();
    for (const Moment& moment : moments)
      if (auto still = drawer.still(pictures, moment.frame))
        stills.pictures.emplace_back(moment.caption, std::move(*still));
    if (stills.pictures.empty())
      stills.why_none = "The session's video has no picture of a registered bone or an aimed guide.";
  } catch (const InvalidInput&) {  // its words name the video's file, which is often the patient's name
    stills.why_none = kUnreadable;
  } catch (const IoError&) {
    stills.why_none = kUnreadable;
  }
  stills.is_one_missing = stills.pictures.size() < wanted;
  return stills;
}

void draw_stills_section(FlowingPages& pages, const Stills& stills) {
  constexpr double kGap_mm = 4, kWidth_mm = (FlowingPages::kWidthMm - 2 * kGap_mm) / 3;
  constexpr TextStyle kCaption{.size_pt = 8, .bold = false, .ink = kGray};
  pages.heading("Pictures of the session, with the plan", stills.pictures.empty() ? 6 : kWidth_mm + 6);
  if (stills.pictures.empty()) return pages.sentence(stills.why_none, kCaption);
  double x_mm = pages.left_mm();
  const double y_mm = pages.y_mm() + 2;
  for (const auto& [caption, still] : stills.pictures) {
    pages.pdf().image(x_mm, y_mm, kWidth_mm, still.rgb, still.width, still.height);
    pages.pdf().text(x_mm, y_mm + kWidth_mm + 3.5, caption, kCaption);
    x_mm += kWidth_mm + kGap_mm;
  }
  pages.skip(kWidth_mm + 6);
  if (stills.is_one_missing)
    pages.sentence(
        "A picture is missing: the session's video has none of that moment, or cannot be read there.",
        kCaption);
  if (!stills.has_overlay)
    pages.sentence("No plan is drawn on them: the case's bone is another than the session's.", kCaption);
}

}  // namespace arthronaut::report
