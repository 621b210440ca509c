#include "planning/segmentation/ct_bones.h"

#include <algorithm>
#include <cmath>
#include <future>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/segmentation/bone_solid.h"
#include "planning/segmentation/edge_surface.h"
#include "planning/segmentation/fibula.h"
#include "planning/segmentation/joint_parting.h"
#include "planning/segmentation/joint_space.h"
#include "planning/segmentation/marrow.h"

namespace arthronaut::segmentation {

namespace {

using bones::BoneKind;
using bones::Side;
using images::Volume;
using images::VoxelMask;

// Cortical bone of adults in CT is above 250 HU, marrow and soft tissue below. In coarse voxels the thin
// shell of the condyles and the plateau is seen through what lies beside it.
constexpr double kCoarse_mm = 1.5, kOfCoarse_hu = 180, kOfFine_hu = 250;
// A piece of less than this is a splinter or a sesamoid.
constexpr double kLeastPiece_mm3 = 4000;
// The condyles and the plateau of the smallest adults cover more in a slice; a fibula and a patella less.
constexpr double kLeastSection_mm2 = 1300;
// From the largest section of a femur down to its end; of a tibia up to the tip of its eminence. A piece that
// goes on further on both sides holds both.
constexpr double kMostBelowCondyles_mm = 42, kMostAbovePlateau_mm = 18;
// A candidate that is alone is parted only where this much of a joint is seen, and into two that are bones.
constexpr double kSureJoint_mm2 = 700, kLeastPart_mm3 = 8000;
// More of a cut beside the joint space may have left a piece of one bone on the other.
constexpr double kMostOffJoint_mm2 = 100;
// Knees lie further apart than bones of one.
constexpr double kBetweenKnees_mm = 70;
// Between the middles of tibia and fibula, level. Rails of the table are as slender, and lie further off.
constexpr double kFurthestFibula_mm = 60;
// And no nearer to the middle, from side to side. What is less tall may be anything.
constexpr double kLeastAside_mm = 8, kLeastFibula_mm = 25;
// A fibula goes on as far as the shaft does, to so much.
constexpr double kFibulaEnds_mm = 15;

struct Candidate {
  BoneSolid solid;
  SectionProfile profile;

