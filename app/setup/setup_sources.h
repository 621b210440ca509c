// Where the pictures for setting up can come from: the simulated arthroscope, folders of still pictures, the
// case's videos, what the user named, camera devices.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/setup/frame_feed.h"
#include "navigation/sources/device_turns.h"

namespace arthronaut::setup {

enum class Purpose { Camera, Tools, Fluid };

// What the user types to be offered the simulated arthroscope in a case with a real scope.
inline constexpr const char* kSimulatorWord = "simulator";

// The simulated arthroscope comes first, but in a case with a real scope (open_case::has_real_camera) it is
// offered only to who asks for it by its word, last; there the cameras come first. May be empty. Looks into
// the file system, opens nothing. Folders of stills (the case's own and those right inside it) are offered
// for the camera alone. `named` are what the user typed, and the streams that this room has used: a folder
// of pictures, a video, or the address of a camera ("/dev/video0?rate=60") or of a stream ("rtsp://...",
// "udp://...", "gst:..."); others are left out. An address stands where the cameras do. Cameras are opened in
// their turn.
[[nodiscard]] std::vector<FeedSource> sources_for(Purpose purpose, const std::filesystem::path& case_folder,
                                                  const sources::DeviceTurns& turns,
                                                  const std::vector<std::filesystem::path>& named = {});

// Which of these was made from this path; nullopt: none.
[[nodiscard]] std::optional<std::size_t> index_of(const std::vector<FeedSource>& sources,
                                                  const std::filesystem::path& path);

}  // namespace arthronaut::setup
