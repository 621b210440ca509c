// The sessions of a case that a command was asked about.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::command_line {

// Of the folder's sessions, oldest first, the one of this name; all where it is empty, never none. The case's
// own files are not read: its records are there also where those are damaged. Throws InvalidInput: no such
// folder, no session in it, none of that name.
[[nodiscard]] std::vector<std::filesystem::path> sessions_named(const std::filesystem::path& case_folder,
                                                                const std::string& name);

}  // namespace arthronaut::command_line
