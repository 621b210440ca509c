// The project's marker tracker beside OpenCV's ArUco, one thread each, on the same recorded pictures with the
// same true camera: accuracy against the clips' truth, rates, and processor time. Prints the tables of
// docs/benchmarks.md.
//
//   markers_accuracy FOLDER   the folder that holds probe_wet, ruler_wet, guide_wet and hard
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>

#include "navigation/lens/lens_tracker.h"
#include "navigation/markers/code_reader.h"
#include "navigation/markers/edge_tracker.h"
#include "navigation/markers/square_search.h"
#include "planning/geometry/quantile.h"
#include "tests/benchmarks/aruco_tracker.h"
#include "tests/real_data/marker_accuracy.h"

namespace arthronaut::real_data {
namespace {

std::unique_ptr<markers::MarkerTracker> make_without_dense_fit(
    std::span<const markers::DeclaredMarker> declared) {
  markers::EdgeTrackerOptions options;
  options.fit_directly = false;
  return markers::make_edge_tracker(declared, markers::codes_4x4_50(), options);
}

using TrackerMaker = std::unique_ptr<markers::MarkerTracker> (*)(std::span<const markers::DeclaredMarker>);

void print_row(const char* clip, const char* tracker, const ClipAccuracy& a) {
  const auto q = [](const std::vector<double>& values, double share) {
    return geometry::quantile(values, share);
  };
  std::printf(
      "| %s | %s | %.3f / %.3f | %.4f / %.4f | %+.4f | %.3f / %.3f | %.4f / %.4f | %.4f / %.4f | %.1f | %.1f "
      "| %d | %.2f |\n",
      clip, tracker, q(a.rotation_deg, 0.5), q(a.rotation_deg, 0.95), q(a.translation_mm, 0.5),
      q(a.translation_mm, 0.95), q(a.depth_mm, 0.5), q(a.relative_rotation_deg, 0.5),
      q(a.relative_rotation_deg, 0.95), q(a.relative_translation_mm, 0.5), q(a.relative_translation_mm, 0.95),
      q(a.tip_mm, 0.5), q(a.tip_mm, 0.95), 100 * a.whole_rate(), 100 * a.partial_rate(), a.wrong_count,
      a.normalised_error);
}

struct Timing {
  std::vector<double> ms;
  void print(const char* what) const {
    std::printf("| %s | %.2f | %.2f | %.2f |\n", what, geometry::quantile(ms, 0.5),
                geometry::quantile(ms, 0.95), geometry::quantile(ms, 0.99));
  }
};

Timing time_each_picture(MarkerClip& clip, const std::function<void(const camera::GrayView&)>& work) {
  Timing timing;
  clip.rewind();
  for (camera::GrayView picture = clip.next_picture(); picture.data; picture = clip.next_picture()) {
    const double start = thread_cpu_ms();
    work(picture);
    timing.ms.push_back(thread_cpu_ms() - start);
  }
  return timing;
}

Timing time_opencv(MarkerClip& clip, bool subpix, bool aruco3) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod =
      subpix ? cv::aruco::CORNER_REFINE_SUBPIX : cv::aruco::CORNER_REFINE_NONE;
  parameters->useAruco3Detection = aruco3;
  parameters->minMarkerLengthRatioOriginalImg = aruco3 ? 0.02F : 0.0F;
  return time_each_picture(clip, [&](const camera::GrayView& picture) {
    const cv::Mat image(picture.height, picture.width, CV_8UC1, const_cast<std::uint8_t*>(picture.data),
                        static_cast<std::size_t>(picture.stride));
    std::vector<std::vector<cv::Point2f>> quads;
    std::vector<int> ids;
    cv::aruco::detectMarkers(image, dictionary, quads, ids, parameters);
  });
}

void print_times(const std::filesystem::path& folder) {
  MarkerClip clip(folder / "probe_wet");
  auto declared = markers::declared_markers(clip.tools());
  std::printf(
      "\n| ms of processor time a frame, 1920 x 1080; probe_wet where none is named | median | 95 %% | 99 %% "
      "|\n|---|---|---|---|\n");
  const auto all = markers::make_tracker(declared);
  time_each_picture(clip, [&](const camera::GrayView& picture) {
    (void)all->track(picture, clip.camera(), clip.timestamp_ns());
  }).print("own: three markers declared, two in view");
  std::erase_if(declared,
                [](const markers::DeclaredMarker& marker) { return marker.id != 0 && marker.id != 2; });
  const auto both = markers::make_tracker(declared);
  time_each_picture(clip, [&](const camera::GrayView& picture) {
    (void)both->track(picture, clip.camera(), clip.timestamp_ns());
  }).print("own: two markers declared, both in view");
  lens::LensTracker lens({.calibration = clip.calibration()});
  both->reset();
  time_each_picture(clip, [&](const camera::GrayView& picture) {
    (void)lens.observe(picture, clip.timestamp_ns());
    (void)both->track(picture, clip.camera(), clip.timestamp_ns());
  }).print("own: the same, with circle and lens mark");
  markers::SquareSearch search;
  std::vector<markers::MarkerCode> codes = markers::codes_4x4_50();
  codes.resize(5);
  const markers::LinearTable light(1.6);
  time_each_picture(clip, [&](const camera::GrayView& picture) {
    const markers::LinearImage image(picture, light);
    for (const auto& square : search.find(picture, clip.camera())) {
      (void)markers::read_code(image, clip.camera(), square.tangent, codes);
    }
  }).print("own: full search, five codes read");
  const auto cold = markers::make_tracker(declared);
  time_each_picture(clip, [&](const camera::GrayView& picture) {
    cold->reset();
    (void)cold->track(picture, clip.camera(), clip.timestamp_ns());
  }).print("own: full search with poses, nothing known");
  MarkerClip smeared(folder / "hard");
  const auto all_smeared = markers::make_tracker(markers::declared_markers(smeared.tools()));
  time_each_picture(smeared, [&](const camera::GrayView& picture) {
    (void)all_smeared->track(picture, smeared.camera(), smeared.timestamp_ns());
  }).print("own: hard, three markers declared, two in view, smeared and covered");
  time_opencv(clip, false, false).print("OpenCV ArUco, default (no pose)");
  time_opencv(clip, true, false).print("OpenCV ArUco, SUBPIX (no pose)");
  time_opencv(clip, true, true).print("OpenCV ArUco, SUBPIX, useAruco3Detection (no pose)");
}

int run(const std::filesystem::path& folder) {
  cv::setNumThreads(1);
  std::printf(
      "| clip | tracker | rotation deg | translation mm | depth bias mm | relative deg | relative mm | tip "
      "mm | whole %% | "
      "covered %% | wrong | normalised error |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const std::pair<const char*, TrackerMaker> trackers[] = {{"own", markers::make_tracker},
                                                           {"edges alone", make_without_dense_fit},
                                                           {"ArUco", markers::make_aruco_tracker}};
  for (const char* name : {"probe_wet", "ruler_wet", "guide_wet", "hard"}) {
    MarkerClip clip(folder / name);
    for (const auto& [label, make] : trackers) {
      clip.rewind();
      print_row(name, label, measure_accuracy(clip, *make(markers::declared_markers(clip.tools()))));
    }
  }
  print_times(folder);
  return 0;
}

}  // namespace
}  // namespace arthronaut::real_data

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: markers_accuracy FOLDER\n");
    return 2;
  }
  return arthronaut::real_data::run(argv[1]);
}
