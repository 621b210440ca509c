#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/tracking_report.h"
#include "navigation/camera/camera_file.h"
#include "navigation/strokes/body_rows.h"
#include "navigation/strokes/poses_file.h"
#include "navigation/tools/measured_part.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

struct PivotArguments {
  int marker_id = -1;
  std::string poses, tools, output, camera, tools_output;
  std::optional<int> world_id;
  bool camera_fixed = false, spin = false;
};

// By frame: camera_from_marker of one marker.
using PosesByFrame = std::map<std::int64_t, geometry::RigidTransform>;

PosesByFrame poses_of(const std::vector<strokes::PoseRow>& rows, int marker_id) {
  PosesByFrame poses;
  for (const strokes::PoseRow& row : rows) {
    if (row.marker_id == marker_id) poses[row.frame] = row.camera_from_marker;
  }
  return poses;
}

// The world marker that the tool's marker shares the most frames with; nullopt without one.
std::optional<int> likely_world(const std::vector<strokes::PoseRow>& rows, const PosesByFrame& tool,
                                int tool_id, const std::vector<int>& world_ids) {
  std::optional<int> best;
  std::size_t most = 2;
  for (const int id : world_ids) {
    if (id == tool_id) continue;
    std::size_t shared = 0;
    for (const auto& [frame, pose] : poses_of(rows, id)) shared += tool.count(frame);
    if (shared > most) {
      most = shared;
      best = id;
    }
  }
  return best;
}

std::vector<geometry::RigidTransform> fixed_from_tool(const Context& context,
                                                      const PivotArguments& arguments) {
  const bool to_standard_output = arguments.output == "-";
  auto rows = strokes::read_poses_file(arguments.poses);
  std::vector<int> world_ids{0, 1};  // the standard ones
  if (!arguments.tools.empty()) {
    const tools::ToolSet set = tools::read_tools_file(arguments.tools);
    strokes::require_sizes(rows, set, arguments.poses);
    rows = strokes::body_rows(rows, set);
    world_ids.clear();
    for (const tools::WorldMarker& marker : set.world_markers) world_ids.push_back(marker.marker_id);
  }
  const PosesByFrame tool = poses_of(rows, arguments.marker_id);
  if (tool.empty()) {
    throw InvalidInput(arguments.poses, "marker_id",
                       "marker " + std::to_string(arguments.marker_id) + " is never seen");
  }
  std::optional<int> world = arguments.world_id;
  if (!world && !arguments.camera_fixed) world = likely_world(rows, tool, arguments.marker_id, world_ids);

  std::vector<geometry::RigidTransform> poses;
  if (!world) {
    if (!to_standard_output) context.say("no world marker in view: the camera is taken as fixed");
    for (const auto& [frame, pose] : tool) poses.push_back(pose);
    return poses;
  }
  const PosesByFrame camera_from_world = poses_of(rows, *world);
  for (const auto& [frame, pose] : tool) {
    const auto seen = camera_from_world.find(frame);
    if (seen != camera_from_world.end()) poses.push_back(seen->second.inverse() * pose);
  }
  if (poses.empty()) {
    throw InvalidInput(arguments.poses, "marker_id",
                       "markers " + std::to_string(*world) + " and " + std::to_string(arguments.marker_id) +
                           " are never seen in the same frame");
  }
  if (!to_standard_output) {
    context.say("world: marker " + std::to_string(*world) + ", " + std::to_string(poses.size()) +
                " frames with both");
  }
  return poses;
}

// Of a camera that is doubted nothing is to be relied on, however well the poses agree.
std::vector<std::string> doubts_of(const PivotArguments& arguments, std::vector<std::string> reasons) {
  if (arguments.camera.empty()) return reasons;
  const std::vector<std::string> of_camera = camera_doubts(arguments.camera);
  reasons.insert(reasons.end(), of_camera.begin(), of_camera.end());
  return reasons;
}

