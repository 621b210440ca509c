#include "navigation/recording/replay.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/pipeline/prefetched_source.h"
#include "navigation/recording/cut_short.h"
#include "navigation/recording/event_comparison.h"
#include "navigation/recording/rerun.h"
#include "navigation/recording/session_overview.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"

namespace arthronaut::recording {

namespace {

// What guidance says in a frame, each by its name; limits are those of the summary's tolerances.
template <typename Of>
struct Number {
  const char* name;
  double Of::*value;
  const char* unit;
};
constexpr std::array kGuideNumbers = {
    Number{"guidance offset", &guidance::GuidanceNumbers::axis_to_entry_mm, "mm"},
    Number{"guidance offset, anterior", &guidance::GuidanceNumbers::offset_anterior_mm, "mm"},
    Number{"guidance offset, proximal", &guidance::GuidanceNumbers::offset_proximal_mm, "mm"},
    Number{"guidance tip to entry", &guidance::GuidanceNumbers::tip_to_entry_mm, "mm"},
    Number{"guidance depth", &guidance::GuidanceNumbers::depth_mm, "mm"},
    Number{"guidance angle", &guidance::GuidanceNumbers::angle_deg, "deg"},
    Number{"guidance sigma of offset", &guidance::GuidanceNumbers::sigma_offset_mm, "mm"},
    Number{"guidance sigma of angle", &guidance::GuidanceNumbers::sigma_angle_deg, "deg"}};
constexpr std::array kDrillNumbers = {Number{"drill depth", &guidance::DrillDepth::depth_mm, "mm"},
                                      Number{"drill remaining", &guidance::DrillDepth::remaining_mm, "mm"},
                                      Number{"drill to exit", &guidance::DrillDepth::to_exit_mm, "mm"},
                                      Number{"drill sigma of depth", &guidance::DrillDepth::sigma_mm, "mm"}};
constexpr std::array kDrillPlaceNumbers = {
    Number{"drill lateral", &guidance::DrillDepth::lateral_mm, "mm"},
    Number{"drill sigma of offset", &guidance::DrillDepth::sigma_offset_mm, "mm"},
    Number{"drill sigma of angle", &guidance::DrillDepth::sigma_angle_deg, "deg"}};

constexpr Number kDrillExit{"drill lateral at the exit", &guidance::DrillDepth::exit_lateral_mm, "mm"};

// Compares what a frame said then with what it says now.
class FrameComparison {
 public:
  FrameComparison(ReplaySummary& summary, double tolerance_mm, double tolerance_deg)
      : summary_(summary), tolerance_mm_(tolerance_mm), tolerance_deg_(tolerance_deg) {}

  void compare(const RecordedFrame& then, const pipeline::FrameResult& now) {
    compare_poses(then, now);
    compare_tip(then, now);
    compare_guidance(then.guidance, now.guidance);
  }

  void compare_poses(const RecordedFrame& then, const pipeline::FrameResult& now) {
    frame_ = then.index;
    rows_.clear();
    pipeline::append_pose_rows(now, rows_);
    for (const strokes::PoseRow& row : then.poses) compare_pose(row, find(rows_, row.marker_id));
    for (const strokes::PoseRow& row : rows_) {
      if (!find(then.poses, row.marker_id)) differs(pose_of(row.marker_id), "has a pose now and had none");
    }
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
      for (const Number<guidance::GuidanceNumbers>& number : kGuideNumbers) compare_number(number, then, now);
      compare_axis("guide", then.guide_point_mm, then.guide_direction, now.guide_point_mm,
                   now.guide_direction);
      // What was recorded before there was this third component holds none.
      if (then.offset_lateral_mm != 0)
        compare_number({"guidance offset, lateral", &guidance::GuidanceNumbers::offset_lateral_mm, "mm"},
                       then, now);
    }
    compare_drill(then.drill, now.drill);
  }

