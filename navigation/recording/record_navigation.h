// Navigates a video and records it as a session: what `arthronaut navigate` and the demo do.
#pragma once

#include <functional>

#include "navigation/pipeline/navigate_video.h"
#include "navigation/recording/session.h"

namespace arthronaut::recording {

enum class KeepVideo {
  Copy,    // the source's file, as it is
  Refer,   // only where it is
  Encode,  // the source has no file: its pictures
};

// Records plan, given and found registrations, frames, curves and the open formats into `folder`, which
// exists and is empty. `video` is the source's file or pattern (unused for Encode). Throws what
// navigate_video throws and IoError.
[[nodiscard]] pipeline::NavigationSummary record_navigation(
    sources::FrameSource& source, const pipeline::NavigateOptions& options,
    const std::filesystem::path& folder, KeepVideo keep, const std::filesystem::path& video,
    const pipeline::NavigationObserver& observer = {});

}  // namespace arthronaut::recording
