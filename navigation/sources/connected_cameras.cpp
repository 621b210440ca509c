#include "navigation/sources/connected_cameras.h"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "navigation/sources/device_identity.h"

namespace arthronaut::sources {

std::vector<ConnectedCamera> connected_cameras(const std::filesystem::path& devices,
                                               const std::filesystem::path& names) {
  constexpr std::string_view kPrefix = "video";
  std::vector<ConnectedCamera> cameras;
  std::error_code ignored;  // a machine without that folder has no camera
  for (const auto& entry : std::filesystem::directory_iterator(devices, ignored)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(kPrefix)) continue;
    ConnectedCamera camera;
    const char* const end = file.data() + file.size();
    const auto parsed = std::from_chars(file.data() + kPrefix.size(), end, camera.index);
    if (parsed.ec != std::errc{} || parsed.ptr != end) continue;
    const std::optional<DeviceSays> says = ask_device(entry.path());
    if (says && !says->gives_pictures) continue;
    std::ifstream name(names / file / "name");
    if (!std::getline(name, camera.name) || camera.name.empty())
      camera.name = says && !says->card.empty() ? says->card : entry.path().string();
    cameras.push_back(std::move(camera));
  }
  std::sort(cameras.begin(), cameras.end(),
            [](const ConnectedCamera& a, const ConnectedCamera& b) { return a.index < b.index; });
  return cameras;
}

}  // namespace arthronaut::sources
