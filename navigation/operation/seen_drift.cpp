#include "navigation/operation/seen_drift.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::operation {

namespace {

constexpr std::string_view kUntil = " mm, where it lay until ";
constexpr std::string_view kUnit = " ns";

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
  std::string_view rest(after, static_cast<std::size_t>(end - after));
  if (rest.empty()) return drift;
  if (!rest.starts_with(kUntil)) throw refuse();
  rest.remove_prefix(kUntil.size());
  const auto [unit, wrong] = std::from_chars(rest.data(), end, drift.held_until_ns);
  if (wrong != std::errc() || std::string_view(unit, static_cast<std::size_t>(end - unit)) != kUnit)
    throw refuse();
  return drift;
}

}  // namespace arthronaut::operation