  void compare_drill(const std::optional<guidance::DrillDepth>& then,
                     const std::optional<guidance::DrillDepth>& now) {
    if (then.has_value() != now.has_value()) {
      differs("drill", now ? "is seen now and was not" : "was seen and is not now");
    } else if (then) {
      for (const Number<guidance::DrillDepth>& number : kDrillNumbers) compare_number(number, *then, *now);
      // Older records hold nothing of where the drill was.
      if (!std::isfinite(then->lateral_mm)) return;
      for (const Number<guidance::DrillDepth>& number : kDrillPlaceNumbers)
        compare_number(number, *then, *now);
      if (std::isfinite(then->exit_lateral_mm)) compare_number(kDrillExit, *then, *now);
      if (then->marker_id && then->marker_id != now->marker_id) differs("drill", "is another one now");
      compare_axis("drill", then->tip_mm, then->direction, now->tip_mm, now->direction);
    }
  }

  template <typename Of>
  void compare_number(const Number<Of>& number, const Of& then, const Of& now) {
    const double a = then.*number.value, b = now.*number.value;
    if (std::isnan(a) && std::isnan(b)) return;  // not known, then and now
    amount(number.name, std::abs(a - b), number.unit,
           number.unit[0] == 'm' ? summary_.worst_offset_mm : summary_.worst_angle_deg);
  }

  void compare_axis(const std::string& of, const Eigen::Vector3d& point_then,
                    const Eigen::Vector3d& direction_then, const Eigen::Vector3d& point_now,
                    const Eigen::Vector3d& direction_now) {
    amount(of + "'s point", (point_then - point_now).norm(), "mm", summary_.worst_offset_mm);
    amount(
        of + "'s direction",
        geometry::deg_from_rad(2 * std::asin(std::min(0.5 * (direction_then - direction_now).norm(), 1.0))),
        "deg", summary_.worst_angle_deg);
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

// Where registrations are compared: at the plan's entry, else where the bone was touched, as predicted_tre_mm
// is told. The bone's own origin is the scanner's, which may lie a metre away.
Eigen::Vector3d target_of(const RecordedSession& session, const registration::RegistrationSummary& then,
                          const operation::OperationState& now, const ReplayOptions& options) {
  if (now.plan) return now.plan->tunnel.entry_mm;
  if (session.curves().empty())
    return options.surface != nullptr ? geometry::bounds_of(options.surface->mesh()).center_mm()
                                      : Eigen::Vector3d::Zero().eval();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const strokes::CurvePoint& point : session.curves()) sum += point.position_mm;
  return then.marker_from_bone.inverse() * (sum / static_cast<double>(session.curves().size())).eval();
}

void compare_registration(const RecordedSession& session, const operation::OperationState& now,
                          const ReplayOptions& options, ReplaySummary& summary) {
  const auto then = session.registration();
  const auto& found = now.registration->in_force.registration;
  if (!then && must_hold_registration(session.was_finished(), session.events()))
    summary.differences.push_back({-1, "registration", 0, "", "registration.json is not there any more"});
  if (!options.bone || !then || !session.header().has_journal()) return;
  const bool is_reliable_now = found != nullptr && found->reliable;
  if (then->reliable != is_reliable_now)
    summary.differences.push_back(
        {-1, "registration", 0, "",
         is_reliable_now ? "is reliable now and was not" : "was reliable and is not now"});
  // registration.json always holds a transform, also where none was found: only a reliable one is worth
  // comparing.
  if (!then->reliable || !is_reliable_now) return;
  const Eigen::Vector3d target_in_bone = target_of(session, *then, now, options);
  const double error_mm =
      (then->marker_from_bone * target_in_bone - found->marker_from_bone * target_in_bone).norm();
  summary.registration_mm = error_mm;
  if (error_mm > std::max(options.registration_tolerance_mm, then->predicted_tre_mm))
    summary.differences.push_back({-1, "registration at the target", error_mm, "mm", ""});
}

// The pictures of a session that were kept, each at its frame.
class Pictures {
 public:
  explicit Pictures(const RecordedSession& session) {
    if (session.video().empty()) return;
    try {
      video_ = open_recorded_video(session);
    } catch (const InvalidInput&) {
      // The record itself says that the video ended early: before its first picture, as it seems.
      if (cut_short_in_words(session.was_finished(), session.events()).empty()) throw;
      return;
    }
    prefetched_ = std::make_unique<pipeline::PrefetchedSource>(*video_);
    next_ = prefetched_->next();
  }
  [[nodiscard]] bool has_ended() const { return next_ == nullptr; }
  // Before the first of().
  [[nodiscard]] bool begins_with(const std::vector<RecordedFrame>& frames) const {
    return next_ != nullptr && !frames.empty() && next_->index == frames.front().index;
  }
  // Frames in order; null where none was kept, and from where the video is damaged on.
  [[nodiscard]] camera::FramePtr of(std::int64_t frame) {
    while (next_ != nullptr && next_->index < frame) advance();
    return next_ != nullptr && next_->index == frame ? next_ : nullptr;
  }
  // Why the video could not be read to its end; empty where it could.
  [[nodiscard]] const std::string& damage() const { return damage_; }

