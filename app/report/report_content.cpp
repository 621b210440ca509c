#include "app/report/report_content.h"

#include <set>
#include <utility>

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

}  // namespace

Content gather(const std::filesystem::path& folder, const ReportOptions& options) {
  Content content{.folder = folder,
                  .knee = cases::load_case(folder),
                  .session = nullptr,
                  .achieved = {},
                  .earlier = {},
                  .identity = std::nullopt};
  if (options.with_identity) content.identity = cases::load_identity(folder);
  const auto sessions = cases::session_folders(folder);
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
  return content;
}

}  // namespace arthronaut::report
