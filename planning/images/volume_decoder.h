// A volume as it stands in the bytes of its file, before it is written or without: the inverse of encoded()
// (volume_writer.h).
#pragma once

#include "planning/images/volume.h"
#include "planning/images/volume_writer.h"

namespace arthronaut::images {

// What encoded() was given, as a file that is written and read again.
[[nodiscard]] Volume volume_of(const EncodedVolume& encoded);

}  // namespace arthronaut::images
