// Tells the log of a source that is opened, of its end and of being closed before it.
#pragma once

#include <memory>

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// The same source; it is wrapped while there is a log, and handed back as it is otherwise.
[[nodiscard]] std::unique_ptr<FrameSource> logged(std::unique_ptr<FrameSource> source);

}  // namespace arthronaut::sources