// Throws InvalidInput where what is found belongs to none of the tools.
tools::Tool& tool_in(tools::ToolSet& set, const PivotArguments& arguments) {
  if (set.tracker)
    throw InvalidInput(arguments.tools, "tracker",
                       "the tools are seen by an outside tracker: measure them there");
  for (tools::Tool& tool : set.tools)
    if (tool.marker_id == arguments.marker_id) return tool;
  throw InvalidInput(arguments.tools, "tools",
                     "no tool carries marker " + std::to_string(arguments.marker_id));
}

// What is not reliable does not become a tool, and tools that stood there stay. What the poses of a simulated
// camera tell is simulated.
void conclude(Context& context, const PivotArguments& arguments, const std::string& what,
              const std::vector<std::string>& doubts,
              const std::function<void(tools::Tool&, const provenance::Provenance&)>& take) {
  if (!doubts.empty()) return context.say_unreliable(what, doubts);
  if (arguments.tools_output.empty()) return;
  using provenance::Origin;
  const Origin camera = camera::read_camera_file(arguments.camera).provenance.origin;
  tools::ToolSet set = tools::read_tools_file(arguments.tools);
  tools::Tool& tool = tool_in(set, arguments);
  take(tool, {provenance::found_with(Origin::Measured, camera), files::utc_now()});
  tools::write_tools_file(arguments.tools_output, set);
  if (arguments.output != "-") context.say(what + " of the " + tool.name + ": in " + arguments.tools_output);
}

void calibrate_tip(Context& context, const PivotArguments& arguments) {
  const auto summary = tools::calibrate_pivot(fixed_from_tool(context, arguments));
  const std::vector<std::string> doubts = doubts_of(arguments, summary.reasons);
  nlohmann::ordered_json document;
  document["format"] = "arthronaut.tip";
  document["version"] = 1;
  document["marker_id"] = arguments.marker_id;
  document["tip_mm"] = summary.has_tip() ? files::to_json(summary.tip_in_tool_mm) : nlohmann::ordered_json();
  document["rms_mm"] = summary.has_tip() ? nlohmann::ordered_json(summary.rms_mm) : nlohmann::ordered_json();
  document["cone_deg"] = summary.cone_deg;
  document["reliable"] = doubts.empty();
  document["reasons"] = doubts;
  document["pose_count"] = summary.pose_count;
  document["inlier_count"] = summary.inlier_count;
  if (summary.has_tip()) {
    document["sigma_mm"] = summary.sigma_mm;
    const Eigen::Matrix3d error = summary.tip_error_mm2();
    auto values = nlohmann::ordered_json::array();
    for (int i = 0; i < 9; ++i) values.push_back(error(i / 3, i % 3));
    document["tip_covariance_mm2"] = std::move(values);  // as tools.json keeps it
    document["half_change_mm"] = summary.half_change_mm < 0 ? nlohmann::ordered_json()
                                                            : nlohmann::ordered_json(summary.half_change_mm);
    document["pivot_mm"] = files::to_json(summary.pivot_in_fixed_mm);
  }
  files::write_json(arguments.output, document);
  if (summary.has_tip()) {
    char line[200];
    std::snprintf(line, sizeof line, "tip %.3f, %.3f, %.3f mm; rms %.3f mm on %d of %d poses; cone %.1f deg",
                  summary.tip_in_tool_mm.x(), summary.tip_in_tool_mm.y(), summary.tip_in_tool_mm.z(),
                  summary.rms_mm, summary.inlier_count, summary.pose_count, summary.cone_deg);
    if (arguments.output != "-") context.say(line);
  }
  conclude(context, arguments, "the tip", doubts,
           [&](tools::Tool& tool, const auto& provenance) { tools::take_tip(tool, summary, provenance); });
}

