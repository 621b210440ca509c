#include "planning/postop/drilled_tunnel.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "planning/files/format.h"
#include "planning/geometry/quantile.h"
#include "planning/postop/fit_spread.h"
#include "planning/postop/tunnel_end.h"
#include "planning/postop/tunnel_search.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr double kGridRadius_mm = 70;
constexpr double kReach_mm = 8;         // of the voxels beside a bore, beyond its radius
constexpr double kFirstLength_mm = 26;  // that the first fit looks at, until it is known how long the bore is
constexpr double kShortest_mm = 8;
constexpr double kLeastDiameter_mm = 3.5, kMostDiameter_mm = 14;
// What is asked for, where there is metal, too, and how seldom either may be missed by what is called
// reliable.
constexpr double kAskedEntry_mm = 0.3, kAskedDirection_deg = 0.5, kAskedEntryByMetal_mm = 0.6,
                 kAskedDirectionByMetal_deg = 1, kMostChance = 0.02;
// Half of what is asked for; a third where there is a rim, of which what may be else is not spread as an
// error is: a tunnel known to 0.12 mm was off by 0.31 mm.
constexpr double kMostDiameterSigma_mm = 0.15, kMostSigmaByRim_mm = 0.1;
// How wide a bore is is known through as much blur as this (sigma, voxel included): there is no trial beyond.
constexpr double kMostBlur_mm = 1.0;
constexpr double kSomeMetal = 0.01;
// Pieces of the bore lie off its axis by no more than this.
constexpr double kMostBend_mm = 0.6, kPiece_mm = 8, kPieceKnown_mm = 0.2;
// Beyond the end of a socket there is no wall as wide.
constexpr double kAsWide_mm = 1;
// Of simulated sockets that are known so well none was off by more than 1 mm.
constexpr double kMostLengthSigma_mm = 0.75;
constexpr double kMetalOfPiece = 0.05;
constexpr double kPlugSeen = 0.3;  // of a stretch's wall, to be a plug's
// Of an entry beside the planned axis. Drilling errs by less: mean and three standard deviations of tibial
// tunnels by conventional instruments are 11.8 mm (4.9 and 2.3, 20 knees of foam; KneeNav ACL).
constexpr double kMostOffAxis_mm = 12;
constexpr double kMouthStep_mm = 1.5;
// Of a stretch, from which on it says nothing of the wall.
constexpr double kMetalFilled = 0.5;

struct Candidate {
  TunnelFit fit;
  Passage passage{};
  SeenMouth mouth;
  TunnelEnd end = {};
  double length_sigma_mm = std::numeric_limits<double>::infinity();
  double seen_share = 0, metal_share = 0, clear_mm = 0, bend_mm = 0;
  bool goes_on = false, is_by_screw = false;
  std::vector<Doubt> doubts;

  [[nodiscard]] double entry_sigma_mm() const { return fit.entry_sigma_mm * passage.entry_per_across(); }
  [[nodiscard]] double merit() const {
    return seen_share * std::min(end.from_entry_mm, 30.0) + 20 * mouth.open_share;
  }
};

class Finder {
 public:
  Finder(const images::Volume& postop, const geometry::RigidTransform& postop_from_plan,
         const geometry::Surface& bone, const tunnels::Tunnel& plan)
      : volume_(postop),
        sampler_(postop),
        postop_from_plan_(postop_from_plan),
        bone_(bone),
        ends_(sampler_, postop_from_plan_, bone_),
        depths_(bone),
        grid_(bone_grid(sampler_, postop_from_plan, bone, plan.entry_mm, kGridRadius_mm)) {}

  [[nodiscard]] const BoneGrid& grid() const { return grid_; }

  // Where the cortex is missing nearer to the plan than a bore, and clear of that bore's own mouth and of the
  // others': a tunnel in which nothing stands out from the marrow has a mouth all the same. nullopt: nowhere.
  [[nodiscard]] std::optional<Vector3d> mouth_nearer(const tunnels::Tunnel& plan, const Candidate& bore,
                                                     std::span<const tunnels::Tunnel> others) const {
    const double radius_mm = std::min(0.5 * plan.diameter_mm, bore.fit.radius_mm),
                 off_mm = (bore.passage.entry_mm - plan.entry_mm).norm(), clear_mm = 2 * bore.fit.radius_mm;
    const Vector3d u = plan.direction.unitOrthogonal(), v = plan.direction.cross(u);
    const int places = static_cast<int>(off_mm / kMouthStep_mm);
    for (int i = -places; i <= places; ++i) {
      for (int j = -places; j <= places; ++j) {
        const auto there = passage_of(bone_, plan.entry_mm + kMouthStep_mm * (i * u + j * v), plan.direction);
        if (!there) continue;
        const double at_mm = (there->entry_mm - plan.entry_mm).norm();
        if (at_mm >= off_mm || (there->entry_mm - bore.passage.entry_mm).norm() < clear_mm) continue;
        if (std::ranges::any_of(others, [&](const tunnels::Tunnel& other) {
              return (there->entry_mm - other.entry_mm).norm() < at_mm;
            }))
          continue;
        if (mouth_at(sampler_, postop_from_plan_, bone_, there->entry_mm, plan.direction, radius_mm)
                .is_open())
          return there->entry_mm;
      }
    }
    return std::nullopt;
  }

