#include "navigation/simulator/renderer.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/light.h"
#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/ray_table.h"

namespace arthronaut::simulator {
namespace {

// Samples of a pixel whose parts differ, in pairs about its centre. Points of the R2 sequence: along every
// direction of an edge they lie evenly, so that an edge is placed to 1/64 px, which a square grid of as many
// samples does not do for edges along its rows; in pairs, so that their mean is the centre.
constexpr int kSamplePairs = 18;
constexpr double kR2X = 0.7548776662466927, kR2Y = 0.5698402909980532;

// Signature of what a ray meets: 0 is the background (bone or void).
using Signature = std::int32_t;

struct Candidate {
  const Solid* solid = nullptr;
  int left = 0, top = 0, right = -1, bottom = -1;  // pixels that it may cover, inclusive
};

class SolidLayer {
 public:
  SolidLayer(const Scene& scene, const camera::CameraModel& camera, const PixelArea& area,
             const RayTable& rays, const std::vector<BonePixel>& bone_pixels)
      : area_(area), rays_(rays), bone_pixels_(bone_pixels), exposure_(scene.exposure) {
    for (const auto& solid : scene.solids) candidates_.push_back(bounds_of(*solid, camera));
    right_ = bottom_ = -1;
    left_ = area.left + area.width;
    top_ = area.top + area.height;
    for (const Candidate& c : candidates_) {
      left_ = std::min(left_, c.left);
      top_ = std::min(top_, c.top);
      right_ = std::max(right_, c.right);
      bottom_ = std::max(bottom_, c.bottom);
    }
    left_ = std::max(left_ - 2, area.left);
    top_ = std::max(top_ - 2, area.top);
    right_ = std::min(right_ + 2, area.left + area.width - 1);
    bottom_ = std::min(bottom_ + 2, area.top + area.height - 1);
  }

  // Draws over `light`, whose pixels hold the background.
  void draw(cv::Mat& light) const {
    const int columns = right_ - left_ + 1, rows = bottom_ - top_ + 1;
    if (columns <= 0 || rows <= 0) return;
    parallel_rows(rows, [&](int first, int end) { draw_rows(first, end, columns, light); });
  }

 private:
  static Candidate bounds_of(const Solid& solid, const camera::CameraModel& camera) {
    const Candidate everywhere{&solid, -1 << 20, -1 << 20, 1 << 20, 1 << 20};
    const auto hull = solid.hull();
    if (hull.empty()) return everywhere;
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
    // The lens bends straight lines, but never outside the box of enough points along them.
    for (std::size_t i = 0; i < hull.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (int step = 0; step <= 4; ++step) {
          const auto pixel = camera.project(hull[i] + 0.25 * step * (hull[j] - hull[i]));
          if (!pixel) return everywhere;
          low = low.cwiseMin(*pixel);
          high = high.cwiseMax(*pixel);
        }
      }
    }
    const auto clamped = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
    return {&solid, clamped(low.x()) - 4, clamped(low.y()) - 4, clamped(high.x()) + 4, clamped(high.y()) + 4};
  }

  // Nearest solid along the ray that the bone does not hide.
  Signature trace(double x, double y, float bone_depth, SolidHit& nearest) const {
    Eigen::Vector3d direction(0, 0, 0);
    Signature signature = 0;
    nearest.depth_mm = 1e9;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const Candidate& c = candidates_[i];
      if (x < c.left || x > c.right || y < c.top || y > c.bottom) continue;
      if (direction.z() == 0) direction = rays_.tangent(x, y).homogeneous();
      SolidHit hit;
      if (c.solid->hit(direction, hit) && hit.depth_mm < nearest.depth_mm &&
          hit.depth_mm < bone_depth + c.solid->yields_mm) {
        nearest = hit;
        signature = static_cast<Signature>((i + 1) * 16) + hit.region;
      }
    }
    return signature;
  }

  Eigen::Vector3f shade(double x, double y, const SolidHit& hit) const {
    const Eigen::Vector3d point = hit.depth_mm * rays_.tangent(x, y).homogeneous();
    return lit(point.cast<float>(), hit.normal.cast<float>(), *hit.skin, exposure_);
  }

  float bone_depth(int x, int y) const {
    return bone_pixels_[static_cast<std::size_t>(y - area_.top) * static_cast<std::size_t>(area_.width) +
                        static_cast<std::size_t>(x - area_.left)]
        .depth_mm;
  }

  // Signatures at the corners of the pixels of one row of corners; corner 0 is left of the first pixel.
  void trace_corners(int y_row, int columns, std::vector<Signature>& corners) const {
    SolidHit ignored;
    const int bone_row = std::clamp(y_row, area_.top, area_.top + area_.height - 1);
    for (int i = 0; i <= columns; ++i) {
      const int x = std::min(left_ + i, area_.left + area_.width - 1);
      corners[static_cast<std::size_t>(i)] =
          trace(left_ + i - 0.5, y_row - 0.5, bone_depth(x, bone_row), ignored);
    }
  }

