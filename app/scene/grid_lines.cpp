#include "app/scene/grid_lines.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "planning/files/format.h"

namespace arthronaut::scene {

namespace {

using norms::Bundle;
using tunnels::NormRange;

// at: takes percentages along and across to a point.
template <typename PointAt>
GridLines lines_of(const PointAt& at) {
  GridLines lines;
  constexpr int kParts = 4;
  for (int i = 0; i <= kParts; ++i) {
    const double percent = 100.0 * i / kParts;
    auto& group = i == 0 || i == kParts ? lines.rims : lines.divisions;
    group.push_back({at(percent, 0.0), at(percent, 100.0)});
    group.push_back({at(0.0, percent), at(100.0, percent)});
  }
  return lines;
}

// What plan checks hold it against: of the whole ligament their own ranges, of a bundle its study's.
template <typename PointAt>
NormEllipse ellipse_of(const PointAt& at, bones::BoneKind bone, Bundle bundle, NormRange along,
                       NormRange across) {
  const norms::InsertionNorm& study = norms::default_norm(bone, bundle);
  std::string source = norms::cited(study);
  if (bundle != Bundle::Whole) {
    along = {study.along.mean, study.along.sd};
    across = {study.across.mean, study.across.sd};
  } else if (bone == bones::BoneKind::Tibia) {
    source = "Cho 2017, 38.0 to 45.0 %; 10.1177/23259671231208678";
  }
  NormEllipse ellipse;
  ellipse.bundle = bundle;
  ellipse.center_mm = at(along.center, across.center);
  constexpr int kPoints = 48;
  for (int i = 0; i < kPoints; ++i) {
    const double turn = 2 * std::numbers::pi * i / kPoints;
    ellipse.outline_mm.push_back(
        at(along.center + along.radius * std::cos(turn), across.center + across.radius * std::sin(turn)));
  }
  const bool is_femur = bone == bones::BoneKind::Femur;
  ellipse.words =
      std::string(bundle == Bundle::Whole          ? "Ligament"
                  : bundle == Bundle::Anteromedial ? "AM bundle"
                                                   : "PL bundle") +
      files::format(": %.1f \u00B1 %.1f %% %s, %.1f \u00B1 %.1f %% %s (", along.center, along.radius,
                    is_femur ? "deep to shallow" : "anterior to posterior", across.center, across.radius,
                    is_femur ? "high to low" : "medial to lateral") +
      source + ")";
  return ellipse;
}

}  // namespace

GridLines grid_lines(const landmarks::FemoralQuadrant& quadrant) {
  return lines_of([&](double deep, double high) { return quadrant.point_at({deep, high}); });
}

GridLines grid_lines(const landmarks::TibialGrid& grid) {
  return lines_of([&](double back, double lateral) { return grid.point_at({back, lateral}); });
}

NormEllipse norm_ellipse(const landmarks::FemoralQuadrant& quadrant, Bundle bundle,
                         const tunnels::PlanNorms& norms) {
  return ellipse_of(
      [&](double deep, double high) {
        return quadrant.point_at({deep, high});
      },
      bones::BoneKind::Femur, bundle, norms.femur_deep_shallow_percent, norms.femur_high_low_percent);
}

NormEllipse norm_ellipse(const landmarks::TibialGrid& grid, Bundle bundle, const tunnels::PlanNorms& norms) {
  return ellipse_of(
      [&](double back, double lateral) {
        return grid.point_at({back, lateral});
      },
      bones::BoneKind::Tibia, bundle, norms.tibia_anterior_posterior_percent,
      norms.tibia_medial_lateral_percent);
}

void add_grid(SceneContent& content, const GridLines& lines, std::span<const NormEllipse> norms) {
  for (const auto& line : lines.rims) content.lines.push_back({line, 0.6, false, kGridColor, true});
  for (const auto& line : lines.divisions) content.lines.push_back({line, 0.3, false, kGridColor, true});
  for (const NormEllipse& norm : norms)
    content.lines.push_back({norm.outline_mm, 0.5, true, kNormColor, true});
}

}  // namespace arthronaut::scene
