#include "planning/images/volume_decoder.h"

#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

Volume volume_of(const EncodedVolume& encoded) {
  constexpr std::size_t kUnbounded = std::size_t{1} << 40;  // it has been in memory before
  return parse_nrrd({}, encoded.header + std::string(encoded.voxels), kUnbounded);
}

}  // namespace arthronaut::images
