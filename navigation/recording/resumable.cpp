#include "navigation/recording/resumable.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>
#include <utility>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/recording/declined_resume.h"
#include "navigation/recording/drilled_by_word.h"
#include "navigation/recording/hash_chain.h"
#include "navigation/recording/last_registration.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/rerun.h"
#include "navigation/recording/session_files.h"
#include "planning/cases/case.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

// By its chain of hashes, which is written with all that is recorded, and after it: a database that was cut
// off is put in order by whoever reads it, and would be of now with every look. (Only of before there was a
// chain it is all there is.)
std::chrono::system_clock::time_point last_written(const std::filesystem::path& session_folder) {
  std::error_code none;
  std::filesystem::file_time_type newest = std::filesystem::last_write_time(chain_file(session_folder), none);
  if (none) newest = std::filesystem::last_write_time(database_file(session_folder));
  return std::chrono::time_point_cast<std::chrono::system_clock::duration>(
      std::chrono::file_clock::to_sys(newest));
}

// The files of the tunnels that are drilled, session after session.
void follow_drilled(const RecordedSession& session, std::set<std::string>& files) {
  for (const SessionEvent& event : session.events()) {
    if (event.kind == kDrilledEvent) files.insert(event.text);
    if (event.kind == kDrilledTakenBackEvent) files.erase(event.text);
    if (event.kind == kSaidTooEarlyEvent)
      std::erase_if(files, [&](const std::string& file) {
        return name_of_tunnel_in(file, session.header().bone) == event.text;
      });
  }
}

// Likewise those that are drilled by word alone.
void follow_said(const RecordedSession& session, std::vector<SaidDrilled>& said) {
  const bones::BoneKind bone = session.header().bone;
  const auto forget = [&](const std::string& tunnel) {
    std::erase_if(said, [&](const SaidDrilled& one) { return one.tunnel == tunnel; });
  };
  for (const SessionEvent& event : session.events()) {
    if (event.kind == kDrilledEvent) forget(name_of_tunnel_in(event.text, bone));
    if (event.kind == kSaidTooEarlyEvent) forget(event.text);
  }
  // The pictures have a clock of their own, which began with the record. A copy of it has newer files.
  const std::int64_t begin_ns = session.first_frame_ns().value_or(0);
  const std::chrono::system_clock::time_point begin =
      files::time_of_utc(session.header().started_utc).value_or(std::chrono::sys_seconds{});
  for (const DrilledByWord& one : drilled_by_word(session.events(), bone)) {
    forget(one.tunnel);
    said.push_back({one.tunnel, begin + std::chrono::nanoseconds(one.timestamp_ns - begin_ns)});
  }
}

// Whether it was drilled in its newest session, and nothing is left to be drilled.
bool has_come_to_its_end(const RecordedSession& newest, const std::vector<tunnels::TunnelKey>& planned) {
  std::set<std::string> drilled;
  follow_drilled(newest, drilled);
  if (drilled.empty()) return false;
  drilled.clear();
  for (const RecordedSession& session : sessions_before(newest, [](const std::string&) {}))
    follow_drilled(session, drilled);
  follow_drilled(newest, drilled);
  // A single tunnel's is the only one, whatever is planned since.
  return drilled.contains(operation::achieved_file_name(newest.header().bone)) ||
         std::ranges::none_of(planned, [&](const tunnels::TunnelKey& key) {
           return key.bundle != norms::Bundle::Whole && !drilled.contains(operation::achieved_file_name(key));
         });
}

// Of the bundles' tunnels of the operation, those that are drilled.
std::vector<tunnels::TunnelKey> drilled_bundles(const RecordedSession& newest,
                                                const std::vector<RecordedSession>& before) {
  std::set<std::string> files;
  for (const RecordedSession& session : before) follow_drilled(session, files);
  follow_drilled(newest, files);
  std::vector<tunnels::TunnelKey> keys;
  for (const norms::Bundle bundle : {norms::Bundle::Anteromedial, norms::Bundle::Posterolateral}) {
    const tunnels::TunnelKey key(newest.header().bone, bundle);
    if (files.contains(operation::achieved_file_name(key))) keys.push_back(key);
  }
  return keys;
}

// What was drawn before and what was drawn since, numbered on; the newest when it is too much for a screen.
strokes::Curves joined(const operation::ResumeOperation* before, const strokes::Curves& since) {
  strokes::Curves all = before != nullptr ? before->drawn : strokes::Curves();
  const int first = all.empty() ? 0 : all.back().curve + 1;
  for (const strokes::CurvePoint& point : since) {
    all.push_back({point.curve + first, std::nullopt, point.position_mm});
  }
  if (all.size() > operation::StrokeBook::kMostTraced)
    all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(operation::StrokeBook::kMostTraced));
  return all;
}

int stroke_count_of(const strokes::Curves& curves) {
  int count = 0;
  for (std::size_t i = 0; i < curves.size(); ++i)
    count += i == 0 || curves[i].curve != curves[i - 1].curve ? 1 : 0;
  return count;
}