  [[nodiscard]] double above_mm() const { return profile.high_mm() - profile.largest_at_mm(); }
  [[nodiscard]] double below_mm() const { return profile.largest_at_mm() - profile.low_mm; }
  [[nodiscard]] bool may_hold_both() const {
    return below_mm() > kMostBelowCondyles_mm && above_mm() > kMostAbovePlateau_mm;
  }
};

struct Found {
  std::vector<Candidate> candidates;  // highest first
  std::vector<PieceExtent> slender;
};

void tell(const CtBonesOptions& options, double fraction) {
  if (options.tell) options.tell(fraction);
}

Found found_pieces(const Volume& volume, const CtBonesOptions& options) {
  const auto threshold = static_cast<float>(options.threshold_for(volume));
  VoxelMask above(volume.size);
  for (std::size_t v = 0; v < volume.values.size(); ++v) above.inside[v] = volume.values[v] >= threshold;
  tell(options, 0.05);
  const double voxel_mm3 = std::abs(volume.lps_from_index.linear().determinant());
  auto pieces = images::connected_pieces(above, static_cast<std::size_t>(kLeastPiece_mm3 / 8 / voxel_mm3));
  tell(options, 0.25);
  constexpr std::size_t kMostPieces = 12;
  if (pieces.size() > kMostPieces) pieces.resize(kMostPieces);
  Found found;
  for (const auto& piece : pieces) {
    Candidate candidate;
    candidate.solid = solid_of(volume, piece.voxels, options.closing_radius_mm);
    candidate.profile = profile_of(volume, candidate.solid);
    if (candidate.profile.volume_mm3 < kLeastPiece_mm3) continue;
    if (candidate.profile.largest_mm2() < kLeastSection_mm2) {  // it may be the cortex alone
      BoneSolid whole = candidate.solid;
      if (close_marrow(volume, whole, VoxelMask(whole.mask.size), threshold).widest_mm > 0)
        candidate.profile = profile_of(volume, whole);
    }
    if (candidate.profile.largest_mm2() < kLeastSection_mm2) {
      const SectionProfile& p = candidate.profile;
      found.slender.push_back({p.center_mm, p.high_mm() - p.low_mm, p.low_mm});
    } else {
      found.candidates.push_back(std::move(candidate));
    }
  }
  std::stable_sort(found.candidates.begin(), found.candidates.end(), [](const auto& a, const auto& b) {
    return a.profile.center_mm.z() > b.profile.center_mm.z();
  });
  tell(options, 0.5);
  return found;
}

// Of a volume with both knees the one that was asked for: the outermost on its side, whatever lies between
// them.
void keep_one_knee(Found& found, const CtBonesOptions& options, CtBones& result) {
  auto& all = found.candidates;
  std::vector<double> across;
  for (const Candidate& c : all) across.push_back(c.profile.center_mm.x());
  std::sort(across.begin(), across.end());
  std::vector<double> gaps;
  for (std::size_t i = 0; i + 1 < across.size(); ++i)
    if (across[i + 1] - across[i] >= kBetweenKnees_mm) gaps.push_back(0.5 * (across[i] + across[i + 1]));
  if (gaps.empty()) return;
  if (!options.side) throw ShowsBothKnees("shows both knees: add --side left or --side right");
  const bool is_left = *options.side == Side::Left;
  const auto is_other = [&](double x) { return is_left ? x < gaps.back() : x > gaps.front(); };
  std::erase_if(all, [&](const Candidate& c) { return is_other(c.profile.center_mm.x()); });
  std::erase_if(found.slender, [&](const PieceExtent& s) { return is_other(s.center_mm.x()); });
  result.is_one_of_both = true;
  result.notes.push_back("more than one knee is seen: the bones farthest on the patient's " +
                         std::string(bones::to_text(*options.side)) + " were taken");
}

// Whether a whole bone lies above it already: then it is no femur, however high its plateau reaches above its
// largest level section, as it does in a knee that leans.
bool stands_below_a_bone(const Found& found, std::size_t at) {
  constexpr double kLeastShare = 0.25;  // a patella is less of a tibia
  const SectionProfile& below = found.candidates[at].profile;
  return std::any_of(found.candidates.begin(), found.candidates.begin() + static_cast<std::ptrdiff_t>(at),
                     [&](const Candidate& other) {
                       return other.profile.volume_mm3 > kLeastShare * below.volume_mm3 &&
                              other.profile.center_mm.z() > below.high_mm();
                     });
}

// The joint is looked for between the shafts, from a little above the section that may be the condyles'.
// `off_joint_mm2`: see PartedBones.
bool part_at_joint(const Volume& volume, Found& found, std::size_t at, const CtBonesOptions& options,
                   CtBones& result, double& off_joint_mm2) {
  const Candidate& whole = found.candidates[at];
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i index =
        whole.solid.box.first +
        Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1).cwiseProduct(whole.solid.box.size);
    const Eigen::Vector3d p = volume.lps_from_index * index.cast<double>();
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr double kAround_mm = 60;
  const double middle = whole.profile.largest_at_mm();
  low.z() = std::max(low.z(), middle - kAround_mm);
  high.z() = std::min(high.z(), middle + kAround_mm);
  const auto joint = find_joint_space(volume, low, high, options.threshold_for(volume));
  const bool is_needed = whole.may_hold_both();
  if (!joint || (!is_needed && joint->area_mm2 < kSureJoint_mm2)) return false;
  PartedBones parted =
      part_bones(volume, whole.solid, *joint, options.threshold_for(volume), options.closing_radius_mm);
  // Within one bone alone a sheet finds dark marrow here and there, and most of the cut goes through bone.
  if (!is_needed && parted.off_joint_mm2 > joint->area_mm2) return false;
  Candidate femur{std::move(parted.above), {}}, tibia{std::move(parted.below), {}};
  femur.profile = profile_of(volume, femur.solid);
  tibia.profile = profile_of(volume, tibia.solid);
  const double least = std::min(femur.profile.volume_mm3, tibia.profile.volume_mm3);
  if (!is_needed && least < kLeastPart_mm3) return false;
  off_joint_mm2 = std::max(off_joint_mm2, parted.off_joint_mm2);
  result.notes.push_back("femur and tibia touch: parted along the joint space, of which " +
                         std::to_string(std::lround(joint->area_mm2 / 100)) + " cm\u00B2 are seen");
  found.candidates[at] = std::move(femur);
  found.candidates.insert(found.candidates.begin() + static_cast<std::ptrdiff_t>(at) + 1, std::move(tibia));
  return true;
}

// Which candidate is which bone; nullptr where there is none.
struct Chosen {
  Candidate *femur = nullptr, *tibia = nullptr;
};

Chosen chosen_of(Found& found) {
  Chosen chosen;
  auto& all = found.candidates;
  const auto is_large = [&](const Candidate& c) {
    double most = 0;
    for (const Candidate& other : all) most = std::max(most, other.profile.volume_mm3);
    return c.profile.volume_mm3 > 0.08 * most;
  };
  std::vector<Candidate*> large;
  for (Candidate& c : all) {
    if (is_large(c)) large.push_back(&c);
  }
  if (large.size() >= 2) {
    chosen.femur = large[0];
    chosen.tibia = large[1];
  } else if (large.size() == 1) {
    Candidate& only = *large.front();
    (only.above_mm() > only.below_mm() ? chosen.femur : chosen.tibia) = &only;
  }
  return chosen;
}

// What hung on a bone and is no part of it.
struct Appendage {
  std::vector<Eigen::Vector3d> taken_mm;
  bool is_fibula = false;  // runs beside the shaft to its end, as no outgrowth does
  bool stays = false;      // it is seen, and could not be parted
  bool remains = false;    // something hangs on the bone still
};

Appendage take_off(const Volume& volume, BoneKind kind, Candidate& candidate, const VoxelMask& marrow) {
  Appendage appendage;
  bool is_seen = false;
  if (kind == BoneKind::Tibia) {  // by a neck alone its shaft would be parted from its head
    PartedFibula parted = part_fibula(volume, candidate.solid);
    appendage.taken_mm = std::move(parted.taken_mm);
    is_seen = parted.outcome == PartedFibula::Outcome::NotParted;
    appendage.is_fibula = !appendage.taken_mm.empty() &&
                          extent_of(appendage.taken_mm).low_mm < candidate.profile.low_mm + kFibulaEnds_mm;
  }
  if (appendage.taken_mm.empty()) {
    appendage.taken_mm = take_off_appendage(volume, candidate.solid, marrow);
  } else {  // what hangs on it by a neck now may be what remains of the fibula
    BoneSolid looked_at = candidate.solid;
    appendage.remains = !take_off_appendage(volume, looked_at, marrow).empty();
  }
  appendage.stays = is_seen && appendage.taken_mm.empty();
  if (!appendage.taken_mm.empty()) candidate.profile = profile_of(volume, candidate.solid);
  return appendage;
}

// Which side of the tibia a fibula's piece lies on; nullopt where it lies where none is.
std::optional<Side> side_of(const PieceExtent& piece, const SectionProfile& tibia) {
  const Eigen::Vector3d from_tibia = piece.center_mm - tibia.center_mm;
  if (piece.center_mm.z() > tibia.high_mm() || std::abs(from_tibia.x()) < kLeastAside_mm ||
      from_tibia.head<2>().norm() > kFurthestFibula_mm)
    return std::nullopt;
  return from_tibia.x() > 0 ? Side::Left : Side::Right;
}

// Lateral is where the fibula is: a slender piece that stands free beside the tibia, or what was parted from
// it along its shaft. What hung on the tibia by a neck may be its head, or an outgrowth: it is asked only
// where there is neither.
struct FibulaSide {
  std::optional<Side> side;
  bool is_contradicted = false;  // one on either side
};
FibulaSide side_by_fibula(const std::vector<PieceExtent>& free, const Appendage& appendage,
                          const SectionProfile& tibia) {
  FibulaSide told;
  const auto say = [&](const PieceExtent& piece) {
    const auto side = side_of(piece, tibia);
    if (side && told.side && *side != *told.side) told.is_contradicted = true;
    if (side) told.side = side;
  };
  for (const PieceExtent& piece : free)
    if (piece.height_mm > kLeastFibula_mm) say(piece);
  if (!appendage.taken_mm.empty()) {
    const PieceExtent taken = extent_of(appendage.taken_mm);
    if (appendage.is_fibula || (!told.side && taken.height_mm > kLeastFibula_mm)) say(taken);
  }
  if (told.is_contradicted) told.side.reset();
  return told;
}

CtBone surface_of(const Volume& volume, BoneKind kind, const Candidate& candidate, const Candidate* other,
                  const Appendage& appendage, const CtBonesOptions& options) {
  CtBone bone;
  bone.kind = kind;
  const BoneSolid& solid = candidate.solid;
  VoxelMask others = within_other(solid, other ? &other->solid : nullptr);
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  for (const Eigen::Vector3d& p : appendage.taken_mm) {
    const Eigen::Vector3i at = (index_from_lps * p).array().round().cast<int>().matrix() - solid.box.first;
    others.inside[others.index(at.x(), at.y(), at.z())] = 1;
  }
  bone.mesh =
      edge_surface(volume, solid.box, solid.mask, others, {.threshold = options.threshold_for(volume)});
  bone.notes.push_back(
      files::format("threshold %.0f HU, surface at the local edge; %.0f ml, marrow filled in",
                    options.threshold_for(volume), candidate.profile.volume_mm3 / 1000));
  if (appendage.stays)
    bone.doubts.push_back("the fibula hangs on it and could not be parted from it: look at its outer side");
  if (appendage.remains)
    bone.doubts.push_back(
        "where the fibula was taken off something hangs on it still: look at its outer side");
  if (!appendage.taken_mm.empty())
    bone.notes.push_back(kind == BoneKind::Femur ? "a bone that touches (the patella) was taken off"
                         : appendage.is_fibula
                             ? "the fibula, which touches, was taken off"
                             : "what hangs on it (the fibula's head, or an outgrowth) was taken off");
  return bone;
}

std::string values_in_words(const Volume& volume) {
  const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
  return files::format("its values run from %.0f to %.0f", *low, *high);
}

}  // namespace