 private:
  void advance() {
    next_ = nullptr;
    try {
      next_ = prefetched_->next();
    } catch (const InvalidInput& error) {
      damage_ = error.what();
    } catch (const IoError& error) {
      damage_ = error.what();
    }
  }

  std::string damage_;
  std::unique_ptr<sources::FrameSource> video_, prefetched_;
  camera::FramePtr next_;
};

// Pictures that are tracked again against those that were seen, by their luma: the first that differs is
// told, with how many do. What is wrong with one is wrong with the video, and not with the program.
class PictureComparison {
 public:
  explicit PictureComparison(const RecordedSession& session) {
    if (session.header().video_has_exact_luma) pictures_ = &session.pictures();
  }
  // Frames in order.
  void compare(const camera::Frame& picture) {
    if (pictures_ == nullptr) return;
    while (next_ < pictures_->size() && (*pictures_)[next_].frame < picture.index) ++next_;
    if (next_ == pictures_->size() || (*pictures_)[next_].frame != picture.index) return;
    const KeptPicture& kept = (*pictures_)[next_];
    if (!kept.luma || *kept.luma == digest_of_luma(camera::luma_of(picture, gray_))) return;
    if (other_count_++ == 0) first_other_ = picture.index;
  }
  void add_to(ReplaySummary& summary) const {
    if (other_count_ > 0)
      summary.differences.push_back({first_other_, "picture", 0, "",
                                     "is not the one that was seen; so are " + std::to_string(other_count_) +
                                         " in all: the video was changed, or is decoded differently here"});
  }

 private:
  const std::vector<KeptPicture>* pictures_ = nullptr;  // null: none is to be the same
  std::size_t next_ = 0;
  std::vector<std::uint8_t> gray_;
  long other_count_ = 0;
  std::int64_t first_other_ = -1;
};

// States by their digests: the first that differs is told, with how many do.
class StateComparison {
 public:
  void compare(const RecordedFrame& then, const operation::OperationState& now, bool has_picture) {
    if (!then.digests) return;
    ++compared_;
    const bool is_same = then.digests->decisions == operation::digest_of_decisions(now) &&
                         (!has_picture || then.digests->frame == operation::digest_of_frame(now));
    if (is_same) {
      ++equal_;
    } else if (first_unequal_ < 0) {
      first_unequal_ = then.index;
    }
  }
  void add_to(ReplaySummary& summary) const {
    summary.states_compared = compared_;
    summary.states_equal = equal_;
    if (summary.is_same_build && first_unequal_ >= 0)
      summary.differences.push_back({first_unequal_, "state", 0, "",
                                     "is not the same to the last bit, from here on in " +
                                         std::to_string(compared_ - equal_) + " of " +
                                         std::to_string(compared_) + " frames"});
  }

