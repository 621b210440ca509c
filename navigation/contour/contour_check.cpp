#include "navigation/contour/contour_check.h"

#include <algorithm>

namespace arthronaut::contour {

namespace {

// Of a frame, taken in turn: what it costs is bounded whatever is seen.
constexpr std::size_t kOutlinesPerFrame = 48, kPlacesPerFrame = 28;
constexpr int kKeptPerFrame = 10;
// Fewer of either cannot outvote an edge or a highlight that happens to lie elsewhere.
constexpr int kFewestOutlines = 8, kFewestPieces = 5;
constexpr int kEnoughKept = 12;
// A drift of this and more may be one of more than the drift test compares: how far, the search says, which
// takes a few pictures.
constexpr double kEdge_mm = 1.4;
constexpr double kStill_px = 6;  // a picture that moves by more is smeared: nothing is kept of it

}  // namespace

std::string_view to_text(ContourState state) {
  switch (state) {
    case ContourState::NotChecked:
      return "not checked";
    case ContourState::Holds:
      return "holds";
    case ContourState::Drifted:
      return "drifted";
    case ContourState::LooksOtherwise:
      return "does not look as it did";
  }
  return "unknown";
}

std::string_view to_text(NotCheckedReason reason) {
  switch (reason) {
    case NotCheckedReason::NoRegistration:
      return "no registration stands";
    case NotCheckedReason::NoPose:
      return "the bone marker is not tracked";
    case NotCheckedReason::Settling:
      return "learning what the bone looks like";
    case NotCheckedReason::TooLittleInView:
      return "too little in view that looks as it did";
  }
  return "unknown";
}

ContourCheck::ContourCheck(const geometry::TriangleMesh& mesh, const ContourOptions& options)
    : options_(options),
      visible_(mesh),
      memory_(visible_.places().size()),
      outline_test_(options.outline),
      surface_test_(options.surface),
      knock_(visible_.places().size(), options.knock) {}

void ContourCheck::begin(const geometry::RigidTransform& world_from_bone) {
  end();
  has_begun_ = true;
  world_from_bone_ = world_from_bone;
  verdict_.reason = NotCheckedReason::Settling;
}

void ContourCheck::end() {
  has_begun_ = has_seen_bone_ = has_outline_reference_ = false;
  visible_.restart();
  memory_.forget();
  outline_test_.clear();
  surface_test_.clear();
  knock_.clear();
  camera_from_bone_before_.reset();
  time_before_ns_ = 0;
  outline_settled_s_ = surface_settled_s_ = 0;
  next_outline_ = next_place_ = 0;
  verdict_ = {};
}

const ContourVerdict& ContourCheck::look(const camera::GrayView& luma, const camera::CameraModel& camera,
                                         const std::optional<geometry::RigidTransform>& camera_from_world,
                                         std::span<const Covered> covered, std::int64_t timestamp_ns) {
  const double elapsed_s =
      time_before_ns_ != 0
          ? std::clamp(1e-9 * static_cast<double>(timestamp_ns - time_before_ns_), 0.0, kLongestGap_s)
          : 0;
  const bool is_first = time_before_ns_ == 0;
  time_before_ns_ = timestamp_ns;
  verdict_.timestamp_ns = timestamp_ns;
  verdict_.outline_pieces = verdict_.surface_pieces = 0;
  if (!has_begun_) return verdict_;
  if (is_first) verdict_.held_until_ns = timestamp_ns;  // where it lies is learned from here on
  if (!camera_from_world) {
    // What was seen stays as it was: nothing was seen to move meanwhile, and nothing to stay.
    camera_from_bone_before_.reset();
    if (verdict_.state != ContourState::Drifted) {
      verdict_.state = ContourState::NotChecked;
      verdict_.reason = NotCheckedReason::NoPose;
      verdict_.share_seen = 0;
    }
    return verdict_;
  }
  const geometry::RigidTransform camera_from_bone = *camera_from_world * world_from_bone_;
  has_seen_bone_ = visible_.advance(camera_from_bone, camera) || has_seen_bone_;
  ask_outline(luma, camera, camera_from_bone, covered);
  ask_surface(luma, camera, camera_from_bone, covered, is_still(camera, camera_from_bone));
  camera_from_bone_before_ = camera_from_bone;
  conclude(elapsed_s);
  if (verdict_.state != ContourState::Drifted)
    knock_.search(visible_, memory_, luma, camera, camera_from_bone);
  return verdict_;
}

bool ContourCheck::is_still(const camera::CameraModel& camera,
                            const geometry::RigidTransform& camera_from_bone) const {
  if (!camera_from_bone_before_ || visible_.places_seen().empty()) return false;
  const auto& place = visible_.places()[static_cast<std::size_t>(visible_.places_seen().front())];
  const auto now = camera.project(camera_from_bone * place.in_bone_mm),
             before = camera.project(*camera_from_bone_before_ * place.in_bone_mm);
  return now && before && (*now - *before).norm() < kStill_px;
}

void ContourCheck::ask_outline(const camera::GrayView& luma, const camera::CameraModel& camera,
                               const geometry::RigidTransform& camera_from_bone,
                               std::span<const Covered> covered) {
  const std::vector<ContourPoint>& outline = visible_.outline();
  const std::size_t count = std::min(outline.size(), kOutlinesPerFrame);
  for (std::size_t i = 0; i < count; ++i) {
    const ContourPoint& point = outline[(next_outline_ + i * outline.size() / count) % outline.size()];
    if (const auto profile = edge_profile(luma, camera, camera_from_bone, point, covered)) {
      outline_test_.add(*profile);
      ++verdict_.outline_pieces;
    }
  }
  ++next_outline_;
}

void ContourCheck::ask_surface(const camera::GrayView& luma, const camera::CameraModel& camera,
                               const geometry::RigidTransform& camera_from_bone,
                               std::span<const Covered> covered, bool may_keep) {
  const std::vector<std::int32_t>& seen = visible_.places_seen();
  const DriftVerdict& so_far = surface_test_.verdict();
  // Only beside what was kept and is seen to lie where it lay: else a drift would be kept with it.
  const bool settles = surface_settled_s_ < options_.settle_s || memory_.count() < kEnoughKept;
  const bool lies_where_it_lay = so_far.is_checked && so_far.lead < 0;
  const bool looks_as_it_did = settles || (lies_where_it_lay && knock_.agreement().agrees);
  may_keep = may_keep && looks_as_it_did;
  int kept = 0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < seen.size() && compared < kPlacesPerFrame; ++i) {
    const auto index = static_cast<std::size_t>(seen[next_place_++ % seen.size()]);
    const SurfacePlace& place = visible_.places()[index];
    if (memory_.keeps(index)) {
      if (const auto map = memory_.compare(index, place, luma, camera, camera_from_bone, covered)) {
        surface_test_.add(*map);
        knock_.add(index, *map, looks_as_it_did);
        ++verdict_.surface_pieces;
        ++compared;
      }
    } else if (may_keep && kept < kKeptPerFrame) {
      kept += memory_.keep(index, place, luma, camera, camera_from_bone, covered);
    }
  }
}

