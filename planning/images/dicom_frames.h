// The functional groups of an enhanced (multi-frame) CT or MR: what is shared by all its frames, and what
// each frame says for itself (DICOM PS3.3, C.7.6.16). Inner header of images.
#pragma once

#include <vector>

#include "planning/images/dicom_slice.h"

class DcmDataset;

namespace arthronaut::images {

[[nodiscard]] bool has_functional_groups(DcmDataset& dataset);

// One slice a frame, in the order of the file: position, orientation, spacing, rescaling and echo time of
// each from the functional groups, the rest from `common`. A frame without a position, an orientation or a
// spacing gets has_geometry = false. Throws InvalidInput when there are other groups than frames.
[[nodiscard]] std::vector<DicomSlice> slices_of_frames(const DicomSlice& common, DcmDataset& dataset);

}  // namespace arthronaut::images
