// Tells whether a Matroska or WebM file is complete. libavformat reads such a file to where it breaks off and
// then reports an ordinary end of file, so the element sizes are followed here.
#pragma once

#include <filesystem>

namespace arthronaut::sources {

// True when the file is Matroska and an element of it (segment, cluster or block) reaches beyond the end of
// the file.
[[nodiscard]] bool matroska_breaks_off(const std::filesystem::path& file);

}  // namespace arthronaut::sources
