#include "app/report/report_content.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "navigation/recording/case_sessions.h"
#include "navigation/recording/session_check.h"
#include "planning/geometry/error.h"
#include "planning/postop/achieved_file.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::report {

namespace {

// The newest of each bundle that is planned and not among the session's own.
void add_earlier(const std::vector<std::filesystem::path>& sessions, Content& content) {
  if (content.achieved.empty()) return;
  const bones::BoneKind bone = content.achieved.front().planned.bone;
  std::set<tunnels::TunnelKey> known;
  for (const auto& achieved : content.achieved) known.insert(achieved.planned.key());
  if (known.contains(tunnels::TunnelKey(bone))) return;  // a single tunnel: what was before it is not planned
  for (auto it = sessions.rbegin(); it != sessions.rend(); ++it) {
    for (const auto& file : operation::achieved_files(*it)) {
      auto achieved = operation::read_achieved_file(file);
      const tunnels::TunnelKey key = achieved.planned.key();
      if (key.bone != bone || !content.knee.plan.tunnels.contains(key) || known.contains(key)) continue;
      if (recording::RecordedSession(*it).header().source_kind != content.session->header().source_kind)
        continue;
      known.insert(key);
      content.earlier.push_back({std::move(achieved), it->filename().string()});
    }
  }
}

// A broken file of marks takes nothing else away.
void add_looked_at(Content& content) {
  const std::filesystem::path folder = content.session->folder();
  content.last_hash = recording::chain_head(folder);
  try {
    content.marks = recording::read_marks(folder);
  } catch (const InvalidInput& error) {
    content.marks_problem = error.what();
  } catch (const IoError& error) {
    content.marks_problem = error.what();
  }
}

// A broken comparison takes nothing else away.
void add_postoperative(Content& content) {
  const std::filesystem::path file = content.folder / "achieved.json";
  if (!std::filesystem::exists(file)) return;
  try {
    content.postoperative = postop::read_achieved_file(file);
  } catch (const InvalidInput& error) {
    content.postoperative_problem = error.what();
  } catch (const IoError& error) {
    content.postoperative_problem = error.what();
  }
}

// Whether the differences are those to today's plan: the entry's is kept to what files round.
bool is_of_the_plan(const Content& content, const tunnels::TunnelKey& key,
                    const postop::AchievedTunnel& found) {
  constexpr double kRounded_mm = 0.01, kRounded_rad = 1e-3;
  const auto plan = content.knee.plan.tunnels.find(key);
  return plan != content.knee.plan.tunnels.end() &&
         std::abs((found.tunnel.entry_mm - plan->second.entry_mm).norm() - found.offset_mm) < kRounded_mm &&
         std::abs(geometry::angle_between_rad(found.tunnel.direction, plan->second.direction) -
                  found.angle_rad) < kRounded_rad;
}

}  // namespace

std::string verdict_of(const Content& content, const tunnels::TunnelKey& key) {
  const postop::Comparison& comparison = content.postoperative.at(key);
  if (!comparison.bone.is_found) return "bone not found in the images";
  if (!comparison.tunnel.is_found) return "no tunnel found";
  if (!is_of_the_plan(content, key, comparison.tunnel)) return "of an earlier plan";
  return comparison.bone.reliable && comparison.tunnel.reliable ? "reliable" : "not reliable";
}

std::vector<std::string> doubts_of(const Content& content, const tunnels::TunnelKey& key) {
  const postop::Comparison& comparison = content.postoperative.at(key);
  std::vector<std::string> doubts;
  if (comparison.tunnel.is_found && !is_of_the_plan(content, key, comparison.tunnel))
    doubts.emplace_back("the plan was changed since: compare again");
  for (const auto* reasons : {&comparison.bone.reasons, &comparison.tunnel.reasons})
    for (const std::string& reason : *reasons)
      if (std::find(doubts.begin(), doubts.end(), reason) == doubts.end()) doubts.push_back(reason);
  return doubts;
}

Content gather(const std::filesystem::path& folder, const ReportOptions& options) {
  Content content{.folder = folder,
                  .knee = cases::load_case(folder),
                  .session = nullptr,
                  .achieved = {},
                  .earlier = {},
                  .marks = {},
                  .marks_problem = {},
                  .last_hash = {},
                  .postoperative = {},
                  .postoperative_problem = {},
                  .identity = std::nullopt};
  if (options.with_identity && !options.is_deidentified) content.identity = cases::load_identity(folder);
  const auto sessions = recording::operation_folders(folder);
  for (auto it = sessions.rbegin(); it != sessions.rend(); ++it) {
    const auto achieved_files = operation::achieved_files(*it);
    const bool has_achieved = !achieved_files.empty();
    if (!has_achieved && !std::filesystem::exists(*it / "session.json")) continue;
    auto session = std::make_unique<recording::RecordedSession>(*it);
    if (!has_achieved && !session->registration()) continue;
    content.session = std::move(session);
    for (const auto& file : achieved_files) content.achieved.push_back(operation::read_achieved_file(file));
    // The newest session with a drilled tunnel; failing that, the newest with a registration.
    if (has_achieved) break;
    bool older_has_achieved = false;
    for (auto older = it; older != sessions.rend(); ++older) {
      older_has_achieved |= !operation::achieved_files(*older).empty();
    }
    if (!older_has_achieved) break;
  }
  add_earlier(sessions, content);
  add_postoperative(content);
  if (content.session) add_looked_at(content);
  return content;
}

}  // namespace arthronaut::report
