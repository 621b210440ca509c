#include "navigation/contour/surface_memory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arthronaut::contour {

namespace {

constexpr int kField = kPieceSide + 2 * kShifts;  // samples to a side of what is looked through
constexpr float kBlownOut = 245;
// Root mean square of a piece about its mean, over the mean plus a floor of noise and blacks: less is no
// texture.
constexpr float kLeastContrast = 0.012f, kDark = 10;
constexpr double kLeast_px_per_mm = 6;
// How much less, or more, contrast than it had a piece may show to be looked at for where it lies: a film, a
// smear or a highlight over it is no other place of the bone.
constexpr float kDimmer = 0.4f, kStarker = 2.5f;
// The same of its brightness: in the dark what is seen is the sensor's noise.
constexpr float kDarker = 0.5f, kBrighter = 2.5f;
// A piece is compared with what is seen from no other side, and neither much nearer nor much further off.
constexpr float kSameSide = 0.82f, kNearer = 0.6f, kFurther = 1.67f;

using Field = std::array<float, static_cast<std::size_t>(kField) * kField>;

// Samples [-half, half] about the place in the plane of its surface; false: not all of it can be seen.
bool read_field(const SurfacePlace& place, const camera::GrayView& luma, const camera::CameraModel& camera,
                const geometry::RigidTransform& camera_from_bone, std::span<const Covered> covered, int half,
                Field& field) {
  Eigen::Matrix<double, 2, 3> jacobian;
  const auto at = camera.project(camera_from_bone * place.in_bone_mm, jacobian);
  if (!at) return false;
  const Eigen::Vector2d u = jacobian * camera_from_bone.rotate(place.u) * kPieceStep_mm,
                        v = jacobian * camera_from_bone.rotate(place.v) * kPieceStep_mm;
  if (std::min(u.norm(), v.norm()) < kLeast_px_per_mm * kPieceStep_mm * 0.4) return false;
  // The piece itself and a little beside it; what lies further out is only looked through.
  constexpr int kClear = kPieceHalf + 2;
  for (const int i : {-kClear, 0, kClear})
    for (const int j : {-kClear, 0, kClear})
      if (!is_free(camera, covered, *at + i * u + j * v)) return false;
  // The mean of four pixels about a sample: what is finer than half a step tells nothing.
  const int spread = std::max(1, static_cast<int>(0.25 * std::min(u.norm(), v.norm())));
  std::size_t k = 0;
  for (int j = -half; j <= half; ++j) {
    for (int i = -half; i <= half; ++i, ++k) {
      const Eigen::Vector2d sample = *at + i * u + j * v;
      const int x = std::clamp(static_cast<int>(sample.x() + 0.5), spread, luma.width - 1 - spread),
                y = std::clamp(static_cast<int>(sample.y() + 0.5), spread, luma.height - 1 - spread);
      const std::uint8_t* const above = luma.row(y - spread);
      const std::uint8_t* const row = luma.row(y);
      const std::uint8_t* const below = luma.row(y + spread);
      field[k] = 0.125f * static_cast<float>(above[x - spread] + above[x + spread] + below[x - spread] +
                                             below[x + spread] + 4 * row[x]);
    }
  }
  return true;
}

using PieceSamples = std::array<float, static_cast<std::size_t>(kPieceSide) * kPieceSide>;

// Sum of the squares of -half ... half, over all rows.
constexpr float kSlopeSquares = kPieceSide * 2.0f * (1 + 4 + 9 + 16);
static_assert(kPieceHalf == 4, "kSlopeSquares");

// Of samples with mean 0 and norm 1. Returns what share of their root mean square is grain; the grain then
// has norm 1 as well.
float take_grain(const PieceSamples& samples, PieceSamples& grain) {
  float along_x = 0, along_y = 0;
  std::size_t k = 0;
  for (int y = -kPieceHalf; y <= kPieceHalf; ++y)
    for (int x = -kPieceHalf; x <= kPieceHalf; ++x, ++k) {
      along_x += static_cast<float>(x) * samples[k];
      along_y += static_cast<float>(y) * samples[k];
    }
  along_x /= kSlopeSquares;
  along_y /= kSlopeSquares;
  float squares = 0;
  k = 0;
  for (int y = -kPieceHalf; y <= kPieceHalf; ++y)
    for (int x = -kPieceHalf; x <= kPieceHalf; ++x, ++k) {
      grain[k] = samples[k] - along_x * static_cast<float>(x) - along_y * static_cast<float>(y);
      squares += grain[k] * grain[k];
    }
  const float norm = std::sqrt(squares);
  for (float& value : grain) value /= std::max(norm, 1e-6f);
  return norm;
}

// The grain about where the piece was kept, and its contrast there.
void hold_grain(const PieceSamples& grain, float contrast_then, float brightness_then, const Field& field,
                ShiftMap& map) {
  for (int dv = kShifts - 1; dv <= kShifts + 1; ++dv) {
    for (int du = kShifts - 1; du <= kShifts + 1; ++du) {
      float sum = 0, squares = 0, product = 0, along_x = 0, along_y = 0;
      for (int j = 0; j < kPieceSide; ++j) {
        const float* const row = field.data() + (dv + j) * kField + du;
        const float* const kept = grain.data() + j * kPieceSide;
        for (int i = 0; i < kPieceSide; ++i) {
          sum += row[i];
          squares += row[i] * row[i];
          product += row[i] * kept[i];
          along_x += static_cast<float>(i - kPieceHalf) * row[i];
          along_y += static_cast<float>(j - kPieceHalf) * row[i];
        }
      }
      constexpr float kCount = kPieceSide * kPieceSide;
      const float mean = sum / kCount;
      const float slope = (along_x * along_x + along_y * along_y) / kSlopeSquares;
      const float deviation = std::sqrt(std::max(0.0f, (squares - slope) / kCount - mean * mean));
      const float floor = 0.25f * kLeastContrast * (mean + kDark);
      map.in_place = std::max(map.in_place, product / (kPieceSide * std::max(deviation, floor)));
      if (du != kShifts || dv != kShifts) continue;
      const float contrast = deviation / (mean + kDark);
      const float brightness = (mean + kDark) / brightness_then;
      map.is_as_clear = contrast > kDimmer * contrast_then && contrast < kStarker * contrast_then &&
                        brightness > kDarker && brightness < kBrighter;
    }
  }
}

}  // namespace

