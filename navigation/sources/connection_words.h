// Inner header: why an address can't be connected to, in words that say what to see to.
#pragma once

#include <string>

namespace arthronaut::sources {

// An error of libavformat's on opening that address; in the library's own words where no better are known.
[[nodiscard]] std::string connection_words(int error, const std::string& address);

}  // namespace arthronaut::sources
