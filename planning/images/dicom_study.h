// The slices that a folder, a DICOMDIR or a file leads to, by series, and what makes a volume of a series.
// Inner header of images.
#pragma once

#include <exception>
#include <map>
#include <string>
#include <vector>

#include "planning/images/dicom_slice.h"
#include "planning/images/series_list.h"
#include "planning/images/volume_file.h"

namespace arthronaut::images {

using DicomSlices = std::vector<DicomSlice>;

// One that cannot be read, and which series it is of, where that stands before its damage.
struct BrokenDicom {
  SkippedFile skipped;
  std::string series_uid;
  std::exception_ptr error;
};

struct DicomStudy {
  std::map<std::string, DicomSlices> series;  // by UID
  std::vector<SkippedFile> skipped;           // DICOM files that are no image
  std::vector<BrokenDicom> broken;            // one of them hides none of the others
  std::vector<std::filesystem::path> others;  // no DICOM
  std::size_t dicom_count = 0;
};

// Headers alone are read. `progress` gets a fraction of 0 to 1. Throws IoError, InvalidInput: of what is
// there as a whole, not of one file.
[[nodiscard]] DicomStudy read_dicom_study(const std::filesystem::path& source, std::size_t most_bytes,
                                          const std::function<void(double)>& progress);

// "CT series 3 "Knee 0.6", 400 images".
[[nodiscard]] std::string described(const DicomSlices& slices);

// Slices in the order of their places, one at each, evenly spaced.
struct DicomStack {
  DicomSlices slices;
  Eigen::Vector3d step_mm =
      Eigen::Vector3d::Zero();     // from slice to slice; not along the normal for a tilted gantry
  std::vector<std::string> notes;  // choices that were made
};
// Throws InvalidInput (file, place, reason): no geometry, mixed sizes, a missing slice, slices twice, one
// slice only. `source` is for messages.
[[nodiscard]] DicomStack stacked(const std::filesystem::path& source, DicomSlices slices);

}  // namespace arthronaut::images
