#include <cstdio>
#include <memory>
#include <optional>

#include "app/command_line/cartilage_option.h"
#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "navigation/registration/registration.h"
#include "navigation/registration/registration_file.h"
#include "planning/bones/mesh_file.h"
#include "planning/cases/case.h"

namespace arthronaut::command_line {

namespace {

struct RegisterArguments {
  std::string bone, curves, output, space, unit, cartilage;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  CLI::Option* target_option = nullptr;
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();
  CLI::Option* entry_option = nullptr;
  bool no_marker_prior = false;
  std::uint64_t seed = 1;
};

// A mesh that lies in a case is kept ready in the case's cache.
registration::SurfaceIndex prepare(const geometry::TriangleMesh& mesh,
                                   const std::filesystem::path& mesh_file) {
  const std::filesystem::path folder = mesh_file.parent_path();
  for (const bones::BoneKind kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    if (std::filesystem::exists(folder / "case.json") && mesh_file == cases::mesh_file(folder, kind)) {
      return registration::SurfaceIndex(mesh, cases::surface_index_file(folder, kind));
    }
  }
  return registration::SurfaceIndex(mesh);
}

void register_bone(Context& context, const RegisterArguments& arguments) {
  refuse_before_the_work(
      {.read = {arguments.bone, arguments.curves, arguments.cartilage}, .written = {arguments.output}});
  bones::MeshFileOptions mesh_options;
  if (!arguments.space.empty()) mesh_options.space = bones::space_from_text(arguments.space);
  if (!arguments.unit.empty()) mesh_options.unit = bones::length_unit_from_text(arguments.unit);
  const auto mesh = bones::read_mesh(arguments.bone, mesh_options);
  const auto curves = strokes::read_curves_file(arguments.curves);

  registration::RegistrationOptions options;
  options.seed = arguments.seed;
  options.use_marker_prior = !arguments.no_marker_prior;
  if (arguments.target_option->count() > 0) options.target_in_bone_mm = arguments.target;
  if (arguments.entry_option->count() > 0) options.plan_entry_in_bone_mm = arguments.entry;
  if (!arguments.cartilage.empty()) {
    options.cartilage.emplace().points_mm =
        read_cartilage({arguments.cartilage, arguments.space, arguments.unit}).vertices_mm;
  }
  const registration::SurfaceIndex bone = prepare(mesh, arguments.bone);
  const auto summary = registration::register_curves(bone, curves, options);
  registration::write_registration_file(arguments.output, summary, registration::registered_mesh(mesh));
  if (summary.has_pose && arguments.output != "-") {
    char line[160];
    std::snprintf(line, sizeof line, "%d points, rms %.2f mm, %.0f %% on the bone, predicted error %.2f mm",
                  summary.point_count, summary.rms_mm, 100 * summary.inlier_fraction,
                  summary.predicted_tre_mm);
    context.say(line);
  }
  if (arguments.output != "-") {
    for (const std::string& assumption : summary.assumptions) context.say(assumption);
  }
  if (!summary.reliable) context.say_unreliable("the registration", summary.reasons);
}

}  // namespace

void add_register_command(CLI::App& app, Context& context) {
  CLI::App* command =
      add_subcommand(app, context, "register",
                     "Find where the bone lies from the curves touched on it, with no initial guess",
                     "arthronaut register --bone femur.ply --curves curves.csv --target -74.5,16.1,-9.7 -o "
                     "registration.json");
  const auto arguments = std::make_shared<RegisterArguments>();
  command->add_option("--bone", arguments->bone, "Surface mesh of the bone")->required();
  command->add_option("--curves", arguments->curves, "curves.csv as written by digitise")->required();
  arguments->target_option =
      add_vector_option(*command, "--target", arguments->target,
                        "Point of the bone, mm, where the predicted error is given; default: "
                        "the centroid of the points");
  arguments->entry_option =
      add_vector_option(*command, "--plan-entry", arguments->entry,
                        "Entry of the planned tunnel, mm: the strokes are looked for within a "
                        "probe's reach of it first, then on the whole bone");
  add_cartilage_option(*command, arguments->cartilage);
  command->add_flag("--no-marker-prior", arguments->no_marker_prior,
                    "Don't assume that the world marker sits on the bone");
  command
      ->add_option("--seed", arguments->seed,
                   "Seed of the random search; the same seed gives the same result")
      ->check(a_seed());
  add_mesh_options(*command, arguments->space, arguments->unit, "the mesh");
  command->add_option("-o,--output", arguments->output, "registration.json to write; - is standard output")
      ->required()
      ->check(a_name());
  command->callback([&context, arguments] { register_bone(context, *arguments); });
}

}  // namespace arthronaut::command_line
