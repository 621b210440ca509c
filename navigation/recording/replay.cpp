#include "navigation/recording/replay.h"

#include <algorithm>
#include <cmath>

#include "navigation/pipeline/prefetched_source.h"

namespace arthronaut::recording {

namespace {

// Compares what a frame said then with what it says now.
class FrameComparison {
 public:
  FrameComparison(ReplaySummary& summary, double tolerance_mm, double tolerance_deg)
      : summary_(summary), tolerance_mm_(tolerance_mm), tolerance_deg_(tolerance_deg) {}

  void compare(const RecordedFrame& then, const pipeline::FrameResult& now) {
    frame_ = then.index;
    rows_.clear();
    pipeline::append_pose_rows(now, rows_);
    for (const strokes::PoseRow& row : then.poses) compare_pose(row, find(rows_, row.marker_id));
    for (const strokes::PoseRow& row : rows_) {
      if (!find(then.poses, row.marker_id)) differs(pose_of(row.marker_id), "has a pose now and had none");
    }
    compare_tip(then, now);
    compare_guidance(then.guidance, now.guidance);
  }

 private:
  static std::string pose_of(int marker_id) { return "pose of marker " + std::to_string(marker_id); }

  static const strokes::PoseRow* find(const std::vector<strokes::PoseRow>& rows, int marker_id) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.marker_id == marker_id; });
    return row == rows.end() ? nullptr : &*row;
  }

  void compare_pose(const strokes::PoseRow& then, const strokes::PoseRow* now) {
    if (!now) return differs(pose_of(then.marker_id), "had a pose and has none now");
    const geometry::RigidTransform& a = then.camera_from_marker;
    const geometry::RigidTransform& b = now->camera_from_marker;
    amount(pose_of(then.marker_id), (a.translation_mm - b.translation_mm).norm(), "mm",
           summary_.worst_pose_mm);
    amount(pose_of(then.marker_id),
           geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation)), "deg",
           summary_.worst_pose_deg);
  }

  void compare_tip(const RecordedFrame& then, const pipeline::FrameResult& now) {
    if (then.tip_is_valid != now.tip_is_valid) {
      differs("tip", now.tip_is_valid ? "is valid now and was not" : "was valid and is not now");
    } else if (then.tip_is_valid) {
      amount("tip", (then.tip_in_world_mm - now.tip_in_world_mm).norm(), "mm", summary_.worst_tip_mm);
    }
  }

  void compare_guidance(const guidance::GuidanceNumbers& then, const guidance::GuidanceNumbers& now) {
    if (then.state != now.state) {
      differs("guidance", "was \"" + std::string(guidance::to_text(then.state)) + "\" and is \"" +
                              std::string(guidance::to_text(now.state)) + "\" now");
    } else if (then.is_valid()) {
      amount("guidance offset", std::abs(then.axis_to_entry_mm - now.axis_to_entry_mm), "mm",
             summary_.worst_offset_mm);
      amount("guidance depth", std::abs(then.depth_mm - now.depth_mm), "mm", summary_.worst_offset_mm);
      amount("guidance angle", std::abs(then.angle_deg - now.angle_deg), "deg", summary_.worst_angle_deg);
    }
  }

  void amount(const std::string& what, double value, const char* unit, double& worst) {
    worst = std::max(worst, value);
    // Written so that NaN is a difference.
    if (value <= (unit[0] == 'm' ? tolerance_mm_ : tolerance_deg_)) return;
    summary_.differences.push_back({frame_, what, value, unit, ""});
  }

  void differs(const std::string& what, const std::string& detail) {
    summary_.differences.push_back({frame_, what, 0, "", detail});
  }

  ReplaySummary& summary_;
  double tolerance_mm_, tolerance_deg_;
  std::int64_t frame_ = -1;
  std::vector<strokes::PoseRow> rows_;
};

// Gives the pipeline the plans and registrations of the session when their frame has come.
class EventPlayer {
 public:
  EventPlayer(const RecordedSession& session, pipeline::NavigationPipeline& pipeline)
      : session_(session), pipeline_(pipeline) {}

  void play_before(std::int64_t frame) {
    const auto& events = session_.events();
    for (; next_ < events.size() && events[next_].after_frame < frame; ++next_) play(events[next_]);
  }
  void play_rest() {
    for (; next_ < session_.events().size(); ++next_) play(session_.events()[next_]);
  }
  [[nodiscard]] const RecordedSession::PlanChange& plan() const { return plan_; }
  [[nodiscard]] const std::optional<registration::RegistrationSummary>& found() const { return found_; }

