#include "planning/files/within_folder.h"

namespace arthronaut::files {

std::string within_folder(const std::filesystem::path& folder, std::string reason) {
  if (folder.empty()) return reason;
  const std::string prefix = (folder / "").string();  // with the stroke: "." stands in any sentence
  for (auto at = reason.find(prefix); at != std::string::npos; at = reason.find(prefix, at))
    reason.erase(at, prefix.size());
  return reason;
}

}  // namespace arthronaut::files
