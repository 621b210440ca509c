// What is passed while one picture of a video is looked for: decoding begins at the key frame before it,
// which may be hundreds of pictures away.
#pragma once

#include <functional>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

// Called for every picture that is decoded on the way, in the order in which they are shown; `passed` makes
// it and must not be called later. False: what is looked for is not wanted any more.
using OnTheWay = std::function<bool(const std::function<camera::FramePtr()>& passed)>;

}  // namespace arthronaut::sources
