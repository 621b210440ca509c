#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "navigation/strokes/body_rows.h"
#include "navigation/strokes/curves.h"
#include "navigation/strokes/stroke_tangents.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

struct DigitiseArguments {
  std::string poses, tools, bone = "femur", tool = "probe", output;
  bool with_shaft = false;
};

// What the tools lack is told with their file.
strokes::Curves digitised(const DigitiseArguments& arguments, const std::vector<strokes::PoseRow>& poses,
                          const tools::ToolSet& tools) {
  try {
    return strokes::digitise(poses, tools, bones::bone_kind_from_text(arguments.bone), arguments.tool);
  } catch (const InvalidInput& error) {
    throw InvalidInput(arguments.tools, "", error.what());
  }
}

void digitise(Context& context, const DigitiseArguments& arguments) {
  refuse_before_the_work({.read = {arguments.poses, arguments.tools}, .written = {arguments.output}});
  const auto poses = strokes::read_poses_file(arguments.poses);
  const auto tools = tools::read_tools_file(arguments.tools);
  strokes::require_sizes(poses, tools, arguments.poses);
  const auto curves = digitised(arguments, poses, tools);
  strokes::write_curves_file(
      arguments.output, curves,
      arguments.with_shaft ? strokes::ShaftColumns::Write : strokes::ShaftColumns::LeaveOut);
  if (arguments.output != "-") {
    const int count = curves.empty() ? 0 : curves.back().curve + 1;
    context.say(files::format("%zu points on %d stroke%s, %.0f mm", curves.size(), count,
                              count == 1 ? "" : "s", strokes::smoothed_length_mm(curves)));
  }
  if (curves.empty()) {
    context.say_unreliable("what was digitised",
                           {"the world marker and the tool were never seen together over a stroke"});
  }
}

}  // namespace

void add_digitise_command(CLI::App& app, Context& context) {
  CLI::App* command = add_subcommand(
      app, context, "digitise", "Turn marker poses into the curves that the probe's tip drew on the bone",
      "arthronaut digitise --poses poses.csv --tools tools.json --bone femur --tool probe -o curves.csv");
  const auto arguments = std::make_shared<DigitiseArguments>();
  command->add_option("--poses", arguments->poses, "poses.csv as written by track")->required();
  command->add_option("--tools", arguments->tools, "tools.json: markers and the tip")->required();
  command->add_option("--bone", arguments->bone, "femur or tibia: whose world marker the tip is seen from")
      ->check(CLI::IsMember({"femur", "tibia"}));
  command->add_option("--tool", arguments->tool, "Name of the tool that touches the bone");
  command->add_flag(
      "--with-shaft", arguments->with_shaft,
      "Write where the probe's shaft was too; register then rules out what leads it through the bone");
  command->add_option("-o,--output", arguments->output, "curves.csv to write; - is standard output")
      ->required()
      ->check(a_name());
  command->callback([&context, arguments] { digitise(context, *arguments); });
}

}  // namespace arthronaut::command_line
