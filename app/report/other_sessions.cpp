#include "app/report/other_sessions.h"

#include <algorithm>
#include <set>
#include <utility>

#include "app/report/plans_in_force.h"
#include "app/report/report_words.h"
#include "app/report/session_rows.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/drilled_by_word.h"
#include "navigation/recording/session_overview.h"
#include "navigation/recording/session_timeline.h"
#include "planning/bones/mesh_hash.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::report {

namespace {

// Whether a tunnel that was drilled then, in an earlier session, is a part of what `content` tells of.
bool belongs_to(const Content& content, const recording::SessionHeader& then) {
  const recording::SessionHeader& now = content.session->header();
  if (then.source_kind != now.source_kind) return false;
  if (then.bone == now.bone) return !recording::is_of_another_surface(then, now.mesh_sha256);
  const auto bone = content.knee.bones.find(then.bone);
  return bone != content.knee.bones.end() &&
         !recording::is_of_another_surface(then, bones::mesh_sha256(bone->second.mesh));
}

// Of a session whose record can be read: a figure of one that cannot is not told.
recording::SessionHeader header_of_whole(const std::filesystem::path& folder) {
  recording::SessionOverview then = recording::read_overview(folder);
  if (!then.end_was_read && !then.problems.empty()) throw InvalidInput(then.problems.front());
  return std::move(then.header);
}

// Nothing of them may be told here, and the session be damaged all the same.
void note_damaged_frames(const std::filesystem::path& folder, Content& content) {
  const recording::SessionTimeline frames(folder);
  for (const std::string& problem : frames.problems())
    content.damaged.emplace_back(folder.filename().string(), files::within_folder(content.folder, problem));
}

// The newest of each tunnel that is planned and not among the session's own.
void add_earlier(const std::vector<std::filesystem::path>& sessions, Content& content) {
  const bool tells_of_own =
      !content.achieved.empty() ||
      std::ranges::any_of(content.by_word, [](const Content::ByWord& said) { return said.at_s.has_value(); });
  if (!tells_of_own) return;
  std::set<tunnels::TunnelKey> known;
  for (const auto& achieved : content.achieved) known.insert(achieved.planned.key());
  for (auto it = sessions.rbegin(); it != sessions.rend(); ++it) {
    unless_unreadable(*it, content, [&] {
      for (const auto& file : operation::achieved_files(*it)) {
        auto achieved = operation::read_achieved_file(file);
        const tunnels::TunnelKey key = achieved.planned.key();
        // Beside a bone's single tunnel what was before it is not planned.
        const bool is_told = known.contains(key) || known.contains(tunnels::TunnelKey(key.bone));
        if (is_told || !content.knee.plan.tunnels.contains(key)) continue;
        if (!belongs_to(content, header_of_whole(*it))) continue;
        known.insert(key);
        content.earlier.push_back({std::move(achieved), it->filename().string()});
      }
    });
  }
}

// Of each tunnel the newest session that says anything of it decides.
void add_by_word(const std::vector<std::filesystem::path>& sessions, Content& content) {
  if (content.session == nullptr) return;
  std::set<std::string> known;
  for (auto it = sessions.rbegin(); it != sessions.rend(); ++it) {
    if (!std::filesystem::exists(*it / "session.json")) continue;
    unless_unreadable(*it, content, [&] {
      const recording::SessionOverview then = recording::read_overview(*it);
      const bool is_own = content.session->folder() == *it;
      if (!is_own && !belongs_to(content, then.header)) return;
      if (!is_own && !then.events_were_read)
        throw InvalidInput(then.problems.empty() ? "what was done cannot be read" : then.problems.front());
      if (!is_own) note_damaged_frames(*it, content);
      for (const recording::DrilledByWord& said : recording::drilled_by_word(then.events, then.header.bone)) {
        if (!known.insert(said.tunnel).second) continue;
        content.by_word.push_back(
            {said.tunnel, said.why, it->filename().string(),
             is_own ? std::optional(time_s(*content.session, said.timestamp_ns)) : std::nullopt});
      }
      for (const std::string& tunnel : recording::said_too_early(then.events)) known.insert(tunnel);
      for (const auto& file : operation::achieved_files(*it))
        known.insert(tunnels::name_of(operation::read_achieved_file(file).planned.key()));
    });
  }
}

// Recorded by its poses, and said once more when none came: both are told, and which is which.
void note_figures_of_before(Content& content) {
  std::set<std::string> with_figures;
  for (const auto& achieved : content.achieved) with_figures.insert(tunnels::name_of(achieved.planned.key()));
  for (const auto& earlier : content.earlier)
    with_figures.insert(tunnels::name_of(earlier.achieved.planned.key()));
  for (Content::ByWord& said : content.by_word)
    said.has_figures_of_before = with_figures.contains(said.tunnel);
}

void add_others(const std::vector<std::filesystem::path>& sessions, Content& content) {
  std::set<std::string> names;
  for (const Content::Earlier& earlier : content.earlier) names.insert(earlier.session);
  for (const Content::ByWord& said : content.by_word)
    if (!said.at_s) names.insert(said.session);
  for (const auto& folder : sessions) {
    if (!names.contains(folder.filename().string())) continue;
    unless_unreadable(folder, content, [&] {
      const recording::RecordedSession session(folder);
      Content::Other& other = content.others.emplace_back();
      other.session = folder.filename().string();
      other.bone = session.header().bone;
      other.safety = safety_of(session, false);
      other.plans = plans_in_words(plans_in_force(session));
      other.plan_warnings = plan_warnings(session, content);
      try {  // the rest of it is told all the same
        other.registration = registration_that_counts(session);
      } catch (const InvalidInput&) {
        other.has_broken_registration = true;
      } catch (const IoError&) {
        other.has_broken_registration = true;
      }
    });
  }
}

}  // namespace

