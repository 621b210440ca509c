#include "navigation/operation/seen_drift.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::operation {

namespace {

constexpr std::string_view kUntil = " mm, where it lay until ";
constexpr std::string_view kLookedUntil = ", as it did until ";
constexpr std::string_view kLastSure = "last sure at ", kNeverSure = "never sure";
constexpr std::string_view kUnit = " ns";

// " mm, where it lay until 5 ns" after that head; false: it is something else.
bool read_until(std::string_view text, std::string_view head, std::int64_t& until_ns) {
  if (!text.starts_with(head)) return false;
  text.remove_prefix(head.size());
  const char* const end = text.data() + text.size();
  const auto [unit, error] = std::from_chars(text.data(), end, until_ns);
  return error == std::errc() && std::string_view(unit, static_cast<std::size_t>(end - unit)) == kUnit;
}

}  // namespace

std::string to_text(const SeenDrift& drift) {
  std::string text = files::format("%.17g", drift.drift_mm);
  if (drift.held_until_ns == SeenDrift().held_until_ns) return text;
  return text + std::string(kUntil) + std::to_string(drift.held_until_ns) + std::string(kUnit);
}

SeenDrift seen_drift_from_text(const std::string& text, const std::string& where) {
  const auto refuse = [&]() -> InvalidInput {
    return {where, "", "\"" + text + "\" does not say how far the bone has moved"};
  };
  SeenDrift drift;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, drift.drift_mm);
  if (error != std::errc() || !std::isfinite(drift.drift_mm) || drift.drift_mm < 0) throw refuse();
  const std::string_view rest(after, static_cast<std::size_t>(end - after));
  if (rest.empty()) return drift;
  if (!read_until(rest, kUntil, drift.held_until_ns)) throw refuse();
  return drift;
}

std::string to_text(const SeenLooks& looks) {
  if (!looks.otherwise) return std::string(kLooksAsItDid);
  std::string text(kLooksOtherwise);
  if (looks.held_until_ns == SeenLooks().held_until_ns) return text;
  return text + std::string(kLookedUntil) + std::to_string(looks.held_until_ns) + std::string(kUnit);
}

SeenLooks seen_looks_from_text(const std::string& text, const std::string& where) {
  SeenLooks looks;
  if (text == kLooksAsItDid) return looks;
  looks.otherwise = true;
  const bool is_short = text == kLooksOtherwise;
  const bool is_long =
      text.starts_with(kLooksOtherwise) &&
      read_until(std::string_view(text).substr(kLooksOtherwise.size()), kLookedUntil, looks.held_until_ns);
  if (!is_short && !is_long)
    throw InvalidInput(where, "", "\"" + text + "\" does not say how the bone looks");
  return looks;
}

std::string to_text(const SeenMedium& medium) {
  if (medium.last_sure_ns < 0) return std::string(kNeverSure);
  return std::string(kLastSure) + std::to_string(medium.last_sure_ns) + std::string(kUnit);
}

SeenMedium seen_medium_from_text(const std::string& text, const std::string& where) {
  SeenMedium medium;
  if (text != kNeverSure && (!read_until(text, kLastSure, medium.last_sure_ns) || medium.last_sure_ns < 0))
    throw InvalidInput(where, "", "\"" + text + "\" does not say until when the medium was sure");
  return medium;
}

}  // namespace arthronaut::operation
