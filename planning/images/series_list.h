// What a folder from a hospital holds: its image series, what each is and what is wrong with it, without
// opening them.
//
// A folder of a PACS download or a disc holds several series, plans, reports and pictures of screens. The
// list says of each series whether read_volume() would take it, and if not, why, in the same words.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "planning/images/volume_file.h"

namespace arthronaut::images {

struct ImageSeries {
  std::string uid = {};     // DICOM: what VolumeFileOptions::series takes; empty for other files
  std::string number = {};  // DICOM: the series number
  std::string format = {};  // "DICOM", "NIfTI", "NRRD", "MetaImage"
  std::string modality = {}, description = {};  // as the file says; may be empty
  // DICOM: whose images they are and of when ("20260131"), as the file says; may be empty.
  std::string patient_name = {}, patient_id = {}, study_date = {};
  int image_count = 0;  // slices as stored; several for each place in a multi-echo series
  // Columns, rows and slices of the volume that it makes, and their distances. Zero where unknown: of a
  // refused series what its first image says.
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3d spacing_mm = Eigen::Vector3d::Zero();
  // In the order of the slices where there is one. A file of several frames stands once.
  std::vector<std::filesystem::path> files = {};
  std::string refusal = {};  // why it cannot be opened; empty when it can
  std::vector<std::string> warnings =
      {};  // it can be opened, but a person should know: gaps, few slices, echoes

  [[nodiscard]] bool is_readable() const { return refusal.empty(); }
};

// "CT series 3: Knee 0.6 bone"; of what has no description its file's name.
[[nodiscard]] std::string title_of(const ImageSeries& series);
// "400 images, 512 x 512 x 400 voxels of 0.4 x 0.4 x 0.6 mm", with signs of multiplication.
[[nodiscard]] std::string detail_of(const ImageSeries& series);

struct SkippedFile {
  std::filesystem::path file;
  std::string reason;  // without the file's name: "is no image", "byte 312: broken or cut off: ..."
};

struct SeriesList {
  std::vector<ImageSeries> series;   // by series number, then UID; other volumes after DICOM, by name
  std::vector<SkippedFile> skipped;  // DICOM files that are no image, broken files
  std::size_t other_count = 0;       // files that are nothing of an image
};

// `source` is a folder (looked through to its depths), a DICOMDIR or one volume file. Throws IoError when it
// cannot be listed, InvalidInput when it holds too many files or is a broken directory; a broken file in a
// folder is listed as skipped. A folder without images gives an empty list. Of options `on_progress` and
// `most_bytes` count.
[[nodiscard]] SeriesList find_series(const std::filesystem::path& source,
                                     const VolumeFileOptions& options = {});

// A small picture for a list.
struct Thumbnail {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;  // rows from the top; 0 black
};

// The middle slice, its sides in the proportion that they have in the patient, the longer one of
// `longest_side` pixels. The window runs from the 1 % to the 99 % quantile of the slice's values. Reads that
// slice alone for DICOM, the whole file for others. Throws IoError and InvalidInput as read_volume; a
// series that is refused may have a picture all the same.
[[nodiscard]] Thumbnail thumbnail_of(const ImageSeries& series, int longest_side = 128);

}  // namespace arthronaut::images
