#include "app/review/session_review.h"

#include <algorithm>
#include <future>
#include <map>
#include <utility>

#include "app/guidance_severity/guidance_severity.h"
#include "navigation/registration/registration_file.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

namespace {

template <typename Holds>
TimeTrack track_of(const recording::SessionTimeline& timeline, const std::string& name, const Holds& holds) {
  std::vector<bool> flags;
  flags.reserve(timeline.frames().size());
  for (const recording::FrameGlance& frame : timeline.frames()) flags.push_back(holds(frame));
  return {name, stretches_of(flags, 2)};
}

TimeTrack marker_track(const recording::SessionTimeline& timeline, const tools::ToolSet& tools, int id) {
  const auto& ids = timeline.marker_ids();
  const auto at = std::find(ids.begin(), ids.end(), id);
  const std::uint32_t bit = at == ids.end() ? 0 : std::uint32_t{1} << static_cast<unsigned>(at - ids.begin());
  return track_of(timeline, guidance_severity::marker_name(tools, id),
                  [bit](const recording::FrameGlance& frame) { return (frame.posed & bit) != 0; });
}

// A registration that cannot be read is said, and none stands in its place.
std::shared_ptr<const registration::RegistrationSummary> registration_of(const recording::SessionEvent& event,
                                                                         const std::filesystem::path& folder,
                                                                         std::vector<std::string>& problems) {
  try {
    return std::make_shared<const registration::RegistrationSummary>(
        registration::read_registration_file(folder / event.text));
  } catch (const std::runtime_error& error) {
    problems.emplace_back(error.what());
    return nullptr;
  }
}

std::shared_ptr<recording::RecordedPictures> opened(
    const std::shared_ptr<const recording::SessionOverview>& session) {
  try {
    return std::make_shared<recording::RecordedPictures>(session);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

// A curve's times are of whole microseconds: between these lies the frame's.
constexpr double kRounded_s = 1e-6;
std::int64_t first_ns(double time_s) { return static_cast<std::int64_t>((time_s - kRounded_s) * 1e9); }
std::int64_t last_ns(double time_s) { return static_cast<std::int64_t>((time_s + kRounded_s) * 1e9); }

// Each change is in force from the frame on that comes after it. Returns the registrations by their files.
std::map<std::string, std::shared_ptr<const registration::RegistrationSummary>> follow(
    SessionReview& review) {
  std::map<std::string, std::shared_ptr<const registration::RegistrationSummary>> registrations;
  for (const recording::SessionEvent& event : review.session->events) {
    Standing next = review.standings.back();
    next.from_frame = event.after_frame < 0 ? -1 : event.after_frame + 1;
    if (event.kind == recording::kPlanEvent)
      next.plan = review.session->plan_of(event);
    else if (recording::is_registration(event))
      next.registration = registrations[event.text] = registration_of(event, review.folder, review.problems);
    else if (event.kind == recording::kVoidEvent)
      next.registration = nullptr;
    else
      continue;
    review.standings.push_back(std::move(next));
  }
  return registrations;
}

// Of the plan that was in force at that frame or last before it, of those of this tunnel.
double planned_length_mm(const SessionReview& review, const tunnels::TunnelKey& key,
                         std::int64_t frame_index) {
  double length_mm = 0;
  for (const Standing& standing : review.standings)
    if (standing.plan.plan && standing.plan.plan->key() == key &&
        (length_mm == 0 || standing.from_frame <= frame_index))
      length_mm = standing.plan.planned_length_mm;
  return length_mm;
}

DrilledTunnel drilled_tunnel(const SessionReview& review, operation::AchievedTunnel achieved) {
  DrilledTunnel tunnel{std::move(achieved)};
  const tunnels::TunnelKey key = tunnel.achieved.planned.key();
  const std::string file = operation::achieved_file_name(key);
  for (const recording::SessionEvent& event : review.session->events)
    if (event.kind == recording::kDrilledEvent && event.text == file) tunnel.from_frame = event.after_frame;
  tunnel.length_mm = tunnel.achieved.depth_mm ? *tunnel.achieved.depth_mm
                                              : planned_length_mm(review, key, tunnel.from_frame);
  return tunnel;
}

// An operation that goes on keeps what was drawn before, in the times of another clock. The first point of
// each stroke of this session is the tip of one of its frames.
std::size_t points_of_before(const SessionReview& review) {
  const strokes::Curves& curves = review.session->curves;
  if (review.session->header.continues.empty()) return 0;
  const auto& frames = review.timeline->frames();
  constexpr double kSameTip_mm = 1e-3;  // what the file rounds, and a little more
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!curves[i].time_s || (i > 0 && curves[i].curve == curves[i - 1].curve)) continue;
    const std::int64_t until_ns = last_ns(*curves[i].time_s);
    const auto after = std::ranges::upper_bound(frames, until_ns, {}, &recording::FrameGlance::timestamp_ns);
    if (after == frames.begin()) continue;
    const recording::RecordedFrame& frame =
        review.timeline->frame(static_cast<std::size_t>(after - frames.begin()) - 1);
    if (frame.tip_is_valid && (frame.tip_in_world_mm - curves[i].position_mm).norm() < kSameTip_mm) return i;
  }
  return curves.size();
}

}  // namespace

