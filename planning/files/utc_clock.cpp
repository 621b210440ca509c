#include "planning/files/utc_clock.h"

#include <array>
#include <ctime>

namespace arthronaut::files {

std::string utc_now() { return utc_now_as("%Y-%m-%dT%H:%M:%SZ"); }

std::string utc_now_as(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), format, &parts);
  return text.data();
}

}  // namespace arthronaut::files
