// What comes between scope and markers, painted over a finished picture in linear light: fingers,
// instruments, blood, debris, bubbles, dust, highlights. One picture at a time, in the order of time.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tests/benchmarks/hard_clips/motion.h"
#include "tests/benchmarks/hard_clips/recipe.h"

namespace arthronaut::hard_clips {

// Where the clip's markers are in the picture at some time, for what has to hit them.
struct MarkerPlaces {
  Eigen::Vector2d center_px[ClipMotion::kMarkers];
  double side_px[ClipMotion::kMarkers];
};

class Obstructions {
 public:
  explicit Obstructions(const ClipRecipe& recipe);

  // `light`: CV_32FC3, blue green red, 1 is the sensor's limit. `cover`: CV_8UC1 of the same size, 255 where
  // what was seen before cannot be seen any more.
  void paint(double time_s, const MarkerPlaces& places, cv::Mat& light, cv::Mat& cover) const;

 private:
  struct Part {  // of any kind; what its numbers mean is the kind's affair
    int marker = 0;
    double size = 0, rate = 0, phase = 0, angle = 0, reach = 0, level = 0;
    cv::Vec3f color;
  };
  void paint_capsule(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light,
                     cv::Mat& cover) const;
  void paint_cloud(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light,
                   cv::Mat& cover) const;
  void paint_fleck(const Part& part, double time_s, cv::Mat& light, cv::Mat& cover) const;
  void paint_bubble(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light,
                    cv::Mat& cover) const;
  void paint_veil(double time_s, cv::Mat& light) const;
  void paint_glare(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light) const;

  ClipRecipe recipe_;
  std::vector<Part> capsules_, clouds_, flecks_, bubbles_, highlights_;
  double veil_ = 0, veil_rate_ = 0;
};

// Smooth noise between 0 and 1 that repeats every 64 units.
[[nodiscard]] float noise_at(float x, float y);

}  // namespace arthronaut::hard_clips