double CtBonesOptions::threshold_for(const Volume& volume) const {
  return threshold.value_or(volume.spacing_mm().maxCoeff() > kCoarse_mm ? kOfCoarse_hu : kOfFine_hu);
}

CtBones bones_of_ct(const Volume& volume, const CtBonesOptions& options) {
  CtBones result;
  Found found = found_pieces(volume, options);
  keep_one_knee(found, options, result);
  if (found.candidates.empty()) {
    throw InvalidInput(files::format("holds no femur and no tibia above the threshold of %.0f HU: ",
                                     options.threshold_for(volume)) +
                       values_in_words(volume));
  }
  bool is_joined = false;
  double off_joint_mm2 = 0;
  for (std::size_t i = 0; i < found.candidates.size(); ++i) {
    if (stands_below_a_bone(found, i)) continue;
    const bool holds_both = found.candidates[i].may_hold_both();
    if (!holds_both && found.candidates.size() > 1) continue;
    if (part_at_joint(volume, found, i, options, result, off_joint_mm2)) {
      ++i;
    } else {
      is_joined = is_joined || holds_both;
    }
  }
  tell(options, 0.7);
  const Chosen chosen = chosen_of(found);
  std::vector<std::pair<BoneKind, Candidate*>> wanted;
  if (chosen.femur && options.only != BoneKind::Tibia) wanted.emplace_back(BoneKind::Femur, chosen.femur);
  if (chosen.tibia && options.only != BoneKind::Femur) wanted.emplace_back(BoneKind::Tibia, chosen.tibia);
  if (wanted.empty()) {
    throw InvalidInput("shows no " + std::string(bones::to_text(*options.only)) + ", only a " +
                       (chosen.femur ? "femur" : "tibia"));
  }
  std::vector<Appendage> appendages(wanted.size());
  const auto for_each_bone = [&](const auto& work) {
    std::vector<std::future<void>> others;  // waited for where work(0) throws, too
    for (std::size_t i = 1; i < wanted.size(); ++i)
      others.push_back(std::async(std::launch::async, [&work, i] { work(i); }));
    work(0);
    for (auto& other : others) other.get();
  };
  const auto other_of = [&](std::size_t i) {
    return wanted[i].second == chosen.femur ? chosen.tibia : chosen.femur;
  };
  std::vector<double> gaps_mm(wanted.size());
  std::vector<VoxelMask> others;  // as they are parted, before either is closed
  for (std::size_t i = 0; i < wanted.size(); ++i)
    others.push_back(within_other(wanted[i].second->solid, other_of(i) ? &other_of(i)->solid : nullptr));
  for_each_bone([&](std::size_t i) {
    Candidate& candidate = *wanted[i].second;
    const ClosedMarrow closed =
        close_marrow(volume, candidate.solid, others[i], options.threshold_for(volume));
    gaps_mm[i] = closed.widest_mm;
    if (closed.widest_mm > 0) candidate.profile = profile_of(volume, candidate.solid);
    appendages[i] = take_off(volume, wanted[i].first, candidate, closed.voxels);
  });
  tell(options, 0.8);
  result.bones.resize(wanted.size());
  for_each_bone([&](std::size_t i) {
    result.bones[i] =
        surface_of(volume, wanted[i].first, *wanted[i].second, other_of(i), appendages[i], options);
    if (gaps_mm[i] > 0)
      result.bones[i].notes.push_back(files::format(
          "its cortex has gaps of up to %.0f mm at the threshold, across which the marrow was closed off",
          gaps_mm[i]));
  });
  for (CtBone& bone : result.bones) {
    if (is_joined)
      bone.doubts.push_back("femur and tibia seem to touch, and no joint space is seen between them");
    if (off_joint_mm2 > kMostOffJoint_mm2)
      bone.doubts.push_back(files::format(
          "femur and tibia touch, and over %.0f cm\u00B2 no joint space parts them: a piece of the "
          "one may have gone with the other, look at both where they meet",
          std::max(1.0, std::round(off_joint_mm2 / 100))));
  }
  if (chosen.tibia) {
    Appendage of_tibia;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i].first == BoneKind::Tibia) of_tibia = std::move(appendages[i]);
    const FibulaSide told = side_by_fibula(found.slender, of_tibia, chosen.tibia->profile);
    result.side_by_fibula = told.side;
    if (!told.side)
      result.why_no_fibula =
          of_tibia.stays ? "the fibula could not be parted from the tibia"
          : told.is_contradicted
              ? "what may be the fibula lies on both sides of the tibia"
              : "no fibula is seen apart from the tibia: it lies outside of the images, or "
                "is a part of that bone";
    for (CtBone& bone : result.bones)
      if (bone.kind == BoneKind::Tibia && !told.side && !of_tibia.stays)
        bone.notes.push_back(result.why_no_fibula);
  } else {
    result.why_no_fibula = "no tibia is seen, beside which a fibula would lie";
  }
  tell(options, 1);
  return result;
}

}  // namespace arthronaut::segmentation
