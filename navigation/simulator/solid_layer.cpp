#include "navigation/simulator/solid_layer.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::simulator {
namespace {

// Samples of a pixel whose parts differ, in pairs about its centre. Points of the R2 sequence: along every
// direction of an edge they lie evenly, so that an edge is placed to 1/64 px, which a square grid of as many
// samples does not do for edges along its rows; in pairs, so that their mean is the centre.
constexpr int kSamples = 36;
// Where no print is in the pixel, which is what poses are found by, a third will do.
constexpr int kPlainSamples = 12;
constexpr double kR2X = 0.7548776662466927, kR2Y = 0.5698402909980532;

constexpr int kBlockRows = 16;  // rows that are searched for solids as one

struct SamplePlaces {
  alignas(32) float x[padded(kSamples)] = {}, y[padded(kSamples)] = {};  // px, about the centre
};
const SamplePlaces& sample_places() {
  static const SamplePlaces kPlaces = [] {
    SamplePlaces places;
    double u = 0.5, v = 0.5;
    for (int i = 0; i < kSamples; i += 2) {
      u += kR2X;
      v += kR2Y;
      u -= std::floor(u);
      v -= std::floor(v);
      for (const int k : {0, 1}) {
        const double sign = 2 * k - 1;
        places.x[i + k] = static_cast<float>(sign * (u - 0.5));
        places.y[i + k] = static_cast<float>(sign * (v - 0.5));
      }
    }
    return places;
  }();
  return kPlaces;
}

PartLook numbers_of(const Skin& skin) {
  PartLook look;
  for (int c = 0; c < 3; ++c) look.albedo_bgr[c] = skin.albedo_bgr[c];
  look.specular = skin.specular;
  look.gloss_doublings = std::min(skin.gloss_doublings, PartLook::kMostDoublings);
  return look;
}

constexpr float kFar_mm = 1e9f;

}  // namespace

SolidLayer::SolidLayer(const std::vector<std::unique_ptr<Solid>>& solids, const PixelArea& area,
                       const RayTable& rays, float exposure)
    : area_(area), rays_(rays), exposure_(exposure), looks_(1), is_print_(1, false) {
  for (const auto& solid : solids) {
    candidates_.push_back({solid.get(), static_cast<int>(looks_.size()), {}});
    for (const Look& look : solid->looks()) {
      looks_.push_back(numbers_of(look.skin));
      is_print_.push_back(look.is_print);
    }
    find_spans(candidates_.back());
  }
}

void SolidLayer::find_spans(Candidate& candidate) const {
  constexpr std::array<int, 2> kNone{1 << 20, -1};
  const std::array<int, 2> whole_row{0, area_.width - 1};
  candidate.spans.assign(static_cast<std::size_t>(area_.height), kNone);
  const std::vector<Ball> balls = candidate.solid->cover();
  if (balls.empty()) candidate.spans.assign(candidate.spans.size(), whole_row);
  for (const Ball& ball : balls) {
    const double distance = ball.center_mm.norm();
    if (distance <= ball.radius_mm) {  // the lens is in it
      candidate.spans.assign(candidate.spans.size(), whole_row);
      break;
    }
    widen(ball.center_mm / distance, std::asin(ball.radius_mm / distance), candidate);
  }
}