 private:
  void play(const SessionEvent& event) {
    if (event.kind == kPlanEvent) {
      plan_ = session_.plan_of(event);
      pipeline_.set_plan(plan_.plan, plan_.planned_length_mm);
    } else if (event.kind == kRegistrationEvent || event.kind == kGivenRegistrationEvent) {
      const registration::RegistrationSummary registration = session_.registration_of(event);
      pipeline_.set_registration(registration);
      if (event.kind == kRegistrationEvent) found_ = registration;
    }
  }

  const RecordedSession& session_;
  pipeline::NavigationPipeline& pipeline_;
  std::size_t next_ = 0;
  RecordedSession::PlanChange plan_;
  std::optional<registration::RegistrationSummary> found_;
};

Eigen::Vector3d centroid(const strokes::Curves& curves) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const strokes::CurvePoint& point : curves) sum += point.position_mm;
  return sum / static_cast<double>(curves.size());
}

// What was registered. curves.csv is rounded; where the recorded poses give the same strokes, they give them
// exactly.
strokes::Curves registered_curves(const RecordedSession& session) {
  const pipeline::PipelineOptions options = session.pipeline_options();
  const tools::Tool* probe = options.tools.find_tool(options.probe_name);
  if (!probe || !probe->tip_mm) return session.curves();
  std::vector<strokes::PoseRow> rows;
  for (const RecordedFrame& frame : session.frames()) {
    rows.insert(rows.end(), frame.poses.begin(), frame.poses.end());
  }
  strokes::Curves curves = strokes::digitise(rows, options.tools, options.bone, options.probe_name);
  return curves.size() == session.curves().size() ? curves : session.curves();
}

void compare_registration(const RecordedSession& session, const EventPlayer& player,
                          const ReplayOptions& options, ReplaySummary& summary) {
  if (!options.bone || !player.found() || session.curves().empty()) return;
  const registration::RegistrationSummary& then = *player.found();
  registration::RegistrationOptions registering;
  registering.seed = options.seed;
  registering.covered = options.covered;
  if (player.plan().plan) registering.target_in_bone_mm = player.plan().plan->entry_mm;
  const auto now = registration::register_curves(*options.bone, registered_curves(session), registering);
  const auto differs = [&](const char* detail) {
    summary.differences.push_back({-1, "registration", 0, "", detail});
  };
  if (then.reliable != now.reliable)
    differs(now.reliable ? "is reliable now and was not" : "was reliable and is not now");
  // registration.json always holds a transform, also where none was found: only a reliable one is worth
  // comparing.
  if (!then.reliable || !now.reliable) return;
  const Eigen::Vector3d target_in_bone =
      registering.target_in_bone_mm.value_or(then.marker_from_bone.inverse() * centroid(session.curves()));
  const double error_mm =
      (then.marker_from_bone * target_in_bone - now.marker_from_bone * target_in_bone).norm();
  summary.registration_mm = error_mm;
  if (error_mm > std::max(options.registration_tolerance_mm, then.predicted_tre_mm)) {
    summary.differences.push_back({-1, "registration at the target", error_mm, "mm", ""});
  }
}

}  // namespace

ReplaySummary replay_session(const RecordedSession& session, const ReplayOptions& options,
                             const std::function<void(long)>& progress) {
  ReplaySummary summary;
  summary.recorded_frames = static_cast<long>(session.frames().size());
  const bool reencoded = session.header().video_is_reencoded;
  FrameComparison comparison(summary, reencoded ? options.reencoded_tolerance_mm : options.tolerance_mm,
                             reencoded ? options.reencoded_tolerance_deg : options.tolerance_deg);
  const auto video = open_recorded_video(session);
  pipeline::PrefetchedSource prefetched(*video);
  pipeline::NavigationPipeline pipeline(session.pipeline_options());
  EventPlayer player(session, pipeline);
  pipeline::FrameResult result;
  auto recorded = session.frames().begin();
  while (const camera::FramePtr frame = prefetched.next()) {
    player.play_before(frame->index);
    pipeline.process(*frame, result);
    recorded = std::find_if(recorded, session.frames().end(),
                            [&](const auto& f) { return f.index == frame->index; });
    if (recorded == session.frames().end()) break;
    comparison.compare(*recorded, result);
    ++summary.replayed_frames;
    if (progress) progress(summary.replayed_frames);
  }
  player.play_rest();
  if (session.was_finished() && summary.replayed_frames < summary.recorded_frames) {
    summary.differences.push_back({-1, "video", 0, "",
                                   "shows " + std::to_string(summary.replayed_frames) + " of " +
                                       std::to_string(summary.recorded_frames) + " recorded frames"});
  }
  compare_registration(session, player, options, summary);
  return summary;
}

}  // namespace arthronaut::recording
