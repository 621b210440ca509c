#include <algorithm>
#include <cmath>
#include <iterator>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/images/dicom_directory.h"
#include "planning/images/dicom_file.h"
#include "planning/images/dicom_slice.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

namespace fs = std::filesystem;
using Slices = std::vector<DicomSlice>;

// Slices lie where their positions say, to the rounding of scanners' headers; a missing slice is 100 % off.
constexpr double kPositionTolerance_fraction = 0.05;
constexpr std::size_t kMostFiles = 50000, kMostSlices = 200000;
// Of the time that reading takes; the rest goes into the pixels.
constexpr double kHeadersFraction = 0.5;

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (auto at = fs::recursive_directory_iterator(folder, error);
       !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (at->is_regular_file(error)) files.push_back(at->path());
    if (files.size() > kMostFiles)
      throw InvalidInput(folder, "", "holds more files than a study of a knee has");
  }
  if (error) throw IoError(folder, "cannot list: " + error.message());
  // The folder's order is the file system's: the same folder must give the same volume everywhere.
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InvalidInput(folder, "", "is empty");
  return files;
}

// The folder's own table of contents at its top, when it has one.
std::optional<fs::path> directory_in(const fs::path& folder) {
  for (const char* name : {"DICOMDIR", "dicomdir"}) {
    if (fs::is_regular_file(folder / name) && has_dicom_mark(folder / name)) return folder / name;
  }
  return std::nullopt;
}

// What the source leads to: files that may be slices.
std::vector<fs::path> files_of(const fs::path& source, std::size_t most_bytes) {
  const bool is_folder = fs::is_directory(source);
  const std::optional<fs::path> directory = is_folder ? directory_in(source) : source;
  if (directory) {
    const auto images = images_of_dicom_directory(*directory, most_bytes);
    if (images && images->empty()) throw InvalidInput(*directory, "", "lists no image");
    if (images) return *images;
  }
  return is_folder ? files_below(source) : std::vector<fs::path>{source};
}

Slices slices_of(const fs::path& source, const VolumeFileOptions& options) {
  const std::vector<fs::path> files = files_of(source, options.most_bytes);
  Slices slices;
  std::size_t dicom_count = 0, done = 0;
  for (const auto& file : files) {
    auto found = read_dicom_slices(file, options.most_bytes);
    dicom_count += found.has_value();
    if (found) std::move(found->begin(), found->end(), std::back_inserter(slices));
    if (slices.size() > kMostSlices)
      throw InvalidInput(source, "", "holds more slices than a study of a knee has");
    report(options, kHeadersFraction * static_cast<double>(++done) / static_cast<double>(files.size()));
  }
  if (dicom_count == 0) throw InvalidInput(source, "", "holds no DICOM file");
  if (slices.empty()) throw InvalidInput(source, "", "holds DICOM files, but no image among them");
  return slices;
}

std::string described(const DicomSlice& first, std::size_t count) {
  return first.modality + " series " + (first.series_number.empty() ? "?" : first.series_number) +
         (first.description.empty() ? "" : " \"" + first.description + "\"") + ", " + std::to_string(count) +
         " images";
}

Slices chosen_series(const fs::path& source, Slices slices, const std::string& wanted) {
  std::map<std::string, Slices> series;
  for (auto& slice : slices) series[slice.series_uid].push_back(std::move(slice));
  std::string list;
  std::vector<Slices*> matching;
  for (auto& [uid, members] : series) {
    const DicomSlice& first = members.front();
    list += (list.empty() ? "" : "; ") + described(first, members.size()) + ", UID " + uid;
    if (wanted.empty() || wanted == uid || wanted == first.series_number) matching.push_back(&members);
  }
  if (matching.empty()) throw InvalidInput(source, "", "holds no series " + wanted + ": " + list);
  if (matching.size() > 1) {
    throw InvalidInput(
        source, "",
        "holds " + std::to_string(series.size()) + " series, name one with --series NUMBER or UID: " + list);
  }
  return std::move(*matching.front());
}

void refuse_odd_ones(const Slices& slices) {
  const DicomSlice& first = slices.front();
  const auto refuse = [](const DicomSlice& s, const std::string& reason) {
    throw InvalidInput(s.file, s.place(), reason);
  };
  for (const DicomSlice& s : slices) {
    if (!s.has_geometry) refuse(s, "does not say where it lies in the patient");
    if (s.frame.columns != first.frame.columns || s.frame.rows != first.frame.rows) {
      refuse(s, "is " + std::to_string(s.frame.columns) + " x " + std::to_string(s.frame.rows) +
                    " pixels, other images of the series are " + std::to_string(first.frame.columns) + " x " +
                    std::to_string(first.frame.rows));
    }
    // Scout pictures across the others often share their series.
    if (s.along_columns.dot(first.along_columns) < 0.9999 || s.along_rows.dot(first.along_rows) < 0.9999)
      refuse(s, "lies at an angle to " + first.name() + " of the same series");
    if (std::abs(s.column_spacing_mm - first.column_spacing_mm) > 1e-3 * first.column_spacing_mm ||
        std::abs(s.row_spacing_mm - first.row_spacing_mm) > 1e-3 * first.row_spacing_mm) {
      refuse(s, "has another pixel spacing than other images of the series");
    }
  }
}

