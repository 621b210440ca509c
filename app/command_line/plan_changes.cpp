#include "app/command_line/plan_changes.h"

#include <memory>
#include <utility>

#include "app/command_line/command.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/plan_versions.h"
#include "planning/default_plan/default_plan.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/grid_landmarks.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/landmarks/propose.h"
#include "planning/plan_export/markups_file.h"
#include "planning/tunnels/diameter_range.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::command_line {

namespace {

// An entry that lies further off the bone is a slip, not a rounding.
constexpr double kSnapMm = 5.0;
constexpr double kToldMm = 0.02;  // a move that is more than the rounding of what is typed

double diameter_mm_of(const PlanArguments& arguments) {
  return arguments.names_diameter ? arguments.diameter_mm
                                  : tunnels::usual_diameter_mm(norms::bundle_from_text(arguments.type));
}

// moved_mm: how far the entry was, to lie on the bone.
tunnels::Tunnel planned_tunnel(const PlanArguments& arguments, const cases::Case& knee,
                               const geometry::Surface& surface, double& moved_mm,
                               std::vector<std::string>& notes) {
  const tunnels::TunnelKey key = key_of(arguments);
  const bones::BoneKind kind = key.bone;
  tunnels::Tunnel tunnel{.bone = kind,
                         .entry_mm = arguments.entry_mm,
                         .direction = arguments.direction.normalized(),
                         .diameter_mm = diameter_mm_of(arguments),
                         .bundle = key.bundle};
  if (arguments.at_footprint) {
    const auto marks = knee.landmarks.find(kind);
    if (marks == knee.landmarks.end() || !marks->second.contains("native_footprint")) {
      throw InvalidInput(arguments.case_folder, std::string(bones::to_text(kind)),
                         "has no landmark native_footprint: give --entry");
    }
    tunnel.entry_mm = marks->second.at("native_footprint");
  }
  const auto nearest = surface.closest_point(tunnel.entry_mm);
  const Eigen::Vector3d moved = nearest.point_mm - tunnel.entry_mm;
  moved_mm = moved.norm();
  if (moved_mm > kSnapMm) {
    throw InvalidInput(arguments.case_folder, arguments.bone,
                       files::format("--entry lies %.1f mm off it, more than %.0f mm", moved_mm, kSnapMm));
  }
  if (moved_mm > kToldMm)
    notes.push_back(files::format(
        "The entry lay %.2f mm off the bone and was moved to its nearest point; the axis is %.2f mm beside "
        "the one that was asked for.",
        moved_mm, (moved - moved.dot(tunnel.direction) * tunnel.direction).norm()));
  tunnel.entry_mm = nearest.point_mm;
  if (!tunnels::measure(tunnel, surface).enters_bone) {
    throw InvalidInput(arguments.case_folder, arguments.bone, "--direction leads out of it at this entry");
  }
  return tunnel;
}

// By norms and landmarks. Where those of the case give no grid, the proposed ones become the case's: whoever
// reads it, as a report, has the grid that was planned by. Throws InvalidInput where there is no default;
// `verdict` says how far it may be relied on, `by_shape` what the shape gave where it was asked.
tunnels::Tunnel default_tunnel(const PlanArguments& arguments, cases::Case& knee, bones::BoneKind kind,
                               const std::shared_ptr<const geometry::Surface>& surface,
                               const cases::BoneDoubts& doubts, PlanVerdict& verdict,
                               plan_review::ProposedBone& by_shape) {
  const Progress progress("Making the default plan", 0);
  landmarks::Landmarks& marks = knee.landmarks[kind];
  landmarks::LandmarkStates& states = knee.landmark_states[kind];
  const bones::Bone& bone = knee.bones.at(kind);
  if (!landmarks::is_grid_confirmed(kind, marks, states)) {
    by_shape.surface = surface;
    by_shape.proposal = landmarks::propose(bone.mesh, kind, {.side = knee.side, .surface = surface.get()});
    if (!landmarks::has_grid(bone.mesh, kind, knee.side, marks))
      take_proposal(by_shape.proposal, marks, states);
  }
  default_plan::BoneInput input{
      .bone = &bone, .surface = surface.get(), .landmarks = marks, .states = states};
  input.unseen = cases::unseen_parts_of(doubts, bone);
  if (by_shape.surface) input.proposal = &by_shape.proposal;
  const norms::Bundle bundle = norms::bundle_from_text(arguments.type);
  input.beside = default_plan::beside({kind, bundle}, knee.plan.tunnels);
  auto planned =
      default_plan::plan_bone(input, knee.side, {.bundle = bundle, .diameter_mm = diameter_mm_of(arguments)});
  if (!planned.is_usable())
    throw InvalidInput(
        arguments.case_folder, "",
        std::string("has no default plan") +
            (planned.outcome == default_plan::DefaultTunnel::Outcome::NoLandmarks
                 ? " (landmarks are placed by hand by L in Plan, or by arthronaut landmarks --set): "
                 : ": ") +
            planned.message);
  if (arguments.within_spread) planned = default_plan::moved_within_spread(std::move(planned));
  verdict = {.is_reliable = planned.doubts.empty(),
             .reasons = planned.doubts,
             .source = planned.source,
             .place = planned.place,
             .off_norm_mm = planned.off_norm_mm,
             .other_entry = planned.other_entry};
  for (const tunnels::PlanCheck& check : planned.failed) {
    verdict.is_reliable = false;
    verdict.reasons.push_back(
        (arguments.within_spread && bundle == norms::Bundle::Whole && planned.off_norm_mm > 0
             ? "with the aim from the norm's place it fails the check \""
             : "no direction that a drill can follow from there passes the check \"") +
        check.name + "\": " + check.text);
  }
  return planned.tunnel;
}

// Says of the tunnels that go for it that they do.
void put(const tunnels::Tunnel& tunnel, const std::string& mesh_sha256, cases::Case& knee,
         std::vector<std::string>& notes) {
  const auto before = knee.plan.of(tunnel.bone);
  knee.plan.put(tunnel, mesh_sha256);
  for (const tunnels::TunnelKey& key : before) {
    if (!knee.plan.tunnels.contains(key))
      notes.push_back("The tunnel " + tunnels::name_of(key) +
                      " is no longer planned: a bone has a single tunnel, or those of bundles.");
  }
}

// Tunnels as another program moved them; only those of bones that the case holds.
void take_markups(const PlanArguments& arguments, cases::Case& knee, std::vector<std::string>& notes) {
  // Of a file that is moved and taken more than once it is so, too: a question, and no failure.
  const std::string doubt =
      plan_export::origin_doubt(arguments.markups, knee, cases::load_plan_versions(arguments.case_folder));
  if (!doubt.empty()) notes.push_back("Look: " + doubt);
  std::map<bones::BoneKind, geometry::Surface> surfaces;
  const auto surface_of = [&](bones::BoneKind kind) -> const geometry::Surface* {
    const auto bone = knee.bones.find(kind);
    return bone == knee.bones.end() ? nullptr : &surfaces.try_emplace(kind, bone->second.mesh).first->second;
  };
  const plan_export::TakenTunnels taken = plan_export::read_tunnels(arguments.markups, knee.plan, surface_of);
  if (!taken.note.empty()) notes.push_back("The " + taken.note + ".");
  for (const auto& [key, tunnel] : taken.tunnels)
    if (is_asked_for(arguments, key.bone))
      put(tunnel, bones::mesh_sha256(knee.bones.at(key.bone).mesh), knee, notes);
}

// Throws InvalidInput where there is no such tunnel, or two of which none is named.
void remove_tunnel(const PlanArguments& arguments, cases::Case& knee) {
  const auto keys = knee.plan.of(bones::bone_kind_from_text(arguments.bone));
  if (keys.size() == 1 && !arguments.names_type) return knee.plan.remove(keys.front());
  if (keys.size() > 1 && !arguments.names_type)
    throw InvalidInput(arguments.case_folder, "plan.json",
                       "plans two tunnels in the " + arguments.bone + ": say by --type which, am or pl");
  const tunnels::TunnelKey key = key_of(arguments);
  if (!knee.plan.tunnels.contains(key))
    throw InvalidInput(arguments.case_folder, "plan.json", "holds no tunnel " + tunnels::name_of(key));
  knee.plan.remove(key);
}

// By hand or by default.
void place_tunnel(const PlanArguments& arguments, const cases::BoneDoubts& doubts, ChangedPlan& changed) {
  const auto bone = changed.knee.bones.find(key_of(arguments).bone);
  if (bone == changed.knee.bones.end())
    throw InvalidInput(arguments.case_folder, "case.json", "holds no " + arguments.bone);
  const geometry::TriangleMesh& mesh = bone->second.mesh;
  const auto surface = std::make_shared<const geometry::Surface>(mesh);
  put(arguments.by_default
          ? default_tunnel(arguments, changed.knee, bone->first, surface, doubts, changed.verdict,
                           changed.proposed)
          : planned_tunnel(arguments, changed.knee, *surface, changed.verdict.entry_moved_mm, changed.notes),
      bones::mesh_sha256(mesh), changed.knee, changed.notes);
}

}  // namespace

tunnels::TunnelKey key_of(const PlanArguments& arguments) {
  return {bones::bone_kind_from_text(arguments.bone), norms::bundle_from_text(arguments.type)};
}

bool is_asked_for(const PlanArguments& arguments, bones::BoneKind bone) {
  return arguments.bone.empty() || arguments.bone == bones::to_text(bone);
}

ChangedPlan changed_plan(const PlanArguments& arguments, cases::Case knee, const cases::BoneDoubts& doubts) {
  ChangedPlan changed{std::move(knee)};
  if (!arguments.markups.empty()) {
    take_markups(arguments, changed.knee, changed.notes);
  } else if (arguments.versions.taken > 0) {
    std::vector<bones::BoneKind> asked_for{bones::BoneKind::Femur, bones::BoneKind::Tibia};
    std::erase_if(asked_for, [&](bones::BoneKind kind) { return !is_asked_for(arguments, kind); });
    take_version(arguments.case_folder, arguments.versions.taken, asked_for, changed.knee);
  } else if (arguments.removes) {
    remove_tunnel(arguments, changed.knee);
  } else if (arguments.places()) {
    place_tunnel(arguments, doubts, changed);
  }
  return changed;
}

}  // namespace arthronaut::command_line
