// The images that a case keeps, so that Plan mode can show slices: the volume as it was imported, without
// loss, in images/ of the case's folder. Whose picture it is, it does not say (identity.h).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>

#include "planning/images/volume.h"
#include "planning/images/volume_writer.h"

namespace arthronaut::cases {

// Of case.json; the volume itself is loaded when it is shown.
struct CaseImage {
  std::string file;           // within the case's folder, "images/1.nrrd"
  std::string modality = {};  // "CT", "MR"; empty when unknown
  std::string source = {};    // "DICOM", "NIfTI"
  bool is_label_map = false;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3d spacing_mm = Eigen::Vector3d::Zero();
};

// Throws IoError or InvalidInput (file, place, reason). A CT of 512 x 512 x 400 takes about a second and 0.7
// GiB while it is read. Values and axes are those of the source.
[[nodiscard]] images::Volume load_image(const std::filesystem::path& case_folder, const CaseImage& image,
                                        const std::function<void(double fraction)>& on_progress = nullptr);

// Writes the volume as image `number` (from 1) of the case, over what is there; names it in image.file.
// case.json does not name it before it is saved. Throws IoError.
void store_image(const std::filesystem::path& case_folder, int number, const images::EncodedVolume& volume,
                 CaseImage& image);

}  // namespace arthronaut::cases
