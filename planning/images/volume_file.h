// Reads volumes: DICOM (a folder of slices, an enhanced CT or MR in one file, or a DICOMDIR), NIfTI (.nii,
// .nii.gz), NRRD (.nrrd, .nhdr) and MetaImage (.mha, .mhd).
//
// DICOM is read by DCMTK (its JPEG 2000 by GDCM); the other readers are the project's own: VTK's drop the
// orientation of NRRD and MetaImage, and none of them refuses a file that is cut off. A file that does not
// say where left is, is refused: a guess would mirror knees.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "planning/images/dicom_origin.h"
#include "planning/images/volume.h"

namespace arthronaut::images {

struct VolumeFileOptions {
  // Which series of a DICOM folder that holds several: its series number or its UID. Empty: the only one.
  std::string series;
  // What reading may take for the volume's values and the bytes they are made of. A header that asks for more
  // is refused before anything of that size is allocated.
  std::size_t most_bytes = std::size_t{2} << 30;
  // Called now and then on the same thread, with a fraction that grows to 1. May throw, to stop.
  std::function<void(double fraction)> on_progress = nullptr;
  // DICOM: called once on the same thread, before the pixels are read, with what the chosen series is of.
  std::function<void(const DicomOrigin& origin)> on_origin = nullptr;
};

// Throws IoError when something cannot be read, InvalidInput (file, place, reason) for everything else: no
// orientation, mixed sizes, a missing slice, slices twice, a file cut off, several volumes in one file, more
// memory than the options allow.
[[nodiscard]] Volume read_volume(const std::filesystem::path& source, const VolumeFileOptions& options = {});

// True for a folder, for the extensions above and for a file that says in its first bytes that it is DICOM.
[[nodiscard]] bool is_volume_source(const std::filesystem::path& source);

}  // namespace arthronaut::images
