// What a report is made from. Inner header of report.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/report/report.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"

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
  std::optional<cases::Identity> identity;  // where it is to be named
};

// Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] Content gather(const std::filesystem::path& folder, const ReportOptions& options);

}  // namespace arthronaut::report
