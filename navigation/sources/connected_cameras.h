// The cameras that are connected, as Linux lists them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::sources {

struct ConnectedCamera {
  int index = 0;     // of /dev/videoN
  std::string name;  // "Capture card"; "/dev/video0" where the system tells none
};

// By index; empty when there is none. Further nodes of a camera, which give no pictures (its metadata), are
// left out. The folders are given for tests alone.
[[nodiscard]] std::vector<ConnectedCamera> connected_cameras(
    const std::filesystem::path& devices = "/dev",
    const std::filesystem::path& names = "/sys/class/video4linux");

}  // namespace arthronaut::sources
