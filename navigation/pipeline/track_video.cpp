#include "navigation/pipeline/track_video.h"

#include <algorithm>
#include <chrono>

#include "navigation/pipeline/medium_check.h"
#include "navigation/pipeline/prefetched_source.h"
#include "planning/files/format.h"

namespace arthronaut::pipeline {

namespace {

constexpr std::size_t kStateCount = static_cast<std::size_t>(markers::MarkerState::Disagreeing) + 1;

void add_marker(std::vector<MarkerStatistics>& markers, int id, std::string name) {
  MarkerStatistics statistics;
  statistics.id = id;
  statistics.name = std::move(name);
  statistics.frames_by_loss.assign(kStateCount, 0);
  markers.push_back(std::move(statistics));
}

std::vector<std::string> reasons_of(const TrackedVideo& video) {
  const ViewStatistics& s = video.statistics;
  std::vector<std::string> reasons;
  if (s.frame_count == 0) reasons.emplace_back("the video has no frame");
  if (std::string why = s.reason_of_camera(); !why.empty()) return {std::move(why)};
  if (!video.rows.empty() || s.frame_count == 0) return reasons;
  if (s.frames_with_unknown_lens == s.frame_count) {
    reasons.emplace_back(
        "the lens mark was not seen, so the lens angle and with it the camera are not known");
    return reasons;
  }
  if (2 * s.frames_frozen > s.frame_count) {
    reasons.emplace_back("the picture is frozen: no pose of it is of its moment");
    return reasons;
  }
  reasons.emplace_back("no declared marker was tracked in any frame");
  const auto is_doubtful = [](const MarkerStatistics& m) {
    return m.main_loss == markers::MarkerState::Doubtful;
  };
  if (std::any_of(s.markers.begin(), s.markers.end(), is_doubtful)) {
    reasons.emplace_back(
        "markers were seen, but their corners fit no pose: are camera, medium and sizes right?");
  }
  return reasons;
}

// A pose is in proportion to the size that its marker was taken to have.
void append_sized_rows(const PictureObservation& view, const std::vector<markers::DeclaredMarker>& declared,
                       std::vector<strokes::PoseRow>& rows) {
  const std::size_t before = rows.size();
  append_pose_rows(view, rows);
  for (std::size_t i = before; i < rows.size(); ++i)
    for (const markers::DeclaredMarker& marker : declared)
      if (marker.id == rows[i].marker_id) rows[i].size_mm = marker.size_mm;
}

// Where the medium is contradicted no pose stands, and none did since it was sure.
class MediumStretches {
 public:
  explicit MediumStretches(std::vector<strokes::PoseRow>& rows) : rows_(rows) {}
  // After the rows of the picture at this time were appended.
  void follow(const MediumVerdict& verdict, std::int64_t timestamp_ns) {
    const bool contradicts = verdict.fit == MediumFit::Contradicts;
    if (contradicts && !is_in_one_) begin(verdict);
    if (contradicts) {
      drop_later_than(stretches_.back().from_s);
      stretches_.back().to_s = seconds_of(timestamp_ns);
      stretches_.back().words = reason_text(verdict);
    }
    is_in_one_ = contradicts;
  }
  [[nodiscard]] bool has_any() const { return !stretches_.empty(); }
  [[nodiscard]] std::vector<std::string> reasons() const {
    // With no row left the whole video is meant.
    if (rows_.empty()) return {stretches_.back().words};
    std::vector<std::string> reasons;
    for (const Stretch& one : stretches_)
      reasons.push_back(
          files::format("from %.1f s to %.1f s there is no pose: ", std::max(one.from_s, 0.0), one.to_s) +
          one.words);
    return reasons;
  }

 private:
  struct Stretch {
    double from_s = 0, to_s = 0;
    std::string words;
  };
  static double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
  void begin(const MediumVerdict& verdict) {
    stretches_.push_back({verdict.last_sure_ns < 0 ? -1 : seconds_of(verdict.last_sure_ns), 0, ""});
  }
  void drop_later_than(double time_s) {
    while (!rows_.empty() && rows_.back().time_s > time_s) rows_.pop_back();
  }

