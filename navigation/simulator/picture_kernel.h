// The innermost loops of a drawn picture, eight pixels at a time. Plain numbers and nothing else: the same
// code is compiled for every processor and for those with AVX2, and picture_kernel() gives what this one can
// run. Both do the same operations in the same order, so they draw the same bits.
//
// Where nothing else is said, counts are multiples of kTogether, arrays hold that many values, and frames are
// the camera's, mm.
#pragma once

#include <cstdint>

namespace arthronaut::simulator {

inline constexpr int kTogether = 8;
[[nodiscard]] constexpr int padded(int count) { return (count + kTogether - 1) / kTogether * kTogether; }

// Beside the lens, as the fibres of a real scope are.
inline constexpr float kLightPosition_mm[3] = {0.9f, -1.3f, 0.0f};
// Nothing is seen closer than this.
inline constexpr float kNearest_mm = 0.5f;

// Rays (x, y, 1) from the lens, and how far each goes to the bone, along z.
struct RayRow {
  const float *x = nullptr, *y = nullptr, *ground_mm = nullptr;
};

// What rays have met, nearest so far. part 0: nothing.
struct MetRow {
  float* depth_mm = nullptr;  // along z
  std::int32_t* part = nullptr;
  float* normal[3] = {};
};

// How a part of a solid answers light.
struct PartLook {
  float albedo_bgr[3] = {};
  float specular = 0;
  std::int32_t gloss_doublings = 0;  // at most kMostDoublings
  static constexpr int kMostDoublings = 7;
};

// A printed square on a plate. The cell in row r and column c is white where bit c + r * count of the words
// is set.
struct PrintNumbers {
  float center_mm[2] = {};
  float cells_per_mm = 0;
  std::int32_t count = 0;
  static constexpr int kWords = 8;
  std::int32_t words[kWords] = {};
};

struct PlateNumbers {
  float axes[3][3] = {};    // of the plate, in the camera frame
  float origin_mm[3] = {};  // the camera, in the plate's frame
  float half_size_mm[2] = {};
  float thickness_mm = 0, tick_spacing_mm = 0, yields_mm = 0;
  bool is_round = false;
  const PrintNumbers* prints = nullptr;
  int print_count = 0;
};

struct RodNumbers {
  float from_mm[3] = {}, along[3] = {};
  float radius_mm = 0, length_mm = 0, yields_mm = 0;
};

struct BoardNumbers {
  float axes[3][3] = {};
  float origin_mm[3] = {};
  float square_mm = 0, yields_mm = 0;
};

// Parts of plate and board, counted from the first; a rod is all one.
enum Region : std::int32_t { kPaper, kInk, kSide, kRegions };

// Rays within a pixel: that of its middle, and by how much they turn from its left side to its right one, and
// from its upper side to its lower one.
struct PixelRays {
  float middle[2] = {}, along[2] = {}, down[2] = {};
};
// Where a pixel is sampled: px, about its middle.
struct SamplePlaces {
  const float *x = nullptr, *y = nullptr;
};
// What samples of a pixel have met of one part.
struct PartCount {
  std::int32_t part = 0, first_sample = 0, count = 0;
};

// Bit k: of the pixel in column first + k.
struct Seams {
  std::uint32_t is_seam = 0;  // its corners have met different parts
  std::uint32_t is_face = 0;  // they have all met the same one, which is not 0
};

// A triangle in one row of the picture: shares of its second and third corner, and depth by shares.
struct TriangleRow {
  std::int32_t triangle = 0;
  float share_b = 0, share_b_step = 0, share_c = 0, share_c_step = 0;  // at column 0, by column
  float depth_mm = 0, depth_b_mm = 0, depth_c_mm = 0;
};

// By place on the bone.
struct BoneAttributes {
  enum { kCamera, kNormal = 3, kBone = 6, kRedness = 9, kCount = 10 };
  const float* at[kCount] = {};  // camera frame, normal there, bone frame, redness
};

// Smooth random values in four channels on a periodic lattice of kLattice^3 nodes; each row of nodes ends
// with its first one once more.
inline constexpr int kLattice = 32;  // a power of two
inline constexpr int kLatticeFloats = kLattice * kLattice * (kLattice + 1) * 4;

// By grey level.
struct ToneNumbers {
  float read_variance = 0, shot_share = 0;
};

inline constexpr int kBlurReach = 3;  // rows, and pixels, each way

struct PictureKernel {
  // Each takes what is nearer than what was met so far and not hidden by the bone; parts count from
  // first_part.
  void (*meet_plate)(const PlateNumbers& plate, const RayRow& rays, int count, int first_part,
                     const MetRow& met);
  void (*meet_rod)(const RodNumbers& rod, const RayRow& rays, int count, int first_part, const MetRow& met);
  void (*meet_board)(const BoardNumbers& board, const RayRow& rays, int count, int first_part,
                     const MetRow& met);
  // The rays of a pixel's samples, at one distance from the bone, which have met nothing yet.
  void (*begin_samples)(const PixelRays& pixel, const SamplePlaces& places, int count, float ground_mm,
                        float nothing_mm, float* x, float* y, float* grounds_mm, const MetRow& met);
  // Counts the samples that met each part, in the order in which the parts were met first, of part 0 none.
  // Of any count up to kMostSamples, of arrays that go on to the packet's end. Returns how many parts, of
  // which those beyond `room` are left out.
  int (*count_parts)(const std::int32_t* parts, int count, int room, PartCount* counts);
  static constexpr int kMostSamples = 64;
  // Of the pixels in kTogether columns by what their upper and lower left corners met, which go on by one
  // beyond them.
  Seams (*seams)(const std::int32_t* upper, const std::int32_t* lower);
  // Light of what was met, pixel by pixel, blue green red; looks by part. Of rays that met nothing it is any.
  void (*light_parts)(const PartLook* looks, const RayRow& rays, int count, const MetRow& met, float exposure,
                      float* bgr);

