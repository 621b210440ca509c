// What the bone's surface looked like where the registration said that it was: small pieces of the picture,
// each kept at its place on the bone, in the plane of the surface there. Seen again from elsewhere, a piece
// that does not lie where it lay tells how far the bone has moved against its marker since; how far the
// registration was off when the piece was kept, it does not tell.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/contour/edge_search.h"

namespace arthronaut::contour {

inline constexpr int kPieceHalf = 4;  // samples to each side of a piece's middle
inline constexpr int kPieceSide = 2 * kPieceHalf + 1;
inline constexpr int kShifts = 6;  // that it is looked for to each side
inline constexpr int kShiftSide = 2 * kShifts + 1;
inline constexpr double kPieceStep_mm = 0.3;  // of samples and shifts

// How alike the picture is, by shift (u first, then v): correlation, 0 where there is none, its mean over all
// shifts taken away.
struct ShiftMap {
  std::array<float, kShiftSide * kShiftSide> likeness{};
  // The shift, in steps along u and v, that a bone shows which lies t mm further: d shift / d t.
  Eigen::Matrix<float, 2, 3> shift_per_mm = Eigen::Matrix<float, 2, 3>::Zero();
  // The best correlation of the grain within one shift of none, 0 to 1. Of the grain alone, what is left of a
  // piece without its plane of brightness: how light falls off over a bone is much the same everywhere.
  float in_place = 0;
  bool is_as_clear = false;  // the picture there has about the contrast and brightness that it had
};

// Allocates nothing after the construction.
class SurfaceMemory {
 public:
  explicit SurfaceMemory(std::size_t place_count);

  // Compares the piece that is kept of a place with the picture. nullopt: none is kept, it was seen too
  // differently, or it cannot be seen now.
  [[nodiscard]] std::optional<ShiftMap> compare(std::size_t index, const SurfacePlace& place,
                                                const camera::GrayView& luma,
                                                const camera::CameraModel& camera,
                                                const geometry::RigidTransform& camera_from_bone,
                                                std::span<const Covered> covered) const;
  // Keeps what is seen of a place that nothing is kept of yet, where it can be told from its surroundings.
  // Returns whether it did.
  bool keep(std::size_t index, const SurfacePlace& place, const camera::GrayView& luma,
            const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_bone,
            std::span<const Covered> covered);
  [[nodiscard]] bool keeps(std::size_t index) const { return pieces_[index].is_kept; }
  // The grain of a place that something is kept of: rows along v, norm 1, without mean and slope.
  [[nodiscard]] const std::array<float, kPieceSide * kPieceSide>& grain(std::size_t index) const {
    return pieces_[index].grain;
  }
  [[nodiscard]] int count() const { return count_; }
  void forget();

 private:
  struct Piece {
    bool is_kept = false;
    float contrast = 0;                                    // of its grain, when it was kept
    float brightness = 0;                                  // then, above black
    Eigen::Vector3f to_eye = Eigen::Vector3f::Zero();      // in the bone's frame, mm, when it was kept
    std::array<float, kPieceSide * kPieceSide> samples{};  // mean 0, norm 1
    std::array<float, kPieceSide * kPieceSide> grain{};
  };
  std::vector<Piece> pieces_;
  int count_ = 0;
};

}  // namespace arthronaut::contour
