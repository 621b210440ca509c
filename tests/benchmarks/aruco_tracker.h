// The tracker that others would build: what the product's own is held against in benchmarks and tests, and a
// second opinion on what a picture shows.
#pragma once

#include <memory>
#include <span>

#include "navigation/markers/marker_tracker.h"

namespace arthronaut::markers {

// OpenCV's ArUco detector for finding, corners refined to sub-pixel on the raw frame, IPPE, refinement on
// distorted pixels. Throws as make_tracker.
[[nodiscard]] std::unique_ptr<MarkerTracker> make_aruco_tracker(std::span<const DeclaredMarker> declared);

}  // namespace arthronaut::markers
