// The phantom knee as a case.
#pragma once

#include <string>

#include "planning/cases/case.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::phantom {

// Bones, landmarks and the anatomical plan; created now.
[[nodiscard]] cases::Case case_of(const PhantomKnee& knee, const std::string& name);

}  // namespace arthronaut::phantom
