// Where the pictures for setting up can come from: the simulated arthroscope, folders of still pictures, the
// case's videos, what the user named, camera devices.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/setup_view/frame_feed.h"
#include "navigation/camera/camera_model.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::setup_view {

enum class Purpose { Camera, Tools, Fluid };

// Always at least the simulated arthroscope, which comes first. Looks into the file system, opens nothing.
// Folders of stills (the case's own and those right inside it) are offered for the camera alone. `named` are
// paths the user typed: a folder of pictures or a video; others are left out.
[[nodiscard]] std::vector<FeedSource> sources_for(Purpose purpose, const std::filesystem::path& case_folder,
                                                  const std::vector<std::filesystem::path>& named = {});

// Which of these was made from this path; nullopt: none.
[[nodiscard]] std::optional<std::size_t> index_of(const std::vector<FeedSource>& sources,
                                                  const std::filesystem::path& path);

// The pictures in a folder (*.png, *.jpg, *.jpeg, *.bmp, *.tif, *.tiff), by name.
[[nodiscard]] std::vector<std::filesystem::path> pictures_of(const std::filesystem::path& folder);

// The name that camera.json carries for the simulated arthroscope.
inline constexpr const char* kSimulatedScope = "Simulated arthroscope";

// What a source is tracked with: the case's camera.json; of the simulated arthroscope its own, unless the
// case has adopted a calibration of it. Throws InvalidInput or IoError.
[[nodiscard]] camera::Calibration camera_of(const FeedSource& source,
                                            const std::filesystem::path& case_folder);
// The case's tools.json, or the standard tools where it has none; the simulated arthroscope shows the
// standard tools. Throws InvalidInput or IoError.
[[nodiscard]] tools::ToolSet tools_of(const FeedSource& source, const std::filesystem::path& case_folder);

// Why what was found with this source may not replace the files of this case: a simulated result is kept from
// replacing that of a real scope or tool. Empty when it may.
[[nodiscard]] std::string camera_is_kept(const FeedSource& source, const std::filesystem::path& case_folder);
[[nodiscard]] std::string tools_are_kept(const FeedSource& source, const std::filesystem::path& case_folder);

}  // namespace arthronaut::setup_view
