#include "navigation/provenance/provenance.h"

#include <array>
#include <charconv>
#include <chrono>

#include "planning/files/json_document.h"

namespace arthronaut::provenance {

namespace {

constexpr std::array kOrigins{Origin::Measured, Origin::Nominal, Origin::Simulated};

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

// Seconds since 1970. Fractions of a second and a zone other than Z are not what this program writes.
std::optional<double> seconds_of(std::string_view text) {
  using namespace std::chrono;
  const auto y = cut_number(text, 4);
  if (!y || !cut(text, '-')) return std::nullopt;
  const auto m = cut_number(text, 2);
  if (!m || !cut(text, '-')) return std::nullopt;
  const auto d = cut_number(text, 2);
  if (!d) return std::nullopt;
  const year_month_day date{year(*y), month(static_cast<unsigned>(*m)), day(static_cast<unsigned>(*d))};
  if (!date.ok()) return std::nullopt;
  double seconds = 86400.0 * static_cast<double>(sys_days(date).time_since_epoch().count());
  if (text.empty()) return seconds;
  if (!cut(text, 'T')) return std::nullopt;
  double unit = 3600;
  for (int part = 0; part < 3; ++part, unit /= 60) {
    if (part > 0 && !cut(text, ':')) return std::nullopt;
    const auto value = cut_number(text, 2);
    if (!value || *value > (part == 0 ? 23 : 60)) return std::nullopt;
    seconds += unit * *value;
  }
  if (!text.empty() && text != "Z") return std::nullopt;
  return seconds;
}

}  // namespace

std::string_view to_text(Origin origin) {
  switch (origin) {
    case Origin::Measured:
      return "measured";
    case Origin::Nominal:
      return "nominal";
    case Origin::Simulated:
      return "simulated";
  }
  return "nominal";
}

std::optional<Origin> origin_from_text(std::string_view text) {
  for (const Origin origin : kOrigins)
    if (text == to_text(origin)) return origin;
  return std::nullopt;
}

Origin found_with(Origin itself, Origin by_means_of) {
  return by_means_of == Origin::Simulated ? Origin::Simulated : itself;
}

std::optional<double> days_between(std::string_view from_utc, std::string_view to_utc) {
  const auto from_s = seconds_of(from_utc), to_s = seconds_of(to_utc);
  if (!from_s || !to_s) return std::nullopt;
  return (*to_s - *from_s) / 86400;
}

Provenance read_provenance(const files::JsonObject& entry, Origin unless_said) {
  Provenance provenance;
  provenance.origin = unless_said;
  if (entry.has("origin")) {
    const auto origin = origin_from_text(entry.text("origin"));
    if (!origin) entry.fail("origin", "must be measured, nominal or simulated");
    provenance.origin = *origin;
  }
  if (entry.has("calibrated_utc")) {
    provenance.calibrated_utc = entry.text("calibrated_utc");
    if (!seconds_of(provenance.calibrated_utc))
      entry.fail("calibrated_utc", "must be a time such as 2026-11-21T10:00:00Z");
  }
  return provenance;
}

}  // namespace arthronaut::provenance
