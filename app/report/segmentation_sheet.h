// What became of a segmentation, on one page: each bone's surface over the images in three planes, and what
// speaks for and against it.
#pragma once

#include <filesystem>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"
#include "planning/import/bone_quality.h"

namespace arthronaut::report {

struct SegmentedBone {
  importing::BoneQuality quality;
  geometry::TriangleMesh mesh;  // LPS, mm
};

// PDF, A4, replaced in one step; it names no patient. volume: that was segmented. Throws IoError.
void write_segmentation_sheet(const std::filesystem::path& file, const images::Volume& volume,
                              const std::vector<SegmentedBone>& bones);

}  // namespace arthronaut::report