// Seen so that most drifts would show, and none does. What is remembered of the time before a move outweighs
// what is seen of it for a while, the longer the less is seen of it.
void ContourCheck::note_held(bool outline_counts, bool surface_counts) {
  const DriftVerdict &outline = outline_test_.verdict(), &surface = surface_test_.verdict();
  const auto holds = [&](const DriftVerdict& test) {
    return test.lead < 0 && test.share_seen >= options_.belies_from_share;
  };
  const bool contradicts = surface_counts && surface.lead >= 0;
  if (contradicts || !((surface_counts && holds(surface)) || (outline_counts && holds(outline)))) return;
  const double lag_s = options_.lag_memories * std::max(options_.outline.memory_s, options_.surface.memory_s);
  verdict_.held_until_ns =
      std::max(verdict_.held_until_ns, verdict_.timestamp_ns - static_cast<std::int64_t>(1e9 * lag_s));
}

void ContourCheck::conclude(double elapsed_s) {
  const bool has_outline = verdict_.outline_pieces >= kFewestOutlines,
             has_surface = verdict_.surface_pieces >= kFewestPieces;
  const DriftVerdict& outline = outline_test_.judge(elapsed_s);
  const DriftVerdict& surface = surface_test_.judge(elapsed_s);
  const KnockVerdict& knock = knock_.judge(elapsed_s);
  const AgreementVerdict& agreement = knock_.agreement();
  outline_settled_s_ += has_outline ? elapsed_s : 0;
  surface_settled_s_ += has_surface ? elapsed_s : 0;
  if (!has_outline_reference_ && outline_settled_s_ >= options_.settle_s) {
    outline_test_.set_reference(outline_test_.best_near_mm());
    has_outline_reference_ = true;
  }
  const bool outline_counts = has_outline_reference_ && has_outline,
             surface_counts = surface_settled_s_ >= options_.settle_s && has_surface;
  // A surface that fits where it lay, seen so that most drifts would show in it, belies an outline that seems
  // to have moved: what lies behind an outline changes, and then another edge is taken for it.
  const bool surface_holds =
      surface_counts && surface.lead < 0 && surface.share_seen >= options_.belies_from_share;
  const bool by_outline = outline_counts && outline.has_drifted && !surface_holds,
             by_surface = surface_counts && surface.has_drifted;
  if (verdict_.state == ContourState::Drifted) return;
  if (!agreement.differs && !knock.is_looking) note_held(outline_counts, surface_counts);
  verdict_.share_seen =
      std::max(outline_counts ? outline.share_seen : 0, surface_counts ? surface.share_seen : 0);
  const double drift_mm = by_surface ? surface.from_reference_mm : outline.from_reference_mm;
  const bool has_drifted = by_outline || by_surface;
  if (has_drifted && !(knock.is_looking && drift_mm > kEdge_mm)) {
    verdict_.state = ContourState::Drifted;
    verdict_.is_by_outline = !by_surface;
    verdict_.drift_mm = std::max(drift_mm, knock.seen_mm);
  } else if (knock.is_found) {
    verdict_.state = ContourState::Drifted;
    verdict_.is_by_outline = false;
    verdict_.drift_mm = knock.knock_mm;
  } else if (knock.is_otherwise) {
    verdict_.state = ContourState::LooksOtherwise;
  } else if (!has_drifted && !agreement.differs &&
             ((outline_counts && outline.is_checked) || (surface_counts && surface.is_checked))) {
    verdict_.state = ContourState::Holds;
  } else {
    verdict_.state = ContourState::NotChecked;
    const bool settles =
        !has_seen_bone_ || ((has_outline || has_surface) && !outline_counts && !surface_counts);
    verdict_.reason = settles ? NotCheckedReason::Settling : NotCheckedReason::TooLittleInView;
  }
}

}  // namespace arthronaut::contour
