#include "navigation/contour/knock_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace arthronaut::contour {

namespace {

constexpr double kAcross_mm = 0.42, kAlong_mm = 3;  // of a step across the line of sight, and along it
constexpr double kKnockReach_mm = 8.6;
constexpr double kCell_mm = 0.2;
constexpr int kSmallestCell_px = 2;
constexpr std::size_t kMostPieces = 28;
constexpr std::size_t kLooksPerFrame = 28;  // a look: one piece in one layer
constexpr float kLeastGrain = 0.003f, kBlack = 10;
constexpr double kInPlace_mm = 1.0, kApart_mm = 2.0;

// Columns and rows of a piece's samples, from its middle, and the sum of the squares of either.
constexpr std::array<float, 25> kAlongX{-2, -1, 0,  1,  2, -2, -1, 0,  1,  2, -2, -1, 0,
                                        1,  2,  -2, -1, 0, 1,  2,  -2, -1, 0, 1,  2};
constexpr std::array<float, 25> kAlongY{-2, -2, -2, -2, -2, -1, -1, -1, -1, -1, 0, 0, 0,
                                        0,  0,  1,  1,  1,  1,  1,  2,  2,  2,  2, 2};
constexpr float kSlopes = 50;

// Mean and slope; then norm 1. Whether anything is left.
bool take_slope_away(std::array<float, 25>& samples) {
  float mean = 0, along_x = 0, along_y = 0, squares = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    mean += samples[k] / 25;
    along_x += samples[k] * kAlongX[k] / kSlopes;
    along_y += samples[k] * kAlongY[k] / kSlopes;
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k] -= mean + along_x * kAlongX[k] + along_y * kAlongY[k];
    squares += samples[k] * samples[k];
  }
  if (squares < 1e-6f) return false;
  for (float& value : samples) value /= std::sqrt(squares);
  return true;
}

}  // namespace

KnockSearch::KnockSearch() {
  pieces_.reserve(kMostPieces);
  score_.resize(static_cast<std::size_t>(kLayers) * kRow * kRow);
}

void KnockSearch::reserve_for(const Eigen::Vector2i& image_size_px) {
  const std::size_t width = static_cast<std::size_t>(image_size_px.x()) / kSmallestCell_px + 1,
                    height = static_cast<std::size_t>(image_size_px.y()) / kSmallestCell_px + 1;
  small_.luma.reserve(width * height);
  small_.sums.reserve(width);
}

void KnockSearch::clear() {
  pieces_.clear();
  next_ = 0;
}

void KnockSearch::shrink(const camera::GrayView& luma, int cell_px) {
  small_.cell_px = cell_px;
  small_.width = luma.width / cell_px;
  small_.height = luma.height / cell_px;
  const auto width = static_cast<std::size_t>(small_.width);
  small_.luma.resize(width * static_cast<std::size_t>(small_.height));
  small_.sums.resize(width);
  const float share = 1.0f / static_cast<float>(cell_px * cell_px);
  for (int y = 0; y < small_.height; ++y) {
    std::fill(small_.sums.begin(), small_.sums.end(), 0U);
    for (int k = 0; k < cell_px; ++k) {
      const std::uint8_t* pixel = luma.row(y * cell_px + k);
      for (std::size_t x = 0; x < width; ++x, pixel += cell_px) {
        std::uint32_t sum = 0;
        for (int i = 0; i < cell_px; ++i) sum += pixel[i];
        small_.sums[x] += sum;
      }
    }
    float* const row = small_.luma.data() + static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x) row[x] = share * static_cast<float>(small_.sums[x]);
  }
}

