#include "planning/postop/postop_source.h"

#include <algorithm>
#include <cmath>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/images/volume_file.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr float kBone_hu = 1000;
// Whole numbers alone make no label map where some are as large as bone is dense: a CT without noise.
constexpr int kLeastBone_hu = 200;
constexpr double kMeshVoxel_mm = 0.5, kRoom_mm = 8;
constexpr double kLargest_mm = 600;  // a mesh in other units is no bone

void make_picture_of_labels(images::Volume& volume, const std::set<int>& labels,
                            const std::filesystem::path& source) {
  const auto there = images::labels_of(volume);
  for (const int label : labels) {
    if (std::none_of(there.begin(), there.end(), [&](const auto& one) { return one.first == label; }))
      throw InvalidInput(source, "", "holds no label " + std::to_string(label));
  }
  for (float& value : volume.values) {
    const bool is_bone = labels.empty() ? value != 0 : labels.contains(static_cast<int>(value));
    value = is_bone ? kBone_hu : 0;
  }
  volume.segments.clear();
}

// Each voxel by the share of it that is in the bone: exact along z, over 2 x 2 lines across it.
images::Volume picture_of(const geometry::TriangleMesh& mesh) {
  const geometry::Surface bone(mesh);
  const geometry::Bounds bounds = geometry::bounds_of(mesh);
  images::Volume volume;
  const Vector3d low = bounds.min_mm.array() - kRoom_mm;
  volume.size = ((bounds.size_mm().array() + 2 * kRoom_mm) / kMeshVoxel_mm).ceil().cast<int>();
  volume.lps_from_index.linear() = Vector3d::Constant(kMeshVoxel_mm).asDiagonal();
  volume.lps_from_index.translation() = low;
  volume.format = "mesh";
  volume.values.assign(static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()), 0.0F);
  constexpr int kLines = 2;
  for (int j = 0; j < kLines * volume.size.y(); ++j) {
    for (int i = 0; i < kLines * volume.size.x(); ++i) {
      const Vector3d index((i + 0.5) / kLines - 0.5 + 1.3e-5, (j + 0.5) / kLines - 0.5 + 2.7e-5, -0.5);
      float* const column = volume.values.data() + volume.index(i / kLines, j / kLines, 0);
      const auto slice =
          static_cast<std::size_t>(volume.size.x()) * static_cast<std::size_t>(volume.size.y());
      int within = 0;
      double from = 0;
      for (const auto& hit : bone.all_hits(volume.lps_from_index * index, Vector3d::UnitZ())) {
        const double at = hit.distance_mm / kMeshVoxel_mm;
        const bool enters = hit.normal.z() < 0;
        if (enters && within++ == 0) from = at;
        if (enters || within == 0 || --within > 0) continue;
        for (int k = static_cast<int>(from); k < std::min<double>(at, volume.size.z()); ++k)
          column[static_cast<std::size_t>(k) * slice] +=
              static_cast<float>(std::min(at, k + 1.0) - std::max<double>(from, k)) * kBone_hu /
              (kLines * kLines);
      }
    }
  }
  return volume;
}

images::Volume volume_of_mesh(const std::filesystem::path& source) {
  const bones::MeshFile file = bones::read_mesh_file(source);
  try {
    const auto mended = bones::mend_mesh(file.mesh);
    if (!mended.report.is_closed) throw InvalidInput("is not closed, and its holes cannot be mended");
    if (geometry::bounds_of(mended.mesh).size_mm().maxCoeff() > kLargest_mm)
      throw InvalidInput("is larger than any bone");
    return picture_of(mended.mesh);
  } catch (const InvalidInput& error) {
    throw InvalidInput(source, "", error.what());
  }
}

}  // namespace

std::vector<images::ImageSeries> comparable_series(std::vector<images::ImageSeries> series) {
  // A scout has one image.
  std::erase_if(series, [](const images::ImageSeries& one) {
    return !one.is_readable() || one.uid.empty() || one.modality != "CT" || one.size.z() < 2;
  });
  std::stable_sort(series.begin(), series.end(),
                   [](const auto& a, const auto& b) { return a.spacing_mm.z() < b.spacing_mm.z(); });
  return series;
}

images::Volume read_postop(const std::filesystem::path& source, const PostopSourceOptions& options) {
  if (!std::filesystem::exists(source)) throw IoError(source, "does not exist");
  const bool is_mesh = bones::is_mesh_file(source) && !std::filesystem::is_directory(source);
  if (is_mesh) {
    if (!options.series.empty() || !options.labels.empty())
      throw InvalidInput(source, "", "is a mesh: --series and --label are for volumes");
    return volume_of_mesh(source);
  }
  if (!images::is_volume_source(source))
    throw InvalidInput(
        source, "",
        "is nothing that is compared: DICOM, a volume (NIfTI, NRRD, MetaImage) or a mesh (STL, "
        "PLY, OBJ, VTK, VTP)");
  images::VolumeFileOptions reading{.series = options.series};
  reading.on_progress = options.on_progress;
  images::Volume volume = images::read_volume(source, reading);
  if (volume.modality == images::Modality::Mr || volume.modality == images::Modality::Other)
    throw InvalidInput(source, "",
                       "is " + volume.modality_in_file + ": a tunnel is found in a CT, or in a label map");
  const bool has_labels = !options.labels.empty() ||
                          (images::is_label_map(volume) && std::ranges::max(volume.values) < kLeastBone_hu);
  if (has_labels) make_picture_of_labels(volume, options.labels, source);
  return volume;
}

}  // namespace arthronaut::postop
