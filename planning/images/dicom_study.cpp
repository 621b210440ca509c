#include "planning/images/dicom_study.h"

#include <algorithm>
#include <iterator>

#include "planning/geometry/error.h"
#include "planning/images/dicom_directory.h"
#include "planning/images/dicom_file.h"

namespace arthronaut::images {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 50000, kMostSlices = 200000;

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::path place = folder;  // that is listed next
  for (auto at = fs::recursive_directory_iterator(folder, error);
       !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    place = at->path();
    if (at->is_regular_file(error)) files.push_back(place);
    if (files.size() > kMostFiles)
      throw InvalidInput(folder, "",
                         "holds more than " + std::to_string(kMostFiles) +
                             " files, which no study of a knee has: choose the folder of the study alone");
  }
  if (error) throw IoError(place, "cannot be listed: " + error.message());
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

// Without the "FILE: " that messages begin with.
std::string without_name(const fs::path& file, const std::string& message) {
  const std::string start = file.string() + ": ";
  return message.starts_with(start) ? message.substr(start.size()) : message;
}

}  // namespace

DicomStudy read_dicom_study(const fs::path& source, std::size_t most_bytes,
                            const std::function<void(double)>& progress) {
  const std::vector<fs::path> files = files_of(source, most_bytes);
  DicomStudy study;
  std::size_t slice_count = 0, done = 0;
  for (const auto& file : files) {
    std::optional<DicomSlices> found;
    try {
      found = read_dicom_slices(file, most_bytes);
      study.dicom_count += found.has_value();
      if (!found) study.others.push_back(file);
      if (found && found->empty()) study.skipped.push_back({file, "is no image"});
    } catch (const std::runtime_error& error) {
      study.broken.push_back({{file, without_name(file, error.what())},
                              series_uid_before_damage(file),
                              std::current_exception()});
    }
    if (found) {
      slice_count += found->size();
      for (DicomSlice& slice : *found) study.series[slice.series_uid].push_back(std::move(slice));
    }
    if (slice_count > kMostSlices)
      throw InvalidInput(source, "", "holds more slices than a study of a knee has");
    progress(static_cast<double>(++done) / static_cast<double>(files.size()));
  }
  return study;
}

std::string described(const DicomSlices& slices) {
  const DicomSlice& first = slices.front();
  return first.modality + " series " + (first.series_number.empty() ? "?" : first.series_number) +
         (first.description.empty() ? "" : " \"" + first.description + "\"") + ", " +
         std::to_string(slices.size()) + (slices.size() == 1 ? " image" : " images");
}

}  // namespace arthronaut::images
