#include "planning/postop/tunnel_end.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planning/geometry/quantile.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

// How much of a thinner bore is to be seen, and by how much thinner it is looked for.
constexpr double kLeastNarrow_mm = 4, kFirstThinner_mm = 1;
// How far off, and one sigma, widths tell where a bore gets thinner.
constexpr double kWidthsTell_mm = 3, kWidthsSigma_mm = 0.7;

// The diameter of the thinner bore that is seen beyond a place; 0: none is.
double thinner_beyond_mm(const std::vector<WallVoxel>& voxels, const TunnelFit& fit, const Passage& passage,
                         double end_mm) {
  const double from = end_mm + kBeyondFrom_mm, to = std::min(end_mm + kBeyondTo_mm, passage.length_mm());
  if (to - from < kLeastNarrow_mm) return 0;
  Bore thinner = bore_of(fit, passage);
  thinner.radius_mm -= std::min(kFirstThinner_mm, 0.2 * thinner.radius_mm);
  const TunnelFit beyond = fit_tunnel(voxels, thinner, from, to, Wall::Clear, fit.profile);
  const auto is_seen = [](const Stretch& stretch) { return stretch.seen_share > kLeastSeen; };
  const bool is_thinner = beyond.is_fitted &&
                          std::any_of(beyond.stretches.begin(), beyond.stretches.end(), is_seen) &&
                          beyond.radius_mm < fit.radius_mm - kThinner_mm;
  return is_thinner ? 2 * beyond.radius_mm : 0;
}

// Between the two bores, where there is graft before a socket's end and marrow behind it.
TellingRing between(double thinner_mm, double radius_mm) {
  const double wide_mm = radius_mm - 0.5 * thinner_mm;
  return {0.5 * thinner_mm + 0.25 * wide_mm, radius_mm - 0.1 * wide_mm};
}

}  // namespace

Bore bore_of(const TunnelFit& fit, const Passage& passage) {
  return {passage.entry_mm, fit.direction, fit.radius_mm, 0};
}

TunnelEnd TunnelEnds::find(const std::vector<WallVoxel>& voxels, const TunnelFit& fit, const Passage& passage,
                           const std::optional<Narrowing>& before) const {
  TunnelEnd end;
  const double whole_mm = passage.length_mm(), in_images_mm = length_in_images_mm(passage);
  end.from_entry_mm = whole_mm;
  end.leaves_images = in_images_mm < whole_mm;
  end.comes_out = end.is_seen =
      mouth_at(sampler_, postop_from_plan_, bone_, passage.exit_mm, -fit.direction, fit.radius_mm).is_open();
  const AlongBore bore = along(fit, passage);
  // What comes out may be a thinner bore beyond a socket, as for the loop of a button: the widths tell where
  // it begins to a millimetre or two, the grey between both bores more nearly.
  end.narrowing = narrowing_of(fit.stretches);
  if (!end.narrowing) end.narrowing = before;
  std::optional<double> ends_at;
  if (end.narrowing) {
    const auto& [by_widths_mm, thinner_mm] = *end.narrowing;
    end.beyond_mm = thinner_beyond_mm(voxels, fit, passage, by_widths_mm);
    const bool is_fitted = end.beyond_mm > 0;
    auto by_grey = bore.end_mm(between(is_fitted ? end.beyond_mm : thinner_mm, fit.radius_mm));
    if (by_grey && std::abs(*by_grey - by_widths_mm) > kWidthsTell_mm) by_grey.reset();
    // Where metal or too little bone hides its wall the grey between both alone tells of the thinner one.
    if (by_grey && !is_fitted) end.beyond_mm = thinner_mm;
    if (end.beyond_mm > 0) ends_at = by_grey.value_or(by_widths_mm);
    end.is_narrowing_seen = ends_at.has_value();
  }
  if (!ends_at) {
    ends_at = bore.end_mm(middle_of(fit.radius_mm));
    if (ends_at) end.beyond_mm = thinner_beyond_mm(voxels, fit, passage, *ends_at);
  }
  if (end.comes_out && end.beyond_mm == 0) return end;
  end.comes_out = false;
  end.is_seen = ends_at.has_value();
  end.from_entry_mm = std::min(in_images_mm, ends_at.value_or(whole_mm));
  return end;
}

double TunnelEnds::sigma_mm(const TunnelFit& fit, const Passage& passage, const TunnelEnd& end) const {
  if (!end.is_seen) return std::numeric_limits<double>::infinity();
  if (end.comes_out) return sigma_of_passage_mm(fit, passage);
  const AlongBore bore = along(fit, passage);
  if (end.beyond_mm == 0) return bore.end_sigma_mm(middle_of(fit.radius_mm), end.from_entry_mm);
  const double by_grey = bore.end_sigma_mm(between(end.beyond_mm, fit.radius_mm), end.from_entry_mm);
  return end.narrowing ? std::min(by_grey, kWidthsSigma_mm) : by_grey;
}

AlongBore TunnelEnds::along(const TunnelFit& fit, const Passage& passage) const {
  // Of marrow, where a socket ends: cortex beside the bore's beginning stands out by twice as much and more,
  // and half of that is a step that marrow never makes.
  constexpr double kOfMarrow = 0.25;
  std::vector<double> contrasts;
  for (const Stretch& stretch : fit.stretches)
    if (stretch.seen_share > kLeastSeen) contrasts.push_back(stretch.outside_hu - stretch.inside_hu);
  return {sampler_,
          postop_from_plan_,
          bone_,
          passage,
          fit.radius_mm,
          contrasts.empty() ? 0 : geometry::quantile(std::move(contrasts), kOfMarrow),
          fit.profile.blur_mm};
}

// Of a bore that comes out: by how far its ends on the bone's surface move with the axis.
double TunnelEnds::sigma_of_passage_mm(const TunnelFit& fit, const Passage& passage) const {
  const Vector3d d = fit.direction, u = d.unitOrthogonal(), v = d.cross(u);
  double variance = 0;
  for (const Vector3d& across : {u, v}) {
    const std::pair<Vector3d, Vector3d> moved[] = {
        {passage.entry_mm + M_SQRT1_2 * fit.entry_sigma_mm * across, d},
        {passage.entry_mm, (d + M_SQRT1_2 * fit.direction_sigma_rad * across).normalized()}};
    for (const auto& [entry_mm, direction] : moved) {
      const auto other = passage_of(bone_, entry_mm, direction);
      if (!other) return std::numeric_limits<double>::infinity();
      variance += std::pow(other->length_mm() - passage.length_mm(), 2);
    }
  }
  return std::sqrt(variance);
}

// From the entry to where the images end, or the bone.
double TunnelEnds::length_in_images_mm(const Passage& passage) const {
  constexpr double kStation_mm = 0.5;
  const double whole_mm = passage.length_mm();
  const Vector3d step = (passage.exit_mm - passage.entry_mm) / whole_mm;
  for (double t = kStation_mm; t < whole_mm; t += kStation_mm)
    if (!std::isfinite(sampler_.at(postop_from_plan_ * (passage.entry_mm + t * step))))
      return t - kStation_mm;
  return std::isfinite(sampler_.at(postop_from_plan_ * passage.exit_mm)) ? whole_mm : whole_mm - kStation_mm;
}

}  // namespace arthronaut::postop