SurfaceMemory::SurfaceMemory(std::size_t place_count) : pieces_(place_count) {}

void SurfaceMemory::forget() {
  for (Piece& piece : pieces_) piece.is_kept = false;
  count_ = 0;
}

bool SurfaceMemory::keep(std::size_t index, const SurfacePlace& place, const camera::GrayView& luma,
                         const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_bone,
                         std::span<const Covered> covered) {
  Piece& piece = pieces_[index];
  Field field;
  if (piece.is_kept || !read_field(place, luma, camera, camera_from_bone, covered, kPieceHalf, field))
    return false;
  const Eigen::Map<const Eigen::ArrayXf> seen(field.data(), kPieceSide * kPieceSide);
  if (seen.maxCoeff() > kBlownOut) return false;
  const float mean = seen.mean();
  const float deviation = std::sqrt((seen - mean).square().mean());
  if (deviation < kLeastContrast * (mean + kDark)) return false;
  Eigen::Map<Eigen::ArrayXf>(piece.samples.data(), kPieceSide * kPieceSide) =
      (seen - mean) / (deviation * kPieceSide);
  piece.to_eye = (camera_from_bone.inverse().translation_mm - place.in_bone_mm).cast<float>();
  piece.brightness = mean + kDark;
  piece.contrast = take_grain(piece.samples, piece.grain) * deviation / (mean + kDark);
  piece.is_kept = true;
  ++count_;
  return true;
}

std::optional<ShiftMap> SurfaceMemory::compare(std::size_t index, const SurfacePlace& place,
                                               const camera::GrayView& luma,
                                               const camera::CameraModel& camera,
                                               const geometry::RigidTransform& camera_from_bone,
                                               std::span<const Covered> covered) const {
  const Piece& piece = pieces_[index];
  if (!piece.is_kept) return std::nullopt;
  const Eigen::Vector3d to_eye = camera_from_bone.inverse().translation_mm - place.in_bone_mm;
  const float now = static_cast<float>(to_eye.norm()), then = piece.to_eye.norm();
  if (piece.to_eye.dot(to_eye.cast<float>()) < kSameSide * now * then || now < kNearer * then ||
      now > kFurther * then)
    return std::nullopt;
  Field field;
  if (!read_field(place, luma, camera, camera_from_bone, covered, kPieceHalf + kShifts, field))
    return std::nullopt;

  ShiftMap map;
  float total = 0;
  for (int dv = 0; dv < kShiftSide; ++dv) {
    for (int du = 0; du < kShiftSide; ++du) {
      float sum = 0, squares = 0, product = 0;
      for (int j = 0; j < kPieceSide; ++j) {
        const float* const row = field.data() + (dv + j) * kField + du;
        const float* const kept = piece.samples.data() + j * kPieceSide;
        for (int i = 0; i < kPieceSide; ++i) {
          sum += row[i];
          squares += row[i] * row[i];
          product += row[i] * kept[i];
        }
      }
      constexpr float kCount = kPieceSide * kPieceSide;
      const float mean = sum / kCount;
      const float deviation = std::sqrt(std::max(0.0f, squares / kCount - mean * mean));
      // Without contrast a likeness is one of noise.
      const float norm = kPieceSide * std::max(deviation, 0.5f * kLeastContrast * (mean + kDark));
      const float likeness = std::max(0.0f, product / norm);
      map.likeness[static_cast<std::size_t>(dv * kShiftSide + du)] = likeness;
      total += likeness;
    }
  }
  hold_grain(piece.grain, piece.contrast, piece.brightness, field, map);
  for (float& likeness : map.likeness) likeness -= total / (kShiftSide * kShiftSide);
  // What lies at p + t is seen where its line of sight meets the plane: p + t - r (n.t) / (n.r).
  const Eigen::Vector3d ray = to_eye.normalized();
  const Eigen::Matrix3d onto_plane =
      Eigen::Matrix3d::Identity() - ray * place.normal.transpose() / std::max(0.2, place.normal.dot(ray));
  map.shift_per_mm.row(0) = (place.u.transpose() * onto_plane / kPieceStep_mm).cast<float>();
  map.shift_per_mm.row(1) = (place.v.transpose() * onto_plane / kPieceStep_mm).cast<float>();
  return map;
}

}  // namespace arthronaut::contour