bool SessionReview::has_pose() const {
  return std::ranges::any_of(standings, [](const Standing& standing) {
    return standing.registration != nullptr && standing.registration->has_pose;
  });
}

const Standing& SessionReview::standing_at(std::int64_t frame_index) const {
  const auto after =
      std::upper_bound(standings.begin() + 1, standings.end(), frame_index,
                       [](std::int64_t frame, const Standing& s) { return frame < s.from_frame; });
  return *std::prev(after);
}

RegistrationRow registration_row(const SessionReview& review, std::int64_t frame_index) {
  const auto& registration = review.standing_at(frame_index).registration;
  const auto& next = review.standing_at(frame_index + 1).registration;
  // What began with this picture is told below as having happened.
  if (registration == nullptr && next != nullptr)
    return {widgets::Severity::Quiet,
            next->reliable ? "found with this picture, in force from the next one on: target " +
                                 widgets::plus_minus(next->predicted_tre_mm) + " mm"
                           : "found with this picture, not reliable"};
  if (registration == nullptr) return {widgets::Severity::Quiet, "none at this moment"};
  if (!registration->reliable)
    return {widgets::Severity::Bad,
            registration->reasons.empty() ? "not reliable" : registration->reasons.front()};
  // What ended it with this picture is told below: nothing good stands above that.
  const bool ends = next == nullptr || !next->reliable;
  return {ends ? widgets::Severity::Quiet : widgets::Severity::Good,
          "target " + widgets::plus_minus(registration->predicted_tre_mm) + " mm" +
              (ends ? "; in this picture for the last time" : "")};
}

std::vector<const DrilledTunnel*> SessionReview::drilled_at(std::int64_t frame_index) const {
  std::vector<const DrilledTunnel*> there;
  for (const DrilledTunnel& tunnel : drilled)
    if (frame_index >= tunnel.from_frame && tunnel.length_mm > 0) there.push_back(&tunnel);
  return there;
}

std::span<const strokes::CurvePoint> SessionReview::drawn_until(std::int64_t timestamp_ns) const {
  const std::span all(session->curves);
  const auto own = all.subspan(points_of_before);
  const auto later = std::ranges::find_if(own, [&](const strokes::CurvePoint& point) {
    return point.time_s && first_ns(*point.time_s) > timestamp_ns;
  });
  return all.first(points_of_before + static_cast<std::size_t>(later - own.begin()));
}

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
  review.session =
      std::make_shared<const recording::SessionOverview>(recording::read_overview(session_folder));
  auto pictures = std::async(std::launch::async, [session = review.session] { return opened(session); });
  review.timeline = std::make_shared<const recording::SessionTimeline>(session_folder);
  review.pictures = pictures.get();
  const recording::SessionOverview& session = *review.session;
  const recording::SessionTimeline& timeline = *review.timeline;
  review.problems = session.problems;
  for (const std::string& problem : timeline.problems())
    if (std::find(review.problems.begin(), review.problems.end(), problem) == review.problems.end())
      review.problems.push_back(problem);
  const tools::ToolSet tools = session.options.tools;
  const auto add_marker = [&](int id) { review.tracks.push_back(marker_track(timeline, tools, id)); };
  if (const auto* world = tools.find_world_marker(session.header.bone)) add_marker(world->marker_id);
  if (const auto* probe = tools.find_tool(session.header.probe_name)) add_marker(probe->marker_id);
  if (const auto* guide = tools.find_tool(session.header.guide_name)) add_marker(guide->marker_id);
  review.tracks.push_back(track_of(timeline, "Lens angle",
                                   [](const recording::FrameGlance& f) { return f.intrinsics_are_known; }));
  review.tracks.push_back(
      track_of(timeline, "Guidance", [](const recording::FrameGlance& f) { return f.is_guided(); }));
  review.tracks.back().is_guidance = true;
  review.points_of_before = points_of_before(review);
  const auto registrations = follow(review);
  review.moments = moments_of(
      session.events, timeline,
      [&](const recording::SessionEvent& event) -> std::optional<registration::RegistrationSummary> {
        const auto& registration = registrations.at(event.text);
        return registration == nullptr ? std::nullopt : std::optional(*registration);
      });
  try {  // a broken file must not hide the session: its reason is shown in its place
    for (const std::filesystem::path& file : operation::achieved_files(session_folder))
      review.drilled.push_back(drilled_tunnel(review, operation::read_achieved_file(file)));
  } catch (const std::runtime_error& error) {
    review.achieved_problem = files::within_folder(session_folder, error.what());
  }
  for (std::string& problem : review.problems)
    problem = files::within_folder(session_folder, std::move(problem));
  return review;
}

std::string origin_in_words(const recording::SessionHeader& header) {
  if (!header.source_kind) return "RECORDING";
  switch (*header.source_kind) {
    case sources::SourceKind::Live:
      return "RECORDING of a live camera";
    case sources::SourceKind::Recording:
      return "RECORDING of a video";
    case sources::SourceKind::Simulation:
      return "RECORDING of a simulation";
  }
  return "RECORDING";
}

}  // namespace arthronaut::review
