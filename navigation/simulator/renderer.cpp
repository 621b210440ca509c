#include "navigation/simulator/renderer.h"

#include <algorithm>
#include <array>
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

constexpr int kBlockRows = 16;  // rows that are searched for solids as one

// Signature of what a ray meets: 0 is the background (bone or void).
using Signature = std::int32_t;

// A solid and the pixels of each row of the area that it may cover, from first to last; none: last < first.
struct Candidate {
  const Solid* solid = nullptr;
  std::vector<std::array<int, 2>> spans;
};

class SolidLayer {
 public:
  SolidLayer(const Scene& scene, const camera::CameraModel& camera, const PixelArea& area,
             const RayTable& rays, const std::vector<BonePixel>& bone_pixels)
      : area_(area), rays_(rays), bone_pixels_(bone_pixels), exposure_(scene.exposure) {
    for (const auto& solid : scene.solids) candidates_.push_back(spans_of(*solid, camera));
  }

  // Draws over `light`, whose pixels hold the background.
  void draw(cv::Mat& light) const {
    parallel_rows(area_.height, [&](int first, int end) { draw_rows(first, end, light); });
  }

 private:
  Candidate spans_of(const Solid& solid, const camera::CameraModel& camera) const {
    constexpr std::array<int, 2> kNone{1 << 20, -1};
    const std::array<int, 2> whole_row{0, area_.width - 1};
    Candidate candidate{&solid, {static_cast<std::size_t>(area_.height), kNone}};
    const std::vector<Ball> balls = solid.cover();
    if (balls.empty()) candidate.spans.assign(candidate.spans.size(), whole_row);
    for (const Ball& ball : balls) {
      if (is_out_of_sight(ball)) continue;
      Eigen::Matrix<double, 2, 3> d_pixel_d_point;
      const auto pixel = camera.project(ball.center_mm, d_pixel_d_point);
      if (!pixel || ball.center_mm.z() < 3 * ball.radius_mm) {
        candidate.spans.assign(candidate.spans.size(), whole_row);
        break;
      }
      // To first order the ball reaches this far; the lens bends the rest by less than a third of it.
      const double reach = 1.35 * d_pixel_d_point.norm() * ball.radius_mm + 3;
      const Eigen::Vector2d at = *pixel - Eigen::Vector2d(area_.left, area_.top);
      const int top = std::max(0, static_cast<int>(at.y() - reach));
      const int bottom = std::min(area_.height - 1, static_cast<int>(at.y() + reach));
      for (int y = top; y <= bottom; ++y) {
        auto& span = candidate.spans[static_cast<std::size_t>(y)];
        span = {std::min(span[0], std::max(0, static_cast<int>(at.x() - reach))),
                std::max(span[1], std::min(area_.width - 1, static_cast<int>(at.x() + reach)))};
      }
    }
    return candidate;
  }

  // Behind the lens, or further off its axis than any scope sees.
  static bool is_out_of_sight(const Ball& ball) {
    constexpr double kWidestDeg = 62;
    const double distance = ball.center_mm.norm();
    if (distance <= ball.radius_mm) return false;
    const double half_angle = std::asin(ball.radius_mm / distance);
    return std::atan2(ball.center_mm.head<2>().norm(), ball.center_mm.z()) - half_angle >
           geometry::rad_from_deg(kWidestDeg);
  }

  // Nearest solid along the ray that the bone does not hide.
  Signature trace(double x, double y, float bone_depth, SolidHit& nearest) const {
    const int column = static_cast<int>(x + 0.5) - area_.left;
    const int row = std::clamp(static_cast<int>(y + 0.5) - area_.top, 0, area_.height - 1);
    Eigen::Vector3d direction(0, 0, 0);
    Signature signature = 0;
    nearest.depth_mm = 1e9;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const Candidate& c = candidates_[i];
      const auto& span = c.spans[static_cast<std::size_t>(row)];
      if (column < span[0] || column > span[1]) continue;
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

  // From the leftmost to the rightmost pixel that a solid may cover in a block of rows, with one to spare
  // each way.
  std::array<int, 2> span_of_block(int block) const {
    std::array<int, 2> all{area_.width, -1};
    const int first = std::max(0, block * kBlockRows - 1);
    const int last = std::min(area_.height - 1, (block + 1) * kBlockRows);
    for (const Candidate& candidate : candidates_) {
      for (int row = first; row <= last; ++row) {
        const auto& span = candidate.spans[static_cast<std::size_t>(row)];
        all = {std::min(all[0], span[0]), std::max(all[1], span[1])};
      }
    }
    return {std::max(0, all[0] - 1), std::min(area_.width - 1, all[1] + 1)};
  }

  // Signatures at the upper left corners of a row's pixels, in the span and one beyond it.
  void trace_corners(int row, const std::array<int, 2>& span, std::vector<Signature>& corners) const {
    SolidHit ignored;
    const int bone_row = std::min(row, area_.height - 1);
    for (int column = span[0]; column <= span[1] + 1; ++column) {
      const int x = area_.left + column;
      const float depth = bone_depth(area_.left + std::min(column, area_.width - 1), area_.top + bone_row);
      corners[static_cast<std::size_t>(column)] = trace(x - 0.5, area_.top + row - 0.5, depth, ignored);
    }
  }

  void draw_rows(int first, int end, cv::Mat& light) const {
    std::vector<Signature> above(static_cast<std::size_t>(area_.width) + 1), below(above.size());
    std::array<int, 2> span{0, -1};
    for (int row = first; row < end; ++row) {
      if (row == first || row % kBlockRows == 0) {
        span = span_of_block(row / kBlockRows);
        trace_corners(row, span, above);
      } else {
        std::swap(above, below);
      }
      if (span[1] < span[0]) continue;
      trace_corners(row + 1, span, below);
      auto* out = light.ptr<Eigen::Vector3f>(row);
      const int y = area_.top + row;
      for (int column = span[0]; column <= span[1]; ++column) {
        const auto i = static_cast<std::size_t>(column);
        const int x = area_.left + column;
        const Signature corner = above[i];
        if (corner != above[i + 1] || corner != below[i] || corner != below[i + 1]) {
          out[i] = supersample(x, y, out[i]);
        } else if (corner != 0) {
          SolidHit hit;
          if (trace(x, y, bone_depth(x, y), hit) != 0) out[i] = shade(x, y, hit);
        }
      }
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
