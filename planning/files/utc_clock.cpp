#include "planning/files/utc_clock.h"

#include <array>
#include <ctime>
#include <string_view>

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

std::string utc_in_words(const std::string& utc) {
  constexpr std::string_view kForm = "2026-01-31T12:00:00Z";
  if (utc.size() != kForm.size() || utc[10] != 'T' || utc.back() != 'Z') return utc;
  return utc.substr(0, 10) + " " + utc.substr(11, 8) + " UTC";
}

}  // namespace arthronaut::files
