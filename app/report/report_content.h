// What a report is made from. Inner header of report.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/report/report.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_marks.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/postop/comparison.h"

namespace arthronaut::report {

// What the report tells of: the case and, where there is one, the session that matters.
struct Content {
  std::filesystem::path folder;
  cases::Case knee;
  std::unique_ptr<recording::RecordedSession> session;
  std::vector<operation::AchievedTunnel> achieved;  // in `session`
  // Tunnels of other bundles of that bone, drilled in sessions before it: after each start of a source there
  // is another. Of the same kind of source alone: a rehearsal says nothing of the patient.
  struct Earlier {
    operation::AchievedTunnel achieved;
    std::string session;
  };
  std::vector<Earlier> earlier = {};
  recording::SessionMarks marks = {};  // of `session`: what whoever looked at it marked
  std::string marks_problem = {};      // why they cannot be read; empty when they can
  std::string last_hash = {};          // of the chain of `session`; empty: it has none, or a broken one
  // With images after the operation, as the case's achieved.json keeps it.
  std::map<tunnels::TunnelKey, postop::Comparison> postoperative = {};
  std::string postoperative_problem = {};   // why it cannot be read; empty when it can
  std::optional<cases::Identity> identity;  // where it is to be named
};

// Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] Content gather(const std::filesystem::path& folder, const ReportOptions& options);

// "reliable", "not reliable", "of an earlier plan", "no tunnel found", "bone not found in the images".
[[nodiscard]] std::string verdict_of(const Content& content, const tunnels::TunnelKey& key);
// Why it must not be relied on, each reason once; empty: reliable.
[[nodiscard]] std::vector<std::string> doubts_of(const Content& content, const tunnels::TunnelKey& key);

}  // namespace arthronaut::report
