// The voxels' way from the import's process to the workstation: memory that both see. Through the socket, 200
// MB would be held several times over. Inner header of import.
//
// The workstation makes the memory, as the child may write no file, and gives its end to the child as
// kSharedDescriptor. The child believes in nothing; the workstation reads from it after the child's death.
#pragma once

#include <cstdint>
#include <string_view>

#include "planning/images/volume_writer.h"

namespace arthronaut::importing {

inline constexpr int kSharedDescriptor = 3;

// Room for a count and so many bytes; pages are taken as they are written. Throws IoError.
[[nodiscard]] int create_shared_memory(std::uint64_t most_bytes);

// In the child. False when there is no such memory, or too little.
[[nodiscard]] bool put_voxels(int descriptor, std::string_view voxels);

// What the child put there; empty voxels when it put none, or what it says cannot be.
[[nodiscard]] images::EncodedVolume taken_voxels(int descriptor);

}  // namespace arthronaut::importing
