// Tells whether a Matroska or WebM file is complete. libavformat reads such a file to where it breaks off and
// then reports an ordinary end of file, so the element sizes are followed here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace arthronaut::sources {

// True when the file is Matroska and an element of it (segment, cluster or block) reaches beyond the end of
// the file.
[[nodiscard]] bool matroska_breaks_off(const std::filesystem::path& file);

// True when the file is Matroska whose end was never written or is cut off: it has no index. Reads some
// bytes.
[[nodiscard]] bool matroska_is_unfinished(const std::filesystem::path& file);

// A cluster that lies whole in the file, but for the last one, which may be cut off.
struct MatroskaCluster {
  std::int64_t position = 0;  // of its first byte
  std::int64_t time = 0;      // of its first block, in the file's ticks
};
// In the order of the file; empty when it is not Matroska. Reads some bytes a cluster.
[[nodiscard]] std::vector<MatroskaCluster> matroska_clusters(const std::filesystem::path& file);

}  // namespace arthronaut::sources
