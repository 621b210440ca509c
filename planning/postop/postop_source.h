// Post-operative images from whatever an import reads: a CT, a label map, a mesh.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "planning/images/series_list.h"
#include "planning/images/volume.h"

namespace arthronaut::postop {

struct PostopSourceOptions {
  std::string series = {};    // DICOM: series number or UID, where there are several
  std::set<int> labels = {};  // label maps: those that are bone; empty: all but 0
  std::function<void(double fraction)> on_progress = nullptr;  // of reading
};

// Of what a folder or a disc from a hospital holds, what may be compared: the CTs that can be opened, the
// finest slices first.
[[nodiscard]] std::vector<images::ImageSeries> comparable_series(std::vector<images::ImageSeries> series);

// A CT as it is. A label map, or a mesh of one drilled bone (closed, or with holes that can be mended), as a
// picture of it without noise: 1000 HU where there is bone, 0 HU elsewhere. Throws IoError, InvalidInput
// (file, place, reason): unreadable, an MR, labels that are not there.
[[nodiscard]] images::Volume read_postop(const std::filesystem::path& source,
                                         const PostopSourceOptions& options = {});

}  // namespace arthronaut::postop