void calibrate_axis(Context& context, const PivotArguments& arguments) {
  tools::SpinCalibrationOptions options;
  if (!arguments.tools.empty())
    for (const tools::Tool& tool : tools::read_tools_file(arguments.tools).tools)
      if (tool.marker_id == arguments.marker_id && tool.axis)
        options.declared_direction = tool.axis->direction;
  const auto summary = tools::calibrate_spin(fixed_from_tool(context, arguments), options);
  const std::vector<std::string> doubts = doubts_of(arguments, summary.reasons);
  nlohmann::ordered_json document;
  document["format"] = "arthronaut.axis";
  document["version"] = 1;
  document["marker_id"] = arguments.marker_id;
  const bool has = summary.has_axis();
  document["axis_point_mm"] = has ? files::to_json(summary.axis_point_in_tool_mm) : nlohmann::ordered_json();
  document["axis_direction"] =
      has ? files::to_json(summary.axis_direction_in_tool) : nlohmann::ordered_json();
  document["rms_mm"] = has ? nlohmann::ordered_json(summary.rms_mm) : nlohmann::ordered_json();
  if (has) {
    document["axis_point_sigma_mm"] = summary.point_sigma_mm;
    document["axis_direction_sigma_deg"] = summary.direction_sigma_deg;
  }
  document["turn_deg"] = summary.turn_deg;
  document["reliable"] = doubts.empty();
  document["reasons"] = doubts;
  document["pose_count"] = summary.pose_count;
  document["inlier_count"] = summary.inlier_count;
  files::write_json(arguments.output, document);
  conclude(context, arguments, "the axis", doubts,
           [&](tools::Tool& tool, const auto& provenance) { tools::take_axis(tool, summary, provenance); });
}

}  // namespace

void add_pivot_command(CLI::App& app, Context& context) {
  CLI::App* subcommand = add_subcommand(
      app, context, "pivot",
      "Find the tip of a tool that was pivoted about a fixed point (or, with --spin, its axis)",
      "arthronaut pivot --marker 2 --poses poses.csv --camera camera.json --tools tools.json "
      "--write-tools tools.json -o tip.json");
  const auto arguments = std::make_shared<PivotArguments>();
  subcommand->add_option("--marker", arguments->marker_id, "Id of the tool's marker")
      ->required()
      ->check(a_marker_id());
  subcommand->add_option("--poses", arguments->poses, "Poses as written by track")->required();
  CLI::Option* world = subcommand
                           ->add_option("--world", arguments->world_id,
                                        "Id of the world marker (default: of those that the tools declare, "
                                        "or 0 and 1, whichever is seen with the tool)")
                           ->check(a_marker_id());
  subcommand
      ->add_flag("--camera-fixed", arguments->camera_fixed, "The scope was clamped: use no world marker")
      ->excludes(world);
  subcommand->add_flag("--spin", arguments->spin, "The tool was turned about its own axis: find that axis");
  subcommand->add_option("-o,--output", arguments->output, "tip.json, or - for standard output")
      ->required()
      ->check(a_name());
  CLI::Option* tools = subcommand->add_option(
      "--tools", arguments->tools,
      "tools.json: world markers, which way a guide drills, and bodies of several markers");
  CLI::Option* camera = subcommand->add_option(
      "--camera", arguments->camera,
      "camera.json that the poses were tracked with: what it is doubted for, so is what is found");
  subcommand
      ->add_option("--write-tools", arguments->tools_output,
                   "tools.json to write: --tools with what was found, and where that comes from, in it; "
                   "nothing that is not reliable")
      ->needs(tools)
      ->needs(camera)
      ->check(a_file());
  subcommand->callback([arguments, &context] {
    refuse_before_the_work(
        {.read = {arguments->poses, arguments->tools, arguments->camera}, .written = {arguments->output}});
    // The tools are what it adds to: they may be written over.
    refuse_before_the_work({.read = {arguments->poses, arguments->camera},
                            .written = {arguments->tools_output, arguments->output},
                            .makes = "tools.json"});
    // Any marker of a body stands for it.
    if (!arguments->tools.empty()) {
      tools::ToolSet known = tools::read_tools_file(arguments->tools);
      arguments->marker_id = strokes::body_id_of(arguments->marker_id, known);
      if (arguments->world_id) arguments->world_id = strokes::body_id_of(*arguments->world_id, known);
      if (!arguments->tools_output.empty()) (void)tool_in(known, *arguments);
    }
    arguments->spin ? calibrate_axis(context, *arguments) : calibrate_tip(context, *arguments);
  });
}

}  // namespace arthronaut::command_line