  void draw_rows(int first, int end, int columns, cv::Mat& light) const {
    std::vector<Signature> above(static_cast<std::size_t>(columns) + 1), below(above.size());
    trace_corners(top_ + first, columns, above);
    for (int row = first; row < end; ++row) {
      const int y = top_ + row;
      trace_corners(y + 1, columns, below);
      auto* out = light.ptr<Eigen::Vector3f>(y - area_.top) + (left_ - area_.left);
      for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
        const int x = left_ + static_cast<int>(i);
        const Signature corner = above[i];
        if (corner != above[i + 1] || corner != below[i] || corner != below[i + 1]) {
          out[i] = supersample(x, y, out[i]);
        } else if (corner != 0) {
          SolidHit hit;
          if (trace(x, y, bone_depth(x, y), hit) != 0) out[i] = shade(x, y, hit);
        }
      }
      std::swap(above, below);
    }
  }

  // Mean light over the pixel's area; linear, so that an edge lies where its blurred profile says.
  Eigen::Vector3f supersample(int x, int y, const Eigen::Vector3f& background) const {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    double u = 0.5, v = 0.5;
    for (int i = 0; i < kSamplePairs; ++i) {
      u += kR2X;
      v += kR2Y;
      u -= std::floor(u);
      v -= std::floor(v);
      for (const double sign : {-1.0, 1.0}) {
        SolidHit hit;
        const double sx = x + sign * (u - 0.5), sy = y + sign * (v - 0.5);
        sum += trace(sx, sy, bone_depth(x, y), hit) != 0 ? shade(sx, sy, hit) : background;
      }
    }
    return sum / (2 * kSamplePairs);
  }

  const PixelArea& area_;
  const RayTable& rays_;
  const std::vector<BonePixel>& bone_pixels_;
  float exposure_;
  std::vector<Candidate> candidates_;
  int left_, top_, right_, bottom_;  // pixels that any solid may cover, inclusive
};

// The field stop's surroundings, with room for the blur.
PixelArea visible_area(const camera::CameraModel& camera) {
  const camera::Boundary& b = camera.boundary();
  const auto low = [&](double center) {
    return std::max(0, static_cast<int>(std::floor(center - b.radius_px)) - 8);
  };
  const auto high = [&](double center, int size) {
    return std::min(size, static_cast<int>(std::ceil(center + b.radius_px)) + 8);
  };
  const int left = low(b.center_px.x()), top = low(b.center_px.y());
  return {left, top, high(b.center_px.x(), camera.image_size_px().x()) - left,
          high(b.center_px.y(), camera.image_size_px().y()) - top};
}

// The capsule behind the bone: red, far and without detail. Without it the rim would stand on black.
Eigen::Vector3f backdrop(const Eigen::Vector2d& tangent, float exposure) {
  constexpr float kFarMm = 36;
  static const Skin kTissue{{0.10f, 0.12f, 0.34f}, 0, 1};
  const Eigen::Vector3f direction = tangent.homogeneous().cast<float>();
  return lit(kFarMm * direction, -direction.normalized(), kTissue, exposure);
}

}  // namespace

Renderer::Renderer(BoneView* bone, const SensorOptions& sensor) : bone_(bone), sensor_(sensor) {}

void Renderer::render(const Scene& scene, const camera::CameraModel& camera, double mark_angle_deg,
                      std::uint64_t noise_seed, camera::Frame& frame) {
  frame.width = camera.image_size_px().x();
  frame.height = camera.image_size_px().y();
  const PixelArea area = visible_area(camera);
  const double reach =
      camera.boundary().radius_px + 40 + (camera.principal_point_px() - camera.boundary().center_px).norm();
  const RayTable rays(camera, reach);
  const FieldStop stop(camera.boundary(), mark_angle_deg, sensor_.vignette_share);

  const double visible_radius2 = std::pow(camera.boundary().radius_px + 4, 2);
  bone_pixels_.assign(static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height),
                      BonePixel{});
  light_.create(area.height, area.width, CV_32FC3);
  light_ = cv::Scalar::all(0);
  // 1. The bone. 2. The solids over it. 3. The field stop over both. 4. The sensor.
  const bool draws_bone = scene.has_bone && bone_;
  if (draws_bone) bone_->look(scene.camera_from_bone, camera);
  parallel_rows(area.height, [&](int first, int end) {
    if (draws_bone) bone_->draw(area, first, end, bone_pixels_);
    for (int y = first; y < end; ++y) {
      auto* out = light_.ptr<Eigen::Vector3f>(y);
      const BonePixel* row = bone_pixels_.data() + static_cast<std::ptrdiff_t>(y) * area.width;
      for (int x = 0; x < area.width; ++x) {
        // Light that the field stop will not pass need not be computed.
        const double dx = x + area.left - camera.boundary().center_px.x();
        const double dy = y + area.top - camera.boundary().center_px.y();
        if (dx * dx + dy * dy > visible_radius2) continue;
        out[x] = row[x].triangle >= 0 ? bone_->shade(row[x], scene.exposure)
                                      : backdrop(rays.tangent(x + area.left, y + area.top), scene.exposure);
      }
    }
  });
  SolidLayer(scene, camera, area, rays, bone_pixels_).draw(light_);
  parallel_rows(area.height, [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      auto* out = light_.ptr<Eigen::Vector3f>(y);
      for (int x = 0; x < area.width; ++x) out[x] *= stop.share_passed(x + area.left, y + area.top);
    }
  });
  expose(light_, area, sensor_, noise_seed, frame);
}

}  // namespace arthronaut::simulator
