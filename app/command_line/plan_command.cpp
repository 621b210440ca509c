#include "app/command_line/command.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/tunnels/aim.h"
#include "planning/tunnels/plan_checks.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::command_line {

namespace {

// An entry that lies further off the bone is a slip, not a rounding.
constexpr double kSnapMm = 5.0;

struct PlanArguments {
  std::string case_folder, bone;
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
  double diameter_mm = 9.0;
  bool at_footprint = false, customary = false, list = false;
};

void describe(const Context& context, const cases::Case& knee, const tunnels::Tunnel& tunnel,
              const geometry::Surface& surface) {
  const auto measured = tunnels::measure(tunnel, surface);
  const auto& e = tunnel.entry_mm;
  const auto& d = tunnel.direction;
  context.say(files::format("%s tunnel, %.1f mm", std::string(bones::to_text(tunnel.bone)).c_str(),
                            tunnel.diameter_mm));
  context.say(files::format("  entry      %.3f, %.3f, %.3f mm", e.x(), e.y(), e.z()));
  context.say(files::format("  direction  %.5f, %.5f, %.5f", d.x(), d.y(), d.z()));
  if (measured.enters_bone) {
    const auto& x = measured.exit_mm;
    context.say(files::format("  length     %.2f mm inside bone", measured.length_mm));
    context.say(files::format("  exit       %.3f, %.3f, %.3f mm", x.x(), x.y(), x.z()));
    context.say(files::format("  wall       %.2f mm at the thinnest", measured.wall_mm));
  }
  if (const auto fit = cases::plan_fit(knee, tunnel.bone); !fit.is_valid())
    context.say("  ! not valid: " + fit.reason);
  const auto marks = knee.landmarks.find(tunnel.bone);
  const auto surroundings = tunnels::surroundings_of(
      knee.bones.at(tunnel.bone).mesh, tunnel.bone,
      marks == knee.landmarks.end() ? landmarks::Landmarks{} : marks->second, knee.side);
  for (const auto& check : tunnels::check_plan(tunnel, measured, surroundings)) {
    const bool is_amiss = check.verdict == tunnels::PlanCheck::Verdict::Look ||
                          check.verdict == tunnels::PlanCheck::Verdict::Wrong;
    const std::string source = is_amiss && !check.source.empty() ? " [" + check.source + "]" : "";
    context.say((is_amiss ? "  ! " : "    ") + check.name + ": " + check.text + source);
  }
}

tunnels::Tunnel planned_tunnel(const PlanArguments& arguments, const cases::Case& knee, bones::BoneKind kind,
                               const geometry::Surface& surface, bool has_entry) {
  tunnels::Tunnel tunnel{.bone = kind,
                         .entry_mm = arguments.entry_mm,
                         .direction = arguments.direction.normalized(),
                         .diameter_mm = arguments.diameter_mm};
  if (arguments.at_footprint || arguments.customary) {
    const auto marks = knee.landmarks.find(kind);
    if (marks == knee.landmarks.end() || !marks->second.contains("native_footprint")) {
      throw InvalidInput(arguments.case_folder, std::string(bones::to_text(kind)),
                         "has no landmark native_footprint: give --entry");
    }
    tunnel.entry_mm = marks->second.at("native_footprint");
  } else if (!has_entry) {
    throw InvalidInput("plan: --entry (or --at-footprint) is needed beside --direction");
  }
  const auto nearest = surface.closest_point(tunnel.entry_mm);
  const double off_mm = (nearest.point_mm - tunnel.entry_mm).norm();
  if (off_mm > kSnapMm) {
    throw InvalidInput(
        files::format("plan: --entry lies %.1f mm off the bone, more than %.0f mm", off_mm, kSnapMm));
  }
  tunnel.entry_mm = nearest.point_mm;
  if (arguments.customary) {
    tunnel.direction = tunnels::customary_direction(kind, knee.side);
    tunnel = tunnels::aim(tunnel, surface, tunnels::customary_aim(kind));
  }
  if (!tunnels::measure(tunnel, surface).enters_bone) {
    throw InvalidInput("plan: --direction leads out of the bone at this entry");
  }
  return tunnel;
}

}  // namespace

void add_plan_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App* sub =
      add_subcommand(app, context, "plan", "Place a tunnel, or show the plan when no bone is given",
                     "arthronaut plan Knee.arthro --bone femur --entry -10.1,12.9,-0.3 --direction "
                     "-0.83,-0.37,0.41 --diameter-mm 9");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  auto* bone =
      sub->add_option("--bone", arguments->bone, "femur or tibia")->check(CLI::IsMember({"femur", "tibia"}));
  auto* entry = add_vector_option(*sub, "--entry", arguments->entry_mm, "Entry on the joint side, mm, LPS")
                    ->needs(bone);
  auto* direction =
      add_vector_option(*sub, "--direction", arguments->direction, "Direction of drilling, into the bone")
          ->needs(bone);
  auto* footprint =
      sub->add_flag("--at-footprint", arguments->at_footprint, "Enter at the native footprint's centre")
          ->needs(bone)
          ->excludes(entry);
  sub->add_option("--diameter-mm", arguments->diameter_mm, "Diameter")
      ->check(CLI::Range(3.0, 15.0))
      ->capture_default_str();
  auto* customary =
      sub->add_flag("--default", arguments->customary,
                    "Through the native footprint in the customary direction, fitted to the bone")
          ->needs(bone)
          ->excludes(entry)
          ->excludes(direction)
          ->excludes(footprint);
  sub->add_flag("--list", arguments->list, "Show the plan")->excludes(direction)->excludes(customary);
  entry->needs(direction);
  footprint->needs(direction);
  sub->callback([arguments, entry, direction, &context] {
    const bool writes = direction->count() > 0 || arguments->customary;
    cases::CaseLock lock;
    if (writes) lock = cases::lock_or_refuse(arguments->case_folder);
    if (!lock.notice().empty()) context.say(lock.notice() + ".");
    auto knee = cases::load_case(arguments->case_folder);
    if (!writes) {
      if (knee.plan.tunnels.empty()) context.say("No tunnel is planned.");
      for (const auto& [kind, tunnel] : knee.plan.tunnels) {
        if (!arguments->bone.empty() && arguments->bone != bones::to_text(kind)) continue;
        if (!knee.bones.contains(kind)) {
          throw InvalidInput(arguments->case_folder, "plan.json", "plans a bone that the case lacks");
        }
        describe(context, knee, tunnel, geometry::Surface(knee.bones.at(kind).mesh));
      }
      return;
    }
    if (!arguments->customary && arguments->direction.norm() < 1e-9)
      throw InvalidInput("plan: --direction must not be zero");
    const auto kind = bones::bone_kind_from_text(arguments->bone);
    const auto bone_of_case = knee.bones.find(kind);
    if (bone_of_case == knee.bones.end()) {
      throw InvalidInput(arguments->case_folder, "case.json", "holds no " + arguments->bone);
    }
    const geometry::Surface surface(bone_of_case->second.mesh);
    const auto tunnel = planned_tunnel(*arguments, knee, kind, surface, entry->count() > 0);
    knee.plan.tunnels[kind] = tunnel;
    knee.plan.mesh_sha256[kind] = bones::mesh_sha256(bone_of_case->second.mesh);
    cases::name_meshes(knee);
    knee.plan_version = cases::save_plan_over(arguments->case_folder, knee.plan, knee.plan_version);
    describe(context, knee, tunnel, surface);
  });
}

}  // namespace arthronaut::command_line
