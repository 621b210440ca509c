// Reasons that name files, for whoever knows the folder that they lie in, or is not to be told it.
#pragma once

#include <filesystem>
#include <string>

namespace arthronaut::files {

// "/data/Knee.arthro/plan.json: is broken" within /data/Knee.arthro: "plan.json: is broken".
[[nodiscard]] std::string within_folder(const std::filesystem::path& folder, std::string reason);

}  // namespace arthronaut::files
