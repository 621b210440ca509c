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

// Of the code at each pixel, with its derivatives: by the pose's body twist; by velocity and change along x
// and y and about the normal; by the logarithm of the smear.
struct SeenLevels {
  alignas(32) float level[kPixelsTogether], by_smear[kPixelsTogether];
  alignas(32) float by_pose[6][kPixelsTogether],
      by_velocity[3][kPixelsTogether], by_change[3][kPixelsTogether];
};

// Pixels beside what the direct fit takes them for.
struct SeenPixels {
  alignas(32) float grey[kPixelsTogether], place_x[kPixelsTogether], place_y[kPixelsTogether];
  alignas(32) float weight[kPixelsTogether];
};

// The unknowns of the direct fit: pose (6), smear, gamma, the light: bias (cubic) and gain (quadratic) as
// polynomials of the place; and, last, velocity and its change over the exposure (x, y, about the normal), of
// which a picture of one moment says nothing.
struct DirectUnknowns {
  static constexpr int kBiasTerms = 10, kGainTerms = 6, kLightTerms = kBiasTerms + kGainTerms;
  static constexpr int kSmear = 6, kGamma = 7, kLight = 8;
  static constexpr int kVelocity = kLight + kLightTerms, kChange = kVelocity + 3, kCount = kChange + 3;
};

// The light as the fit has it.
struct FittedLight {
  float terms[DirectUnknowns::kLightTerms];  // of the bias, and of the gain
  float gamma = 1;
  float noise = 1;          // grey levels: what is off by some of it weighs less
  bool has_weights = true;  // those of the pixels are taken instead
};

// The unknowns are padded to kProductSize.
inline constexpr int kProductSize = 32;
struct ExplainedPixels {
  alignas(32) float residual[kPixelsTogether], weight[kPixelsTogether];
  alignas(32) float code[kPixelsTogether];  // the code's part of the grey level, about the middle
  // The derivatives of the grey level by the unknowns, times the root of the weight.
  alignas(32) float rows[kPixelsTogether][kProductSize];
};

[[nodiscard]] bool processor_has_avx2();

void look_at_code(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen);
void look_at_code_avx2(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen);
// The level alone, the same to the bit; what else SeenLevels holds is left as it was.
void look_at_level(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen);
void look_at_level_avx2(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen);

void explain_pixels(const FittedLight& light, const SeenPixels& pixels, const SeenLevels& levels,
                    ExplainedPixels& explained);
void explain_pixels_avx2(const FittedLight& light, const SeenPixels& pixels, const SeenLevels& levels,
                         ExplainedPixels& explained);

// Adds row * row^T of eight rows to the sum, of which the half below the diagonal counts; of the rows' first
// `count` numbers, a multiple of eight: beyond them all are zero.
void add_products(const float (&rows)[kPixelsTogether][kProductSize], int count,
                  float (&sum)[kProductSize][kProductSize]);
void add_products_avx2(const float (&rows)[kPixelsTogether][kProductSize], int count,
                       float (&sum)[kProductSize][kProductSize]);

}  // namespace arthronaut::markers
