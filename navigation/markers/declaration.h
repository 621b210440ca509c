// What every tracker checks about what it is given.
#pragma once

#include <span>

#include "navigation/markers/marker_tracker.h"

namespace arthronaut::markers {

inline constexpr int kDictionarySize = 50;  // DICT_4X4_50

// Throws InvalidInput for an id that is not below dictionary_size, an id declared twice, a size that is not
// above 0.
void check_declaration(std::span<const DeclaredMarker> declared, int dictionary_size = kDictionarySize);
// Throws InvalidInput when the frame is empty or not of the camera's size.
void check_frame_size(const camera::GrayView& frame, const camera::CameraModel& camera);

}  // namespace arthronaut::markers
