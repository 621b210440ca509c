#include "navigation/simulator/solid_layer.h"

#include <algorithm>
#include <bit>
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

struct R2Places {
  alignas(32) float x[padded(kSamples)] = {}, y[padded(kSamples)] = {};
};
SamplePlaces sample_places() {
  static const R2Places kPlaces = [] {
    R2Places places;
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
  return {kPlaces.x, kPlaces.y};
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

void SolidLayer::Corners::resize(std::size_t size) {
  part.resize(size, 0);
  for (auto* values : {&x, &y, &depth_mm, &normal[0], &normal[1], &normal[2]}) values->resize(size, 0.0f);
}

void SolidLayer::Corners::push_back(float at_x, float at_y, float at_depth_mm, std::int32_t met_part,
                                    const std::array<float, 3>& met_normal) {
  x.push_back(at_x);
  y.push_back(at_y);
  depth_mm.push_back(at_depth_mm);
  part.push_back(met_part);
  for (std::size_t axis = 0; axis < 3; ++axis) normal[axis].push_back(met_normal[axis]);
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
  const auto room = static_cast<std::size_t>(padded(area_.width + 1) + kTogether);
  for (Corners* corners : {&memory.above_, &memory.below_}) corners->resize(room);
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
    float* const out = light + static_cast<std::ptrdiff_t>(3) * area_.width * row;
    draw_row(row, span, bone_rows, memory, out);
    mix_samples(memory, out);
  }
}

// Faces are lit at once; pixels where parts meet are sampled, and wait for mix_samples.
void SolidLayer::draw_row(int row, const std::array<int, 2>& span, const BoneRows& bone_rows, Memory& memory,
                          float* out) const {
  Corners& above = memory.above_;
  const PictureKernel& kernel = picture_kernel();
  constexpr std::uint32_t kAll = (1U << kTogether) - 1;
  for (int first = span[0] / kTogether * kTogether; first <= span[1]; first += kTogether) {
    const int from = std::max(first, span[0]) - first, last = std::min(kTogether - 1, span[1] - first);
    const std::uint32_t within = kAll >> (kTogether - 1 - last) & kAll << from;
    auto [is_seam, is_face] = kernel.seams(above.part.data() + first, memory.below_.part.data() + first);
    is_seam &= within;
    is_face &= within;
    // Inside a face light changes slowly: that of the corner will do.
    if (is_face != 0) {
      float* const bgr = out + static_cast<std::ptrdiff_t>(3) * first;
      float lit[3 * kTogether];
      kernel.light_parts(looks_.data(), {above.x.data() + first, above.y.data() + first, nullptr}, kTogether,
                         above.met(first), exposure_, is_face == kAll ? bgr : lit);
      if (is_face != kAll)
        for (; is_face != 0; is_face &= is_face - 1)
          std::copy_n(lit + 3 * std::countr_zero(is_face), 3, bgr + 3 * std::countr_zero(is_face));
    }
    for (; is_seam != 0; is_seam &= is_seam - 1) {
      const int column = first + std::countr_zero(is_seam);
      sample(row, column, bone_rows.depth_mm(row)[column], memory);
    }
  }
}

// What is in a pixel, by samples. Of each part one ray is kept to be shaded, the first that met it.
void SolidLayer::sample(int row, int column, float ground_mm, Memory& memory) const {
  const Corners &above = memory.above_, &below = memory.below_;
  const auto left = static_cast<std::size_t>(column), right = left + 1;
  const auto has_print = [&](const Corners& corners) {
    return is_print_[static_cast<std::size_t>(corners.part[left])] ||
           is_print_[static_cast<std::size_t>(corners.part[right])];
  };
  const int count = has_print(above) || has_print(below) ? kSamples : kPlainSamples, room = padded(count);

  // Within a pixel rays turn evenly: by what the corners' say.
  PixelRays pixel;
  const auto put = [&](int axis, const std::vector<float>& a, const std::vector<float>& b) {
    pixel.middle[axis] = 0.25f * (a[left] + a[right] + b[left] + b[right]);
    pixel.along[axis] = 0.5f * (a[right] - a[left] + b[right] - b[left]);
    pixel.down[axis] = 0.5f * (b[left] - a[left] + b[right] - a[right]);
  };
  put(0, above.x, below.x);
  put(1, above.y, below.y);
  constexpr int kRoom = padded(kSamples);
  alignas(32) float x[kRoom], y[kRoom], ground[kRoom], depth[kRoom], normal[3][kRoom];
  alignas(32) std::int32_t part[kRoom];
  const MetRow met{depth, part, {normal[0], normal[1], normal[2]}};
  const PictureKernel& kernel = picture_kernel();
  kernel.begin_samples(pixel, sample_places(), room, ground_mm, kFar_mm, x, y, ground, met);
  for (const Candidate& candidate : candidates_) {
    const auto& span = candidate.spans[static_cast<std::size_t>(row)];
    if (column < span[0] || column > span[1]) continue;
    candidate.solid->meet({x, y, ground}, room, candidate.first_part, met);
  }

  // Of more parts than are kept the ground stands in for the others.
  constexpr int kMostParts = 8;
  PartCount counts[kMostParts];
  const int part_count = kernel.count_parts(part, count, kMostParts, counts);
  if (part_count == 0) return;
  memory.sampled_.push_back({column, count, part_count});
  for (int k = 0; k < part_count; ++k) {
    const auto i = static_cast<std::size_t>(counts[k].first_sample);
    memory.counts_.push_back(counts[k].count);
    memory.kept_.push_back(x[i], y[i], depth[i], part[i], {normal[0][i], normal[1][i], normal[2][i]});
  }
}

// Mean light over the area of each sampled pixel, of its parts and the ground's, which `out` holds; linear,
// so that an edge lies where its blurred profile says.
void SolidLayer::mix_samples(Memory& memory, float* out) const {
  const int kept_count = static_cast<int>(memory.counts_.size());
  if (kept_count == 0) return;
  Corners& kept = memory.kept_;
  kept.resize(static_cast<std::size_t>(padded(kept_count)));  // what is beyond is of part 0
  memory.lit_.resize(3 * kept.part.size());
  picture_kernel().light_parts(looks_.data(), {kept.x.data(), kept.y.data(), nullptr}, padded(kept_count),
                               kept.met(0), exposure_, memory.lit_.data());
  const float* lit = memory.lit_.data();
  const int* count = memory.counts_.data();
  for (const Sampled& pixel : memory.sampled_) {
    float* const bgr = out + static_cast<std::ptrdiff_t>(3) * pixel.column;
    int covered = 0;
    float sum[3] = {};
    for (int k = 0; k < pixel.part_count; ++k, lit += 3, ++count) {
      covered += *count;
      for (int c = 0; c < 3; ++c) sum[c] += static_cast<float>(*count) * lit[c];
    }
    for (int c = 0; c < 3; ++c)
      bgr[c] = (sum[c] + static_cast<float>(pixel.sample_count - covered) * bgr[c]) /
               static_cast<float>(pixel.sample_count);
  }
  memory.sampled_.clear();
  memory.counts_.clear();
  kept.resize(0);
}

}  // namespace arthronaut::simulator
