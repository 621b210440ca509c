#include "navigation/markers/marker_company.h"

namespace arthronaut::markers {
namespace {

constexpr std::int64_t kCompanyNs = 1'000'000'000;  // how long it counts

}  // namespace

void MarkerCompany::remember(std::span<const MarkerObservation> observations, std::int64_t timestamp_ns) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!observations[i].is_tracked()) continue;
    for (std::size_t other = 0; other < observations.size(); ++other) {
      if (other == i || !observations[other].is_tracked()) continue;
      beside_[i] = {other,
                    observations[other].camera_from_marker.inverse() * observations[i].camera_from_marker,
                    timestamp_ns};
      break;
    }
  }
}

std::optional<MarkerCompany::Place> MarkerCompany::place_of(std::size_t marker,
                                                            std::span<const MarkerObservation> observations,
                                                            std::int64_t timestamp_ns) const {
  const Beside& beside = beside_[marker];
  const std::int64_t age_ns = timestamp_ns - beside.timestamp_ns;
  if (beside.timestamp_ns < 0 || age_ns >= kCompanyNs || !observations[beside.other].is_tracked())
    return std::nullopt;
  return Place{observations[beside.other].camera_from_marker * beside.other_from_marker, age_ns};
}

}  // namespace arthronaut::markers
