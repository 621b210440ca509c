#include "navigation/openigtlink/ras_from_lps.h"

namespace arthronaut::openigtlink {

geometry::RigidTransform ras_from_lps(const geometry::RigidTransform& target_from_source) {
  const Eigen::Quaterniond& q = target_from_source.rotation;
  const Eigen::Vector3d& t = target_from_source.translation_mm;
  // Turning x and y about is a half turn about z, so the rotation's axis turns with them.
  return {{q.w(), -q.x(), -q.y(), q.z()}, {-t.x(), -t.y(), t.z()}};
}

}  // namespace arthronaut::openigtlink
