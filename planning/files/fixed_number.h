// A number with so many decimals.
#pragma once

#include <string>

namespace arthronaut::files {

// "1.2", "-0.4"; never "-0.0": what is nothing to so many decimals has no sign.
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace arthronaut::files
