#include "planning/default_plan/default_plan.h"

#include "planning/default_plan/aim.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/norms/footprint.h"

namespace arthronaut::default_plan {

namespace {

using Eigen::Vector3d;
using landmarks::Landmarks;
using Outcome = DefaultTunnel::Outcome;

constexpr double kUsualCondyles_mm = 48, kCondyleRadius_mm = 21;

// What the entry follows from; of either pair that tells the direction of the view one will do.
std::vector<std::string> needed(bones::BoneKind bone, const Landmarks& known) {
  if (bone == bones::BoneKind::Tibia)
    return {"plateau_anterior", "plateau_posterior", "plateau_medial", "plateau_lateral"};
  const std::string pair = known.contains("lateral_condyle_center") && known.contains("medial_condyle_center")
                               ? "center"
                               : "posterior";
  return {"blumensaat_anterior", "blumensaat_posterior", "lateral_condyle_" + pair, "medial_condyle_" + pair};
}

void check_range(const char* field, double value, double least, double greatest) {
  if (!(value >= least && value <= greatest))
    throw InvalidInput(
        files::format("default plan: %s is %g, must be %g to %g", field, value, least, greatest));
}

std::optional<Joint> joint_of(const BoneInput& input, const Landmarks& marks, bones::Side side) {
  Joint joint;
  joint.axes = landmarks::anatomical_axes(input.bone->kind, side, marks, input.bone->mesh);
  if (joint.axes.origin != landmarks::AnatomicalAxes::Origin::FromLandmarks) return std::nullopt;
  const bool is_femur = input.bone->kind == bones::BoneKind::Femur;
  if (!is_femur) return joint;
  for (const std::string part : {"center", "posterior"}) {
    const auto lateral = marks.find("lateral_condyle_" + part), medial = marks.find("medial_condyle_" + part);
    if (lateral == marks.end() || medial == marks.end()) continue;
    joint.center_mm = (lateral->second + medial->second) / 2;
    joint.scale = (lateral->second - medial->second).norm() / kUsualCondyles_mm;
    // The axis of flexion lies a condyle's radius in front of its hindmost point.
    if (part == "posterior") joint.center_mm += kCondyleRadius_mm * joint.scale * joint.axes.anterior;
    return joint;
  }
  return std::nullopt;
}

// False where no bone is at the norm's place.
bool put_at_norm(tunnels::Tunnel& at_entry, const BoneInput& input, bones::Side side,
                 const Landmarks& marks) {
  const auto footprint =
      norms::expected_footprint(input.bone->mesh, *input.surface, at_entry.bone, side, marks,
                                norms::default_norm(at_entry.bone, at_entry.bundle));
  if (!footprint) return false;
  at_entry.entry_mm = footprint->center_mm;
  at_entry.direction = -footprint->normal;
  return true;
}

}  // namespace

double usual_diameter_mm(norms::Bundle bundle) {
  switch (bundle) {
    case norms::Bundle::Whole:
      break;
    case norms::Bundle::Anteromedial:
      return 7.0;
    case norms::Bundle::Posterolateral:
      return 6.0;
  }
  return 9.0;
}

void Options::check() const {
  check_range("diameter_mm", diameter_mm, 3, 15);
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
  bool all_confirmed = true;
  const auto follows_from = needed(kind, input.landmarks);
  for (const std::string& name : follows_from) all_confirmed &= is_confirmed(name);
  Landmarks marks = input.landmarks;
  if (!all_confirmed) {
    if (proposal == nullptr) {
      made = landmarks::propose(input.bone->mesh, kind, {.side = side});
      proposal = &made;
    }
    landmarks::LandmarkStates states = input.states;
    landmarks::take_proposal(*proposal, marks, states);
    std::string names;
    for (const std::string& name : follows_from) {
      if (!is_confirmed(name)) names += (names.empty() ? "" : ", ") + name;
    }
    result.doubts.push_back("the " + std::string(bones::to_text(kind)) +
                            "'s landmarks are proposed and nobody has confirmed them: " + names);
    result.doubts.insert(result.doubts.end(), proposal->doubts.begin(), proposal->doubts.end());
  }
  const auto joint = joint_of(input, marks, side);
  if (!joint) {
    result.outcome = Outcome::NoLandmarks;
    result.message = "the " + std::string(bones::to_text(kind)) + "'s landmarks are not known" +
                     (proposal != nullptr && !proposal->is_usable() ? ": " + proposal->reason : "");
    return result;
  }
  tunnels::Tunnel at_entry{.bone = kind,
                           .entry_mm = {},
                           .direction = {},
                           .diameter_mm = options.diameter_mm,
                           .bundle = options.bundle};
  if (options.bundle == norms::Bundle::Whole && is_confirmed("native_footprint")) {
    const auto on = input.surface->closest_point(input.landmarks.at("native_footprint"));
    at_entry.entry_mm = on.point_mm;
    at_entry.direction = -on.normal;
    result.source = "the native footprint, as marked on this bone";
  } else if (put_at_norm(at_entry, input, side, marks)) {
    result.source = norms::default_norm(kind, options.bundle).source;
  } else {
    result.outcome = Outcome::NoFootprint;
    result.message = "no bone is where the norm places the insertion";
    return result;
  }
  // The anteromedial tunnel has its usual aim; the posterolateral one makes room for it, also where it comes
  // first. Else the order in which they are planned would decide how much bone is left between them.
  std::optional<tunnels::Tunnel> to_come;
  if (options.bundle == norms::Bundle::Posterolateral && input.beside == nullptr) {
    tunnels::Tunnel at_am_entry = at_entry;
    at_am_entry.bundle = norms::Bundle::Anteromedial;
    at_am_entry.diameter_mm = usual_diameter_mm(at_am_entry.bundle);
    if (put_at_norm(at_am_entry, input, side, marks))
      to_come = aim(at_am_entry, *input.surface, *joint, options);
  }
  const auto aimed = aim(at_entry, *input.surface, *joint, options, to_come ? &*to_come : input.beside);
  if (!aimed) {
    result.outcome = Outcome::NoAim;
    result.message = "no direction that a drill can follow from there leaves the " +
                     std::string(bones::to_text(kind)) + " on the right face";
    return result;
  }
  result.tunnel = *aimed;
  result.outcome = Outcome::Planned;
  result.message.clear();
  return result;
}

const tunnels::Tunnel* beside(const tunnels::TunnelKey& key,
                              const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned) {
  if (key.bundle == norms::Bundle::Whole) return nullptr;
  const auto other =
      key.bundle == norms::Bundle::Anteromedial ? norms::Bundle::Posterolateral : norms::Bundle::Anteromedial;
  const auto found = planned.find({key.bone, other});
  return found == planned.end() ? nullptr : &found->second;
}

std::map<bones::BoneKind, DefaultTunnel> plan_knee(const std::vector<BoneInput>& bones, bones::Side side,
                                                   const Options& options) {
  std::map<bones::BoneKind, DefaultTunnel> plan;
  for (const BoneInput& bone : bones) plan[bone.bone->kind] = plan_bone(bone, side, options);
  return plan;
}

}  // namespace arthronaut::default_plan
