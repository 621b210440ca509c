#include "planning/files/local_time.h"

#include <array>
#include <cstdio>
#include <ctime>
#include <optional>

namespace arthronaut::files {

namespace {

std::optional<std::tm> local_of(const std::string& utc) {
  std::tm parts{};
  char end = 0;
  if (std::sscanf(utc.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%c", &parts.tm_year, &parts.tm_mon, &parts.tm_mday,
                  &parts.tm_hour, &parts.tm_min, &parts.tm_sec, &end) != 7 ||
      end != 'Z')
    return std::nullopt;
  parts.tm_year -= 1900;
  parts.tm_mon -= 1;
  const std::time_t moment = timegm(&parts);
  std::tm local{};
  if (localtime_r(&moment, &local) == nullptr) return std::nullopt;
  return local;
}

std::string as(const char* format, const std::tm& local) {
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), format, &local);
  return text.data();
}

}  // namespace

std::string local_time_in_words(const std::string& utc) {
  const auto local = local_of(utc);
  return local ? as("%Y-%m-%d %H:%M:%S", *local) : utc;
}

std::string local_day(const std::string& utc) {
  const auto local = local_of(utc);
  return local ? as("%Y-%m-%d", *local) : utc.substr(0, 10);
}

}  // namespace arthronaut::files
