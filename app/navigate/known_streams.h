// The streams that this workstation has navigated with: addresses are long, and typed once. With the user's
// data, not with a case: a stream belongs to the room.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::navigate {

// Beside the built-in case: $XDG_DATA_HOME/arthronaut/streams.json, else ~/.local/share/...
[[nodiscard]] std::filesystem::path known_streams_file();

// The one used last first. Nothing where there is no such file, or it can't be read: it is a convenience.
[[nodiscard]] std::vector<std::string> load_known_streams(const std::filesystem::path& file);
// Puts it first; at most five are kept. The folder is
// this user's alone, since an address may hold a password. A disk that fails is no reason not to navigate.
void note_stream(const std::filesystem::path& file, const std::string& address) noexcept;

}  // namespace arthronaut::navigate