  // nullopt: too short, or it does not open at the bone's surface.
  [[nodiscard]] std::optional<Candidate> measured(const Bore& found) {
    Candidate candidate;
    const auto first = passage_of(bone_, found.entry_mm, found.direction);
    if (!first) return std::nullopt;
    const double whole_mm = first->length_mm();
    const auto voxels = wall_voxels(volume_, postop_from_plan_.inverse(), grid_, depths_, found, whole_mm + 8,
                                    found.radius_mm + kReach_mm);
    Bore bore{first->entry_mm, found.direction, found.radius_mm, 0};
    if (!fitted(voxels, bore, std::min(whole_mm, kFirstLength_mm), WallProfile{}, Blur::AsItLooks, candidate))
      return std::nullopt;
    // Once more, to where it ends.
    for (int round = 0; round < 2; ++round) {
      candidate.end = ends_.find(voxels, candidate.fit, candidate.passage, candidate.end.narrowing);
      if (candidate.end.from_entry_mm < kShortest_mm) return std::nullopt;
      const auto known = round > 0 ? std::optional(candidate.fit.profile) : std::nullopt;
      if (!fitted(voxels, bore_of(candidate.fit, candidate.passage), candidate.end.from_entry_mm, known,
                  round > 0 ? Blur::Fitted : Blur::AsItLooks, candidate))
        return std::nullopt;
    }
    candidate.end = ends_.find(voxels, candidate.fit, candidate.passage, candidate.end.narrowing);
    if (candidate.end.from_entry_mm < kShortest_mm) return std::nullopt;
    candidate.mouth = mouth_at(sampler_, postop_from_plan_, bone_, candidate.passage.entry_mm,
                               candidate.fit.direction, candidate.fit.radius_mm);
    if (!candidate.mouth.is_open()) return std::nullopt;
    candidate.length_sigma_mm = ends_.sigma_mm(candidate.fit, candidate.passage, candidate.end);
    candidate.bend_mm = bend(voxels, candidate);
    candidate.goes_on = goes_on(voxels, candidate);
    describe(candidate);
    return candidate;
  }

 private:
  // False when nothing is fitted, or what is fitted is no tunnel.
  bool fitted(const std::vector<WallVoxel>& voxels, const Bore& bore, double length_mm,
              const std::optional<WallProfile>& known, Blur blur, Candidate& candidate) const {
    candidate.is_by_screw = false;
    candidate.fit = fit_tunnel(voxels, bore, 0, length_mm, Wall::Clear, known, blur);
    if (!candidate.fit.is_fitted) return false;
    double clear_mm = 0, filled_mm = 0;
    for (const Stretch& stretch : candidate.fit.stretches)
      (stretch.metal_share > kMetalFilled ? filled_mm : clear_mm) +=
          length_mm / static_cast<double>(candidate.fit.stretches.size());
    if (clear_mm < kShortest_mm && filled_mm > kShortest_mm) {
      const TunnelFit by_screw = fit_tunnel(voxels, bore, 0, length_mm, Wall::Screw);
      if (by_screw.is_fitted) {
        candidate.fit = by_screw;
        candidate.is_by_screw = true;
      }
    }
    const auto passage = passage_of(bone_, on_axis(candidate.fit, bore.entry_mm), candidate.fit.direction);
    if (!passage) return false;
    candidate.passage = *passage;
    const double diameter = 2 * candidate.fit.radius_mm;
    return diameter > kLeastDiameter_mm - 1 && diameter < kMostDiameter_mm + 2 &&
           (candidate.passage.entry_mm - bore.entry_mm).norm() < 6;
  }

  // The axis' point beside a place.
  [[nodiscard]] static Vector3d on_axis(const TunnelFit& fit, const Vector3d& place) {
    return fit.point_mm + (place - fit.point_mm).dot(fit.direction) * fit.direction;
  }