void KnockSearch::begin(const VisibleBone& visible, const SurfaceMemory& memory, const camera::GrayView& luma,
                        const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_bone) {
  clear();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  int kept = 0;
  for (const std::int32_t seen : visible.places_seen()) kept += memory.keeps(static_cast<std::size_t>(seen));
  int at = 0;
  for (const std::int32_t seen : visible.places_seen()) {
    const auto index = static_cast<std::size_t>(seen);
    if (!memory.keeps(index)) continue;
    // Evenly of those there are.
    constexpr auto kMost = static_cast<int>(kMostPieces);
    if (kept > kMost && (at * kMost) / kept == ((at + 1) * kMost) / kept) {
      ++at;
      continue;
    }
    ++at;
    if (pieces_.size() == kMostPieces) break;
    const SurfacePlace& place = visible.places()[index];
    Wanted piece;
    piece.in_camera_mm = camera_from_bone * place.in_bone_mm;
    piece.u_in_camera = camera_from_bone.rotate(place.u);
    piece.v_in_camera = camera_from_bone.rotate(place.v);
    const auto& samples = memory.grain(index);
    static_assert(2 * kSide - 1 == kPieceSide, "every second sample of a piece");
    for (std::size_t j = 0; j < kSide; ++j)
      for (std::size_t i = 0; i < kSide; ++i)
        piece.samples[j * kSide + i] = samples[2 * j * kPieceSide + 2 * i];
    if (!take_slope_away(piece.samples)) continue;
    pieces_.push_back(piece);
    middle += piece.in_camera_mm;
  }
  if (pieces_.empty()) return;
  camera_ = camera;
  const Eigen::Vector3d ray = middle.normalized();
  across_.col(0) = ray.unitOrthogonal();
  across_.col(1) = ray.cross(across_.col(0));
  across_.col(2) = ray;
  bone_from_camera_ = camera_from_bone.inverse().matrix();
  std::fill(score_.begin(), score_.end(), 0.0f);
  const double px_per_mm =
      camera.central_focal_px() / std::max(1.0, middle.norm() / static_cast<double>(pieces_.size()));
  shrink(luma, std::clamp(static_cast<int>(kCell_mm * px_per_mm + 0.5), kSmallestCell_px, 32));
}

bool KnockSearch::advance() {
  if (!is_under_way()) return false;
  const std::size_t end = std::min(pieces_.size() * kLayers, next_ + kLooksPerFrame);
  for (; next_ < end; ++next_) look_for(pieces_[next_ / kLayers], static_cast<int>(next_ % kLayers));
  if (is_under_way()) return false;
  conclude();
  return true;
}

Eigen::Vector3d KnockSearch::displacement_in_camera(int x, int y, int layer) const {
  return across_ * Eigen::Vector3d(kAcross_mm * (x - kReach), kAcross_mm * (y - kReach),
                                   kAlong_mm * (layer - kLayers / 2));
}

