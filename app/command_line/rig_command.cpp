#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "navigation/strokes/body_rows.h"
#include "navigation/strokes/poses_file.h"
#include "navigation/tools/rig_calibration.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

constexpr double kStandardSize_mm = 4;

struct RigArguments {
  std::string poses, tool, tools, output;
  std::vector<int> markers;
  std::optional<int> reference;
  std::optional<double> size_mm;
};

// The tool, or the world marker of the bone, that carries the markers; added where the set has none of the
// name.
struct Body {
  tools::Tool* tool = nullptr;
  tools::WorldMarker* world = nullptr;
  bool is_new = false;
  [[nodiscard]] std::vector<tools::BodyMarker> markers() const {
    return tool != nullptr ? tools::markers_of(*tool) : tools::markers_of(*world);
  }
};

Body body_of(tools::ToolSet& set, const std::string& name) {
  for (tools::Tool& tool : set.tools)
    if (tool.name == name) return {&tool, nullptr};
  for (tools::WorldMarker& world : set.world_markers)
    if (name == bones::to_text(world.bone)) return {nullptr, &world};
  tools::Tool tool;
  tool.name = name;
  set.tools.push_back(tool);
  return {&set.tools.back(), nullptr, true};
}

// A tool of which only the marker is known stands for that marker alone: so that track follows it.
bool is_placeholder(const tools::Tool& tool, const std::string& name) {
  return tool.name != name && !tool.tip_mm && !tool.axis && tool.markers.empty();
}

std::set<int> ids_in(const std::vector<strokes::PoseRow>& rows) {
  std::set<int> ids;
  for (const strokes::PoseRow& row : rows) ids.insert(row.marker_id);
  return ids;
}

// Which markers are taken to be on the body. As named; else those that the tools say are on it; else all that
// are seen and that nothing else declares (without tools: all but the standard world markers).
std::vector<int> markers_on_body(const RigArguments& arguments, const tools::ToolSet& set, const Body& body,
                                 const std::vector<strokes::PoseRow>& rows) {
  if (!arguments.markers.empty()) return arguments.markers;
  std::vector<int> own;
  if (!body.is_new)
    for (const tools::BodyMarker& marker : body.markers()) own.push_back(marker.marker_id);
  if (own.size() > 1) return own;
  std::set<int> others;
  for (const tools::WorldMarker& world : set.world_markers)
    if (&world != body.world)
      for (const tools::BodyMarker& marker : tools::markers_of(world)) others.insert(marker.marker_id);
  for (const tools::Tool& tool : set.tools)
    if (!arguments.tools.empty() && &tool != body.tool && !is_placeholder(tool, arguments.tool))
      for (const tools::BodyMarker& marker : tools::markers_of(tool)) others.insert(marker.marker_id);
  for (const int id : ids_in(rows))
    if (!others.contains(id) && std::find(own.begin(), own.end(), id) == own.end()) own.push_back(id);
  return own;
}

// That the poses were found with, where they say it.
std::optional<double> tracked_size_mm(int id, const std::vector<strokes::PoseRow>& rows) {
  for (const strokes::PoseRow& row : rows)
    if (row.marker_id == id && row.size_mm) return row.size_mm;
  return std::nullopt;
}

// As the tools declare it, else as the poses or the command say; nothing where none does.
std::optional<double> known_size_mm(int id, const RigArguments& arguments, const tools::ToolSet& set,
                                    const Body& body, const std::vector<strokes::PoseRow>& rows) {
  const auto look = [&](const auto& bodies) -> std::optional<double> {
    for (const auto& one : bodies)
      for (const tools::BodyMarker& marker : tools::markers_of(one))
        if (marker.marker_id == id) return marker.size_mm;
    return std::nullopt;
  };
  if (!arguments.tools.empty()) {
    const std::size_t said = set.tools.size() - (body.is_new ? 1 : 0);  // a new one says nothing yet
    if (const auto size_mm = look(std::span(set.tools).first(said))) return *size_mm;
    if (const auto size_mm = look(set.world_markers)) return *size_mm;
  }
  const std::optional<double> tracked_mm = tracked_size_mm(id, rows);
  if (tracked_mm && arguments.size_mm && *tracked_mm != *arguments.size_mm)
    throw InvalidInput(arguments.poses, "size_mm",
                       files::format("marker %d was taken for %g mm, --size-mm says %g", id, *tracked_mm,
                                     *arguments.size_mm));
  return tracked_mm ? tracked_mm : arguments.size_mm;
}

