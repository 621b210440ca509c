#include "app/command_line/registration_experiment_command.h"

#include <cstdio>
#include <memory>
#include <optional>

#include "app/command_line/option_checks.h"
#include "navigation/experiments/registration_experiment.h"
#include "planning/bones/mesh_file.h"

namespace arthronaut::command_line {

namespace {

using experiments::RegistrationExperimentResult;

struct ExperimentArguments {
  std::string bone, noise = "dry", side = "right", space, unit, plot, trial_folder, registered_to, evidence;
  int trials = 10;
  std::uint64_t seed = 1;
  bool no_marker_prior = false;
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  CLI::Option* area_option = nullptr;
};

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

void say_result(const Context& context, const RegistrationExperimentResult& result) {
  const int count = static_cast<int>(result.trials.size());
  context.say(formatted("success (target error below %.0f mm): %d of %d",
                        RegistrationExperimentResult::success_mm, result.success_count, count));
  context.say(formatted("reliable: %d; reliable but wrong: %d; doubted though right: %d",
                        result.reliable_count, result.reliable_but_wrong_count,
                        result.doubted_though_right_count));
  context.say(formatted("target error, median: %.3f mm; error / predicted error, median: %.2f",
                        result.median_target_error_mm, result.median_error_ratio));
  context.say(
      formatted("far control points, reliable trials: RMS about the centroid %.3f mm, RMS error against the "
                "truth %.3f mm",
                result.spread_rms_mm, result.error_rms_mm));
  context.say(formatted("one registration, median: %.0f ms of one core", 1e3 * result.median_seconds));
  if (!context.verbose) return;
  for (const experiments::ControlPoint& control : result.control_points) {
    context.say(formatted("  control point %.0f mm away: spread %.3f mm, error %.3f mm", control.distance_mm,
                          control.spread_rms_mm, control.error_rms_mm));
  }
  for (const experiments::TrialOutcome& trial : result.trials) {
    std::string line = formatted("  target error %.3f mm, predicted %.3f mm, %s", trial.target_error_mm,
                                 trial.predicted_error_mm, trial.reliable ? "reliable" : "doubted");
    for (const std::string& reason : trial.reasons) line += "; " + reason;
    context.say(line);
  }
}

void run(Context& context, const ExperimentArguments& arguments) {
  refuse_before_the_work(
      {.read = {arguments.bone, arguments.registered_to}, .written = {arguments.plot, arguments.evidence}});
  bones::MeshFileOptions mesh_options;
  if (!arguments.space.empty()) mesh_options.space = bones::space_from_text(arguments.space);
  if (!arguments.unit.empty()) mesh_options.unit = bones::length_unit_from_text(arguments.unit);
  experiments::RegistrationExperimentOptions options;
  options.series.noise = experiments::trial_noise_from_text(arguments.noise);
  options.trial_count = arguments.trials;
  options.series.seed = arguments.seed;
  options.use_marker_prior = !arguments.no_marker_prior;
  options.series.side = bones::side_from_text(arguments.side);
  if (arguments.area_option->count() > 0) options.series.area_center_mm = arguments.area;
  const auto mesh = bones::read_mesh(arguments.bone, mesh_options);
  if (!arguments.trial_folder.empty()) {
    experiments::write_trials(arguments.trial_folder, experiments::TrialSeries(mesh, options.series),
                              options.trial_count);
    context.say(formatted("wrote %d trials; nothing was registered", options.trial_count));
    return;
  }
  std::optional<geometry::TriangleMesh> other;
  if (!arguments.registered_to.empty())
    options.registered_to = &other.emplace(bones::read_mesh(arguments.registered_to, mesh_options));
  RegistrationExperimentResult result;
  {
    Progress progress("registering", options.trial_count);
    result =
        experiments::run_registration_experiment(mesh, options, [&](int done) { progress.advance_to(done); });
  }
  if (!arguments.plot.empty())
    experiments::write_registration_plot(arguments.plot, result, options.series.noise);
  if (!arguments.evidence.empty()) experiments::write_verdict_evidence(arguments.evidence, result);
  if (result.is_on_own_bone)
    say_result(context, result);
  else
    context.say(formatted("taken for reliable on another bone: %d of %d", result.reliable_count,
                          static_cast<int>(result.trials.size())));
  if (result.reliable_but_wrong_count > 0) {
    context.say_unreliable("the experiment", {"a registration that was wrong took itself for reliable"});
  }
}

}  // namespace

void add_registration_experiment(CLI::App& experiment, Context& context) {
  CLI::App* command = add_subcommand(
      experiment, context, "registration",
      "The paper's second experiment: registrations of made-up strokes on any bone, their spread and their "
      "error",
      "arthronaut experiment registration --bone femur.ply --trials 10 --noise dry --plot registration.png");
  const auto arguments = std::make_shared<ExperimentArguments>();
  command->add_option("--bone", arguments->bone, "Surface mesh of a femur, or of any bone with --area")
      ->required();
  command->add_option("--trials", arguments->trials, "Number of trials")->check(whole_between(1, 1000000));
  command->add_option("--noise", arguments->noise, "dry, ex-vivo or hard")
      ->check(CLI::IsMember({"dry", "ex-vivo", "hard"}));
  command->add_option("--seed", arguments->seed, "Seed of the trials; the same seed gives the same figures")
      ->check(a_seed());
  command->add_option("--side", arguments->side, "Which knee: left or right")
      ->check(CLI::IsMember({"left", "right"}));
  arguments->area_option =
      add_vector_option(*command, "--area", arguments->area,
                        "Middle of the digitised area and target, mm; default: the lateral wall "
                        "of the femur's notch");
  command->add_flag("--no-marker-prior", arguments->no_marker_prior,
                    "Don't assume that the world marker sits on the bone");
  add_mesh_options(*command, arguments->space, arguments->unit, "the mesh");
  command->add_option("--plot", arguments->plot, "PNG to draw the paper's plot into")->check(a_file());
  command
      ->add_option("--onto", arguments->registered_to,
                   "Register the strokes to this mesh instead: another person's bone, so that none may be "
                   "taken for reliable; read with the same --space and --unit")
      ->excludes("--plot");
  command->add_option("--evidence", arguments->evidence,
                      "CSV of what each verdict rested on: misfit, lead and what was needed of it");
  command
      ->add_option(
          "--write-trials", arguments->trial_folder,
          "Write the trials into this folder for other programs, instead of registering them: bone.ply, and "
          "for each trial its curves (trial_K.csv) and its truth (trial_K.json)")
      ->excludes("--plot")
      ->excludes("--onto")
      ->excludes("--evidence")
      ->excludes("--no-marker-prior");
  command->callback([&context, arguments] { run(context, *arguments); });
}

}  // namespace arthronaut::command_line
