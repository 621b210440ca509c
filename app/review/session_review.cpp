#include "app/review/session_review.h"

#include <algorithm>

#include "app/guidance_severity/guidance_severity.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

namespace {

template <typename Holds>
TimeTrack track_of(const recording::RecordedSession& session, const std::string& name, const Holds& holds) {
  std::vector<bool> flags;
  flags.reserve(session.frames().size());
  for (const recording::RecordedFrame& frame : session.frames()) flags.push_back(holds(frame));
  return {name, stretches_of(flags, 2)};
}

}  // namespace

std::vector<Stretch> stretches_of(const std::vector<bool>& holds, std::size_t bridge) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (!holds[i]) continue;
    if (!stretches.empty() && i - stretches.back().last <= bridge + 1)
      stretches.back().last = i;
    else
      stretches.push_back({i, i});
  }
  return stretches;
}

SessionReview read_review(const std::filesystem::path& session_folder) {
  SessionReview review;
  review.folder = session_folder;
  review.session = std::make_shared<const recording::RecordedSession>(session_folder);
  const recording::RecordedSession& session = *review.session;
  const tools::ToolSet tools = session.pipeline_options().tools;
  const auto marker_track = [&](int id) {
    review.tracks.push_back(track_of(
        session, guidance_severity::marker_name(tools, id), [id](const recording::RecordedFrame& frame) {
          return std::any_of(frame.poses.begin(), frame.poses.end(),
                             [id](const strokes::PoseRow& row) { return row.marker_id == id; });
        }));
  };
  if (const auto* world = tools.find_world_marker(session.header().bone)) marker_track(world->marker_id);
  if (const auto* probe = tools.find_tool(session.header().probe_name)) marker_track(probe->marker_id);
  if (const auto* guide = tools.find_tool(session.header().guide_name)) marker_track(guide->marker_id);
  review.tracks.push_back(track_of(session, "Lens angle",
                                   [](const recording::RecordedFrame& f) { return f.intrinsics_are_known; }));
  review.tracks.push_back(
      track_of(session, "Guidance", [](const recording::RecordedFrame& f) { return f.guidance.is_valid(); }));
  for (const recording::SessionEvent& event : session.events())
    if (event.kind == recording::kPlanEvent) review.plan = session.plan_of(event);
  try {  // a broken file must not hide the session: its reason is shown in its place
    for (const std::filesystem::path& file : operation::achieved_files(session_folder))
      review.achieved.push_back(operation::read_achieved_file(file));
  } catch (const std::runtime_error& error) {
    review.achieved_problem = error.what();
  }
  return review;
}

std::string origin_in_words(const recording::SessionHeader& header) {
  const auto kind = sources::source_kind_from_text(header.source_kind);
  if (!kind) return "RECORDING";
  switch (*kind) {
    case sources::SourceKind::Live:
      return "RECORDING of a live camera";
    case sources::SourceKind::Recording:
      return "RECORDING of a video";
    case sources::SourceKind::Simulation:
      return "RECORDING of a simulation";
  }
  return "RECORDING";
}

double time_s(const recording::RecordedSession& session, std::size_t frame) {
  return static_cast<double>(session.frames()[frame].timestamp_ns - session.frames().front().timestamp_ns) *
         1e-9;
}

std::size_t frame_at(const recording::RecordedSession& session, double seconds) {
  const auto& frames = session.frames();
  const std::int64_t wanted = frames.front().timestamp_ns + static_cast<std::int64_t>(seconds * 1e9);
  const auto after =
      std::upper_bound(frames.begin(), frames.end(), wanted,
                       [](std::int64_t t, const recording::RecordedFrame& f) { return t < f.timestamp_ns; });
  return after == frames.begin() ? 0 : static_cast<std::size_t>(after - frames.begin()) - 1;
}

}  // namespace arthronaut::review