  // How far pieces of the bore lie off its axis, at most.
  [[nodiscard]] double bend(const std::vector<WallVoxel>& voxels, const Candidate& candidate) const {
    double most = 0;
    const Bore bore = bore_of(candidate.fit, candidate.passage);
    for (double from = 0; from + kPiece_mm <= candidate.end.from_entry_mm + 0.5; from += 0.5 * kPiece_mm) {
      const TunnelFit piece =
          fit_tunnel(voxels, bore, from, from + kPiece_mm, candidate.is_by_screw ? Wall::Screw : Wall::Clear,
                     candidate.fit.profile);
      if (!piece.is_fitted || piece.stretches.empty()) continue;
      const bool is_seen = std::all_of(piece.stretches.begin(), piece.stretches.end(), [&](const Stretch& s) {
        return s.seen_share > kLeastSeen && (candidate.is_by_screw || s.metal_share < kMetalOfPiece);
      });
      if (!is_seen) continue;
      const Vector3d middle = bore.entry_mm + (from + 0.5 * kPiece_mm) * bore.direction;
      // At its middle a piece's place and tilt do not depend on each other.
      const double known =
          std::sqrt(std::max(0.0, std::pow(piece.entry_sigma_mm, 2) -
                                      std::pow((from + 0.5 * kPiece_mm) * piece.direction_sigma_rad, 2)));
      if (known < kPieceKnown_mm) most = std::max(most, (on_axis(piece, middle) - middle).norm());
    }
    return most;
  }

  // Whether its wall is seen beyond where it is said to end, as wide as before.
  [[nodiscard]] bool goes_on(const std::vector<WallVoxel>& voxels, const Candidate& candidate) const {
    const double from = candidate.end.from_entry_mm + kBeyondFrom_mm,
                 to = candidate.end.from_entry_mm + kBeyondTo_mm;
    if (candidate.end.comes_out || to > candidate.passage.length_mm()) return false;
    const TunnelFit beyond = fit_tunnel(voxels, bore_of(candidate.fit, candidate.passage), from, to,
                                        Wall::Clear, candidate.fit.profile);
    return beyond.is_fitted && std::abs(beyond.radius_mm - candidate.fit.radius_mm) < kAsWide_mm &&
           std::all_of(beyond.stretches.begin(), beyond.stretches.end(),
                       [](const Stretch& stretch) { return stretch.seen_share > kLeastSeen; });
  }

