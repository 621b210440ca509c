#include "navigation/simulator/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/simulator/ground.h"
#include "navigation/simulator/light.h"
#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/ray_table.h"

namespace arthronaut::simulator {
namespace {

// Samples of a pixel whose parts differ, in pairs about its centre. Points of the R2 sequence: along every
// direction of an edge they lie evenly, so that an edge is placed to 1/64 px, which a square grid of as many
// samples does not do for edges along its rows; in pairs, so that their mean is the centre.
constexpr int kSamplePairs = 18;
// Where no print is in the pixel, which is what poses are found by, a third will do.
constexpr int kPlainSamplePairs = 6;
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
  SolidLayer(const Scene& scene, const PixelArea& area, const RayTable& rays,
             const std::vector<BonePixel>& bone_pixels)
      : area_(area), rays_(rays), bone_pixels_(bone_pixels), exposure_(scene.exposure) {
    for (const auto& solid : scene.solids) candidates_.push_back(spans_of(*solid));
  }

  // Draws over `light`, whose pixels hold the background.
  void draw(cv::Mat& light) const {
    parallel_rows(area_.height, [&](int first, int end) { draw_rows(first, end, light); });
  }

 private:
  Candidate spans_of(const Solid& solid) const {
    constexpr std::array<int, 2> kNone{1 << 20, -1};
    const std::array<int, 2> whole_row{0, area_.width - 1};
    Candidate candidate{&solid, {static_cast<std::size_t>(area_.height), kNone}};
    const std::vector<Ball> balls = solid.cover();
    if (balls.empty()) candidate.spans.assign(candidate.spans.size(), whole_row);
    for (const Ball& ball : balls) {
      const double distance = ball.center_mm.norm();
      if (distance <= ball.radius_mm) {  // the lens is in it
        candidate.spans.assign(candidate.spans.size(), whole_row);
        break;
      }
      widen(ball.center_mm / distance, std::asin(ball.radius_mm / distance), candidate);
    }
    return candidate;
  }

  // By what a ball covers: all directions within half_angle of `direction`.
  void widen(const Eigen::Vector3d& direction, double half_angle, Candidate& candidate) const {
    constexpr int kCorners = 16;  // of a pyramid that holds the cone
    const double off_axis = std::atan2(direction.head<2>().norm(), direction.z());
    if (off_axis - half_angle > std::atan(rays_.widest_tangent())) return;  // out of sight
    const Eigen::Vector3d side = direction.unitOrthogonal(), up = direction.cross(side);
    const double slant = std::tan(half_angle) / std::cos(geometry::kPi / kCorners);
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
    for (int i = 0; i < kCorners; ++i) {
      const double turn = 2 * geometry::kPi * i / kCorners;
      const Eigen::Vector3d corner = direction + slant * (std::cos(turn) * side + std::sin(turn) * up);
      // What stands beside the lens or behind it is seen at the rim.
      const Eigen::Vector2d tangent = corner.head<2>() / std::max(corner.z(), 1e-3);
      const Eigen::Vector2d at = rays_.pixel(tangent) - Eigen::Vector2d(area_.left, area_.top);
      left = std::min(left, at.x());
      right = std::max(right, at.x());
      top = std::min(top, at.y());
      bottom = std::max(bottom, at.y());
    }
    // The lens bends the pyramid's edges by a pixel at most; an ellipse in the box about the corners would
    // not hold a cone that is cut off by the rim, so only the rounding of the box's own corners is left out
    // there.
    const double center_y = 0.5 * (top + bottom), half_height = 0.5 * (bottom - top) + 2;
    const double center_x = 0.5 * (left + right), half_width = 0.5 * (right - left) + 2;
    const bool is_whole = off_axis + half_angle < std::atan(rays_.widest_tangent());
    const int first = std::max(0, static_cast<int>(center_y - half_height));
    const int last = std::min(area_.height - 1, static_cast<int>(center_y + half_height) + 1);
    for (int y = first; y <= last; ++y) {
      double half = half_width;
      if (is_whole) {
        const double share = std::min(1.0, std::max(0.0, std::abs(y - center_y) - 1) / half_height);
        half = half_width * std::sqrt(1 - share * share) + 2;
      }
      auto& span = candidate.spans[static_cast<std::size_t>(y)];
      span = {std::min(span[0], std::max(0, static_cast<int>(center_x - half))),
              std::max(span[1], std::min(area_.width - 1, static_cast<int>(center_x + half) + 1))};
    }
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

  // What a ray through a pixel's upper left corner meets, and where.
  struct Corner {
    Signature signature = 0;
    SolidHit hit;
  };
  static bool is_print(const Corner& corner) { return corner.signature != 0 && corner.hit.is_print; }

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

  // The upper left corners of a row's pixels, in the span and one beyond it.
  void trace_corners(int row, const std::array<int, 2>& span, std::vector<Corner>& corners) const {
    const int bone_row = std::min(row, area_.height - 1);
    for (int column = span[0]; column <= span[1] + 1; ++column) {
      const int x = area_.left + column;
      const float depth = bone_depth(area_.left + std::min(column, area_.width - 1), area_.top + bone_row);
      Corner& corner = corners[static_cast<std::size_t>(column)];
      corner.signature = trace(x - 0.5, area_.top + row - 0.5, depth, corner.hit);
    }
  }

  void draw_rows(int first, int end, cv::Mat& light) const {
    std::vector<Corner> above(static_cast<std::size_t>(area_.width) + 1), below(above.size());
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
        const Signature corner = above[i].signature;
        if (corner != above[i + 1].signature || corner != below[i].signature ||
            corner != below[i + 1].signature) {
          const bool has_print =
              is_print(above[i]) || is_print(above[i + 1]) || is_print(below[i]) || is_print(below[i + 1]);
          out[i] = supersample(x, y, out[i], has_print ? kSamplePairs : kPlainSamplePairs);
        } else if (corner != 0) {
          // Inside a face light changes slowly: that of the corner will do.
          out[i] = shade(x - 0.5, y - 0.5, above[i].hit);
        }
      }
    }
  }

