// The project's markers beside AprilTags read by libapriltag: tags of the same size in the same places, drawn
// by the simulator in the same light with the same noise, seen through the same true camera, one thread each.
// Prints the table of docs/benchmarks.md.
//
//   apriltag_comparison [FRAMES [SEED]]
#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "navigation/markers/marker_tracker.h"
#include "navigation/markers/planar_pose.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/simulator/simulated_ruler.h"
#include "planning/geometry/quantile.h"
#include "tests/real_data/pose_error.h"

namespace arthronaut {
namespace {

constexpr int kIds[] = {5, 6};
constexpr double kSizeMm = 2.89;

// A way to read two markers: what is printed, and where it is seen.
class Reader {
 public:
  virtual ~Reader() = default;
  [[nodiscard]] virtual simulator::MarkerCells cells(int id) const = 0;
  // camera_from_marker of kIds, empty when one is not found.
  virtual std::array<std::optional<geometry::RigidTransform>, 2> read(const camera::GrayView& picture,
                                                                      const camera::CameraModel& camera,
                                                                      std::int64_t timestamp_ns) = 0;
};

class OwnReader final : public Reader {
 public:
  OwnReader() {
    const markers::DeclaredMarker declared[] = {{kIds[0], kSizeMm}, {kIds[1], kSizeMm}};
    tracker_ = markers::make_tracker(declared);
  }
  [[nodiscard]] simulator::MarkerCells cells(int id) const override { return simulator::marker_cells(id); }
  std::array<std::optional<geometry::RigidTransform>, 2> read(const camera::GrayView& picture,
                                                              const camera::CameraModel& camera,
                                                              std::int64_t timestamp_ns) override {
    std::array<std::optional<geometry::RigidTransform>, 2> found;
    const auto seen = tracker_->track(picture, camera, timestamp_ns);
    for (std::size_t i = 0; i < 2; ++i) {
      if (seen[i].is_tracked()) found[i] = seen[i].camera_from_marker;
    }
    return found;
  }

 private:
  std::unique_ptr<markers::MarkerTracker> tracker_;
};

class AprilTagReader final : public Reader {
 public:
  AprilTagReader(apriltag_family_t* family, void (*destroy)(apriltag_family_t*), float decimation)
      : family_(family), destroy_(destroy), detector_(apriltag_detector_create()) {
    apriltag_detector_add_family(detector_, family_);
    detector_->nthreads = 1;
    detector_->quad_decimate = decimation;
  }
  ~AprilTagReader() override {
    apriltag_detector_destroy(detector_);
    destroy_(family_);
  }
  AprilTagReader(const AprilTagReader&) = delete;
  AprilTagReader& operator=(const AprilTagReader&) = delete;

  [[nodiscard]] simulator::MarkerCells cells(int id) const override {
    image_u8_t* picture = apriltag_to_image(family_, id);
    simulator::MarkerCells cells;
    cells.count = family_->width_at_border;
    const int margin = (family_->total_width - family_->width_at_border) / 2;
    for (int row = 0; row < cells.count; ++row) {
      for (int column = 0; column < cells.count; ++column)
        cells.is_white.push_back(picture->buf[(row + margin) * picture->stride + column + margin] > 127);
    }
    image_u8_destroy(picture);
    return cells;
  }

  // Its corners, with the pose that our own solver finds for them on the distorted picture.
  std::array<std::optional<geometry::RigidTransform>, 2> read(const camera::GrayView& picture,
                                                              const camera::CameraModel& camera,
                                                              std::int64_t /*timestamp_ns*/) override {
    image_u8_t image{picture.width, picture.height, static_cast<std::int32_t>(picture.stride),
                     const_cast<std::uint8_t*>(picture.data)};
    zarray_t* detections = apriltag_detector_detect(detector_, &image);
    std::array<std::optional<geometry::RigidTransform>, 2> found;
    for (int i = 0; i < zarray_size(detections); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections, i, &detection);
      for (std::size_t k = 0; k < 2; ++k) {
        if (detection->id != kIds[k] || detection->hamming > 0) continue;
        markers::Corners corners;  // theirs run the other way round, pixels counted from the pixel's corner
        for (std::size_t c = 0; c < 4; ++c)
          corners[c] = {detection->p[3 - c][0] - 0.5, detection->p[3 - c][1] - 0.5};
        if (const auto poses = markers::solve_square(camera, corners, kSizeMm))
          found[k] = poses->best.camera_from_marker;
      }
    }
    apriltag_detections_destroy(detections);
    return found;
  }

