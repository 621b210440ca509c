#include <cstdio>
#include <memory>
#include <optional>

#include "app/command_line/command.h"
#include "app/command_line/medium_option.h"
#include "app/command_line/option_checks.h"
#include "navigation/calibration/calibration.h"
#include "navigation/calibration/residual_plot.h"
#include "navigation/camera/doubted_camera_file.h"
#include "navigation/sources/frame_source.h"
#include "planning/files/fixed_number.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

struct CalibrateArguments {
  calibration::CalibrationOptions options;
  std::optional<double> medium_index;
  std::string output, plot;
  std::vector<std::string> images;
};

std::vector<calibration::CalibrationPicture> observe(const std::vector<std::string>& images) {
  std::vector<calibration::CalibrationPicture> pictures;
  std::vector<std::uint8_t> gray;
  Progress progress("finding boards", static_cast<long>(images.size()));
  for (const std::string& image : images) {
    const camera::Frame frame = sources::read_picture(image);
    camera::gray_from(frame, gray);
    pictures.push_back(
        calibration::observe_picture(image, {gray.data(), frame.width, frame.height, frame.width}));
    progress.advance_to(static_cast<long>(pictures.size()));
  }
  return pictures;
}

void say_result(const Context& context, const calibration::CalibrationSummary& summary, double square_mm) {
  for (const auto& picture : summary.pictures)
    context.say(files::format("%s: %zu corners, %.2f px, tilted by %.0f degrees, lens at %s degrees%s",
                              picture.name.c_str(), picture.residuals_px.size(), picture.rms_px,
                              picture.tilt_deg, files::fixed(picture.lens_angle_deg, 1).c_str(),
                              picture.mark_is_used ? "" : " (without its mark)"));
  for (const std::string& note : summary.notes) context.say(note);
  const camera::Calibration& c = summary.record.calibration;
  // One sigma, the larger one of two numbers.
  const auto sigma = [&](int first, int last, int decimals) {
    if (!c.covariance) return std::string("(error not known)");
    const double variance = c.covariance->diagonal().segment(first, last - first + 1).maxCoeff();
    return files::format("(+- %.*f)", decimals, std::sqrt(variance));
  };
  context.say(files::format("focal length %.2f px %s, xi %.5f %s", c.focal_px, sigma(0, 0, 2).c_str(),
                            c.distortion_xi, sigma(1, 1, 5).c_str()));
  context.say(files::format("principal point (%.2f, %.2f) px %s, centre of rotation (%.2f, %.2f) px %s",
                            c.principal_point_px.x(), c.principal_point_px.y(), sigma(2, 3, 2).c_str(),
                            c.rotation_center_px.x(), c.rotation_center_px.y(), sigma(4, 5, 2).c_str()));
  context.say(files::format("corners miss the model by %.3f px (RMS)", summary.rms_px) +
              (summary.leave_one_out_rms_px >= 0
                   ? files::format(", those of a picture left out by %.3f px", summary.leave_one_out_rms_px)
                   : std::string()));
  context.say(files::format("the boards stand %.0f mm from the lens, if their squares have sides of %g mm",
                            summary.distance_mm, square_mm));
}

void run_calibrate(Context& context, CalibrateArguments& arguments) {
  calibration::CalibrationOptions& options = arguments.options;
  options.refractive_index = arguments.medium_index.value_or(1.0);
  if (arguments.images.size() < 3)
    throw CLI::ValidationError(
        "IMAGE", "needs three pictures or more, has " + std::to_string(arguments.images.size()));
  refuse_before_the_work({.read = {arguments.images.begin(), arguments.images.end()},
                          .written = {arguments.output, arguments.plot},
                          .makes = "camera.json"});
  const std::vector<calibration::CalibrationPicture> pictures = observe(arguments.images);
  const calibration::CalibrationSummary summary = calibration::calibrate(pictures, options);
  if (!summary.is_usable())
    throw InvalidInput("calibrate: " +
                       (summary.reasons.empty() ? std::string("failed") : summary.reasons.front()));
  if (!arguments.plot.empty()) calibration::write_residual_plot(arguments.plot, summary, pictures);
  camera::write_doubted_camera_file(arguments.output, summary.record, summary.reasons);
  if (arguments.output != "-") say_result(context, summary, options.square_mm);
  if (!summary.reasons.empty()) context.say_unreliable("the calibration", summary.reasons);
}

}  // namespace

void add_calibrate_command(CLI::App& app, Context& context) {
  CLI::App* command =
      add_subcommand(app, context, "calibrate",
                     "Camera calibration from pictures of a checkerboard, the lens turned in between",
                     "arthronaut calibrate --square-mm 1.5 -o camera.json a.png b.png c.png");
  const auto arguments = std::make_shared<CalibrateArguments>();
  command->add_option("--square-mm", arguments->options.square_mm, "Side of one square of the board, mm")
      ->required()
      ->check(between(0.01, 1000));
  command
      ->add_option("--distance-mm", arguments->options.distance_mm,
                   "How far the boards stood from the lens, about, if measured: tells a wrong square size")
      ->check(above_zero());
  add_medium_option(*command, arguments->medium_index,
                    "What the pictures were taken in: air (default), water, saline or a refractive index");
  command->add_option("--scope", arguments->options.scope_name, "Name of the scope, kept in camera.json");
  command->add_option("--head", arguments->options.head_name, "Name of the camera head, kept in camera.json");
  command->add_option("--plot", arguments->plot, "PNG file for a plot of the residuals")->check(a_file());
  command->add_option("-o,--output", arguments->output, "camera.json to write; - is standard output")
      ->required()
      ->check(a_name());
  command->add_option("IMAGE", arguments->images, "Three or more pictures; the board may run past the view")
      ->required();
  command->callback([&context, arguments] { run_calibrate(context, *arguments); });
}

}  // namespace arthronaut::command_line