// Where the frame of the body's tip and axis lies: with the marker asked for; else it stays where it was.
geometry::RigidTransform body_from_reference(const RigArguments& arguments, const Body& body,
                                             const tools::RigSummary& rig) {
  if (arguments.reference || body.is_new) return {};
  for (const tools::BodyMarker& was : body.markers())
    for (const auto& place : rig.places)
      if (place.marker_id == was.marker_id)
        return was.body_from_marker * place.reference_from_marker.inverse();
  if (body.tool != nullptr && !body.tool->tip_mm && !body.tool->axis) return {};
  throw InvalidInput("none of the markers that \"" + arguments.tool +
                     "\" had is among those found: where its tip and axis are is not known");
}

// What the tool is known by, in the frame of the reference.
void take_to_reference(const RigArguments& arguments, const tools::RigSummary& rig, tools::Tool& tool) {
  if (!arguments.reference || (!tool.tip_mm && !tool.axis)) return;
  for (const tools::BodyMarker& was : tools::markers_of(tool)) {
    for (const auto& place : rig.places) {
      if (place.marker_id != was.marker_id) continue;
      const geometry::RigidTransform now_from_then =
          place.reference_from_marker * was.body_from_marker.inverse();
      const Eigen::Matrix3d turn = now_from_then.matrix();
      if (tool.tip_mm) tool.tip_mm = now_from_then * *tool.tip_mm;
      if (tool.tip_covariance_mm2)
        tool.tip_covariance_mm2 = Eigen::Matrix3d(turn * *tool.tip_covariance_mm2 * turn.transpose());
      if (tool.axis)
        tool.axis =
            tools::ToolAxis{now_from_then * tool.axis->point_mm, now_from_then.rotate(tool.axis->direction)};
      return;
    }
  }
  throw InvalidInput("none of the markers that \"" + tool.name +
                     "\" had is among those found: where its tip and axis are is not known");
}

tools::RigOptions rig_options(const RigArguments& arguments, const tools::ToolSet& set, const Body& body,
                              const std::vector<strokes::PoseRow>& rows, std::vector<int>& assumed_ids) {
  tools::RigOptions options;
  for (const int id : markers_on_body(arguments, set, body, rows)) {
    const auto size_mm = known_size_mm(id, arguments, set, body, rows);
    options.markers.emplace_back(id, size_mm.value_or(kStandardSize_mm));
    if (!size_mm) assumed_ids.push_back(id);
  }
  if (options.markers.size() < 2)
    throw InvalidInput(arguments.poses, "marker_id",
                       "holds fewer than two markers that may be on \"" + arguments.tool +
                           "\": name them with --markers, and declare each in the tools of track");
  options.reference_id = arguments.reference;
  if (!body.is_new && !options.reference_id) {
    const int first = body.markers().front().marker_id;
    const auto is_first = [&](const auto& marker) { return marker.first == first; };
    if (std::any_of(options.markers.begin(), options.markers.end(), is_first)) options.reference_id = first;
  }
  return options;
}

template <typename Of>
bool carries_any(const Of& of, const tools::RigOptions& options) {
  const std::vector<tools::BodyMarker> carried = tools::markers_of(of);
  return std::any_of(carried.begin(), carried.end(), [&](const tools::BodyMarker& marker) {
    return std::any_of(options.markers.begin(), options.markers.end(),
                       [&](const auto& wanted) { return wanted.first == marker.marker_id; });
  });
}

// What stood for a marker alone goes once the marker is on the body; so does a standard tool that had its id.
bool gives_way(const tools::Tool& tool, const RigArguments& arguments) {
  return arguments.tools.empty() || is_placeholder(tool, arguments.tool);
}

