// Reads volumes: a folder of DICOM files, NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr) and MetaImage (.mha,
// .mhd).
//
// The readers are the project's own, on GDCM for DICOM: VTK's drop the orientation of NRRD and MetaImage, and
// none of them refuses a file that is cut off. A file that does not say where left is, is refused: a guess
// would mirror knees.
#pragma once

#include <filesystem>
#include <string>

#include "planning/images/volume.h"

namespace arthronaut::images {

struct VolumeFileOptions {
  // Which series of a DICOM folder that holds several: its series number or its UID. Empty: the only one.
  std::string series;
};

// Throws IoError when something cannot be read, InvalidInput (file, place, reason) for everything else: no
// orientation, mixed sizes, a missing slice, slices twice, a file cut off, several volumes in one file.
[[nodiscard]] Volume read_volume(const std::filesystem::path& source, const VolumeFileOptions& options = {});

// True for a folder and for the extensions above.
[[nodiscard]] bool is_volume_source(const std::filesystem::path& source);

}  // namespace arthronaut::images
