#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/series_list.h"
#include "planning/images/volume_bytes.h"
#include "planning/images/volume_file.h"
#include "tests/fuzzing/reader.h"
#include "tests/planning/images/enhanced_dicom.h"
#include "tests/planning/images/volume_forms.h"

namespace arthronaut::fuzzing {
namespace {

using Seeds = std::map<std::string, std::string>;
using Parser = images::Volume (*)(const std::filesystem::path&, std::string_view, std::size_t);

// Far above the seeds, and below what the fuzzer lets one allocation take.
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

std::string what_is_wrong(const images::Volume& volume) {
  if (volume.size.minCoeff() < 1) return "an axis without voxels";
  if (volume.values.size() != static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()))
    return "another number of values than of voxels";
  if (!volume.lps_from_index.matrix().allFinite()) return "a place that is not finite";
  return "";
}

Seeds forms_with(std::initializer_list<std::string_view> endings) {
  auto forms = test::all_volume_forms(test::oblique_volume());
  std::erase_if(forms, [&](const auto& form) {
    for (const std::string_view ending : endings) {
      if (form.first.ends_with(ending)) return false;
    }
    return true;
  });
  return forms;
}

Reader reader_of(const std::string& name, const std::string& ending, Parser parse) {
  return {name, "input" + ending,
          [ending](const std::filesystem::path&) {
            return forms_with({ending, ending + ".gz"});
          },
          [parse, ending](const std::filesystem::path&, std::string_view bytes) {
            return what_is_wrong(parse("input" + ending, bytes, kMostBytes));
          }};
}

// Many frames in one file: a slice alone is no volume.
Seeds enhanced_seeds(const std::filesystem::path& folder) {
  Seeds seeds;
  const images::Volume volume = test::oblique_volume();
  for (const std::string modality : {"CT", "MR"}) {
    test::write_enhanced_dicom(folder / "enhanced.dcm", volume, {.modality = modality});
    seeds["enhanced_" + modality + ".dcm"] = taken(folder / "enhanced.dcm");
  }
  return seeds;
}

Seeds series_seeds(const std::filesystem::path& folder) {
  Seeds seeds = enhanced_seeds(folder);
  test::write_listed_slice(folder, test::oblique_volume(), {"SLICE", "1.2.3.4", 1});
  seeds["slice.dcm"] = taken(folder / "SLICE");
  return seeds;
}

Seeds directory_seeds(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (int k = 0; k < 4; ++k) {
    names.push_back("A" + std::to_string(k));
    test::write_listed_slice(folder, test::oblique_volume(), {names.back(), "1.2.3.4", k});
  }
  test::write_dicom_directory(folder, names);
  return {{"DICOMDIR", taken(folder / "DICOMDIR")}};
}

// The disc's images stay as they are; its table of contents is what is broken.
std::string read_disc(const std::filesystem::path& folder, std::string_view bytes) {
  if (!std::filesystem::exists(folder / "DICOMDIR")) (void)directory_seeds(folder);
  return what_is_wrong(images::read_volume(put(folder, "DICOMDIR", bytes), {.most_bytes = kMostBytes}));
}

// As the browser of a folder looks at it: what cannot be read is listed, so that nothing may throw.
std::string list_series(const std::filesystem::path& folder, std::string_view bytes) {
  (void)put(folder, "input.dcm", bytes);
  const images::SeriesList list = images::find_series(folder, {.most_bytes = kMostBytes});
  for (const auto& series : list.series) (void)images::thumbnail_of(series);
  return "";
}

}  // namespace

std::vector<Reader> volume_readers() {
  const auto nrrd = [](const std::filesystem::path& file, std::string_view text, std::size_t most_bytes) {
    return images::parse_nrrd(file, text, most_bytes);
  };
  return {reader_of("nifti", ".nii", images::parse_nifti),
          reader_of("nrrd", ".nrrd", nrrd),
          reader_of("metaimage", ".mha", images::parse_metaimage),
          {"dicom", "input.dcm", enhanced_seeds,
           [](const std::filesystem::path& folder, std::string_view bytes) {
             return what_is_wrong(
                 images::read_volume(put(folder, "input.dcm", bytes), {.most_bytes = kMostBytes}));
           }},
          {"dicomdir", "", directory_seeds, read_disc},
          {"series", "", series_seeds, list_series}};
}

}  // namespace arthronaut::fuzzing
