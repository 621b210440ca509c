// One DICOM file of a series: what its header says, and its pixels. Inner header of images.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace arthronaut::images {

struct DicomSlice {
  std::filesystem::path file;
  std::string series_uid, series_number, description, modality;
  bool is_image = false;  // a plan, a contour or a report is none
  int columns = 0, rows = 0, frames = 1, samples_per_pixel = 1;
  // LPS, mm. has_geometry is false when the header lacks one of them.
  bool has_geometry = false;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();    // the centre of the first pixel
  Eigen::Vector3d along_columns = Eigen::Vector3d::Zero();  // unit, of increasing column index
  Eigen::Vector3d along_rows = Eigen::Vector3d::Zero();     // unit, of increasing row index
  double column_spacing_mm = 0, row_spacing_mm = 0;
  std::optional<double> echo_time_ms;
  double slope = 1, intercept = 0;

  [[nodiscard]] Eigen::Vector3d normal() const;
  [[nodiscard]] double depth_mm() const { return normal().dot(position_mm); }
};

// Keeps no pixels: they are read when the volume is put together. nullopt for a file that is not DICOM.
// Throws InvalidInput for one that is, and is broken.
[[nodiscard]] std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file);

// Rescaled pixels, columns * rows of them, appended to `values`. Throws InvalidInput: a compression that
// cannot be decoded, pixels cut off, colours.
void append_dicom_pixels(const DicomSlice& slice, std::vector<float>& values);

}  // namespace arthronaut::images
