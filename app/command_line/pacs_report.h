// What a PACS has and has taken, in words and as JSON (docs/pacs.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planning/pacs/query.h"
#include "planning/pacs/retrieve.h"
#include "planning/pacs/send.h"

namespace arthronaut::command_line {

[[nodiscard]] nlohmann::ordered_json json_of(const std::string& where, const pacs::FindSummary& found);
[[nodiscard]] std::vector<std::string> lines_of(const pacs::FindSummary& found);
[[nodiscard]] nlohmann::ordered_json json_of(const std::string& where, const std::string& series_uid,
                                             const std::string& folder, const pacs::RetrieveSummary& summary);
[[nodiscard]] nlohmann::ordered_json json_of(const std::string& where, const pacs::SendSummary& summary);

}  // namespace arthronaut::command_line
