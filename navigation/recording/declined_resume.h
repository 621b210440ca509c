// That somebody was offered to resume an operation and declined: declined.json in the folder of its newest
// session, format "arthronaut.declined", version 1. It is not offered again by itself then; whoever looks at
// the session may take that back. It says nothing of what happened, and nothing is computed from it.
#pragma once

#include <filesystem>

namespace arthronaut::recording {

[[nodiscard]] std::filesystem::path declined_file(const std::filesystem::path& session_folder);
[[nodiscard]] bool is_resume_declined(const std::filesystem::path& session_folder);
// Whether it was declined, and no newer session of its bone decides what there is to be resumed.
[[nodiscard]] bool can_be_taken_back(const std::filesystem::path& case_folder,
                                     const std::filesystem::path& session_folder);
// Atomic; private as the case is. Throws IoError.
void decline_resume(const std::filesystem::path& session_folder);
// As if it had never been declined. Throws IoError; it is then as before.
void take_back_declined_resume(const std::filesystem::path& session_folder);

}  // namespace arthronaut::recording
