// Streams over the network, read with libavformat.
#pragma once

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// As open_stream() of an address whose kind is in small letters.
[[nodiscard]] std::unique_ptr<FrameSource> open_network_stream(const std::string& address);

}  // namespace arthronaut::sources