  // Columns [first, end) of a row, and others of the same packets where the triangle is.
  void (*draw_triangle)(const TriangleRow& row, int first, int end, float* depth_mm, std::int32_t* triangles);
  void (*noise_at)(const float* lattice, const float* const (&at_mm)[3], float nodes_per_mm, int count,
                   float* const (&values)[4]);
  void (*light_bone)(const BoneAttributes& attributes, const float* const (&grain)[4],
                     const float* const (&mottle)[4], int count, float exposure, float* bgr);
  // The capsule behind the bone.
  void (*light_backdrop)(const RayRow& rays, int count, float exposure, float* bgr);
  // Columns in [first, end) whose depth is not within the factor `one_surface` of those of the nodes around
  // them, which stand at every other column: low and high are the nodes' least and greatest depth. Returns
  // how many. Reads up to the packet's end and a node beyond it.
  int (*list_breaks)(const float* depth_mm, const float* low_mm, const float* high_mm, float one_surface,
                     int first, int end, int* columns);

  // A symmetrical blur: weights of the middle, and of its neighbours one, two and three off. The second reads
  // kBlurReach pixels of three values beyond both ends.
  void (*blur_across)(const float* const (&rows)[2 * kBlurReach + 1], const float (&weights)[kBlurReach + 1],
                      int count, float* out);
  void (*blur_along)(const float* in, const float (&weights)[kBlurReach + 1], int count, float* out);
  // Grey levels of light, with normal deviates as its noise.
  void (*expose)(const ToneNumbers& tone, const float* light, const float* deviates, int count,
                 std::uint8_t* out);
};

[[nodiscard]] const PictureKernel& plain_picture_kernel();
[[nodiscard]] const PictureKernel& avx2_picture_kernel();  // for processors that have it
[[nodiscard]] bool draws_by_avx2();
[[nodiscard]] const PictureKernel& picture_kernel();

}  // namespace arthronaut::simulator
