#include "planning/images/volume_file.h"

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

using Parse = Volume (*)(const std::filesystem::path&, std::string_view);

Parse parser_for(const std::filesystem::path& file) {
  const std::string name = lower_case(file.filename().string());
  if (name.ends_with(".nii") || name.ends_with(".nii.gz")) return parse_nifti;
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr")) return parse_nrrd;
  if (name.ends_with(".mha") || name.ends_with(".mhd")) return parse_metaimage;
  return nullptr;
}

}  // namespace

bool is_volume_source(const std::filesystem::path& source) {
  return std::filesystem::is_directory(source) || parser_for(source) != nullptr;
}

Volume read_volume(const std::filesystem::path& source, const VolumeFileOptions& options) {
  if (std::filesystem::is_directory(source)) return read_dicom_folder(source, options);
  const std::string text = files::read_text(source);
  if (const Parse parse = parser_for(source)) {
    if (text.empty()) throw InvalidInput(source, "", "is empty");
    return parse(source, text);
  }
  if (text.size() > 132 && std::string_view(text).substr(128, 4) == "DICM") {
    throw InvalidInput(source, "", "is one DICOM file: name the folder that holds its series");
  }
  throw InvalidInput(source, "",
                     "is not a volume this program reads: a DICOM folder, NIfTI, NRRD or MetaImage");
}

}  // namespace arthronaut::images
