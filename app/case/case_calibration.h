// The camera and the tools that the pictures of a case are tracked with: what Set up adopted, or what is
// built in. Navigate asks here too, so that both mean the same.
#pragma once

#include <filesystem>
#include <string>

#include "navigation/camera/camera_model.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::open_case {

// The name that camera.json carries for the simulated arthroscope.
inline constexpr const char* kSimulatedScope = "Simulated arthroscope";

// Pictures of a real scope are tracked with the case's camera.json; those of the simulated arthroscope with
// its own camera, unless the case has adopted a calibration of it. Throws InvalidInput or IoError.
[[nodiscard]] camera::Calibration camera_of(bool is_simulated, const std::filesystem::path& case_folder);
// The case's tools.json, or the standard tools where it has none. What the simulated arthroscope shows are
// the standard tools: a tools.json that stands beside a real scope's camera.json is not of them. Throws
// InvalidInput or IoError.
[[nodiscard]] tools::ToolSet tools_of(bool is_simulated, const std::filesystem::path& case_folder);
// Both in words: "camera of 2026-11-21, 1 of 4 tools calibrated". Throws as those.
[[nodiscard]] std::string calibration_in_words(bool is_simulated, const std::filesystem::path& case_folder);

// Why what was found with simulated pictures may not replace the files of this case: those are of a real
// scope or tool. Empty when it may.
[[nodiscard]] std::string camera_is_kept(bool is_simulated, const std::filesystem::path& case_folder);
[[nodiscard]] std::string tools_are_kept(bool is_simulated, const std::filesystem::path& case_folder);

}  // namespace arthronaut::open_case