 private:
  long compared_ = 0, equal_ = 0;
  std::int64_t first_unequal_ = -1;
};

}  // namespace

std::string cold_start_in_words(const ReplaySummary& summary) {
  if (summary.cold_differences == 0) return "";
  return std::to_string(summary.cold_differences) + " of them in poses that were tracked without the " +
         std::to_string(summary.frames_before_pictures) +
         " pictures before, which were not kept; what was decided is compared by the record";
}

ReplaySummary replay_session(const RecordedSession& session, const ReplayOptions& options,
                             const std::function<void(long)>& progress) {
  ReplaySummary summary;
  summary.recorded_frames = static_cast<long>(session.frames().size());
  const bool reencoded = session.header().video_is_reencoded && !session.header().video_has_exact_luma;
  summary.is_lossy = reencoded;
  summary.is_same_build = !reencoded && session.header().build == build_identity();
  const double tolerance_mm = reencoded ? options.reencoded_tolerance_mm : options.tolerance_mm,
               tolerance_deg = reencoded ? options.reencoded_tolerance_deg : options.tolerance_deg;
  FrameComparison comparison(summary, tolerance_mm, tolerance_deg);
  FrameComparison cold_comparison(summary, options.reencoded_tolerance_mm, options.reencoded_tolerance_deg);
  StateComparison states;
  PictureComparison seen(session);
  const auto stops = [&] { return summary.was_stopped = options.stops && options.stops(); };
  const std::vector<RecordedSession> before = sessions_before(session, [&](const std::string& id) {
    summary.differences.push_back({-1, "session before", 0, "", id + " is not there any more"});
  });
  operation::OperationSetup setup = setup_of(before.empty() ? session : before.front());
  setup.surface = options.surface;
  setup.cartilage = options.cartilage;
  Rerun rerun(setup, options.bone != nullptr ? Registrations::FoundAgain : Registrations::NotFollowed,
              options.bone);
  for (const RecordedSession& earlier : before)
    if (!rerun.run(earlier, stops)) return summary;

  Pictures pictures(session);
  // What was tracked depends on every picture before: where the first ones were not kept, tracking begins
  // cold and comes out slightly different. What was decided is then run again from the recorded poses alone.
  const bool is_fed = pictures.begins_with(session.frames());
  std::optional<pipeline::NavigationPipeline> cold;
  if (!is_fed && !pictures.has_ended()) cold.emplace(session.pipeline_options());
  rerun.start(session);
  pipeline::FrameResult cold_result;
  for (const RecordedFrame& recorded : session.frames()) {
    if (stops()) {
      states.add_to(summary);
      return summary;
    }
    const camera::FramePtr picture = pictures.of(recorded.index);
    if (picture != nullptr) seen.compare(*picture);
    rerun.play_before(recorded.index);
    const bool feeds = is_fed && picture != nullptr;
    const operation::OperationStatePtr state =
        feeds ? rerun.process(*picture, recorded) : rerun.process(recorded);
    if (feeds) comparison.compare(recorded, state->frame);
    if (feeds && options.on_frame) options.on_frame(recorded, state->frame);
    if (cold && picture != nullptr) {
      cold->process(*picture, cold_result, &recorded.outside);
      const std::size_t before_count = summary.differences.size();
      cold_comparison.compare_poses(recorded, cold_result);
      summary.cold_differences += static_cast<long>(summary.differences.size() - before_count);
    }
    if (cold && picture == nullptr && summary.replayed_frames == 0) ++summary.frames_before_pictures;
    states.compare(recorded, *state, feeds);
    summary.replayed_frames += picture != nullptr ? 1 : 0;
    summary.frames_without_picture += picture != nullptr ? 0 : 1;
    if (progress) progress(summary.replayed_frames + summary.frames_without_picture);
  }
  rerun.play_rest();
  // A kept video that ends early is a fault of the record; pictures that nobody asked to keep are none.
  const bool is_whole_video = !session.video().empty() && session.pictures().empty();
  if (!pictures.damage().empty()) {
    summary.differences.push_back({-1, "video", 0, "",
                                   files::within_folder(session.folder(), pictures.damage()) + "; " +
                                       std::to_string(summary.replayed_frames) + " of " +
                                       std::to_string(summary.recorded_frames) +
                                       " recorded frames were tracked again"});
  } else if (session.was_finished() && is_whole_video && summary.frames_without_picture > 0) {
    summary.differences.push_back({-1, "video", 0, "",
                                   "shows " + std::to_string(summary.replayed_frames) + " of " +
                                       std::to_string(summary.recorded_frames) + " recorded frames"});
  }
  seen.add_to(summary);
  states.add_to(summary);
  // Without its bone no registration is found again, and nothing that follows from one; records of before the
  // journal hold no decisions.
  if (!options.other_bone.empty()) summary.differences.push_back({-1, "bone", 0, "", options.other_bone});
  if (options.bone != nullptr && session.header().has_journal()) {
    compare_events(session, rerun.journal(), summary);
    compare_achieved(session, rerun.journal(), tolerance_mm, tolerance_deg, summary);
  }
  compare_registration(session, *rerun.state(), options, summary);
  return summary;
}

}  // namespace arthronaut::recording
