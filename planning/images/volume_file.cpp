#include "planning/images/volume_file.h"

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

using Parse = Volume (*)(const std::filesystem::path&, std::string_view, std::size_t);

Parse parser_for(const std::filesystem::path& file) {
  const std::string name = lower_case(file.filename().string());
  if (name.ends_with(".nii") || name.ends_with(".nii.gz")) return parse_nifti;
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr")) return parse_nrrd;
  if (name.ends_with(".mha") || name.ends_with(".mhd")) return parse_metaimage;
  return nullptr;
}

// Anything but a plain file (a pipe, a device) is never read: it might have no end.
bool is_dicom(const std::filesystem::path& file) {
  return std::filesystem::is_regular_file(file) && has_dicom_mark(file);
}

}  // namespace

bool is_volume_source(const std::filesystem::path& source) {
  return std::filesystem::is_directory(source) || parser_for(source) != nullptr || is_dicom(source);
}

Volume read_volume(const std::filesystem::path& source, const VolumeFileOptions& options) {
  if (std::filesystem::is_directory(source)) return read_dicom(source, options);
  if (std::filesystem::exists(source) && !std::filesystem::is_regular_file(source))
    throw InvalidInput(source, "", "is neither a file nor a folder");
  if (const Parse parse = parser_for(source)) {
    const std::string text = read_bounded(source, options.most_bytes);
    if (text.empty()) throw InvalidInput(source, "", "is empty");
    report(options, 0.2);
    Volume volume = parse(source, text, options.most_bytes);
    report(options, 1);
    return volume;
  }
  if (is_dicom(source)) return read_dicom(source, options);
  if (!std::filesystem::exists(source)) throw IoError(source, "does not exist");
  throw InvalidInput(source, "", "is not a volume this program reads: DICOM, NIfTI, NRRD or MetaImage");
}

}  // namespace arthronaut::images
