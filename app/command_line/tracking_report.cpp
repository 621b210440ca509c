#include "app/command_line/tracking_report.h"

#include <iostream>

#include "navigation/camera/doubted_camera_file.h"
#include "planning/log/log.h"

namespace arthronaut::command_line {

namespace {

std::string share(long part, long whole) {
  return format("%ld of %ld frames (%.1f %%)", part, whole,
                whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0);
}

}  // namespace

std::vector<std::string> camera_doubts(const std::filesystem::path& camera_file) {
  std::vector<std::string> doubts = camera::read_camera_doubts(camera_file);
  for (std::string& doubt : doubts)
    doubt = camera_file.string() + ": the calibration is not reliable: " + doubt;
  return doubts;
}

bool warn_of_simulated_camera(const std::filesystem::path& camera_file) {
  const bool is_simulated =
      camera::read_camera_file(camera_file).provenance.origin == provenance::Origin::Simulated;
  if (!is_simulated) return false;
  const std::string warning =
      camera_file.string() +
      ": is of the simulated arthroscope: no number is right of a video that a real one has taken";
  std::cerr << "arthronaut: " << warning << '\n';
  log::warning(warning);
  return true;
}

void say_statistics(const Context& context, const pipeline::ViewStatistics& statistics) {
  for (const pipeline::MarkerStatistics& marker : statistics.markers) {
    std::string line = "marker " + std::to_string(marker.id) + " (" + marker.name +
                       "): " + share(marker.frames_with_pose, statistics.frame_count);
    if (marker.frames_with_pose < statistics.frame_count) {
      line += ", else mostly: " + std::string(markers::to_text(marker.main_loss));
    }
    context.say(line);
  }
  context.say("lens mark: " + share(statistics.frames_with_mark, statistics.frame_count));
  if (statistics.frames_off_camera > 0)
    context.say("no pose stands in " + share(statistics.frames_off_camera, statistics.frame_count) + ": " +
                statistics.off_camera);
  const long without_angle = statistics.frames_with_unknown_lens - statistics.frames_off_camera;
  if (without_angle > 0)
    context.say("no pose stands in " + share(without_angle, statistics.frame_count) +
                ": the lens angle is not known there (--fixed-lens if this lens does not turn)");
  if (statistics.frames_frozen > 0) {
    context.say("frozen picture: " + share(statistics.frames_frozen, statistics.frame_count));
  }
  if (context.verbose) {
    context.say(format("processing: %.1f ms a frame, worst %.1f ms", statistics.processing_ms_mean,
                       statistics.processing_ms_worst));
  }
}

std::vector<std::string> record_reasons(const theatre::NavigationSummary& summary) {
  std::vector<std::string> reasons;
  if (!summary.record_trouble.empty()) reasons.push_back("the record ended early: " + summary.record_trouble);
  if (!summary.video_trouble.empty())
    reasons.push_back("the video is not kept to its end: " + summary.video_trouble);
  return reasons;
}

}  // namespace arthronaut::command_line
