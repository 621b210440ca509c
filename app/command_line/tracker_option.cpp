#include "app/command_line/tracker_option.h"

#include "navigation/openigtlink/igtl_tracker.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

void add_tracker_option(CLI::App& subcommand, std::string& address) {
  subcommand.add_option(
      "--tracker", address,
      "Take the poses of bones and tools from this tracker by OpenIGTLink, igtl://HOST:PORT, "
      "and none from the pictures; \"tracker\" in the tools says what it calls them and how "
      "wrong it is");
}

void use_tracker(const std::string& given, const std::filesystem::path& tools_file, const std::string& video,
                 tools::ToolSet& tools) {
  if (given.empty() && !tools.tracker) return;
  openigtlink::see_by(tools, given);
  if (tools.tracker->address.empty())
    throw InvalidInput(tools_file, "tracker",
                       "the tools are seen by an outside tracker: give --tracker igtl://HOST:PORT");
  (void)openigtlink::tracker_address(tools.tracker->address);
  if (sources::kind_of_source(video) != sources::SourceKind::Live)
    throw InvalidInput(
        "--video: an outside tracker tells where the tools are now, and a recording shows what was: only a "
        "live source goes with it");
}

void listen_to_tracker(const Context& context, theatre::NavigateOptions& options) {
  const auto& tracker = options.source.pipeline.tools.tracker;
  if (!tracker) return;
  context.say("tracker: " + tracker->address);
  if (!tracker->has_known_error())
    context.say(
        "tracker: the tools do not say how wrong its poses are (\"tracker\": sigma_mm, sigma_deg): they "
        "guide "
        "nothing");
  options.tracker = [setup = options.source.pipeline] { return openigtlink::listen_to_tracker(setup); };
}

}  // namespace arthronaut::command_line