// By what a ball covers: all directions within half_angle of `direction`.
void SolidLayer::widen(const Eigen::Vector3d& direction, double half_angle, Candidate& candidate) const {
  constexpr int kPyramid = 16;  // corners of a pyramid that holds the cone
  const double off_axis = std::atan2(direction.head<2>().norm(), direction.z());
  if (off_axis - half_angle > std::atan(rays_.widest_tangent())) return;  // out of sight
  const Eigen::Vector3d side = direction.unitOrthogonal(), up = direction.cross(side);
  const double slant = std::tan(half_angle) / std::cos(geometry::kPi / kPyramid);
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (int i = 0; i < kPyramid; ++i) {
    const double turn = 2 * geometry::kPi * i / kPyramid;
    const Eigen::Vector3d corner = direction + slant * (std::cos(turn) * side + std::sin(turn) * up);
    // What stands beside the lens or behind it is seen at the rim.
    const Eigen::Vector2d tangent = corner.head<2>() / std::max(corner.z(), 1e-3);
    const Eigen::Vector2d at = rays_.pixel(tangent) - Eigen::Vector2d(area_.left, area_.top);
    left = std::min(left, at.x());
    right = std::max(right, at.x());
    top = std::min(top, at.y());
    bottom = std::max(bottom, at.y());
  }
  // The lens bends the pyramid's edges by a pixel at most; an ellipse in the box about the corners would not
  // hold a cone that is cut off by the rim, so only the rounding of the box's own corners is left out there.
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

MetRow SolidLayer::Corners::met(int first) {
  return {depth_mm.data() + first,
          part.data() + first,
          {normal[0].data() + first, normal[1].data() + first, normal[2].data() + first}};
}

// From the leftmost to the rightmost pixel that a solid may cover in a block of rows, with one to spare each
// way.
std::array<int, 2> SolidLayer::span_of_block(int block) const {
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
void SolidLayer::trace_corners(int row, const std::array<int, 2>& span, const BoneRows& bone_rows,
                               Corners& corners) const {
  if (span[1] < span[0]) return;
  const int first = span[0] / kTogether * kTogether, end = padded(span[1] + 2);
  rays_.row(area_.left + first - 0.5, area_.top + row - 0.5, end - first, corners.x.data() + first,
            corners.y.data() + first);
  std::fill(corners.depth_mm.begin() + first, corners.depth_mm.begin() + end, kFar_mm);
  std::fill(corners.part.begin() + first, corners.part.begin() + end, 0);
  const int nearest_row = std::min(row, area_.height - 1);
  for (const Candidate& candidate : candidates_) {
    const auto& covered = candidate.spans[static_cast<std::size_t>(nearest_row)];
    if (covered[1] < covered[0]) continue;
    const int from = std::max(first, covered[0] / kTogether * kTogether);
    const int to = std::min(end, padded(covered[1] + 2));
    if (to <= from) continue;
    candidate.solid->meet(
        {corners.x.data() + from, corners.y.data() + from, bone_rows.depth_mm(nearest_row) + from}, to - from,
        candidate.first_part, corners.met(from));
  }
}

void SolidLayer::draw_rows(int first, int end, const BoneRows& bone_rows, Memory& memory,
                           float* light) const {
  if (candidates_.empty()) return;
  const auto room = static_cast<std::size_t>(padded(area_.width + 1));
  for (Corners* corners : {&memory.above_, &memory.below_}) {
    corners->part.resize(room);
    for (auto* values : {&corners->x, &corners->y, &corners->depth_mm, &corners->normal[0],
                         &corners->normal[1], &corners->normal[2]})
      values->resize(room);
  }
  memory.lit_.resize(3 * kTogether);
  memory.counts_.assign(looks_.size(), 0);
  std::array<int, 2> span{0, -1};
  for (int row = first; row < end; ++row) {
    if (row == first || row % kBlockRows == 0) {
      span = span_of_block(row / kBlockRows);
      trace_corners(row, span, bone_rows, memory.above_);
    } else {
      std::swap(memory.above_, memory.below_);
    }
    if (span[1] < span[0]) continue;
    trace_corners(row + 1, span, bone_rows, memory.below_);
    draw_row(row, span, bone_rows, memory, light + static_cast<std::ptrdiff_t>(3) * area_.width * row);
  }
}

void SolidLayer::draw_row(int row, const std::array<int, 2>& span, const BoneRows& bone_rows, Memory& memory,
                          float* out) const {
  Corners &above = memory.above_, &below = memory.below_;
  const std::int32_t *upper = above.part.data(), *lower = below.part.data();
  for (int first = span[0] / kTogether * kTogether; first <= span[1]; first += kTogether) {
    const int from = std::max(first, span[0]), last = std::min(first + kTogether - 1, span[1]);
    std::int32_t met = 0;
    for (int i = from; i <= last + 1; ++i) met |= upper[i] | lower[i];
    if (met == 0) continue;
    // Inside a face light changes slowly: that of the corner will do.
    float* const lit = memory.lit_.data();
    picture_kernel().light_parts(looks_.data(), {above.x.data() + first, above.y.data() + first, nullptr},
                                 kTogether, above.met(first), exposure_, lit);
    for (int i = from; i <= last; ++i) {
      float* const bgr = out + static_cast<std::ptrdiff_t>(3) * i;
      const std::int32_t part = upper[i];
      if (part != upper[i + 1] || part != lower[i] || part != lower[i + 1]) {
        supersample(row, i, bone_rows.depth_mm(row)[i], memory, bgr);
      } else if (part != 0) {
        std::copy_n(lit + static_cast<std::ptrdiff_t>(3) * (i - first), 3, bgr);
      }
    }
  }
}

// Mean light over the pixel's area; linear, so that an edge lies where its blurred profile says. A part of
// the pixel that is all one is shaded once. bgr: the ground's light, and then the mean.
void SolidLayer::supersample(int row, int column, float ground_mm, Memory& memory, float* bgr) const {
  const Corners &above = memory.above_, &below = memory.below_;
  const auto left = static_cast<std::size_t>(column), right = left + 1;
  const auto has_print = [&](const Corners& corners) {
    return is_print_[static_cast<std::size_t>(corners.part[left])] ||
           is_print_[static_cast<std::size_t>(corners.part[right])];
  };
  const int count = has_print(above) || has_print(below) ? kSamples : kPlainSamples, room = padded(count);

  // Within a pixel rays turn evenly: by what the corners' say.
  const auto middle = [&](const std::vector<float>& a, const std::vector<float>& b) {
    return 0.25f * (a[left] + a[right] + b[left] + b[right]);
  };
  const auto along = [&](const std::vector<float>& a, const std::vector<float>& b) {
    return 0.5f * (a[right] - a[left] + b[right] - b[left]);
  };
  const auto down = [&](const std::vector<float>& a, const std::vector<float>& b) {
    return 0.5f * (b[left] - a[left] + b[right] - a[right]);
  };
  const float x0 = middle(above.x, below.x), x_along = along(above.x, below.x),
              x_down = down(above.x, below.x);
  const float y0 = middle(above.y, below.y), y_along = along(above.y, below.y),
              y_down = down(above.y, below.y);
  constexpr int kRoom = padded(kSamples);
  alignas(32) float x[kRoom], y[kRoom], ground[kRoom], depth[kRoom], normal[3][kRoom];
  alignas(32) std::int32_t part[kRoom];
  const SamplePlaces& places = sample_places();
  for (int i = 0; i < room; ++i) {
    x[i] = x0 + places.x[i] * x_along + places.y[i] * x_down;
    y[i] = y0 + places.x[i] * y_along + places.y[i] * y_down;
    ground[i] = ground_mm;
    depth[i] = kFar_mm;
    part[i] = 0;
  }
  const MetRow met{depth, part, {normal[0], normal[1], normal[2]}};
  for (const Candidate& candidate : candidates_) {
    const auto& span = candidate.spans[static_cast<std::size_t>(row)];
    if (column < span[0] || column > span[1]) continue;
    candidate.solid->meet({x, y, ground}, room, candidate.first_part, met);
  }

  // One ray of each part is shaded, the first that met it.
  constexpr int kMostParts = kTogether;
  int firsts[kMostParts] = {}, part_count = 0;
  for (int i = 0; i < count; ++i) {
    int& met_count = memory.counts_[static_cast<std::size_t>(part[i])];
    if (met_count++ > 0 || part[i] == 0) continue;
    if (part_count < kMostParts) firsts[part_count++] = i;
  }
  if (part_count == 0) {
    memory.counts_[0] = 0;
    return;
  }
  alignas(32) float px[kTogether], py[kTogether], pdepth[kTogether], pnormal[3][kTogether];
  alignas(32) std::int32_t pparts[kTogether];
  float lit[3 * kTogether];
  for (int k = 0; k < kTogether; ++k) {
    const int i = firsts[k < part_count ? k : 0];
    px[k] = x[i];
    py[k] = y[i];
    pdepth[k] = depth[i];
    pparts[k] = part[i];
    for (int axis = 0; axis < 3; ++axis) pnormal[axis][k] = normal[axis][i];
  }
  picture_kernel().light_parts(looks_.data(), {px, py, nullptr}, kTogether,
                               {pdepth, pparts, {pnormal[0], pnormal[1], pnormal[2]}}, exposure_, lit);
  int covered = 0;
  float sum[3] = {};
  for (int k = 0; k < part_count; ++k) {
    int& met_count = memory.counts_[static_cast<std::size_t>(pparts[k])];
    covered += met_count;
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<float>(met_count) * lit[3 * k + c];
    met_count = 0;
  }
  // Of more parts than are shaded the ground stands in for the others.
  for (int i = 0; i < count; ++i) memory.counts_[static_cast<std::size_t>(part[i])] = 0;
  for (int c = 0; c < 3; ++c)
    bgr[c] = (sum[c] + static_cast<float>(count - covered) * bgr[c]) / static_cast<float>(count);
}

}  // namespace arthronaut::simulator
