#include "navigation/provenance/provenance.h"

#include <array>
#include <chrono>

#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::provenance {

namespace {

constexpr std::array kOrigins{Origin::Measured, Origin::Nominal, Origin::Simulated};

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
  const auto from = files::time_of_utc(from_utc), to = files::time_of_utc(to_utc);
  if (!from || !to) return std::nullopt;
  return std::chrono::duration<double, std::chrono::days::period>(*to - *from).count();
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
    if (!files::time_of_utc(provenance.calibrated_utc))
      entry.fail("calibrated_utc", "must be a time such as 2026-11-21T10:00:00Z");
  }
  return provenance;
}

}  // namespace arthronaut::provenance
