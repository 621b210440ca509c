#include <map>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "navigation/sources/camera_facts.h"
#include "navigation/sources/connected_cameras.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

using nlohmann::ordered_json;
using sources::CameraFacts;
using sources::CameraInput;
using sources::CameraMode;

struct SourcesArguments {
  std::string camera;
  bool as_json = false;
};

std::string path_of(const CameraFacts& facts) { return "/dev/video" + std::to_string(facts.index); }

ordered_json json_of(const CameraMode& mode) {
  ordered_json written{{"format", mode.format}, {"size_px", {mode.size_px.x(), mode.size_px.y()}}};
  written["frames_per_second"] =
      mode.frames_per_second > 0 ? ordered_json(mode.frames_per_second) : ordered_json(nullptr);
  return written;
}

ordered_json json_of(const CameraInput& input) {
  return {{"index", input.index},     {"name", input.name},           {"in_use", input.is_in_use},
          {"trouble", input.trouble}, {"standards", input.standards}, {"standard", input.standard}};
}

ordered_json json_of(const CameraFacts& facts) {
  ordered_json written{{"source", path_of(facts)},        {"name", facts.name},
                       {"identity", facts.identity},      {"trouble", facts.trouble},
                       {"inputs", ordered_json::array()}, {"modes", ordered_json::array()}};
  for (const CameraInput& input : facts.inputs) written["inputs"].push_back(json_of(input));
  for (const CameraMode& mode : facts.modes) written["modes"].push_back(json_of(mode));
  written["opened_as"] = facts.chosen ? json_of(*facts.chosen) : ordered_json(nullptr);
  return written;
}

void print_input(const Context& context, const CameraInput& input) {
  std::string line = "    input " + std::to_string(input.index) + ": " + input.name;
  if (!input.standards.empty()) {
    line += ", standards";
    for (const std::string& one : input.standards)
      line += (one == input.standard ? " [" + one + "]" : " " + one);
  }
  context.say(line);
  if (!input.trouble.empty()) context.say("  ! " + input.trouble);
}

// A line for each format and size.
void print_modes(const Context& context, const CameraFacts& facts) {
  std::vector<std::string> heads;
  std::map<std::string, std::string> rates;
  for (const CameraMode& mode : facts.modes) {
    const std::string head =
        files::format("    %-6s %4d x %d", mode.format.c_str(), mode.size_px.x(), mode.size_px.y());
    if (!rates.contains(head)) heads.push_back(head);
    const bool is_known = mode.frames_per_second > 0;
    rates[head] += is_known ? files::format(" %.4g", mode.frames_per_second) : " (what the signal has)";
  }
  for (const std::string& head : heads) context.say(head + "  at" + rates[head] + " pictures/s");
}

void print(const Context& context, const CameraFacts& facts) {
  if (!facts.trouble.empty()) return context.say(path_of(facts) + ": ! " + facts.trouble);
  context.say(path_of(facts) + ": " + facts.name);
  context.say("    " + facts.identity);
  for (const CameraInput& input : facts.inputs) print_input(context, input);
  print_modes(context, facts);
  context.say(facts.chosen ? "    is opened as " + text_of(*facts.chosen)
                           : "  ! none of them can be read as asked for");
}

void list_sources(Context& context, const SourcesArguments& arguments) {
  std::vector<sources::CameraAddress> addresses;
  if (arguments.camera.empty()) {
    for (const sources::ConnectedCamera& camera : sources::connected_cameras())
      addresses.push_back({camera.index});
  } else if (sources::is_camera_address(arguments.camera)) {
    addresses.push_back(sources::read_camera_address(arguments.camera));
  } else {
    throw InvalidInput(arguments.camera, "", "is no camera; one is named as /dev/video0 is");
  }
  ordered_json document = {
      {"format", "arthronaut.sources"}, {"version", 1}, {"cameras", ordered_json::array()}};
  for (const sources::CameraAddress& address : addresses) {
    const CameraFacts facts = sources::camera_facts(address);
    if (!arguments.camera.empty() && !facts.trouble.empty()) throw DeviceError(facts.trouble);
    if (arguments.as_json)
      document["cameras"].push_back(json_of(facts));
    else
      print(context, facts);
  }
  if (arguments.as_json) files::write_json("-", document);
  if (addresses.empty() && !arguments.as_json) context.say("No camera is connected.");
}

}  // namespace

void add_sources_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<SourcesArguments>();
  CLI::App* sub = add_subcommand(
      app, context, "sources",
      "List the cameras that are connected: inputs, TV standards, formats, sizes and rates. Nobody who reads "
      "one is disturbed",
      "arthronaut sources\n"
      "  arthronaut sources \"/dev/video0?format=mjpeg&size=1280x720\"");
  sub->add_option("CAMERA", arguments->camera,
                  "This one alone, as it would be opened: /dev/videoN, or with what is wished of it "
                  "(format=, size=, rate=, standard=, input=)");
  sub->add_flag("--json", arguments->as_json, "The list as JSON");
  sub->callback([&context, arguments] { list_sources(context, *arguments); });
}

}  // namespace arthronaut::command_line