// A multi-echo series has each slice several times: the first echo is the one with the most signal.
void keep_first_echo(Slices& slices, std::vector<std::string>& notes) {
  std::map<double, std::size_t> echoes;
  for (const DicomSlice& s : slices) {
    if (!s.echo_time_ms) return;
    ++echoes[*s.echo_time_ms];
  }
  if (echoes.size() < 2) return;
  const auto [first_ms, count] = *echoes.begin();
  // A series whose slices merely differ in their echo time has no position twice.
  if (count == slices.size() || count < 2) return;
  std::erase_if(slices, [first = first_ms](const DicomSlice& s) { return *s.echo_time_ms != first; });
  notes.push_back("of " + std::to_string(echoes.size()) + " echoes the first was taken" +
                  files::format(" (echo time %.3g ms)", first_ms));
}

bool has_position_twice(const Slices& sorted) {
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    if (sorted[i + 1].depth_mm() - sorted[i].depth_mm() < 0.01) return true;
  }
  return false;
}

void sort_by_position(Slices& slices) {
  std::stable_sort(slices.begin(), slices.end(),
                   [](const DicomSlice& a, const DicomSlice& b) { return a.depth_mm() < b.depth_mm(); });
}

// The step from slice to slice, in the patient: not along the normal for a CT with a tilted gantry.
Eigen::Vector3d slice_step_mm(const Slices& sorted) {
  std::vector<double> gaps;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i)
    gaps.push_back(sorted[i + 1].depth_mm() - sorted[i].depth_mm());
  const double usual = geometry::median(gaps);
  const Eigen::Vector3d step =
      (sorted.back().position_mm - sorted.front().position_mm) / static_cast<double>(sorted.size() - 1);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const DicomSlice& next = sorted[i + 1];
    if (std::abs(gaps[i] - usual) > kPositionTolerance_fraction * usual) {
      throw InvalidInput(
          next.file, next.place(),
          files::format("lies %.2f mm from the slice before it, the others %.2f mm apart", gaps[i], usual) +
              ": a slice is missing or one too many (" + sorted[i].file.filename().string() + ")");
    }
  }
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const DicomSlice& next = sorted[i + 1];
    const Eigen::Vector3d expected = sorted.front().position_mm + static_cast<double>(i + 1) * step;
    if ((next.position_mm - expected).norm() > kPositionTolerance_fraction * usual + 0.02) {
      throw InvalidInput(next.file, next.place(),
                         files::format("lies %.2f mm beside the line of the other slices",
                                       (next.position_mm - expected).norm()));
    }
  }
  return step;
}

}  // namespace

Volume read_dicom(const fs::path& source, const VolumeFileOptions& options) {
  Slices slices = chosen_series(source, slices_of(source, options), options.series);
  Volume volume;
  volume.format = "DICOM";
  refuse_odd_ones(slices);
  sort_by_position(slices);
  if (has_position_twice(slices)) keep_first_echo(slices, volume.notes);
  if (slices.size() < 2) {
    throw InvalidInput(source, "",
                       fs::is_directory(source) ? "holds one slice only"
                                                : "is one slice: name the folder that holds its series");
  }
  for (std::size_t i = 0; i + 1 < slices.size(); ++i) {
    if (slices[i + 1].depth_mm() - slices[i].depth_mm() < 0.01) {
      throw InvalidInput(slices[i + 1].file, slices[i + 1].place(),
                         "lies at the same place as " + slices[i].name());
    }
  }
  const DicomSlice& first = slices.front();
  volume.modality = first.modality;
  volume.patient = first.patient;
  volume.size = {first.frame.columns, first.frame.rows, static_cast<int>(slices.size())};
  volume.values.reserve(checked_voxel_count(source, volume.size, 0, options.most_bytes));
  volume.lps_from_index.linear().col(0) = first.along_columns * first.column_spacing_mm;
  volume.lps_from_index.linear().col(1) = first.along_rows * first.row_spacing_mm;
  volume.lps_from_index.linear().col(2) = slice_step_mm(slices);
  volume.lps_from_index.translation() = first.position_mm;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    append_pixels(slices[i], volume.values);
    slices[i].pixels.reset();  // what a codec has kept goes with them
    const double done = static_cast<double>(i + 1) / static_cast<double>(slices.size());
    report(options, kHeadersFraction + (1 - kHeadersFraction) * done);
  }
  volume.notes.insert(volume.notes.begin(), described(first, slices.size()));
  finish(volume, source);
  return volume;
}

}  // namespace arthronaut::images