void check_nothing_else_carries_them(const RigArguments& arguments, const tools::ToolSet& set,
                                     const Body& body, const tools::RigOptions& options) {
  const std::string file = arguments.tools.empty() ? "the standard tools" : arguments.tools;
  for (const tools::WorldMarker& world : set.world_markers)
    if (&world != body.world && carries_any(world, options))
      throw InvalidInput(file, "world_markers",
                         "marker " + std::to_string(world.marker_id) + " is of the world marker of the " +
                             std::string(bones::to_text(world.bone)));
  for (const tools::Tool& tool : set.tools)
    if (&tool != body.tool && !gives_way(tool, arguments) && carries_any(tool, options))
      throw InvalidInput(
          file, "tools",
          "marker " + std::to_string(tool.marker_id) + " is of the tool \"" + tool.name + "\"");
}

std::vector<tools::BodyMarker> body_markers(const tools::RigSummary& rig,
                                            const geometry::RigidTransform& body_from_reference_marker) {
  std::vector<tools::BodyMarker> markers;
  for (const auto& place : rig.places) {
    tools::BodyMarker marker{place.marker_id, place.size_mm,
                             body_from_reference_marker * place.reference_from_marker};
    marker.sigma_mm = place.sigma_mm;
    marker.sigma_deg = place.sigma_deg;
    markers.push_back(marker);
  }
  return markers;
}

void say_rig(const Context& context, const tools::RigSummary& rig) {
  context.say(
      files::format("%zu markers; %d frames with two or more, %d distinct views within %.0f degrees; "
                    "corners to %.3f mm on %d of %d poses",
                    rig.places.size(), rig.frame_count, rig.distinct_views, rig.cone_deg, rig.rms_mm,
                    rig.inlier_count, rig.sighting_count));
  for (const auto& place : rig.places) {
    const Eigen::Vector3d& t = place.reference_from_marker.translation_mm;
    context.say(files::format(
        "  marker %d, %.2f mm: at %.3f, %.3f, %.3f mm (+- %.3f), turned by %.2f degrees (+- %.2f)",
        place.marker_id, place.size_mm, t.x(), t.y(), t.z(), place.sigma_mm,
        geometry::deg_from_rad(geometry::rotation_angle_rad(place.reference_from_marker.rotation)),
        place.sigma_deg));
  }
}

// All that is measured is in proportion to it: never taken in silence.
void say_assumed(const Context& context, const RigArguments& arguments, const std::vector<int>& ids) {
  if (ids.empty() || context.quiet) return;
  std::string names;
  for (const int id : ids) names += (names.empty() ? "" : ", ") + std::to_string(id);
  (arguments.output == "-" ? std::cerr : std::cout) << files::format(
      "marker %s: taken to be %g mm wide, since neither tools nor poses say it; --size-mm says otherwise\n",
      names.c_str(), kStandardSize_mm);
}

// What is not to be relied on is written with its reasons, but not as tools: by its format no reader takes it
// for tools.json, so it cannot guide.
constexpr std::string_view kDoubtfulFormat = "arthronaut.doubtful_rig";

nlohmann::ordered_json doubtful_document(const RigArguments& arguments, const tools::RigSummary& rig) {
  nlohmann::ordered_json json = {{"format", kDoubtfulFormat},
                                 {"version", 1},
                                 {"tool", arguments.tool},
                                 {"reliable", false},
                                 {"reasons", rig.reasons}};
  json["markers"] = nlohmann::ordered_json::array();
  for (const auto& place : rig.places)
    json["markers"].push_back({{"marker_id", place.marker_id},
                               {"size_mm", place.size_mm},
                               {"reference_from_marker", files::to_json(place.reference_from_marker)},
                               {"sigma_mm", place.sigma_mm},
                               {"sigma_deg", place.sigma_deg}});
  json["frames"] = rig.frame_count;
  if (rig.rms_mm >= 0) json["rms_mm"] = rig.rms_mm;
  return json;
}

// Tools that stand there already are not lost for it: then beside them, as NAME.doubtful.json. A device or a
// pipe holds nothing.
std::filesystem::path doubtful_file(const std::filesystem::path& output) {
  if (output == "-" || !std::filesystem::exists(output) || std::filesystem::is_other(output) ||
      files::read_text(output).find(kDoubtfulFormat) != std::string::npos)
    return output;
  return output.parent_path() / (output.stem().string() + ".doubtful.json");
}