 private:
  apriltag_family_t* family_;
  void (*destroy_)(apriltag_family_t*);
  apriltag_detector_t* detector_;
};

struct Row {
  std::string name;
  std::unique_ptr<Reader> reader;
  std::vector<double> rotation_deg, translation_mm, relative_deg, relative_mm, ms;
  int asked = 0, found = 0, wrong = 0;

  void add(const std::array<std::optional<geometry::RigidTransform>, 2>& seen,
           const std::array<geometry::RigidTransform, 2>& truth) {
    for (std::size_t i = 0; i < 2; ++i) {
      ++asked;
      if (!seen[i]) continue;
      ++found;
      const real_data::PoseError error = real_data::pose_error(*seen[i], truth[i]);
      rotation_deg.push_back(error.rotation_deg);
      translation_mm.push_back(error.translation_mm);
      wrong += error.is_wrong();
    }
    if (!seen[0] || !seen[1]) return;
    const real_data::PoseError error =
        real_data::pose_error(seen[0]->inverse() * *seen[1], truth[0].inverse() * truth[1]);
    relative_deg.push_back(error.rotation_deg);
    relative_mm.push_back(error.translation_mm);
  }

  void print() const {
    std::printf("| %s | %.3f / %.3f | %.4f / %.4f | %.3f / %.3f | %.4f / %.4f | %.1f | %d | %.1f / %.1f |\n",
                name.c_str(), geometry::quantile(rotation_deg, 0.5), geometry::quantile(rotation_deg, 0.95),
                geometry::quantile(translation_mm, 0.5), geometry::quantile(translation_mm, 0.95),
                geometry::quantile(relative_deg, 0.5), geometry::quantile(relative_deg, 0.95),
                geometry::quantile(relative_mm, 0.5), geometry::quantile(relative_mm, 0.95),
                100.0 * found / std::max(1, asked), wrong, geometry::quantile(ms, 0.5),
                geometry::quantile(ms, 0.99));
  }
};

void run(int frame_count, std::uint64_t seed) {
  std::vector<Row> rows(5);
  const auto set = [&](std::size_t i, const char* name, std::unique_ptr<Reader> reader) {
    rows[i].name = name;
    rows[i].reader = std::move(reader);
  };
  set(0, "own markers", std::make_unique<OwnReader>());
  set(1, "tag16h5", std::make_unique<AprilTagReader>(tag16h5_create(), tag16h5_destroy, 1.F));
  set(2, "tag16h5, half size", std::make_unique<AprilTagReader>(tag16h5_create(), tag16h5_destroy, 2.F));
  set(3, "tag36h11", std::make_unique<AprilTagReader>(tag36h11_create(), tag36h11_destroy, 1.F));
  set(4, "tag36h11, half size", std::make_unique<AprilTagReader>(tag36h11_create(), tag36h11_destroy, 2.F));

  // Both sizes of a family read the same pictures.
  for (const std::vector<std::size_t>& family : {std::vector<std::size_t>{0}, {1, 2}, {3, 4}}) {
    simulator::RulerOptions options;
    options.camera = simulator::standard_camera();
    options.seed = seed;
    options.frame_count = frame_count;
    options.first_id = kIds[0];
    options.second_id = kIds[1];
    options.size_mm = kSizeMm;
    options.printed = [&](int id) { return rows[family.front()].reader->cells(id); };
    simulator::SimulatedRuler ruler(options);
    std::vector<std::uint8_t> luma;
    for (auto frame = ruler.next(); frame; frame = ruler.next()) {
      const simulator::FrameTruth& at = ruler.truth();
      const camera::CameraModel camera(options.camera, options.camera.lens_angle_rad(at.mark_angle_deg),
                                       options.refractive_index);
      camera::gray_from(*frame, luma);
      const camera::GrayView picture{luma.data(), frame->width, frame->height, frame->width};
      for (const std::size_t i : family) {
        const double start = real_data::thread_cpu_ms();
        const auto seen = rows[i].reader->read(picture, camera, frame->timestamp_ns);
        rows[i].ms.push_back(real_data::thread_cpu_ms() - start);
        rows[i].add(seen, {at.markers[0].camera_from_marker, at.markers[1].camera_from_marker});
      }
    }
  }
  std::printf(
      "| tags | rotation deg | translation mm | relative deg | relative mm | found %% | wrong | ms: median / "
      "99 %% "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) row.print();
}

}  // namespace
}  // namespace arthronaut

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 120;
  const int seed = argc > 2 ? std::atoi(argv[2]) : 1;
  if (frames < 1 || seed < 1) {
    std::fprintf(stderr, "usage: apriltag_comparison [FRAMES [SEED]]\n");
    return 2;
  }
  arthronaut::run(frames, static_cast<std::uint64_t>(seed));
  return 0;
}
