// What the library says of a session, from its folder, without its frames: some milliseconds, however long
// the session is.
#pragma once

#include <filesystem>

#include "planning/library/case_record.h"

namespace arthronaut::recording {

// What cannot be read stays empty, and SessionFacts::problem says why; does not throw InvalidInput or
// IoError. A session that is being recorded is read as far as it goes.
[[nodiscard]] library::SessionFacts read_session_facts(const std::filesystem::path& session_folder);

}  // namespace arthronaut::recording