void unless_unreadable(const std::filesystem::path& session, Content& content,
                       const std::function<void()>& read) {
  const std::string name = session.filename().string();
  const auto is_known = [&](const auto& one) { return one.first == name; };
  if (std::any_of(content.unreadable.begin(), content.unreadable.end(), is_known)) return;
  try {
    read();
  } catch (const InvalidInput& error) {
    content.unreadable.emplace_back(name, files::within_folder(content.folder, error.what()));
  } catch (const IoError& error) {
    content.unreadable.emplace_back(name, files::within_folder(content.folder, error.what()));
  }
}

void add_other_sessions(const std::vector<std::filesystem::path>& sessions, Content& content) {
  add_by_word(sessions, content);
  add_earlier(sessions, content);
  note_figures_of_before(content);
  add_others(sessions, content);
}

void draw_missing_sessions(FlowingPages& pages, const Content& content) {
  const auto draw = [&](const std::string& what, const auto& sessions) {
    for (const auto& [session, reason] : sessions)
      pages.sentence(what + (session.empty() ? "a session of this case."
                                             : "the session " + session + " (" + reason + ")."),
                     {.bold = true, .ink = kWarning});
  };
  draw("NOT READABLE, and not in this report: ", content.unreadable);
  draw("DAMAGED, and in this report only as far as it is whole: ", content.damaged);
}

void draw_other_sessions(FlowingPages& pages, const Content& content) {
  for (const Content::Other& other : content.others) {
    pages.heading("The session of the " + std::string(bones::to_text(other.bone)));
    std::vector<std::vector<std::string>> rows{{"Session", other.session.empty() ? kNotTold : other.session}};
    if (other.registration)
      rows.push_back(
          {"Registration",
           std::string(other.registration->reliable ? "reliable" : "NOT RELIABLE") +
               (other.registration->has_pose ? ", predicted error at the target, one sigma " +
                                                   number(other.registration->predicted_tre_mm, " mm", 2)
                                             : "")});
    if (!other.plans.empty()) rows.insert(rows.begin() + 1, {"Plan in force", other.plans});
    if (other.has_broken_registration) rows.push_back({"Registration", "NOT READABLE"});
    std::ranges::move(rows_of(other.safety), std::back_inserter(rows));
    pages.pairs(rows);
  }
}

std::string in_words(const Content::ByWord& said) {
  const std::string when = said.at_s              ? ", at " + recording::clock_text(*said.at_s)
                           : said.session.empty() ? ", in an earlier session"
                                                  : ", in the session " + said.session;
  return "DRILLED BY WORD ALONE: the " + said.tunnel + " tunnel was said to be drilled" + when +
         ", and no pose shows where it runs (" + said.why + "): " +
         (said.has_figures_of_before ? "the numbers above are of what was recorded before."
                                     : "no number is told of it.");
}

}  // namespace arthronaut::report
