#include "planning/files/utc_clock.h"

#include <array>
#include <ctime>
#include <string_view>

namespace arthronaut::files {

namespace {

constexpr const char* kIso8601 = "%Y-%m-%dT%H:%M:%SZ";

std::string utc_as(const char* format, std::time_t moment) {
  std::tm parts{};
  gmtime_r(&moment, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), format, &parts);
  return text.data();
}

}  // namespace

std::string utc_now() { return utc_now_as(kIso8601); }

double utc_now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string utc_of(std::chrono::system_clock::time_point moment) {
  return utc_as(kIso8601, std::chrono::system_clock::to_time_t(moment));
}

std::string utc_now_as(const char* format) { return utc_as(format, std::time(nullptr)); }

std::string utc_in_words(const std::string& utc) {
  constexpr std::string_view kForm = "2026-01-31T12:00:00Z";
  if (utc.size() != kForm.size() || utc[10] != 'T' || utc.back() != 'Z') return utc;
  return utc.substr(0, 10) + " " + utc.substr(11, 8) + " UTC";
}

}  // namespace arthronaut::files
