#include "navigation/markers/code_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr int kMinKnownPoints = 30;
constexpr double kTurnRad = 0.16;  // of a step: the outermost cells move by half of their size
constexpr double kNearer = 1.1;
constexpr double kMinRange = 12;  // grey levels that the code must span
// Reach, in sides of the marker, from which on more turns are tried.
constexpr double kWide = 0.85;

// The pose seen elsewhere: the camera turned about itself.
std::optional<RigidTransform> shifted(const camera::CameraModel& camera, const RigidTransform& pose,
                                      const Eigen::Vector2d& to_px) {
  const auto ray = camera.ray(to_px);
  if (!ray) return std::nullopt;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(pose.translation_mm, *ray);
  return RigidTransform{turn, Eigen::Vector3d::Zero()} * pose;
}

}  // namespace

bool CodeSearch::place_points(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                              const RigidTransform& pose, double size_mm, const MarkerCode& code,
                              Eigen::Vector2i& center) {
  points_.clear();
  const auto small = [&](const Eigen::Vector2d& pixel) {
    const double middle = 0.5 * (picture.times - 1);
    return Eigen::Vector2d((pixel.x() - picture.left - middle) / picture.times,
                           (pixel.y() - picture.top - middle) / picture.times);
  };
  const auto origin = camera.project(pose.translation_mm);
  if (!origin) return false;
  center = small(*origin).array().round().cast<int>();
  left_ = right_ = top_ = bottom_ = 0;
  const int cells = code.cells;
  for (int row = -1; row <= cells; ++row) {
    for (int column = -1; column <= cells; ++column) {
      const Eigen::Vector3d place(((column + 0.5) / cells - 0.5) * size_mm,
                                  (0.5 - (row + 0.5) / cells) * size_mm, 0);
      const auto pixel = camera.project(pose * place);
      if (!pixel) return false;
      const Eigen::Vector2i there = small(*pixel).array().round().cast<int>() - center.array();
      const bool is_margin = row < 0 || column < 0 || row >= cells || column >= cells;
      points_.push_back({there.y() * picture.view.width + there.x(), there.x(), there.y(),
                         is_margin || code.is_bright(row, column)});
      left_ = std::min(left_, there.x());
      right_ = std::max(right_, there.x());
      top_ = std::min(top_, there.y());
      bottom_ = std::max(bottom_, there.y());
    }
  }
  return true;
}

namespace {

// What the points of a code see at one place, in whole numbers: their counts, and sums of grey levels.
struct Seen {
  unsigned count = 0, sum = 0, squares = 0, bright = 0, bright_sum = 0;

  [[nodiscard]] float score() const {
    if (count < kMinKnownPoints) return -1;
    const auto n = static_cast<float>(count), all = static_cast<float>(sum),
               in_bright = static_cast<float>(bright);
    const float spread = static_cast<float>(squares) - all * all / n,
                code_spread = in_bright - in_bright * in_bright / n;
    if (!(code_spread > 4) || spread < n * static_cast<float>(kMinRange * kMinRange / 4)) return -1;
    return (static_cast<float>(bright_sum) - in_bright * all / n) / std::sqrt(spread * code_spread);
  }
};

using Bytes = std::uint8_t __attribute__((vector_size(CodeSearch::kTogether)));
using Words = std::uint16_t __attribute__((vector_size(2 * CodeSearch::kTogether)));
using Wide = std::uint32_t __attribute__((vector_size(4 * CodeSearch::kTogether)));

// Every step-th of the bytes from here on; of the last lane all that lie before the next one may be read.
void read_lanes(const std::uint8_t* from, int step, Words& lanes) {
  if (step == 1) {
    Bytes bytes;
    std::memcpy(&bytes, from, sizeof bytes);
    lanes = __builtin_convertvector(bytes, Words);
  } else if (step == 2 && std::endian::native == std::endian::little) {
    std::memcpy(&lanes, from, sizeof lanes);
    lanes &= 0xFF;
  } else if (step == 4 && std::endian::native == std::endian::little) {
    Wide apart;
    std::memcpy(&apart, from, sizeof apart);
    lanes = __builtin_convertvector(apart & 0xFF, Words);
  } else {
    std::array<std::uint16_t, CodeSearch::kTogether> apart;
    for (int k = 0; k < CodeSearch::kTogether; ++k) apart[k] = from[k * step];
    std::memcpy(&lanes, apart.data(), sizeof lanes);
  }
}

}  // namespace

