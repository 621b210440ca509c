// The innermost loops of the direct fit, eight pixels at a time. Plain numbers and nothing else: the same
// code is compiled for every processor and for those with AVX2, and processor_has_avx2() says which may run.
// Both do the same operations in the same order, so they give the same bits.
#pragma once

#include <cstdint>

namespace arthronaut::markers {

inline constexpr int kPixelsTogether = 8;

// The printed code and where it stands at each moment of the exposure. See exposed_code.h.
struct ExposedMoments {
  static constexpr int kMost = 12;
  struct Moment {
    float marker_from_camera[9];  // rotation, row by row
    float eye[3];                 // the camera's centre in the marker frame
    float time;
  };
  Moment moments[kMost];
  int count = 0;
  int cells = 0, width = 0;
  float cells_per_mm = 0;
  // By row and column with two cells of margin about the code, width x width: bits 0 to 8 are the cell and
  // its neighbours, row by row, 1 where they are bright.
  std::uint16_t neighbours[14 * 14];
};

struct LookedAt {
  alignas(32) float ray_x[kPixelsTogether], ray_y[kPixelsTogether], ray_z[kPixelsTogether];
  alignas(32) float sigma_x[kPixelsTogether], sigma_y[kPixelsTogether];  // of the smear, in cells
};

// As ExposedCode::Level.
struct SeenLevels {
  alignas(32) float level[kPixelsTogether], by_smear[kPixelsTogether];
  alignas(32) float by_pose[6][kPixelsTogether],
      by_velocity[3][kPixelsTogether], by_change[3][kPixelsTogether];
};

[[nodiscard]] bool processor_has_avx2();

void look_at_code(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen);
void look_at_code_avx2(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen);

// Adds row * row^T of eight rows to the sum, of which the half below the diagonal counts: the unknowns are
// padded to kProductSize.
inline constexpr int kProductSize = 32;
void add_products(const float (&rows)[kPixelsTogether][kProductSize],
                  float (&sum)[kProductSize][kProductSize]);
void add_products_avx2(const float (&rows)[kPixelsTogether][kProductSize],
                       float (&sum)[kProductSize][kProductSize]);

}  // namespace arthronaut::markers
