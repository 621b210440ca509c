#include "planning/files/utc_clock.h"

#include <array>
#include <charconv>
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

// `count` digits at the front of the text, which is cut; nullopt when there are none.
std::optional<int> cut_number(std::string_view& text, std::size_t count) {
  int value = 0;
  if (text.size() < count) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + count, value);
  if (error != std::errc() || end != text.data() + count || value < 0) return std::nullopt;
  text.remove_prefix(count);
  return value;
}

bool cut(std::string_view& text, char expected) {
  if (text.empty() || text.front() != expected) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::string utc_now() { return utc_now_as(kIso8601); }

double utc_now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string utc_of(std::chrono::system_clock::time_point moment) {
  return utc_as(kIso8601, std::chrono::system_clock::to_time_t(moment));
}

std::optional<std::chrono::sys_seconds> time_of_utc(std::string_view utc) {
  using namespace std::chrono;
  const auto y = cut_number(utc, 4);
  if (!y || !cut(utc, '-')) return std::nullopt;
  const auto m = cut_number(utc, 2);
  if (!m || !cut(utc, '-')) return std::nullopt;
  const auto d = cut_number(utc, 2);
  if (!d) return std::nullopt;
  const year_month_day date{year(*y), month(static_cast<unsigned>(*m)), day(static_cast<unsigned>(*d))};
  if (!date.ok()) return std::nullopt;
  sys_seconds moment = sys_days(date);
  if (utc.empty()) return moment;
  if (!cut(utc, 'T')) return std::nullopt;
  seconds unit = hours(1);
  for (int part = 0; part < 3; ++part, unit /= 60) {
    if (part > 0 && !cut(utc, ':')) return std::nullopt;
    const auto value = cut_number(utc, 2);
    if (!value || *value > (part == 0 ? 23 : 60)) return std::nullopt;
    moment += unit * *value;
  }
  if (!utc.empty() && utc != "Z") return std::nullopt;
  return moment;
}

std::string utc_now_as(const char* format) { return utc_as(format, std::time(nullptr)); }

std::string utc_in_words(const std::string& utc) {
  constexpr std::string_view kForm = "2026-01-31T12:00:00Z";
  if (utc.size() != kForm.size() || utc[10] != 'T' || utc.back() != 'Z') return utc;
  return utc.substr(0, 10) + " " + utc.substr(11, 8) + " UTC";
}

}  // namespace arthronaut::files
