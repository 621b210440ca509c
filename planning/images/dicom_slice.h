// The slices of one DICOM file: what its header says of each, and the pixels. Inner header of images.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/images/dicom_origin.h"
#include "planning/images/dicom_pixels.h"
#include "planning/images/volume.h"

namespace arthronaut::images {

struct DicomSlice {
  std::filesystem::path file;
  std::string series_uid, series_number, description, modality;
  Patient patient;
  DicomFrame frame;
  int frames_in_file = 1;
  // LPS, mm. has_geometry is false when the header lacks one of them.
  bool has_geometry = false;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();    // the centre of the first pixel
  Eigen::Vector3d along_columns = Eigen::Vector3d::Zero();  // unit, of increasing column index
  Eigen::Vector3d along_rows = Eigen::Vector3d::Zero();     // unit, of increasing row index
  double column_spacing_mm = 0, row_spacing_mm = 0;
  std::optional<double> echo_time_ms;
  std::optional<bones::Side> side;            // that is shown; not of both, or unpaired
  std::optional<double> instance_number;      // of the file, as its scanner counted
  double gantry_tilt_deg = 0;                 // as the header says; 0 where it does not
  std::shared_ptr<const DicomOrigin> origin;  // of the whole file
  std::shared_ptr<const DicomPixels> pixels;  // of the whole file

  [[nodiscard]] Eigen::Vector3d normal() const;
  [[nodiscard]] double depth_mm() const { return normal().dot(position_mm); }
  // For messages: "frame 12", from 1, where the file holds several.
  [[nodiscard]] std::string place() const;
  [[nodiscard]] std::string name() const;  // the file's name without its folder, and the frame
};

// One slice, or for an enhanced (multi-frame) CT or MR one a frame, each where its functional groups say that
// it lies. Empty for what is no image: a plan, a contour, a report. nullopt for a file that is not DICOM.
//
// No pixels are read: they are when the volume is put together, by append_pixels. Throws InvalidInput for a
// DICOM file that is broken, IoError for one that cannot be read. `most_bytes` as in VolumeFileOptions.
[[nodiscard]] std::optional<std::vector<DicomSlice>> read_dicom_slices(const std::filesystem::path& file,
                                                                       std::size_t most_bytes);

// Rescaled, appended to `values`. Throws InvalidInput as DicomPixels.
void append_pixels(const DicomSlice& slice, std::vector<float>& values);

}  // namespace arthronaut::images