std::optional<Resumable> resumable_from(const RecordedSession& newest) {
  const std::vector<RecordedSession> before = sessions_before(newest, [&](const std::string& id) {
    throw IoError(newest.folder().parent_path() / id, "is not there any more");
  });
  Rerun rerun(setup_of(before.empty() ? newest : before.front()), Registrations::AsRecorded, nullptr);
  LastRegistration last;
  for (const RecordedSession& session : before) {
    rerun.run(session);
    last.follow(session);
  }
  rerun.run(newest);
  last.follow(newest);

  const operation::OperationStatePtr state = rerun.state();
  const operation::Touches& touches = state->registration->touches;
  Resumable found;
  operation::ResumeOperation& resume = found.operation;
  resume.session = newest.header().id;
  resume.of = rerun.operation().now();
  resume.of.placement = 0;  // of that operation; nobody counts it in this one
  resume.plan = state->plan;
  resume.depth_stop_mm = state->depth_stop_mm;
  found.drilled = drilled_bundles(newest, before);
  for (const RecordedSession& session : before) follow_said(session, found.said_drilled);
  follow_said(newest, found.said_drilled);
  found.refusal = last.refusal();
  if (found.refusal.empty()) {
    resume.registration = last.registration();
    resume.registration_of = last.of();
    resume.registration_of.placement = 0;
    found.was_verified = last.was_verified();
  }
  const strokes::Curves strokes = rerun.operation().strokes_in_use();
  found.drawn_length_mm = strokes::length_mm(strokes);
  // After an alarm nobody knows how the marker sits to what was drawn and touched under it.
  if (last.alarm().empty()) {
    resume.drawn = joined(state->resumed.get(), *state->registration->drawn);
    resume.stroke_count =
        stroke_count_of(strokes) + (state->resumed != nullptr ? state->resumed->stroke_count : 0);
    resume.touches_mm = touches.places_mm();
    resume.control_point_mm = touches.control_point_mm();
  }
  const bool has_come_to_something = resume.registration || !last.alarm().empty() ||
                                     resume.stroke_count > 0 || !resume.touches_mm.empty() ||
                                     resume.control_point_mm || resume.depth_stop_mm;
  if (!has_come_to_something) return std::nullopt;
  found.header = newest.header();
  found.was_finished = newest.was_finished();
  found.last_written = last_written(newest.folder());
  found.folder = newest.folder();
  found.was_declined = is_resume_declined(newest.folder());
  return found;
}

// Why the newest session leaves nothing to go on with; empty: its end decides.
std::string why_over(const RecordedSession& newest, const std::string& mesh_sha256,
                     const std::vector<tunnels::TunnelKey>& planned) {
  const SessionHeader& header = newest.header();
  if (!header.has_journal() || header.registers_after_mm > 0)
    return "nobody was at its pedal: what navigate ran on a recording is run again, not resumed";
  if (is_of_another_surface(header, mesh_sha256))
    return "it is of another surface of the bone than the case has now";
  return has_come_to_its_end(newest, planned) ? "its tunnels are drilled, it came to its end" : "";
}

// A program that was killed holds its locks until its memory is gone, a second on: that long it is waited
// for, once for all sessions of a search.
class Patience {
 public:
  bool is_still_being_recorded(const std::filesystem::path& folder) const {
    while (is_being_recorded(folder)) {
      if (std::chrono::steady_clock::now() >= until_) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }

 private:
  std::chrono::steady_clock::time_point until_ = std::chrono::steady_clock::now() + std::chrono::seconds(2);
};

}  // namespace

ResumeSearch find_resumable(const std::filesystem::path& case_folder, bones::BoneKind bone,
                            const std::string& mesh_sha256, const std::vector<tunnels::TunnelKey>& planned) {
  std::vector<std::filesystem::path> folders = cases::session_folders(case_folder);
  std::reverse(folders.begin(), folders.end());
  ResumeSearch search;
  const Patience patience;
  for (const std::filesystem::path& folder : folders) {
    try {  // one broken session must not hide the others for good; that it was passed over is told
      pipeline::PipelineOptions options;
      if (read_session_header(folder, options).bone != bone) continue;
      const bool goes_on =
          patience.is_still_being_recorded(folder);  // before it is read: it may end meanwhile
      const RecordedSession session = RecordedSession::without_frames(folder);
      if (is_exercise(session.header())) continue;
      if (!session.first_frame_ns() && session.header().continues.empty()) continue;
      std::string why = why_over(session, mesh_sha256, planned);
      if (why.empty()) search.left = resumable_from(session);
      if (search.left) search.left->is_being_recorded = goes_on && !session.was_finished();
      if (!search.left)
        search.why_none = "session " + session.header().id + ": " +
                          (why.empty() ? "it came to nothing that could be gone on with" : why);
      return search;
    } catch (const std::runtime_error& error) {  // its files may go away meanwhile, too
      search.passed_over.emplace_back(error.what());
    }
  }
  search.why_none = "no operation on the " + std::string(bones::to_text(bone)) + " is recorded" +
                    (search.passed_over.empty() ? "" : " in what can be read");
  return search;
}

}  // namespace arthronaut::recording