float CodeSearch::score_at(const SquareSearch::SmallPicture& picture, int x, int y) const {
  const bool is_inside =
      x + left_ >= 0 && y + top_ >= 0 && x + right_ < picture.view.width && y + bottom_ < picture.view.height;
  if (x < 0 || y < 0 || x >= picture.view.width || y >= picture.view.height) return -1;
  const std::uint8_t* middle = picture.view.row(y) + x;
  Seen seen;
  for (const Point& point : points_) {
    if (!is_inside && (x + point.dx < 0 || y + point.dy < 0 || x + point.dx >= picture.view.width ||
                       y + point.dy >= picture.view.height))
      continue;
    const unsigned grey = middle[point.offset];
    if (grey >= SquareSearch::kWhite) continue;
    ++seen.count;
    seen.sum += grey;
    seen.squares += grey * grey;
    seen.bright += point.is_bright;
    seen.bright_sum += point.is_bright * grey;
  }
  return seen.score();
}

// The same sums in lanes that the processor adds up at once: most of a search is these loops.
void CodeSearch::score_row(const SquareSearch::SmallPicture& picture, int x, int y, int step,
                           std::array<float, kTogether>& scores) const {
  const int last = x + kTogether * step - 1;
  if (x + left_ < 0 || y + top_ < 0 || last + right_ >= picture.view.width ||
      y + bottom_ >= picture.view.height) {
    for (int k = 0; k < kTogether; ++k) scores[k] = score_at(picture, x + k * step, y);
    return;
  }
  static_assert((SquareSearch::kWhite - 1) * (SquareSearch::kWhite - 1) < 1 << 16);
  static_assert((kMaxCells + 2) * (kMaxCells + 2) * SquareSearch::kWhite < 1 << 16);
  Words count{}, sum{}, bright{}, bright_sum{};
  Wide squares{};
  const std::uint8_t* middle = picture.view.row(y) + x;
  for (const Point& point : points_) {
    Words grey;
    read_lanes(middle + point.offset, step, grey);
    const Words is_known = reinterpret_cast<Words>(grey < SquareSearch::kWhite);  // all bits, or none
    grey &= is_known;
    count -= is_known;
    sum += grey;
    squares += __builtin_convertvector(grey * grey, Wide);
    if (!point.is_bright) continue;
    bright -= is_known;
    bright_sum += grey;
  }
  for (int k = 0; k < kTogether; ++k)
    scores[k] = Seen{count[k], sum[k], squares[k], bright[k], bright_sum[k]}.score();
}

CodePlace CodeSearch::find(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                           const RigidTransform& supposed, double size_mm, const MarkerCode& code,
                           double reach_px) {
  CodePlace best;
  if (!(supposed.translation_mm.z() > 0) || picture.view.width <= 0) return best;
  const double side_px = camera.central_focal_px() * size_mm / supposed.translation_mm.z();
  const double cell = side_px / code.cells / picture.times;
  const int step = std::clamp(static_cast<int>(0.45 * cell), 1, 4);
  const int reach = static_cast<int>(std::ceil(reach_px / picture.times));
  const bool is_wide = reach_px > kWide * side_px;
  const int turns = is_wide ? 2 : 1, distances = is_wide ? 1 : 0;
  Eigen::Vector2i best_shift(0, 0);
  RigidTransform best_pose = supposed;
  Eigen::Vector2i center;
  std::array<float, kTogether> scores;
  for (int turn = -turns; turn <= turns; ++turn) {
    for (int distance = -distances; distance <= distances; ++distance) {
      RigidTransform pose = supposed;
      pose.rotation =
          pose.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(turn * kTurnRad, Eigen::Vector3d::UnitZ()));
      pose.translation_mm *= std::pow(kNearer, distance);
      if (!place_points(picture, camera, pose, size_mm, code, center)) continue;
      for (int dy = -reach; dy <= reach; dy += step) {
        for (int first = -reach; first <= reach; first += kTogether * step) {
          score_row(picture, center.x() + first, center.y() + dy, step, scores);
          for (int k = 0; k < kTogether && first + k * step <= reach; ++k) {
            if (scores[k] <= best.score) continue;
            best.score = scores[k];
            best_shift = {first + k * step, dy};
            best_pose = pose;
          }
        }
      }
    }
  }
  if (best.score < 0.8 * kMinScore) return CodePlace();
  // Finer, about the best.
  if (!place_points(picture, camera, best_pose, size_mm, code, center)) return CodePlace();
  const Eigen::Vector2i coarse = best_shift;
  for (int dy = -step + 1; dy < step; ++dy) {
    for (int dx = -step + 1; dx < step; ++dx) {
      const double score = score_at(picture, center.x() + coarse.x() + dx, center.y() + coarse.y() + dy);
      if (score <= best.score) continue;
      best.score = score;
      best_shift = coarse + Eigen::Vector2i(dx, dy);
    }
  }
  const auto from = camera.project(best_pose.translation_mm);
  const auto there =
      from ? shifted(camera, best_pose, *from + picture.times * best_shift.cast<double>()) : std::nullopt;
  if (!there) return CodePlace();
  best.camera_from_marker = *there;
  return best;
}

}  // namespace arthronaut::markers
