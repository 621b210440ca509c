// The light at the tip of the scope and how wet surfaces answer it. Camera frame, mm.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "navigation/simulator/solids.h"

namespace arthronaut::simulator {

// Beside the lens, as the fibres of a real scope are.
inline const Eigen::Vector3f kLightPosition{0.9f, -1.3f, 0.0f};

inline Eigen::Vector3f unit(const Eigen::Vector3f& v) { return v * (1 / std::sqrt(v.squaredNorm())); }

// Linear light sent to the lens by a surface point: Lambert and a Blinn highlight, both falling off with the
// squared distance. exposure: what a white surface that faces the light sends at 1 mm.
inline Eigen::Vector3f lit(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, const Skin& skin,
                           float exposure) {
  const Eigen::Vector3f to_light = kLightPosition - point;
  const float d2 = to_light.squaredNorm();
  const Eigen::Vector3f light_direction = to_light / std::sqrt(d2);
  const float irradiance = exposure / d2;
  const Eigen::Vector3f half = unit(light_direction - unit(point));
  float highlight = std::max(0.0f, normal.dot(half));
  for (int i = 0; i < skin.gloss_doublings; ++i) highlight *= highlight;
  // A little light comes back from all around the joint.
  const float diffuse = 0.04f + std::max(0.0f, normal.dot(light_direction));
  return irradiance * (diffuse * skin.albedo_bgr + Eigen::Vector3f::Constant(skin.specular * highlight));
}

}  // namespace arthronaut::simulator
