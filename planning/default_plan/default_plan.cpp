#include "planning/default_plan/default_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "planning/default_plan/aim.h"
#include "planning/default_plan/place_words.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/landmarks/grid_landmarks.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/norms/footprint.h"
#include "planning/tunnels/diameter_range.h"
#include "planning/tunnels/plan_norms.h"
#include "planning/tunnels/tunnel_pair.h"

namespace arthronaut::default_plan {

namespace {

using Eigen::Vector3d;
using landmarks::Landmarks;
using norms::Bundle;
using tunnels::Tunnel;
using Outcome = DefaultTunnel::Outcome;

constexpr double kCondyleRadius_mm = 21;  // of an average knee

Bundle other_bundle(Bundle bundle) {
  return bundle == Bundle::Anteromedial ? Bundle::Posterolateral : Bundle::Anteromedial;
}

void check_range(const char* field, double value, double least, double greatest) {
  if (!(value >= least && value <= greatest))
    throw InvalidInput(
        files::format("default plan: %s is %g, must be %g to %g", field, value, least, greatest));
}

std::optional<Joint> joint_of(const BoneInput& input, const Landmarks& marks, bones::Side side) {
  Joint joint;
  // The surface is the caller's, for as long as this call.
  joint.surroundings = tunnels::surroundings_of(
      input.bone->mesh, input.bone->kind, marks, side,
      std::shared_ptr<const geometry::Surface>(std::shared_ptr<void>(), input.surface));
  joint.surroundings.unseen = input.unseen;
  joint.axes = *joint.surroundings.axes;
  if (joint.axes.origin != landmarks::AnatomicalAxes::Origin::FromLandmarks) return std::nullopt;
  const bool is_femur = input.bone->kind == bones::BoneKind::Femur;
  if (!is_femur) return joint;
  const auto hinge = graft::flexion_axis(marks, input.bone->mesh, joint.axes);
  if (!hinge) return std::nullopt;
  joint.hinge = *hinge;
  const auto lateral = marks.find("lateral_condyle_posterior"),
             medial = marks.find("medial_condyle_posterior");
  if (hinge->origin == graft::FlexionAxis::Origin::CondyleCenters || lateral == marks.end() ||
      medial == marks.end())
    return joint;
  // A condyle's radius in front of the hindmost points. Spheres through these alone turned the built-in
  // knee's default by 8 degrees, away from what the condyles' centres give, and left 3.2 mm beside it instead
  // of 5.0.
  joint.hinge.condyles_apart_mm = (lateral->second - medial->second).norm();
  joint.hinge.point_mm = 0.5 * (lateral->second + medial->second) +
                         kCondyleRadius_mm * joint.hinge.scale() * joint.axes.anterior;
  joint.hinge.direction =
      hinge->direction.dot(joint.axes.lateral) < 0 ? Vector3d(-joint.axes.lateral) : joint.axes.lateral;
  return joint;
}

// A bundle's norm, its mean moved on the line through both bundles' means away from the other one, by a share
// of its own spread: at 1 as far as two knees of three have it.
norms::InsertionNorm norm_apart(bones::BoneKind kind, Bundle bundle, double share) {
  norms::InsertionNorm norm = norms::default_norm(kind, bundle);
  if (bundle == Bundle::Whole) return norm;
  const auto& other = norms::default_norm(kind, other_bundle(bundle));
  const Eigen::Vector2d away(norm.along.mean - other.along.mean, norm.across.mean - other.across.mean);
  const double spreads = std::hypot(away.x() / norm.along.sd, away.y() / norm.across.sd);
  norm.along.mean += share / spreads * away.x();
  norm.across.mean += share / spreads * away.y();
  return norm;
}

// What tunnels of a bone are put by.
struct Site {
  const BoneInput& input;
  bones::Side side;
  const Landmarks& marks;
  const Joint& joint;
  const Options& options;

