#include "planning/images/series_list.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/images/dicom_file.h"
#include "planning/images/dicom_study.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

namespace fs = std::filesystem;

// Below this a bone's surface cannot be had as finely as a tunnel is planned.
constexpr int kFewSlices = 20;
constexpr double kThickStep_mm = 2.0;

// Each file once, in the order of the slices.
std::vector<fs::path> files_of(const DicomSlices& slices) {
  std::vector<fs::path> files;
  for (const DicomSlice& slice : slices) {
    if (std::find(files.rbegin(), files.rend(), slice.file) == files.rend()) files.push_back(slice.file);
  }
  return files;
}

std::vector<std::string> warnings_of(const ImageSeries& series) {
  std::vector<std::string> warnings;
  if (series.size.z() < kFewSlices)
    warnings.push_back(files::format("%d slices only: a knee needs more", series.size.z()));
  if (const double widest = series.spacing_mm.maxCoeff(); widest > kThickStep_mm)
    warnings.push_back(
        files::format("%.1f mm from slice to slice: surfaces of bones come out coarse", widest));
  return warnings;
}

ImageSeries series_of(const fs::path& source, DicomSlices slices) {
  const DicomSlice& first = slices.front();
  ImageSeries series{.uid = first.series_uid,
                     .number = first.series_number,
                     .format = "DICOM",
                     .modality = first.modality,
                     .description = first.description,
                     .patient_name = first.patient.name,
                     .patient_id = first.patient.id,
                     .study_date = first.origin != nullptr ? first.origin->study_date : std::string(),
                     .image_count = static_cast<int>(slices.size()),
                     .size = {first.frame.columns, first.frame.rows, static_cast<int>(slices.size())},
                     .spacing_mm = {first.column_spacing_mm, first.row_spacing_mm, 0},
                     .files = files_of(slices)};
  try {
    const DicomStack stack = stacked(source, std::move(slices));
    series.size.z() = static_cast<int>(stack.slices.size());
    series.spacing_mm.z() = stack.step_mm.norm();
    series.files = files_of(stack.slices);
    series.warnings = warnings_of(series);
    series.warnings.insert(series.warnings.end(), stack.notes.begin(), stack.notes.end());
  } catch (const InvalidInput& error) {
    series.refusal = error.what();
  }
  return series;
}

ImageSeries volume_file(const fs::path& file, const VolumeFileOptions& options) {
  ImageSeries series{.description = file.filename().string(), .image_count = 1, .files = {file}};
  try {
    const Volume volume = read_volume(file, {.series = {}, .most_bytes = options.most_bytes});
    series.format = volume.format;
    series.size = volume.size;
    series.spacing_mm = volume.spacing_mm();
    series.warnings = warnings_of(series);
    series.warnings.insert(series.warnings.end(), volume.notes.begin(), volume.notes.end());
  } catch (const std::runtime_error& error) {
    series.refusal = error.what();
  } catch (const std::bad_alloc&) {  // where memory is limited, one large volume must not hide the others
    series.refusal = file.string() + ": needs more memory than there is";
  }
  return series;
}

double number_of(const ImageSeries& series) {
  const double number = std::strtod(series.number.c_str(), nullptr);
  return std::isfinite(number) ? number : 0;
}

// The values of the slice in the middle, and the size of its pixels.
struct Picture {
  int columns = 0, rows = 0;
  double column_spacing_mm = 1, row_spacing_mm = 1;
  std::vector<float> values;
};

Picture middle_picture(const ImageSeries& series) {
  const fs::path& file = series.files.at(series.files.size() / 2);
  Picture picture;
  if (series.format != "DICOM") {
    const Volume volume = read_volume(file);
    picture.columns = volume.size.x();
    picture.rows = volume.size.y();
    picture.column_spacing_mm = volume.spacing_mm().x();
    picture.row_spacing_mm = volume.spacing_mm().y();
    const auto start =
        volume.values.begin() + static_cast<std::ptrdiff_t>(volume.index(0, 0, volume.size.z() / 2));
    picture.values.assign(start, start + static_cast<std::ptrdiff_t>(picture.columns) * picture.rows);
    return picture;
  }
  auto slices = read_dicom_slices(file, VolumeFileOptions{}.most_bytes);
  if (slices) std::erase_if(*slices, [&](const DicomSlice& s) { return s.series_uid != series.uid; });
  if (!slices || slices->empty()) throw InvalidInput(file, "", "holds no image of the series any more");
  std::stable_sort(slices->begin(), slices->end(),
                   [](const DicomSlice& a, const DicomSlice& b) { return a.depth_mm() < b.depth_mm(); });
  const DicomSlice& middle = (*slices)[slices->size() / 2];
  picture.columns = middle.frame.columns;
  picture.rows = middle.frame.rows;
  if (middle.has_geometry) {
    picture.column_spacing_mm = middle.column_spacing_mm;
    picture.row_spacing_mm = middle.row_spacing_mm;
  }
  append_pixels(middle, picture.values);
  return picture;
}

}  // namespace