void KnockSearch::look_for(const Wanted& piece, int layer) {
  // Where the piece would be seen, by displacement: nine places, and a parabola through them each way.
  std::array<Eigen::Vector2d, 9> at;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const auto pixel =
          camera_.project(piece.in_camera_mm + displacement_in_camera(i * kReach, j * kReach, layer));
      if (!pixel) return;
      at[static_cast<std::size_t>(3 * j + i)] = *pixel;
    }
  Eigen::Matrix<double, 2, 3> jacobian;
  const Eigen::Vector3d middle = piece.in_camera_mm + displacement_in_camera(kReach, kReach, layer);
  if (!camera_.project(middle, jacobian)) return;
  const double per_cell = 1.0 / small_.cell_px;
  const Eigen::Vector2d u = jacobian * piece.u_in_camera * (2 * kPieceStep_mm * per_cell),
                        v = jacobian * piece.v_in_camera * (2 * kPieceStep_mm * per_cell);
  std::array<int, kSide * kSide> offsets;
  int reach_x = 0, reach_y = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Eigen::Vector2d offset = (i - kSide / 2) * u + (j - kSide / 2) * v;
      const int dx = static_cast<int>(std::lround(offset.x())),
                dy = static_cast<int>(std::lround(offset.y()));
      offsets[static_cast<std::size_t>(j * kSide + i)] = dy * small_.width + dx;
      reach_x = std::max(reach_x, std::abs(dx));
      reach_y = std::max(reach_y, std::abs(dy));
    }

  const double along_mm = kAlong_mm * (layer - kLayers / 2);
  const double steps =
      std::sqrt(std::max(0.0, kKnockReach_mm * kKnockReach_mm - along_mm * along_mm)) / kAcross_mm;
  const auto to_cell = [&](const Eigen::Vector2d& pixel) {
    return Eigen::Vector2f(((pixel.array() + 0.5) * per_cell - 0.5).matrix().cast<float>());
  };
  for (int y = 0; y < kRow; ++y) {
    const float b = static_cast<float>(y - kReach) / kReach;
    std::array<Eigen::Vector2f, 3> on_row;
    for (std::size_t i = 0; i < 3; ++i)
      on_row[i] = to_cell(at[i]) * (0.5f * b * (b - 1)) + to_cell(at[3 + i]) * (1 - b * b) +
                  to_cell(at[6 + i]) * (0.5f * b * (b + 1));
    const Eigen::Vector2f slope = 0.5f * (on_row[2] - on_row[0]),
                          bend = 0.5f * (on_row[2] + on_row[0]) - on_row[1];
    const double rest = steps * steps - (y - kReach) * (y - kReach);
    if (rest < 0) continue;
    const int half = std::min(kReach, static_cast<int>(std::sqrt(rest)));
    for (int x = kReach - half; x <= kReach + half; ++x) {
      const float a = static_cast<float>(x - kReach) / kReach;
      const Eigen::Vector2f cell = on_row[1] + a * slope + a * a * bend;
      const int cx = static_cast<int>(cell.x() + 0.5f), cy = static_cast<int>(cell.y() + 0.5f);
      if (cx < reach_x || cy < reach_y || cx >= small_.width - reach_x || cy >= small_.height - reach_y)
        continue;
      const float* const here = small_.luma.data() + static_cast<std::ptrdiff_t>(cy) * small_.width + cx;
      float sum = 0, squares = 0, product = 0, along_x = 0, along_y = 0;
      for (std::size_t k = 0; k < offsets.size(); ++k) {
        const float value = here[offsets[k]];
        sum += value;
        squares += value * value;
        product += value * piece.samples[k];
        along_x += value * kAlongX[k];
        along_y += value * kAlongY[k];
      }
      constexpr float kCount = kSide * kSide;
      const float mean = sum / kCount;
      const float sloping = (along_x * along_x + along_y * along_y) / kSlopes;
      const float deviation = std::sqrt(std::max(0.0f, (squares - sloping) / kCount - mean * mean));
      const float norm = kSide * std::max(deviation, kLeastGrain * (mean + kBlack));
      const auto place = (static_cast<std::size_t>(layer) * kRow + static_cast<std::size_t>(y)) * kRow +
                         static_cast<std::size_t>(x);
      score_[place] += product / norm;
    }
  }
}

void KnockSearch::conclude() {
  constexpr float kAsWell = 0.04f;
  found_ = {};
  found_.pieces = static_cast<int>(pieces_.size());
  found_.ray_in_bone = bone_from_camera_ * across_.col(2);
  const auto each = [&](const auto& visit) {
    std::size_t place = 0;
    for (int layer = 0; layer < kLayers; ++layer)
      for (int y = 0; y < kRow; ++y)
        for (int x = 0; x < kRow; ++x, ++place) visit(place, displacement_in_camera(x, y, layer));
  };
  float best = 0, in_place = 0, elsewhere = 0;
  each([&](std::size_t place, const Eigen::Vector3d& by_mm) {
    best = std::max(best, score_[place]);
    if (by_mm.norm() <= kInPlace_mm) in_place = std::max(in_place, score_[place]);
  });
  double nearest_mm = 1e9;
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
  each([&](std::size_t place, const Eigen::Vector3d& by_mm) {
    if (score_[place] < best * (1 - kAsWell) || by_mm.norm() >= nearest_mm) return;
    nearest_mm = by_mm.norm();
    nearest = by_mm;
  });
  const Eigen::Vector3d ray = across_.col(2);
  each([&](std::size_t place, const Eigen::Vector3d& by_mm) {
    const Eigen::Vector3d from_best = by_mm - nearest;
    const double apart_mm = (from_best - ray * ray.dot(from_best)).norm();
    if (apart_mm >= kApart_mm) elsewhere = std::max(elsewhere, score_[place]);
  });
  found_.offset_in_bone_mm = bone_from_camera_ * nearest;
  found_.best = best;
  found_.in_place = in_place;
  found_.elsewhere = elsewhere;
}

}  // namespace arthronaut::contour
