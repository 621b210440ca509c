// The phantom knee as a case.
#pragma once

#include <string>

#include "planning/cases/case.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::phantom {

// Bones, landmarks and the anatomical plan; created now.
[[nodiscard]] cases::Case case_of(const PhantomKnee& knee, const std::string& name);
// A case's bones, landmarks and single tunnels where the simulator looks for those of a phantom; what the
// case lacks stays empty.
[[nodiscard]] PhantomKnee knee_of(const cases::Case& knee);

}  // namespace arthronaut::phantom