void refuse_arguments(const RigArguments& arguments) {
  if (const std::set<int> ids(arguments.markers.begin(), arguments.markers.end());
      ids.size() < arguments.markers.size())
    throw CLI::ValidationError("--markers", "names a marker twice");
  // The tools are what it adds to: they may be written over.
  refuse_before_the_work({.read = {arguments.poses}, .written = {arguments.output}, .makes = "tools.json"});
}

void calibrate(Context& context, const RigArguments& arguments) {
  refuse_arguments(arguments);
  const std::vector<strokes::PoseRow> rows = strokes::read_poses_file(arguments.poses);
  tools::ToolSet set =
      arguments.tools.empty() ? tools::standard_tools() : tools::read_tools_file(arguments.tools);
  if (!arguments.tools.empty()) strokes::require_sizes(rows, set, arguments.poses);
  const Body body = body_of(set, arguments.tool);
  std::vector<int> assumed_ids;
  const tools::RigOptions options = rig_options(arguments, set, body, rows, assumed_ids);
  say_assumed(context, arguments, assumed_ids);
  check_nothing_else_carries_them(arguments, set, body, options);
  std::vector<tools::RigSighting> sightings;
  for (const strokes::PoseRow& row : rows)
    sightings.push_back({row.frame, row.time_s, row.marker_id, row.camera_from_marker});
  const tools::RigSummary rig = tools::calibrate_rig(sightings, options);
  if (rig.has_places() && arguments.output != "-") say_rig(context, rig);
  if (!rig.is_usable()) {
    const std::filesystem::path file = doubtful_file(arguments.output);
    files::write_json(file, doubtful_document(arguments, rig));
    context.say_unreliable("where the markers lie (written to " + file.string() + ", which is no tools.json)",
                           rig.reasons);
    return;
  }
  const std::vector<tools::BodyMarker> markers = body_markers(rig, body_from_reference(arguments, body, rig));
  if (body.tool != nullptr) take_to_reference(arguments, rig, *body.tool);
  const auto take = [&](auto& of) {
    of.markers = markers;
    of.marker_id = markers.front().marker_id;
    of.size_mm = markers.front().size_mm;
  };
  body.tool != nullptr ? take(*body.tool) : take(*body.world);
  std::erase_if(set.tools, [&](const tools::Tool& tool) {
    return tool.name != arguments.tool && gives_way(tool, arguments) && carries_any(tool, options);
  });
  tools::write_tools_file(arguments.output, set);
}

}  // namespace

void add_rig_command(CLI::App& app, Context& context) {
  CLI::App* command =
      add_subcommand(app, context, "rig",
                     "Find where several markers of one body lie on it, from waving it before the scope",
                     "arthronaut rig --poses poses.csv --tool probe --tools tools.json -o tools.json");
  const auto arguments = std::make_shared<RigArguments>();
  command->add_option("--poses", arguments->poses, "Poses of the wave as written by track")->required();
  command
      ->add_option("--tool", arguments->tool,
                   "Name of the tool that carries the markers; femur or tibia for a world of several")
      ->required()
      ->check(a_name());
  command->add_option("--tools", arguments->tools,
                      "tools.json to take sizes and all else from (default: the standard tools)");
  command
      ->add_option(
          "--markers", arguments->markers,
          "Ids of the markers on it, 2,12,13 (default: those that the tools put on it, else all that are "
          "seen and that nothing else declares)")
      ->delimiter(',')
      ->check(a_marker_id());
  command
      ->add_option(
          "--reference", arguments->reference,
          "Id of the marker whose frame becomes the tool's; tip and axis are taken along (default: the "
          "tool keeps its frame)")
      ->check(a_marker_id());
  command
      ->add_option("--size-mm", arguments->size_mm,
                   "Size of markers of which neither tools nor poses say it (default: 4, and said so)")
      ->check(above_zero());
  command->add_option("-o,--output", arguments->output, "tools.json to write; - is standard output")
      ->required()
      ->check(a_name());
  command->callback([&context, arguments] { calibrate(context, *arguments); });
}

}  // namespace arthronaut::command_line