  // Mean light over the pixel's area; linear, so that an edge lies where its blurred profile says. A part of
  // the pixel that is all one is shaded once.
  Eigen::Vector3f supersample(int x, int y, const Eigen::Vector3f& background, int pairs) const {
    struct Part {
      Signature signature = 0;
      Eigen::Vector3f light;
    };
    std::array<Part, 6> parts;
    parts[0] = {0, background};
    std::size_t part_count = 1;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    double u = 0.5, v = 0.5;
    for (int i = 0; i < pairs; ++i) {
      u += kR2X;
      v += kR2Y;
      u -= std::floor(u);
      v -= std::floor(v);
      for (const double sign : {-1.0, 1.0}) {
        SolidHit hit;
        const double sx = x + sign * (u - 0.5), sy = y + sign * (v - 0.5);
        const Signature signature = trace(sx, sy, bone_depth(x, y), hit);
        std::size_t part = 0;
        while (part < part_count && parts[part].signature != signature) ++part;
        if (part == part_count) {
          if (part_count == parts.size()) {
            sum += shade(sx, sy, hit);
            continue;
          }
          parts[part_count++] = {signature, shade(sx, sy, hit)};
        }
        sum += parts[part].light;
      }
    }
    return sum / static_cast<float>(2 * pairs);
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

}  // namespace

Renderer::Renderer(BoneView* bone, const SensorOptions& sensor)
    : bone_(bone), vignette_share_(sensor.vignette_share), sensor_(sensor) {}

void Renderer::render(const Scene& scene, const camera::CameraModel& camera, double mark_angle_deg,
                      std::uint64_t noise_seed, camera::Frame& frame) {
  frame.width = camera.image_size_px().x();
  frame.height = camera.image_size_px().y();
  const PixelArea area = visible_area(camera);
  const double reach =
      camera.boundary().radius_px + 40 + (camera.principal_point_px() - camera.boundary().center_px).norm();
  const RayTable rays(camera, reach);
  const FieldStop stop(camera.boundary(), mark_angle_deg, vignette_share_);

  bone_pixels_.assign(static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height),
                      BonePixel{});
  light_.create(area.height, area.width, CV_32FC3);
  // 1. The bone. 2. The solids over it. 3. The field stop over both. 4. The sensor.
  BoneView* bone = scene.has_bone ? bone_ : nullptr;
  if (bone) {
    bone->look(scene.camera_from_bone, rays, area);
    parallel_rows(area.height, [&](int first, int end) { bone->draw(first, end, bone_pixels_); });
  }
  const Ground ground(bone, bone_pixels_, area, camera.boundary(), rays, scene.exposure);
  parallel_rows(area.height,
                [&](int first, int end) { ground.draw_rows(first, end, light_.ptr<Eigen::Vector3f>(0)); });
  SolidLayer(scene, area, rays, bone_pixels_).draw(light_);
  parallel_rows(area.height, [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      stop.stop(area.left, y + area.top, area.width, light_.ptr<Eigen::Vector3f>(y));
    }
  });
  sensor_.expose(light_, area, noise_seed, frame);
}

}  // namespace arthronaut::simulator