  static void describe(Candidate& c) {
    double seen = 0, weight = 0, metal = 0;
    for (const Stretch& stretch : c.fit.stretches) {
      metal += stretch.metal_share / static_cast<double>(c.fit.stretches.size());
      if (stretch.metal_share > kMetalFilled && !c.is_by_screw) continue;
      seen += stretch.seen_share;
      weight += 1;
    }
    c.seen_share = weight > 0 ? seen / weight : 0;
    c.metal_share = metal;
    c.clear_mm = c.end.from_entry_mm * weight / static_cast<double>(c.fit.stretches.size());
    using enum tunnels::Quantity;
    const auto doubt = [&](std::string reason, tunnels::Quantities about = tunnels::all_quantities()) {
      c.doubts.push_back({std::move(reason), std::move(about)});
    };
    if (c.seen_share < kLeastSeen)
      doubt(files::format("only %.0f %% of its wall are seen, %.0f %% are needed", 100 * c.seen_share,
                          100 * kLeastSeen));
    if (c.clear_mm < kShortest_mm)
      doubt(files::format("only %.0f mm of it are free of metal, %.0f mm are needed", c.clear_mm,
                          kShortest_mm));
    // Whether it fills the tunnel is not to be seen: what it shines over beside it looks as bright as bone.
    if (c.is_by_screw) doubt("only its screw is seen: the tunnel may be wider, and lie beside it");
    const bool by_metal = c.metal_share > kSomeMetal;
    const auto most_sigma = [&](double asked) { return largest_sigma(asked, kMostChance, c.fit.freedom); };
    const double most_entry = most_sigma(by_metal ? kAskedEntryByMetal_mm : kAskedEntry_mm),
                 most_deg = most_sigma(by_metal ? kAskedDirectionByMetal_deg : kAskedDirection_deg),
                 sigma_deg = geometry::deg_from_rad(c.fit.direction_sigma_rad);
    // About all of it: width and length are measured along the axis. A socket was told 1.2 mm too long, known
    // to 0.07 mm, along an axis that was known to 0.40 deg and off by 1.5 deg.
    if (!(c.entry_sigma_mm() <= most_entry))
      doubt(
          files::format("its entry is known to %.2f mm, %.2f mm are needed", c.entry_sigma_mm(), most_entry));
    if (!(sigma_deg <= most_deg))
      doubt(files::format("its direction is known to %.2f deg, %.2f deg are needed", sigma_deg, most_deg));
    const double most_wide = c.fit.profile.has_rim() ? kMostSigmaByRim_mm : kMostDiameterSigma_mm;
    if (!(c.fit.diameter_sigma_mm <= most_wide))
      doubt(files::format("its diameter is known to %.2f mm, %.2f mm are needed", c.fit.diameter_sigma_mm,
                          most_wide),
            {Diameter});
    if (!c.is_by_screw && c.fit.profile.layer_mm > 0)
      doubt(files::format(
          "the wall that is seen is the outer side of a layer of some %.1f mm that is less dense than "
          "the bone: which of its sides was drilled is not seen, and its diameter is not known",
          c.fit.profile.layer_mm));
    if (!c.is_by_screw && !c.fit.profile.has_rim() && c.fit.profile.plain_blur_mm > kMostBlur_mm)
      doubt(
          files::format("the images are blurred by %.2f mm (sigma), %.2f mm are borne: it may be "
                        "wider than it looks",
                        c.fit.profile.plain_blur_mm, kMostBlur_mm));
    if (c.bend_mm > kMostBend_mm)
      doubt(files::format("it is not straight: pieces of it lie %.1f mm off its axis", c.bend_mm));
    // Its edge is as round as the tunnel's wall, which may lie close beside it.
    const auto plug = std::find_if(c.fit.stretches.begin(), c.fit.stretches.end(), [&](const Stretch& s) {
      return !c.is_by_screw && !c.fit.profile.has_rim() && s.metal_share < kMetalOfPiece &&
             s.seen_share > kPlugSeen && s.inside_hu > std::max(s.outside_hu, kMostSoft_hu);
    });
    if (plug != c.fit.stretches.end())
      doubt(
          files::format("%.0f mm from its entry it holds what is denser than the bone around "
                        "it, as a plug of bone: the wall that is seen may be the plug's",
                        plug->from_entry_mm));
    const double diameter = 2 * c.fit.radius_mm;
    if (diameter < kLeastDiameter_mm || diameter > kMostDiameter_mm)
      doubt(files::format("its diameter of %.1f mm is none of a tunnel", diameter));
    if (c.goes_on) doubt("its wall goes on beyond where it seems to end", {Length});
    if (!c.end.is_narrowing_seen)
      doubt(files::format("%.0f mm from its entry it gets %.1f mm wide: whether it ends there is not seen",
                          c.end.narrowing->from_entry_mm, c.end.narrowing->thinner_mm),
            {Diameter, Length});
    if (c.end.is_seen && !(c.length_sigma_mm <= kMostLengthSigma_mm))
      doubt(std::isfinite(c.length_sigma_mm)
                ? files::format("where it ends is known to %.1f mm, %.1f mm are needed", c.length_sigma_mm,
                                kMostLengthSigma_mm)
                : std::string(
                      "how well it is seen where it ends is not known: too little marrow lies beside it"),
            {Length});
    if (!c.end.is_seen)
      doubt(c.end.leaves_images ? "the images end before it does: how long it is is not known"
                                : "where it ends is not seen",
            {Length});
  }

  const images::Volume& volume_;
  images::VolumeSampler sampler_;
  geometry::RigidTransform postop_from_plan_;
  const geometry::Surface& bone_;
  TunnelEnds ends_;
  VoxelDepths depths_;
  BoneGrid grid_;
};

bool is_same(const Candidate& a, const Candidate& b) {
  return (a.passage.entry_mm - b.passage.entry_mm).norm() < a.fit.radius_mm + b.fit.radius_mm;
}

// Of each bore the candidate without doubts, else the one that is seen best.
std::vector<Candidate> distinct(std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.doubts.empty() != b.doubts.empty() ? a.doubts.empty() : a.merit() > b.merit();
  });
  std::vector<Candidate> bores;
  for (Candidate& candidate : candidates)
    if (std::none_of(bores.begin(), bores.end(), [&](const Candidate& b) { return is_same(candidate, b); }))
      bores.push_back(std::move(candidate));
  return bores;
}