SeriesList find_series(const fs::path& source, const VolumeFileOptions& options) {
  if (!fs::exists(source)) throw IoError(source, "does not exist");
  SeriesList list;
  const bool is_folder = fs::is_directory(source);
  if (!is_folder && !(fs::is_regular_file(source) && has_dicom_mark(source))) {
    if (!is_volume_source(source)) throw InvalidInput(source, "", "is no folder and no volume");
    list.series.push_back(volume_file(source, options));
    return list;
  }
  DicomStudy study =
      read_dicom_study(source, options.most_bytes, [&](double fraction) { report(options, fraction); });
  for (auto& [uid, slices] : study.series) list.series.push_back(series_of(source, std::move(slices)));
  std::stable_sort(list.series.begin(), list.series.end(),
                   [](const ImageSeries& a, const ImageSeries& b) { return number_of(a) < number_of(b); });
  list.skipped = std::move(study.skipped);
  for (BrokenDicom& broken : study.broken) list.skipped.push_back(std::move(broken.skipped));
  for (const fs::path& other : study.others) {
    if (is_volume_source(other)) {
      list.series.push_back(volume_file(other, options));
    } else {
      ++list.other_count;
    }
  }
  return list;
}

std::string title_of(const ImageSeries& series) {
  std::string title = series.modality.empty() ? series.format : series.modality;
  if (!series.number.empty()) title += " series " + series.number;
  if (!series.description.empty())
    title += ": " + series.description;
  else if (series.uid.empty() && !series.files.empty())
    title += ": " + series.files.front().filename().string();
  return title;
}

std::string detail_of(const ImageSeries& series) {
  std::string detail = std::to_string(series.image_count) + (series.image_count == 1 ? " image" : " images");
  if (series.size.minCoeff() <= 0) return detail;
  detail += files::format(", %d \u00D7 %d \u00D7 %d", series.size.x(), series.size.y(), series.size.z());
  if (series.spacing_mm.minCoeff() > 0)
    detail += files::format(" voxels of %.2g \u00D7 %.2g \u00D7 %.2g mm", series.spacing_mm.x(),
                            series.spacing_mm.y(), series.spacing_mm.z());
  return detail;
}

Thumbnail thumbnail_of(const ImageSeries& series, int longest_side) {
  if (series.files.empty()) throw InvalidInput("the series has no files");
  if (longest_side < 1 || longest_side > 4096) throw InvalidInput("a thumbnail has 1 to 4096 pixels a side");
  const Picture picture = middle_picture(series);
  const double width_mm = picture.columns * picture.column_spacing_mm,
               height_mm = picture.rows * picture.row_spacing_mm,
               pixel_mm = std::max(width_mm, height_mm) / longest_side;
  Thumbnail thumbnail;
  thumbnail.width = std::max(1, static_cast<int>(std::lround(width_mm / pixel_mm)));
  thumbnail.height = std::max(1, static_cast<int>(std::lround(height_mm / pixel_mm)));
  std::vector<double> sorted(picture.values.begin(), picture.values.end());
  const double low = geometry::quantile(sorted, 0.01),
               range = std::max(geometry::quantile(sorted, 0.99) - low, 1e-9);
  // Each pixel of the thumbnail is the mean of what it covers, or the nearest where that is less than one.
  const auto span = [](int at, int count, int of) {
    const int first = static_cast<int>(static_cast<std::int64_t>(at) * of / count);
    const int end = static_cast<int>(static_cast<std::int64_t>(at + 1) * of / count);
    return std::pair{std::min(first, of - 1), std::max(end, std::min(first, of - 1) + 1)};
  };
  for (int y = 0; y < thumbnail.height; ++y) {
    const auto [top, bottom] = span(y, thumbnail.height, picture.rows);
    for (int x = 0; x < thumbnail.width; ++x) {
      const auto [left, right] = span(x, thumbnail.width, picture.columns);
      double sum = 0;
      for (int row = top; row < bottom; ++row) {
        for (int column = left; column < right; ++column)
          sum += picture.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.columns) +
                                static_cast<std::size_t>(column)];
      }
      const double shade = (sum / ((bottom - top) * (right - left)) - low) / range;
      thumbnail.grey.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(shade, 0.0, 1.0))));
    }
  }
  return thumbnail;
}

}  // namespace arthronaut::images