  [[nodiscard]] Tunnel tunnel_of(Bundle bundle) const {
    return {
        .bone = input.bone->kind,
        .entry_mm = {},
        .direction = {},
        .diameter_mm = bundle == options.bundle ? options.diameter_mm : tunnels::usual_diameter_mm(bundle),
        .bundle = bundle};
  }
  // nullopt where no bone is at the norm's place.
  [[nodiscard]] std::optional<Tunnel> at(const norms::InsertionNorm& norm) const {
    Tunnel tunnel = tunnel_of(norm.bundle);
    const auto footprint =
        norms::expected_footprint(input.bone->mesh, *input.surface, tunnel.bone, side, marks, norm);
    if (!footprint) return std::nullopt;
    tunnel.entry_mm = footprint->center_mm;
    tunnel.direction = -footprint->normal;
    return tunnel;
  }
  [[nodiscard]] std::optional<Tunnel> aimed(const std::optional<Tunnel>& at_entry,
                                            const Tunnel* beside = nullptr) const {
    return at_entry && !options.stop.stop_requested() ? aim(*at_entry, *input.surface, joint, options, beside)
                                                      : std::nullopt;
  }
  // The plan's checks that this tunnel alone fails; not of its diameter, which was asked for.
  [[nodiscard]] std::vector<tunnels::PlanCheck> failed_by(const Tunnel& tunnel) const {
    auto failed = all_failed_by(tunnel);
    std::erase_if(failed, is_of_diameter);
    return failed;
  }
  [[nodiscard]] bool fails_by_diameter(const Tunnel& tunnel) const {
    return std::ranges::any_of(all_failed_by(tunnel), is_of_diameter);
  }
  static bool is_of_diameter(const tunnels::PlanCheck& check) { return check.name == "Diameter"; }
  [[nodiscard]] std::vector<tunnels::PlanCheck> all_failed_by(const Tunnel& tunnel) const {
    const auto measured = tunnels::measure(tunnel, *input.surface);
    const bool leaves_unseen = joint.leaves_unseen(measured);
    auto checks = tunnels::check_plan(tunnel, measured, joint.surroundings);
    std::erase_if(checks, [&](const auto& check) {
      return !tunnels::is_failed(check) && !(leaves_unseen && check.name == "Exit");
    });
    return checks;
  }
  // Infinite where one of them misses the bone.
  [[nodiscard]] double between_mm(const Tunnel& one, const Tunnel& other) const {
    const auto of_one = tunnels::measure(one, *input.surface),
               of_other = tunnels::measure(other, *input.surface);
    if (!of_one.enters_bone || !of_other.enters_bone) return std::numeric_limits<double>::infinity();
    return tunnels::gap_between(one, of_one, other, of_other).bone_mm;
  }
};

// How far either bundle's entry is moved off its norm: see norm_apart.
struct Shares {
  double am = 0, pl = 0;
  [[nodiscard]] double of(Bundle bundle) const { return bundle == Bundle::Anteromedial ? am : pl; }
};
// Of two defaults the posterolateral one gives way, since the back wall is behind the anteromedial one.
constexpr std::array<Shares, 9> kBothGiveWay{
    {{0, 0}, {0, 0.25}, {0, 0.5}, {0, 0.75}, {0, 1}, {0.25, 1}, {0.5, 1}, {0.75, 1}, {1, 1}}};
// Beside a tunnel that is planned there is one to move.
constexpr std::array<Shares, 5> kOneGivesWay{{{0, 0}, {0.25, 0.25}, {0.5, 0.5}, {0.75, 0.75}, {1, 1}}};

// Where norms put entries and how a drill usually comes to them, each found once: the steps by which bundles
// give way ask for the same again.
class Places {
 public:
  explicit Places(const Site& site) : site_(site) {}
  [[nodiscard]] const std::optional<Tunnel>& entry(Bundle bundle, double share = 0) {
    const auto [at, is_new] = entries_.try_emplace({bundle, share});
    if (is_new) at->second = site_.at(norm_apart(site_.input.bone->kind, bundle, share));
    return at->second;
  }
  // With nothing beside it.
  [[nodiscard]] const std::optional<Tunnel>& aimed(Bundle bundle, double share) {
    const auto [at, is_new] = aimed_.try_emplace({bundle, share});
    if (is_new) at->second = site_.aimed(entry(bundle, share));
    return at->second;
  }