  std::vector<strokes::PoseRow>& rows_;
  std::vector<Stretch> stretches_;
  bool is_in_one_ = false;
};

}  // namespace

ViewStatistics::ViewStatistics(const tools::ToolSet& tools) {
  if (tools.tracker) return;  // no marker is looked for
  const auto add = [&](const auto& body, const std::string& name) {
    const std::vector<tools::BodyMarker> of_body = tools::markers_of(body);
    for (const tools::BodyMarker& marker : of_body)
      add_marker(markers, marker.marker_id,
                 of_body.size() == 1 ? name : name + " (" + std::to_string(marker.marker_id) + ")");
  };
  for (const tools::WorldMarker& world : tools.world_markers)
    add(world, std::string(bones::to_text(world.bone)));
  for (const tools::Tool& tool : tools.tools) add(tool, tool.name);
}

void ViewStatistics::add(const PictureObservation& view, double processing_ms) {
  ++frame_count;
  frames_with_mark += view.lens.mark == lens::MarkState::Found ? 1 : 0;
  frames_with_unknown_lens += view.intrinsics_are_known ? 0 : 1;
  const bool is_off_camera =
      !view.intrinsics_are_known && (view.lens.zoom == lens::ZoomState::Changed || view.lens.zoom_or_slip);
  if (is_off_camera && frames_off_camera++ == 0) off_camera = lens::reason_text(view.lens);
  frames_frozen += view.is_frozen ? 1 : 0;
  processing_ms_mean += (processing_ms - processing_ms_mean) / static_cast<double>(frame_count);
  processing_ms_worst = std::max(processing_ms_worst, processing_ms);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    MarkerStatistics& statistics = markers[i];
    if (view.stands_for(view.markers[i])) {
      ++statistics.frames_with_pose;
    } else if (!view.markers[i].is_tracked()) {
      const auto state = static_cast<std::size_t>(view.markers[i].state);
      ++statistics.frames_by_loss[state];
      const auto worst = std::max_element(statistics.frames_by_loss.begin(), statistics.frames_by_loss.end());
      statistics.main_loss = static_cast<markers::MarkerState>(worst - statistics.frames_by_loss.begin());
    }
  }
}

std::string ViewStatistics::reason_of_camera() const {
  if (2 * frames_off_camera <= frame_count) return "";
  return files::format("%ld of %ld frames are not of this camera as it was calibrated: ", frames_off_camera,
                       frame_count) +
         off_camera;
}

TrackedVideo track_video(sources::FrameSource& source, const ViewTrackerOptions& options,
                         const tools::ToolSet& tools, const FrameSeen& on_frame) {
  TrackedVideo video;
  video.statistics = ViewStatistics(tools);
  const std::vector<markers::DeclaredMarker> declared = markers::declared_markers(tools);
  ViewTracker tracker(options, markers::make_tracker(declared));
  const double calibration_index = options.calibration.refractive_index;
  MediumCheck medium(declared, options.refractive_index, calibration_index);
  SecondLook second(declared, medium.other_index(), calibration_index);
  PrefetchedSource prefetched(source);
  MediumStretches stretches(video.rows);
  PictureObservation view;
  while (const camera::FramePtr frame = prefetched.next()) {
    const auto begin = std::chrono::steady_clock::now();
    tracker.observe(*frame, view);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    append_sized_rows(view, declared, video.rows);
    video.statistics.add(view, taken.count());
    medium.look(view);
    if (medium.wants_second_look()) medium.look_again(view, second.look(*frame, view.camera));
    stretches.follow(medium.verdict(), view.timestamp_ns);
    if (on_frame) on_frame(*frame, view);
  }
  video.reasons = stretches.has_any() ? stretches.reasons() : reasons_of(video);
  return video;
}

}  // namespace arthronaut::pipeline
