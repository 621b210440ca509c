#include "app/command_line/ruler_option.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/command_line/medium_option.h"
#include "app/command_line/option_checks.h"
#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/experiments/lens_rotation.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

// The size of both markers, which a ruler has in common.
double common_size_mm(const std::string& file, const std::vector<markers::DeclaredMarker>& declared,
                      int first, int second) {
  const auto size_of = [&](int id) {
    for (const auto& marker : declared)
      if (marker.id == id) return marker.size_mm;
    throw InvalidInput(file, "marker " + std::to_string(id), "is not declared");
  };
  const double size_mm = size_of(first);
  if (std::abs(size_of(second) - size_mm) > 1e-6)
    throw InvalidInput(file, "marker " + std::to_string(second),
                       "is not of the size of marker " + std::to_string(first));
  return size_mm;
}

calibration::RulerSightingsOptions options_of(const RulerArguments& arguments) {
  calibration::RulerSightingsOptions options;
  options.calibration = camera::read_camera_file(arguments.camera).calibration;
  options.follow_lens = !arguments.fixed_lens;
  options.refractive_index = camera::kSalineIndex;
  options.ruler.first_from_second.translation_mm = {arguments.spacing_mm, 0, 0};
  std::vector<int> ids = arguments.ids;
  const auto declared = markers::declared_markers(tools::read_tools_file(arguments.tools));
  if (!arguments.ruler.empty()) {
    const experiments::RulerInFluid seen = experiments::read_ruler_file(arguments.ruler);
    ids = {seen.ruler.first_id, seen.ruler.second_id};
    options.ruler.first_from_second = seen.ruler.first_from_second;
    options.refractive_index = seen.refractive_index;
  }
  if (ids.empty()) {
    if (declared.size() != 2)
      throw InvalidInput(arguments.tools, "tools",
                         "declare " + std::to_string(declared.size()) +
                             " markers: say with --markers which two are the ruler's");
    ids = {declared[0].id, declared[1].id};
  }
  options.ruler.first_id = ids[0];
  options.ruler.second_id = ids[1];
  options.ruler.size_mm = common_size_mm(arguments.tools, declared, ids[0], ids[1]);
  options.refractive_index = arguments.medium_index.value_or(options.refractive_index);
  return options;
}

// The most frequent reason why frames were of no use.
std::string main_loss(const std::vector<std::string>& losses) {
  std::string most;
  for (const std::string& loss : losses)
    if (std::count(losses.begin(), losses.end(), loss) > std::count(losses.begin(), losses.end(), most))
      most = loss;
  return most;
}

}  // namespace

RulerClip look_at_ruler(const RulerArguments& arguments) {
  RulerClip clip;
  clip.options = options_of(arguments);
  clip.options.most = std::numeric_limits<std::size_t>::max();  // a recorded clip is looked at whole
  const auto source = sources::open_video(arguments.video);
  calibration::RulerSightings sightings(clip.options);
  Progress progress("looking for the ruler", static_cast<long>(source->info().frame_count));
  std::vector<std::string> losses;
  while (const camera::FramePtr frame = source->next()) {
    const calibration::RulerLook& seen = sightings.look(*frame);
    if (!seen.is_taken) losses.push_back(seen.reason);
    progress.advance_to(static_cast<long>(sightings.frame_count()));
  }
  clip.frame_count = sightings.frame_count();
  calibration::FluidCheckOptions limits;
  limits.refractive_index = clip.options.refractive_index;
  clip.summary =
      calibration::check_fluid(sightings.sightings(), clip.options.ruler, clip.options.calibration, limits);
  if (!losses.empty() && !clip.summary.is_trusted())
    clip.summary.reasons.push_back("frames without the ruler, mostly: " + main_loss(losses));
  return clip;
}

void add_ruler_options(CLI::App& command, RulerArguments& arguments) {
  command.add_option("--camera", arguments.camera, "camera.json of the arthroscope")->required();
  command.add_option("--tools", arguments.tools, "tools.json that declares the ruler's two markers")
      ->required();
  add_medium_option(
      command, arguments.medium_index,
      "What is said to be before the scope: air, water, saline (default) or a refractive index");
  auto* ids = command
                  .add_option("--markers", arguments.ids,
                              "The ruler's two ids, first,second, where the tools declare more than two")
                  ->delimiter(',')
                  ->expected(2)
                  ->check(a_marker_id());
  auto* spacing =
      command
          .add_option("--spacing-mm", arguments.spacing_mm,
                      "The second marker's centre along the first one's x axis, mm (default: 10); "
                      "both face the same way")
          ->check(above_zero());
  command
      .add_option("--ruler", arguments.ruler,
                  "ruler.json: the two markers' relative pose, where it is another")
      ->excludes(ids)
      ->excludes(spacing);
  command.add_flag("--fixed-lens", arguments.fixed_lens,
                   "The lens stays at the calibration's reference angle; the lens mark is not needed");
  command.add_option("VIDEO", arguments.video, "Video file, or a pattern of still images such as f_%04d.png")
      ->required();
}

}  // namespace arthronaut::command_line