 private:
  const Site& site_;
  std::map<std::pair<Bundle, double>, std::optional<Tunnel>> entries_, aimed_;
};

struct Apart {
  Tunnel tunnel;                                                // the one asked for
  double between_mm = std::numeric_limits<double>::infinity();  // to the other bundle's, where it has one
};

// Beside the other bundle's tunnel where that is planned. Else both are laid out, the posterolateral one
// beside the anteromedial one, which has its usual aim, and the one asked for is taken of them: otherwise the
// order in which they are planned would decide how much bone is left between them.
std::optional<Apart> bundle_apart(const Site& site, Places& places, const Shares& shares) {
  const Bundle bundle = site.options.bundle;
  if (const Tunnel* beside = site.input.beside; beside != nullptr) {
    const auto own = site.aimed(places.entry(bundle, shares.of(bundle)), beside);
    if (!own) return std::nullopt;
    return Apart{*own, site.between_mm(*own, *beside)};
  }
  const auto& am = places.aimed(Bundle::Anteromedial, shares.am);
  const auto pl = site.aimed(places.entry(Bundle::Posterolateral, shares.pl), am ? &*am : nullptr);
  const auto& own = bundle == Bundle::Anteromedial ? am : pl;
  if (!own) return std::nullopt;
  Apart apart{*own};
  if (am && pl) apart.between_mm = site.between_mm(*am, *pl);
  return apart;
}

// No further off the norm than leaves the bone that the plan's check asks for between the bundles; where
// nothing does, where most is left. Puts it, and where it is, into the result.
std::optional<Tunnel> bundle_tunnel(const Site& site, Places& places, DefaultTunnel& result) {
  const Bundle bundle = site.options.bundle;
  std::span<const Shares> steps = kBothGiveWay;
  if (site.input.beside != nullptr)
    steps = kOneGivesWay;
  else if (bundle == Bundle::Anteromedial)
    steps = steps.subspan(4);  // it stays as long as the other one can still give way
  std::optional<Apart> first, best;
  for (const Shares& shares : steps) {
    if (site.options.stop.stop_requested()) return std::nullopt;
    const auto apart = bundle_apart(site, places, shares);
    if (shares.of(bundle) == 0) first = apart;
    if (apart && (!best || apart->between_mm > best->between_mm)) best = apart;
    if (best && best->between_mm >= tunnels::PlanNorms{}.thin_bone_between_tunnels_mm) break;
  }
  if (!best) return std::nullopt;
  result.off_norm_mm = (best->tunnel.entry_mm - places.entry(bundle)->entry_mm).norm();
  if (result.off_norm_mm == 0) return best->tunnel;
  const std::string other = tunnels::name_of({site.input.bone->kind, other_bundle(bundle)});
  result.place = files::format("%.1f mm off the norm's place", result.off_norm_mm);
  if (!std::isfinite(best->between_mm)) return best->tunnel;  // the other bundle has no tunnel to be near to
  result.place += files::format(", away from the tunnel %s, for %.1f mm of bone between the two",
                                other.c_str(), best->between_mm);
  if (first && std::isfinite(first->between_mm))
    result.place += files::format(": %.1f mm at the norm's place", first->between_mm);
  return best->tunnel;
}

// Steps off the norm's place within its spread, in shares of it, the nearest first.
std::vector<Eigen::Vector2d> steps_within_spread() {
  constexpr int kSteps = 4;
  std::vector<Eigen::Vector2d> steps;
  for (int along = -kSteps; along <= kSteps; ++along) {
    for (int across = -kSteps; across <= kSteps; ++across) {
      const Eigen::Vector2d step = Eigen::Vector2d(along, across) / kSteps;
      if (step.norm() > 0 && step.norm() <= 1) steps.push_back(step);
    }
  }
  std::ranges::stable_sort(steps, {}, [](const auto& step) { return step.squaredNorm(); });
  return steps;
}

bool is_wrong(const std::vector<tunnels::PlanCheck>& failed) {
  return std::ranges::any_of(
      failed, [](const auto& check) { return check.verdict == tunnels::PlanCheck::Verdict::Wrong; });
}

double wall_mm(const std::vector<tunnels::PlanCheck>& failed) {
  const auto wall = std::ranges::find(failed, "Wall", &tunnels::PlanCheck::name);
  return wall == failed.end() ? std::numeric_limits<double>::infinity() : wall->value.value_or(0);
}

bool is_better(const std::vector<tunnels::PlanCheck>& failed, const std::vector<tunnels::PlanCheck>& than) {
  return failed.size() != than.size() ? failed.size() < than.size() : wall_mm(failed) > wall_mm(than);
}

// Where within the norm's spread a tunnel of the same aim passes every check, as the map of entries shows it,
// the nearest to the norm's place; where none does, where the fewest fail and none is wrong, of these where
// the wall is thickest.
std::optional<OtherEntry> better_entry(const Site& site, const Tunnel& at_norm,
                                       const std::vector<tunnels::PlanCheck>& failed) {
  std::optional<OtherEntry> best;
  for (const Eigen::Vector2d& step : steps_within_spread()) {
    if (site.options.stop.stop_requested()) return std::nullopt;
    norms::InsertionNorm norm = norms::default_norm(at_norm.bone, at_norm.bundle);
    norm.along.mean += step.x() * norm.along.sd;
    norm.across.mean += step.y() * norm.across.sd;
    auto moved = site.at(norm);
    if (!moved) continue;
    moved->direction = at_norm.direction;
    OtherEntry here{.entry_mm = moved->entry_mm, .failed = site.failed_by(*moved)};
    if (here.failed.empty()) return here;
    if (!is_wrong(here.failed) && (!best || is_better(here.failed, best->failed))) best = std::move(here);
  }
  return is_wrong(failed) ? best : std::nullopt;
}

// The entry itself stays: which places pass changes with what of the shaft another scan shows, by whose axis
// the tunnel is aimed, and a default that follows them leaps by 1 to 2 mm (CT 051).
void look_around(const Site& site, const Tunnel& at_norm, DefaultTunnel& result) {
  if (result.failed.empty()) return;
  result.other_entry = better_entry(site, at_norm, result.failed);
  result.place += around_in_words(at_norm, result, site.joint.axes, site.fails_by_diameter(at_norm));
}

DefaultTunnel stopped() {
  DefaultTunnel result;
  result.outcome = Outcome::Stopped;
  result.message = "it was stopped";
  return result;
}

}  // namespace

void Options::check() const {
  check_range("diameter_mm", diameter_mm, tunnels::kLeastDiameter_mm, tunnels::kGreatestDiameter_mm);
  check_range("flexion_deg", flexion_deg, 90, 140);
  check_range("guide_deg", guide_deg, 35, 75);
}

DefaultTunnel plan_bone(const BoneInput& input, bones::Side side, const Options& options) {
  options.check();
  DefaultTunnel result;
  const bones::BoneKind kind = input.bone->kind;
  landmarks::Proposal made;
  const landmarks::Proposal* proposal = input.proposal;
  const auto is_confirmed = [&](const std::string& name) {
    return input.landmarks.contains(name) &&
           landmarks::state_of(input.states, name) == landmarks::LandmarkState::Confirmed;
  };
  Landmarks marks = input.landmarks;
  if (!landmarks::is_grid_confirmed(kind, input.landmarks, input.states)) {
    if (proposal == nullptr) {
      made = landmarks::propose(input.bone->mesh, kind,
                                {.side = side, .surface = input.surface, .stop = options.stop});
      proposal = &made;
    }
    // A grid that is there was proposed as its owner wished (Blumensaat's line has two ways), and is what is
    // shown and checked by: nothing of another proposal is mixed into it.
    if (landmarks::LandmarkStates states = input.states;
        !landmarks::has_grid(input.bone->mesh, kind, side, marks) || !joint_of(input, marks, side))
      landmarks::take_proposal(*proposal, marks, states);
    std::string proposed, missing;
    for (const std::string& name : landmarks::grid_landmarks(kind, marks)) {
      if (is_confirmed(name)) continue;
      std::string& names = marks.contains(name) ? proposed : missing;
      names += (names.empty() ? "" : ", ") + name;
    }
    const std::string of_bone = "the " + std::string(bones::to_text(kind)) + "'s landmarks ";
    if (!proposed.empty())
      result.doubts.push_back(of_bone + "are proposed and nobody has confirmed them: " + proposed);
    if (!missing.empty())
      result.doubts.push_back(of_bone + "that its grid needs are not all there: " + missing);
    result.doubts.insert(result.doubts.end(), proposal->doubts.begin(), proposal->doubts.end());
  }
  if (options.stop.stop_requested()) return stopped();
  const auto joint = joint_of(input, marks, side);
  if (!joint) {
    result.outcome = Outcome::NoLandmarks;
    result.message = "the " + std::string(bones::to_text(kind)) + "'s landmarks are not known" +
                     (proposal != nullptr && !proposal->is_usable() ? ": " + proposal->reason : "");
    return result;
  }
  const Site site{input, side, marks, *joint, options};
  Places places(site);
  std::optional<Tunnel> aimed;
  bool is_at_norm = false;
  if (options.bundle == Bundle::Whole && is_confirmed("native_footprint")) {
    const auto on = input.surface->closest_point(input.landmarks.at("native_footprint"));
    Tunnel marked = site.tunnel_of(Bundle::Whole);
    marked.entry_mm = on.point_mm;
    marked.direction = -on.normal;
    aimed = site.aimed(marked, input.beside);
    result.source = "the native footprint, as marked on this bone";
    result.place = "at the native footprint";
  } else if (const auto& at_norm = places.entry(options.bundle); at_norm) {
    result.source = norms::cited(norms::default_norm(kind, options.bundle));
    result.place = "at the norm's place";
    is_at_norm = options.bundle == Bundle::Whole;
    aimed = is_at_norm ? site.aimed(at_norm, input.beside) : bundle_tunnel(site, places, result);
  } else {
    result.outcome = Outcome::NoFootprint;
    result.message = "no bone is where the norm places the insertion";
    return result;
  }
  if (options.stop.stop_requested()) return stopped();
  if (!aimed) {
    result.outcome = Outcome::NoAim;
    result.message = "no direction that a drill can follow from there leaves the " +
                     std::string(bones::to_text(kind)) + " on the right face";
    return result;
  }
  result.tunnel = *aimed;
  result.failed = site.failed_by(*aimed);
  if (is_at_norm) look_around(site, *aimed, result);
  if (options.stop.stop_requested()) return stopped();
  result.outcome = Outcome::Planned;
  result.message.clear();
  return result;
}

const tunnels::Tunnel* beside(const tunnels::TunnelKey& key,
                              const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned) {
  if (key.bundle == Bundle::Whole) return nullptr;
  const auto found = planned.find({key.bone, other_bundle(key.bundle)});
  return found == planned.end() ? nullptr : &found->second;
}

}  // namespace arthronaut::default_plan
