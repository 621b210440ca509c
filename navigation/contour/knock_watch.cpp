#include "navigation/contour/knock_watch.h"

#include <algorithm>

namespace arthronaut::contour {

namespace {

// Of a displacement, what can be seen.
double across_sight_mm(const Eigen::Vector3d& by_mm, const Eigen::Vector3d& ray) {
  return (by_mm - ray * ray.dot(by_mm)).norm();
}

}  // namespace

KnockWatch::KnockWatch(std::size_t place_count, const KnockOptions& options)
    : options_(options), agreement_(place_count, options.agreement) {}

void KnockWatch::clear() {
  agreement_.clear();
  search_.clear();
  search_count_ = 0;
  found_before_ = has_looked_ = false;
  verdict_ = {};
}

const KnockVerdict& KnockWatch::judge(double elapsed_s) {
  const AgreementVerdict& agreement = agreement_.judge(elapsed_s);
  verdict_.is_otherwise = agreement.is_otherwise;
  if (agreement.agrees) found_before_ = false;
  if (!is_wanted()) {
    has_looked_ = false;
    verdict_.seen_mm = 0;
  }
  verdict_.is_looking = is_wanted() && !has_looked_;
  return verdict_;
}

bool KnockWatch::is_wanted() const {
  const AgreementVerdict& agreement = agreement_.verdict();
  return agreement.is_asked && agreement.share < options_.searches_below_share;
}

bool KnockWatch::is_believable(const KnockFound& found) const {
  return found.best >= options_.least_correlation * found.pieces &&
         found.best - found.in_place >= options_.lead_pieces &&
         found.best >= options_.over_elsewhere * found.elsewhere &&
         across_sight_mm(found.offset_in_bone_mm, found.ray_in_bone) >= options_.nearest_mm;
}

void KnockWatch::search(const VisibleBone& visible, const SurfaceMemory& memory, const camera::GrayView& luma,
                        const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_bone) {
  if (!search_.is_under_way()) {
    if (is_wanted()) search_.begin(visible, memory, luma, camera, camera_from_bone);
    return;
  }
  if (!search_.advance()) return;
  ++search_count_;
  has_looked_ = is_wanted();
  const KnockFound& found = search_.found();
  const bool is_found = is_believable(found) && is_wanted();
  const Eigen::Vector3d apart_mm = found.offset_in_bone_mm - before_in_bone_mm_;
  if (is_found && found_before_ && across_sight_mm(apart_mm, found.ray_in_bone) <= options_.same_place_mm) {
    verdict_.is_found = true;
    verdict_.knock_mm = found.offset_in_bone_mm.norm();
  }
  found_before_ = is_found;
  verdict_.seen_mm = is_found ? found.offset_in_bone_mm.norm() : 0;
  before_in_bone_mm_ = found.offset_in_bone_mm;
}

}  // namespace arthronaut::contour
