// How this workstation keeps the pictures of its sessions: chosen once, remembered. With the user's data, not
// with a case: it belongs to the room, its streams and its disk.
#pragma once

#include <filesystem>

#include "navigation/recording/kept_video.h"

namespace arthronaut::navigate {

// Beside the built-in case: $XDG_DATA_HOME/arthronaut/pictures.json, else ~/.local/share/...
[[nodiscard]] std::filesystem::path picture_keeping_file();
// As they came where there is no such file, or it can't be read: nothing is lost by that.
[[nodiscard]] recording::PicturesAs load_picture_keeping(const std::filesystem::path& file);
// Throws IoError.
void save_picture_keeping(const std::filesystem::path& file, recording::PicturesAs as);

}  // namespace arthronaut::navigate
