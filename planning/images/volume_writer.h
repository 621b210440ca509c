// Writes volumes, as NRRD: without loss, the patient's axes in the header, nothing of whose picture it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "planning/images/volume.h"

namespace arthronaut::images {

// A volume as it lies in a file: bytes (whole numbers of 0 to 255), 16 bits (whole numbers) or 32-bit floats,
// whichever is the least that loses nothing. Plain: 200 MB of a CT are read back in less time than they are
// unpacked.
struct EncodedVolume {
  std::string header;  // with the empty line at its end; holds the modality and the segments' names
  std::string_view voxels;
  std::shared_ptr<const void> owner;  // of the voxels' memory
};
[[nodiscard]] EncodedVolume encoded(const Volume& volume);
// A label map in the volume's grid, packed (gzip): labels are alike, and pack a hundred times smaller in less
// time than they are written. Of the volume size and axes alone count. Throws InvalidInput when the labels
// are not of its size.
[[nodiscard]] EncodedVolume encoded_labels(const Volume& grid, std::span<const std::uint8_t> labels,
                                           const std::vector<Segment>& segments);

// Atomic. Throw IoError; the file is then as before. read_volume() gives the same values, axes, modality and
// segments back.
void write_volume(const std::filesystem::path& file, const EncodedVolume& volume);
void write_volume(const std::filesystem::path& file, const Volume& volume);

}  // namespace arthronaut::images
