// What a GStreamer pipeline gives: capture cards, encoders and protocols that are reached by its plug-ins
// alone.
#pragma once

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// As open_stream() of "gst:PIPELINE"; the pipeline ends in an appsink.
[[nodiscard]] std::unique_ptr<FrameSource> open_gstreamer_pipeline(const std::string& pipeline);

}  // namespace arthronaut::sources
