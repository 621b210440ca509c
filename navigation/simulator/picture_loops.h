// What picture_kernel.h declares, to be compiled once for each kind of processor: of no use to anyone else.
// Everything here is in the anonymous namespace and calls nothing that is shared with other files, so that no
// instruction of one kind gets into the code of the other.
#pragma once

#include "navigation/simulator/picture_vectors.h"
#include "navigation/simulator/solid_loops.h"

namespace arthronaut::simulator {
namespace {

// -- Light -------------------------------------------------------------------------------------------------

// Linear light sent to the lens by a surface point: Lambert and a Blinn highlight, both falling off with the
// squared distance. exposure: what a white surface that faces the light sends at 1 mm.
struct Lit {
  Floats irradiance, diffuse, highlight;  // the highlight before it is sharpened
};
inline Lit lit(const Vectors& point, const Vectors& normal, float exposure) {
  const Vectors to_light{kLightPosition_mm[0] - point.x, kLightPosition_mm[1] - point.y,
                         kLightPosition_mm[2] - point.z};
  const Floats square = dot(to_light, to_light);
  const Vectors light_direction = scaled(to_light, 1.0F / root(square)), away = unit(point);
  const Vectors half =
      unit({light_direction.x - away.x, light_direction.y - away.y, light_direction.z - away.z});
  // A little light comes back from all around the joint.
  return {exposure / square, 0.04F + larger(dot(normal, light_direction), Floats{}),
          larger(dot(normal, half), Floats{})};
}

// Pixel by pixel: the first two colours are joined, and the third put between them.
inline void store_bgr(const Floats (&light)[3], float* bgr) {
  const Floats &b = light[0], &g = light[1], &r = light[2];
  const Floats low = __builtin_shufflevector(b, g, 0, 8, 1, 1, 9, 2, 2, 10);
  const Floats middle = __builtin_shufflevector(b, g, 10, 3, 11, 11, 4, 12, 12, 5);
  const Floats high = __builtin_shufflevector(b, g, 13, 5, 6, 14, 6, 7, 15, 7);
  store(__builtin_shufflevector(low, r, 0, 1, 8, 3, 4, 9, 6, 7), bgr);
  store(__builtin_shufflevector(middle, r, 10, 1, 2, 11, 4, 5, 12, 7), bgr + kTogether);
  store(__builtin_shufflevector(high, r, 0, 13, 2, 3, 14, 5, 6, 15), bgr + 2 * kTogether);
}

// The looks of a packet's pixels, which nearly always are one.
struct Looks {
  Floats albedo[3], specular;
  Ints doublings;
};
inline Looks looks_of(const PartLook* looks, const std::int32_t* parts) {
  Looks all;
  if (!any(load(parts) != parts[0])) {
    const PartLook& look = looks[parts[0]];
    for (int c = 0; c < 3; ++c) all.albedo[c] = Floats{} + look.albedo_bgr[c];
    all.specular = Floats{} + look.specular;
    all.doublings = Ints{} + look.gloss_doublings;
    return all;
  }
  for (int k = 0; k < kTogether; ++k) {
    const PartLook& look = looks[parts[k]];
    for (int c = 0; c < 3; ++c) all.albedo[c][k] = look.albedo_bgr[c];
    all.specular[k] = look.specular;
    all.doublings[k] = look.gloss_doublings;
  }
  return all;
}

void light_parts(const PartLook* looks, const RayRow& rays, int count, const MetRow& met, float exposure,
                 float* bgr) {
  for (int i = 0; i < count; i += kTogether) {
    const Floats depth = load(met.depth_mm + i);
    const Vectors point{depth * load(rays.x + i), depth * load(rays.y + i), depth};
    const Vectors normal{load(met.normal[0] + i), load(met.normal[1] + i), load(met.normal[2] + i)};
    const Lit light = lit(point, normal, exposure);
    const Looks look = looks_of(looks, met.part + i);
    Floats highlight = light.highlight;
    for (int k = 0; k < PartLook::kMostDoublings; ++k) {
      const Ints goes_on = look.doublings > k;
      if (!any(goes_on)) break;
      highlight = goes_on ? highlight * highlight : highlight;
    }
    Floats out[3];
    for (int c = 0; c < 3; ++c)
      out[c] = light.irradiance * (light.diffuse * look.albedo[c] + look.specular * highlight);
    store_bgr(out, bgr + 3 * i);
  }
}

// -- The bone ----------------------------------------------------------------------------------------------

void draw_triangle(const TriangleRow& row, int first, int end, float* depth_mm, std::int32_t* triangles) {
  const Floats steps{0, 1, 2, 3, 4, 5, 6, 7};
  for (int i = first / kTogether * kTogether; i < end; i += kTogether) {
    const Floats column = static_cast<float>(i) + steps;
    const Floats b = row.share_b + column * row.share_b_step, c = row.share_c + column * row.share_c_step;
    const Floats depth = row.depth_mm + b * row.depth_b_mm + c * row.depth_c_mm;
    const Floats nearest = load(depth_mm + i);
    const Ints wins = (b >= 0) & (c >= 0) & (b + c <= 1) & (depth < nearest);
    if (!any(wins)) continue;
    store(wins ? depth : nearest, depth_mm + i);
    store(wins ? Ints{} + row.triangle : load(triangles + i), triangles + i);
  }
}

struct Place {
  Ints low;
  Floats share;  // of the way to the next node, smoothed
};
inline Place place_of(const float* at_mm, float nodes_per_mm) {
  const Floats position = load(at_mm) * nodes_per_mm;
  const Ints low = floor_of(position);
  const Floats linear = position - floats(low);
  return {low, linear * linear * (3.0F - 2.0F * linear)};
}

void noise_at(const float* lattice, const float* const (&at_mm)[3], float nodes_per_mm, int count,
              float* const (&values)[4]) {
  constexpr int kMask = kLattice - 1, kRow = 4 * (kLattice + 1);
  for (int i = 0; i < count; i += kTogether) {
    const Place x = place_of(at_mm[0] + i, nodes_per_mm), y = place_of(at_mm[1] + i, nodes_per_mm),
                z = place_of(at_mm[2] + i, nodes_per_mm);
    const Ints column = 4 * (x.low & kMask), near = kLattice * (z.low & kMask),
               far = kLattice * ((z.low + 1) & kMask), upper = y.low & kMask, lower = (y.low + 1) & kMask;
    std::int32_t nodes[4][kTogether];
    store(kRow * (near + upper) + column, nodes[0]);
    store(kRow * (near + lower) + column, nodes[1]);
    store(kRow * (far + upper) + column, nodes[2]);
    store(kRow * (far + lower) + column, nodes[3]);
    float shares[3][kTogether];
    store(x.share, shares[0]);
    store(y.share, shares[1]);
    store(z.share, shares[2]);
    for (int k = 0; k < kTogether; ++k) {
      // Four channels of a node and of the next one along x lie side by side.
      const Floats near_upper = load(lattice + nodes[0][k]), far_upper = load(lattice + nodes[2][k]);
      const Floats in_near = near_upper + shares[1][k] * (load(lattice + nodes[1][k]) - near_upper);
      const Floats in_far = far_upper + shares[1][k] * (load(lattice + nodes[3][k]) - far_upper);
      float pair[kTogether];
      store(in_near + shares[2][k] * (in_far - in_near), pair);
      for (int c = 0; c < 4; ++c) values[c][i + k] = pair[c] + shares[0][k] * (pair[c + 4] - pair[c]);
    }
  }
}

inline Vectors vectors_at(const BoneAttributes& attributes, int first, int i) {
  return {load(attributes.at[first] + i), load(attributes.at[first + 1] + i),
          load(attributes.at[first + 2] + i)};
}

void light_bone(const BoneAttributes& attributes, const float* const (&grain)[4],
                const float* const (&mottle)[4], int count, float exposure, float* bgr) {
  constexpr float kBone[3] = {0.30F, 0.42F, 0.50F}, kRed[3] = {0.05F, 0.065F, 0.26F};
  constexpr float kSpecular = 1.4F;
  constexpr int kGlossDoublings = 7;
  for (int i = 0; i < count; i += kTogether) {
    const Floats grey = load(grain[0] + i), patch = load(mottle[0] + i);
    const Floats redness =
        load(attributes.at[BoneAttributes::kRedness] + i) * (1.0F + 0.9F * patch + 0.3F * grey);
    const Floats red = smaller(larger(redness, Floats{}), Floats{} + 0.9F);
    const Floats shade = 1.0F + 0.05F * grey + 0.06F * load(mottle[1] + i);
    // The film of fluid glitters: its highlights follow a rougher normal than the bone's own.
    const Vectors smooth = unit(vectors_at(attributes, BoneAttributes::kNormal, i));
    const Vectors rough = unit({smooth.x + 0.10F * load(grain[1] + i) + 0.13F * load(mottle[1] + i),
                                smooth.y + 0.10F * load(grain[2] + i) + 0.13F * load(mottle[2] + i),
                                smooth.z + 0.10F * load(grain[3] + i) + 0.13F * load(mottle[3] + i)});
    const Lit light = lit(vectors_at(attributes, BoneAttributes::kCamera, i), rough, exposure);
    Floats highlight = light.highlight;
    for (int k = 0; k < kGlossDoublings; ++k) highlight *= highlight;
    Floats out[3];
    for (int c = 0; c < 3; ++c) {
      const Floats albedo = shade * (kBone[c] + red * (kRed[c] - kBone[c]));
      out[c] = light.irradiance * (light.diffuse * albedo + kSpecular * highlight);
    }
    store_bgr(out, bgr + 3 * i);
  }
}

// Red, far and without detail. Without it the rim would stand on black.
void light_backdrop(const RayRow& rays, int count, float exposure, float* bgr) {
  constexpr float kFar_mm = 36;
  constexpr float kTissue[3] = {0.10F, 0.12F, 0.34F};
  for (int i = 0; i < count; i += kTogether) {
    const Vectors direction{load(rays.x + i), load(rays.y + i), Floats{} + 1.0F};
    const Vectors normal = scaled(unit(direction), Floats{} - 1.0F);
    const Lit light = lit(scaled(direction, Floats{} + kFar_mm), normal, exposure);
    Floats out[3];
    for (int c = 0; c < 3; ++c) out[c] = light.irradiance * light.diffuse * kTissue[c];
    store_bgr(out, bgr + 3 * i);
  }
}

int list_breaks(const float* depth_mm, const float* low_mm, const float* high_mm, float one_surface,
                int first, int end, int* columns) {
  int count = 0;
  const int first_node = first / 2 / kTogether * kTogether;
  for (int node = first_node; 2 * node < end; node += kTogether) {
    const Floats a = load(depth_mm + 2 * node), b = load(depth_mm + 2 * node + kTogether);
    const Floats even = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
    const Floats odd = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
    const Floats low = load(low_mm + node), high = load(high_mm + node);
    const Floats low_beside = smaller(low, load(low_mm + node + 1)),
                 high_beside = larger(high, load(high_mm + node + 1));
    const Ints breaks_even = ~((high < one_surface * even) & (even < one_surface * low));
    const Ints breaks_odd = ~((high_beside < one_surface * odd) & (odd < one_surface * low_beside));
    if (!any(breaks_even | breaks_odd)) continue;
    std::int32_t breaks[2][kTogether];
    store(breaks_even, breaks[0]);
    store(breaks_odd, breaks[1]);
    for (int k = 0; k < 2 * kTogether; ++k) {
      const int column = 2 * node + k;
      if (breaks[k % 2][k / 2] != 0 && column >= first && column < end) columns[count++] = column;
    }
  }
  return count;
}

// -- The sensor --------------------------------------------------------------------------------------------

void blur_across(const float* const (&rows)[2 * kBlurReach + 1], const float (&weights)[kBlurReach + 1],
                 int count, float* out) {
  for (int i = 0; i < count; i += kTogether) {
    Floats sum = weights[0] * load(rows[kBlurReach] + i);
    for (int k = 1; k <= kBlurReach; ++k)
      sum += weights[k] * (load(rows[kBlurReach - k] + i) + load(rows[kBlurReach + k] + i));
    store(sum, out + i);
  }
}

void blur_along(const float* in, const float (&weights)[kBlurReach + 1], int count, float* out) {
  for (int i = 0; i < count; i += kTogether) {
    Floats sum = weights[0] * load(in + i);
    for (int k = 1; k <= kBlurReach; ++k) sum += weights[k] * (load(in + i - 3 * k) + load(in + i + 3 * k));
    store(sum, out + i);
  }
}

// 255 * light^(1 / 2.2), by powers of two; to 0.001 levels.
inline Floats level_of(const Floats& light) {
  constexpr float kDarkest = 1e-9F;  // its level is 0.02
  constexpr std::int32_t kMantissa = 0x7fffff, kOne = 0x3f800000;
  const Floats within = smaller(larger(light, Floats{} + kDarkest), Floats{} + 1.0F);
  Ints bits;
  __builtin_memcpy(&bits, &within, sizeof bits);
  const Ints fraction = (bits & kMantissa) | kOne;
  Floats part;
  __builtin_memcpy(&part, &fraction, sizeof part);
  part -= 1.0F;
  const Floats logarithm =
      floats((bits >> 23) - 127) +
      part * (1.44268143F +
              part * (-0.720358789F +
                      part * (0.468658864F +
                              part * (-0.301638007F + part * (0.144471094F - part * 0.0338220447F)))));
  const Floats power = logarithm * (1 / 2.2F);  // not above 0
  const Ints whole = truncated(power - 0.5F);
  const Floats rest = power - floats(whole);
  const Floats factor =
      1.0F + rest * (0.69314718F +
                     rest * (0.24022651F + rest * (0.05550411F + rest * (0.00961813F + rest * 0.00133336F))));
  const Ints exponent = (whole + 127) << 23;
  Floats scale;
  __builtin_memcpy(&scale, &exponent, sizeof scale);
  return 255.0F * factor * scale;
}

void expose(const ToneNumbers& tone, const float* light, const float* deviates, int count,
            std::uint8_t* out) {
  for (int i = 0; i < count; i += kTogether) {
    const Floats level = level_of(load(light + i));
    const Floats sigma = root(tone.read_variance + tone.shot_share * level);
    const Floats noisy = level + sigma * load(deviates + i) + 0.5F;
    const Ints grey = truncated(smaller(larger(noisy, Floats{}), Floats{} + 255.0F));
    store_bytes(grey, out + i);
  }
}

constexpr PictureKernel kKernel{&meet_plate,     &meet_rod,    &meet_board,    &begin_samples, &count_parts,
                                &seams,          &light_parts, &draw_triangle, &noise_at,      &light_bone,
                                &light_backdrop, &list_breaks, &blur_across,   &blur_along,    &expose};

}  // namespace
}  // namespace arthronaut::simulator
