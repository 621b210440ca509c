// A record as JSON: a line of `arthronaut cases --json`, and what the index keeps. Inner header of library.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planning/library/case_record.h"

namespace arthronaut::library {

// Numbers that are not known are left out.
[[nodiscard]] nlohmann::ordered_json to_json(const CaseRecord& record);
// What to_json() made; words that are no UTF-8 come back with a replacement character. Throws
// nlohmann::json::exception or InvalidInput for anything else.
[[nodiscard]] CaseRecord record_from(const nlohmann::json& json);

}  // namespace arthronaut::library
