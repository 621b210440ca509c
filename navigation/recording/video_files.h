// The video of a session as files: copied in, found again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::recording {

// How much copy_video_into() would put on the disk. Throws IoError.
[[nodiscard]] std::uintmax_t video_bytes(const std::filesystem::path& video_or_pattern);

// Copies a video file, or every still of a printf pattern, into the folder as it is; gives the path or
// pattern relative to the folder. Throws IoError, and leaves no part of it then.
[[nodiscard]] std::string copy_video_into(const std::filesystem::path& session_folder,
                                          const std::filesystem::path& video_or_pattern);

// The files of what copy_video_into() gave, relative to the folder, in the order of their names.
[[nodiscard]] std::vector<std::string> video_files(const std::filesystem::path& session_folder,
                                                   const std::string& video);

}  // namespace arthronaut::recording