DrilledTunnel told(const Candidate& candidate, const tunnels::Tunnel& plan) {
  DrilledTunnel drilled;
  drilled.is_found = true;
  drilled.tunnel = {.bone = plan.bone,
                    .entry_mm = candidate.passage.entry_mm,
                    .direction = candidate.fit.direction,
                    .diameter_mm = 2 * candidate.fit.radius_mm,
                    .bundle = plan.bundle};
  drilled.length_mm = candidate.end.from_entry_mm;
  drilled.length_sigma_mm = candidate.length_sigma_mm;
  drilled.comes_out = candidate.end.comes_out;
  drilled.end_is_seen = candidate.end.is_seen;
  drilled.beyond_mm = candidate.end.beyond_mm;
  drilled.entry_sigma_mm = candidate.entry_sigma_mm();
  drilled.entry_per_across = candidate.passage.entry_per_across();
  drilled.direction_sigma_rad = candidate.fit.direction_sigma_rad;
  drilled.diameter_sigma_mm = candidate.fit.diameter_sigma_mm;
  drilled.seen_share = candidate.seen_share;
  drilled.metal_share = candidate.metal_share;
  drilled.stretches = candidate.fit.stretches;
  drilled.doubts = candidate.doubts;
  return drilled;
}

}  // namespace

DrilledTunnel find_drilled(const images::Volume& postop, const geometry::RigidTransform& postop_from_plan,
                           const geometry::Surface& bone, const tunnels::Tunnel& plan,
                           std::span<const tunnels::Tunnel> others, const GoesOn& goes_on) {
  Finder finder(postop, postop_from_plan, bone, plan);
  std::vector<Candidate> candidates;
  const std::vector<Bore> seen = search_bores(finder.grid(), plan);
  double done = 0;
  for (const Bore& bore : seen) {
    if (goes_on && !goes_on(done++ / static_cast<double>(seen.size()))) return {};
    if (auto candidate = finder.measured(bore)) candidates.push_back(std::move(*candidate));
  }
  DrilledTunnel none;
  if (candidates.empty()) {
    none.doubts = {
        {files::format("no tunnel is seen within %.0f mm and %.0f deg of the plan: no bore there is open at "
                       "the bone's surface and stands out from the bone around it; one that is plugged with "
                       "bone is not seen",
                       kSearched_mm, kSearched_deg)}};
    return none;
  }
  const auto off_plan = [&](const Candidate& c) { return (c.passage.entry_mm - plan.entry_mm).norm(); };
  const auto planned_nearer = [&](const Vector3d& entry_mm) -> const tunnels::Tunnel* {
    for (const tunnels::Tunnel& other : others)
      if ((entry_mm - other.entry_mm).norm() < (entry_mm - plan.entry_mm).norm()) return &other;
    return nullptr;
  };
  // The one nearest to the plan, doubtful or not: a neighbour that is seen better is another tunnel. What
  // lies nearer to the other planned one is that, as long as anything else is there.
  const std::vector<Candidate> bores = distinct(std::move(candidates));
  const Candidate& chosen = *std::min_element(bores.begin(), bores.end(), [&](const auto& a, const auto& b) {
    return std::pair(planned_nearer(a.passage.entry_mm) != nullptr, off_plan(a)) <
           std::pair(planned_nearer(b.passage.entry_mm) != nullptr, off_plan(b));
  });
  DrilledTunnel drilled = told(chosen, plan);
  for (const Candidate& other : bores) {
    if (other.seen_share < kLeastSeen || &other == &chosen) continue;
    if (planned_nearer(other.passage.entry_mm) != nullptr) continue;  // that one was to be expected
    drilled.doubts.push_back({files::format("another tunnel opens %.1f mm beside it, farther from the plan",
                                            (other.passage.entry_mm - chosen.passage.entry_mm).norm())});
    break;
  }
  if (const tunnels::Tunnel* nearer = planned_nearer(chosen.passage.entry_mm); nearer != nullptr)
    drilled.doubts.push_back({"it lies nearer to the planned tunnel " + tunnels::name_of(nearer->key()) +
                              " than to this one: which of the two it is cannot be told"});
  else if (const auto mouth = finder.mouth_nearer(plan, chosen, others))
    drilled.doubts.push_back(
        {files::format("the bone is open %.1f mm beside it, too, nearer to the plan, where no bore is seen: "
                       "it may be another tunnel than the planned one, e.g. of an operation before",
                       (*mouth - chosen.passage.entry_mm).norm())});
  const double off_axis_mm = plan.direction.cross(chosen.passage.entry_mm - plan.entry_mm).norm();
  if (off_axis_mm > kMostOffAxis_mm)
    drilled.doubts.push_back(
        {files::format("its entry is %.1f mm beside the planned axis, farther than drilling errs (%.0f mm): "
                       "it may be another tunnel, e.g. of an operation before",
                       off_axis_mm, kMostOffAxis_mm)});
  return drilled;
}

}  // namespace arthronaut::postop
