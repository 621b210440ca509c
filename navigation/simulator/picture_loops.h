// What picture_kernel.h declares, to be compiled once for each kind of processor: of no use to anyone else.
// Everything here is in the anonymous namespace and calls nothing that is shared with other files, so that no
// instruction of one kind gets into the code of the other.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "navigation/simulator/picture_kernel.h"

namespace arthronaut::simulator {
namespace {

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));

inline Floats load(const float* from) {
  Floats v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
inline Ints load(const std::int32_t* from) {
  Ints v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
inline void store(const Floats& v, float* to) { __builtin_memcpy(to, &v, sizeof v); }
inline void store(const Ints& v, std::int32_t* to) { __builtin_memcpy(to, &v, sizeof v); }
inline bool any(const Ints& mask) {
  std::int64_t parts[4];
  __builtin_memcpy(parts, &mask, sizeof parts);
  return (parts[0] | parts[1] | parts[2] | parts[3]) != 0;
}
inline Floats floats(const Ints& v) { return __builtin_convertvector(v, Floats); }
inline Ints truncated(const Floats& v) { return __builtin_convertvector(v, Ints); }
inline Ints floor_of(const Floats& v) {
  const Ints whole = truncated(v);
  return whole + (floats(whole) > v);  // a mask is -1 where it holds
}
inline Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }
inline Floats smaller(const Floats& a, const Floats& b) { return a < b ? a : b; }
inline Floats magnitude(const Floats& v) { return larger(v, -v); }
inline Floats root(const Floats& v) {
#if defined(__AVX__)
  return _mm256_sqrt_ps(v);
#elif defined(__SSE2__)
  __m128 halves[2];
  __builtin_memcpy(halves, &v, sizeof halves);
  halves[0] = _mm_sqrt_ps(halves[0]);
  halves[1] = _mm_sqrt_ps(halves[1]);
  Floats roots;
  __builtin_memcpy(&roots, halves, sizeof roots);
  return roots;
#else
  Floats roots = v;
  for (int i = 0; i < kTogether; ++i) roots[i] = __builtin_sqrtf(v[i]);
  return roots;
#endif
}

// Whole numbers from 0 to 255.
inline void store_bytes(const Ints& v, std::uint8_t* to) {
#if defined(__SSE2__)
  __m128i halves[2];
  __builtin_memcpy(halves, &v, sizeof halves);
  const __m128i pairs = _mm_packs_epi32(halves[0], halves[1]), bytes = _mm_packus_epi16(pairs, pairs);
  __builtin_memcpy(to, &bytes, kTogether);
#else
  for (int i = 0; i < kTogether; ++i) to[i] = static_cast<std::uint8_t>(v[i]);
#endif
}

struct Vectors {
  Floats x, y, z;
};
inline Floats dot(const Vectors& a, const Vectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Floats dot(const float (&a)[3], const Vectors& b) { return a[0] * b.x + a[1] * b.y + a[2] * b.z; }
inline Vectors scaled(const Vectors& v, const Floats& by) { return {v.x * by, v.y * by, v.z * by}; }
inline Vectors unit(const Vectors& v) { return scaled(v, 1.0F / root(dot(v, v))); }

// -- What rays meet ----------------------------------------------------------------------------------------

struct Rays {
  Vectors direction;
  Floats ground_mm;
};
inline Rays rays_at(const RayRow& rays, int i) {
  return {{load(rays.x + i), load(rays.y + i), Floats{} + 1.0F}, load(rays.ground_mm + i)};
}

struct Offer {
  Ints is_met;
  Floats depth_mm;
  Ints part;
  Vectors normal;
};

inline void take(const Offer& offer, const Floats& ground_mm, float yields_mm, const MetRow& met, int i) {
  const Floats nearest = load(met.depth_mm + i);
  const Ints wins = offer.is_met & (offer.depth_mm < nearest) & (offer.depth_mm < ground_mm + yields_mm);
  if (!any(wins)) return;
  store(wins ? offer.depth_mm : nearest, met.depth_mm + i);
  store(wins ? offer.part : load(met.part + i), met.part + i);
  store(wins ? offer.normal.x : load(met.normal[0] + i), met.normal[0] + i);
  store(wins ? offer.normal.y : load(met.normal[1] + i), met.normal[1] + i);
  store(wins ? offer.normal.z : load(met.normal[2] + i), met.normal[2] + i);
}

inline Vectors along(const float (&axis)[3], const Floats& length) {
  return {axis[0] * length, axis[1] * length, axis[2] * length};
}

// Where a plate is printed black, at places on its face.
inline Ints inked(const PlateNumbers& plate, const Floats& x_mm, const Floats& y_mm) {
  Ints ink{}, is_open = Ints{} - 1;
  for (int k = 0; k < plate.print_count; ++k) {
    const PrintNumbers& print = plate.prints[k];
    const auto count = static_cast<float>(print.count);
    const Floats column = (x_mm - print.center_mm[0]) * print.cells_per_mm + 0.5F * count;
    const Floats row = 0.5F * count - (y_mm - print.center_mm[1]) * print.cells_per_mm;
    const Ints is_in = is_open & (column >= 0) & (column < count) & (row >= 0) & (row < count);
    if (!any(is_in)) continue;
    const Ints cell = is_in & (truncated(row) * print.count + truncated(column));
    Ints word{};
    for (int w = 0; w < PrintNumbers::kWords && 32 * w < print.count * print.count; ++w)
      word = (cell >> 5) == w ? Ints{} + print.words[w] : word;
    const Ints is_white = (word >> (cell & 31)) & 1;
    ink |= is_in & (is_white - 1);
    is_open &= ~is_in;
  }
  if (plate.tick_spacing_mm > 0) {
    // Every fifth tick is twice as long.
    const Floats ticks = x_mm * (1 / plate.tick_spacing_mm);
    const Ints nearest = floor_of(ticks + 0.5F);
    const Ints fives = floor_of(floats(nearest) * 0.2F + 0.5F);
    const Floats length_mm = nearest == 5 * fives ? Floats{} + 2.0F : Floats{} + 1.0F;
    ink |= is_open & (magnitude(ticks - floats(nearest)) * plate.tick_spacing_mm < 0.06F) &
           (y_mm > plate.half_size_mm[1] - length_mm);
  }
  return ink;
}

inline Offer meet_round_side(const PlateNumbers& plate, const Vectors& local, const Ints& pending, int part) {
  const float* o = plate.origin_mm;
  const float radius = plate.half_size_mm[0];
  const Floats a = local.x * local.x + local.y * local.y, b = o[0] * local.x + o[1] * local.y;
  const float c = o[0] * o[0] + o[1] * o[1] - radius * radius;
  const Floats square = b * b - a * c;
  const Floats depth = (-b - root(larger(square, Floats{}))) / a;
  const Floats x = o[0] + depth * local.x, y = o[1] + depth * local.y, z = o[2] + depth * local.z;
  const Ints is_met = pending & (square >= 0) & (a >= 1e-12F) & (depth >= kNearest_mm) & (z <= 0) &
                      (z >= -plate.thickness_mm);
  const Floats inverse = 1.0F / root(x * x + y * y);
  const Vectors u = along(plate.axes[0], x * inverse), v = along(plate.axes[1], y * inverse);
  return {is_met, depth, Ints{} + part, {u.x + v.x, u.y + v.y, u.z + v.z}};
}

inline Offer meet_flat_side(const PlateNumbers& plate, const Vectors& local, int axis, const Ints& pending,
                            int part) {
  const float* o = plate.origin_mm;
  const Floats speed = axis == 0 ? local.x : local.y, other = axis == 0 ? local.y : local.x;
  const Floats sign = speed > 0 ? Floats{} - 1.0F : Floats{} + 1.0F;
  const Floats depth = (sign * plate.half_size_mm[axis] - o[axis]) / speed;
  const Floats across = o[1 - axis] + depth * other, z = o[2] + depth * local.z;
  const Ints is_met = pending & (magnitude(speed) >= 1e-12F) &
                      (magnitude(across) <= plate.half_size_mm[1 - axis]) & (depth >= kNearest_mm) &
                      (z <= 0) & (z >= -plate.thickness_mm);
  return {is_met, depth, Ints{} + part, along(plate.axes[axis], sign)};
}

void meet_plate(const PlateNumbers& plate, const RayRow& row, int count, int first_part, const MetRow& met) {
  const float* o = plate.origin_mm;
  for (int i = 0; i < count; i += kTogether) {
    const Rays rays = rays_at(row, i);
    const Vectors local{dot(plate.axes[0], rays.direction), dot(plate.axes[1], rays.direction),
                        dot(plate.axes[2], rays.direction)};
    const Floats depth = -o[2] / local.z;
    const Floats x = o[0] + depth * local.x, y = o[1] + depth * local.y;
    Ints is_met = (local.z < 0) & (depth >= kNearest_mm);  // else seen from behind
    if (plate.is_round) {
      is_met &= x * x + y * y <= plate.half_size_mm[0] * plate.half_size_mm[0];
    } else {
      is_met &= (magnitude(x) <= plate.half_size_mm[0]) & (magnitude(y) <= plate.half_size_mm[1]);
    }
    if (any(is_met)) {
      const Ints ink = is_met & inked(plate, x, y);
      const Ints part = ink ? Ints{} + (first_part + kInk) : Ints{} + (first_part + kPaper);
      take({is_met, depth, part, along(plate.axes[2], Floats{} + 1.0F)}, rays.ground_mm, plate.yields_mm, met,
           i);
    }
    Ints pending = ~is_met;
    if (!any(pending)) continue;
    if (plate.is_round) {
      take(meet_round_side(plate, local, pending, first_part + kSide), rays.ground_mm, plate.yields_mm, met,
           i);
      continue;
    }
    for (int axis = 0; axis < 2; ++axis) {
      const Offer side = meet_flat_side(plate, local, axis, pending, first_part + kSide);
      take(side, rays.ground_mm, plate.yields_mm, met, i);
      pending &= ~side.is_met;
    }
  }
}

inline Offer meet_rod_end(const RodNumbers& rod, const Rays& rays, float at_mm, const Ints& pending,
                          int part) {
  const float center[3] = {rod.from_mm[0] + at_mm * rod.along[0], rod.from_mm[1] + at_mm * rod.along[1],
                           rod.from_mm[2] + at_mm * rod.along[2]};
  const float c =
      center[0] * center[0] + center[1] * center[1] + center[2] * center[2] - rod.radius_mm * rod.radius_mm;
  const Vectors& d = rays.direction;
  const Floats a = dot(d, d), b = -dot(center, d), square = b * b - a * c;
  const Floats depth = (-b - root(larger(square, Floats{}))) / a;
  const float share = 1 / rod.radius_mm;
  return {pending & (square >= 0) & (depth > kNearest_mm),
          depth,
          Ints{} + part,
          {(depth * d.x - center[0]) * share, (depth * d.y - center[1]) * share,
           (depth * d.z - center[2]) * share}};
}

void meet_rod(const RodNumbers& rod, const RayRow& row, int count, int first_part, const MetRow& met) {
  const float* from = rod.from_mm;
  const float start = rod.along[0] * from[0] + rod.along[1] * from[1] + rod.along[2] * from[2];
  const float o[3] = {-from[0] + start * rod.along[0], -from[1] + start * rod.along[1],
                      -from[2] + start * rod.along[2]};
  const float c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2] - rod.radius_mm * rod.radius_mm;
  const float share = 1 / rod.radius_mm;
  for (int i = 0; i < count; i += kTogether) {
    const Rays rays = rays_at(row, i);
    const Vectors& direction = rays.direction;
    // The cylinder about the axis, in the plane across it.
    const Floats speed = dot(rod.along, direction);
    const Vectors d{direction.x - speed * rod.along[0], direction.y - speed * rod.along[1],
                    direction.z - speed * rod.along[2]};
    const Floats a = dot(d, d), b = dot(o, d), square = b * b - a * c;
    const Ints may_be_met = square >= 0;
    if (!any(may_be_met)) continue;
    const Floats depth = (-b - root(larger(square, Floats{}))) / a;
    const Floats position = depth * speed - start;
    const Ints is_side =
        may_be_met & (a > 1e-12F) & (depth > kNearest_mm) & (position >= 0) & (position <= rod.length_mm);
    const Vectors normal{(depth * direction.x - from[0] - position * rod.along[0]) * share,
                         (depth * direction.y - from[1] - position * rod.along[1]) * share,
                         (depth * direction.z - from[2] - position * rod.along[2]) * share};
    take({is_side, depth, Ints{} + first_part, normal}, rays.ground_mm, rod.yields_mm, met, i);
    Ints pending = may_be_met & ~is_side;
    for (int which = 0; which < 2 && any(pending); ++which) {
      const Offer end = meet_rod_end(rod, rays, which == 0 ? 0.0F : rod.length_mm, pending, first_part);
      take(end, rays.ground_mm, rod.yields_mm, met, i);
      pending &= ~end.is_met;
    }
  }
}

void meet_board(const BoardNumbers& board, const RayRow& row, int count, int first_part, const MetRow& met) {
  const float* o = board.origin_mm;
  const float facing = o[2] > 0 ? 1.0F : -1.0F, squares_per_mm = 1 / board.square_mm;
  for (int i = 0; i < count; i += kTogether) {
    const Rays rays = rays_at(row, i);
    const Floats z = dot(board.axes[2], rays.direction);
    const Floats depth = -o[2] / z;
    const Floats x = (o[0] + depth * dot(board.axes[0], rays.direction)) * squares_per_mm;
    const Floats y = (o[1] + depth * dot(board.axes[1], rays.direction)) * squares_per_mm;
    const Ints is_paper = ((floor_of(x) + floor_of(y)) & 1) != 0;
    const Ints part = is_paper ? Ints{} + (first_part + kPaper) : Ints{} + (first_part + kInk);
    const Ints is_met = (magnitude(z) >= 1e-9F) & (depth >= kNearest_mm);
    take({is_met, depth, part, along(board.axes[2], Floats{} + facing)}, rays.ground_mm, board.yields_mm, met,
         i);
  }
}

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

inline void store_bgr(const Floats (&light)[3], float* bgr) {
  float planes[3][kTogether];
  for (int c = 0; c < 3; ++c) store(light[c], planes[c]);
  for (int k = 0; k < kTogether; ++k)
    for (int c = 0; c < 3; ++c) bgr[3 * k + c] = planes[c][k];
}

// The looks of a packet's pixels, which nearly always are one.
struct Looks {
  Floats albedo[3], specular;
  Ints doublings;
};
inline Looks looks_of(const PartLook* looks, const std::int32_t* parts) {
  bool is_one = true;
  for (int k = 1; k < kTogether; ++k) is_one = is_one && parts[k] == parts[0];
  Looks all;
  if (is_one) {
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
    for (int k = 0; k < PartLook::kMostDoublings; ++k)
      highlight = look.doublings > k ? highlight * highlight : highlight;
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

constexpr PictureKernel kKernel{&meet_plate,    &meet_rod,    &meet_board, &light_parts,
                                &draw_triangle, &noise_at,    &light_bone, &light_backdrop,
                                &list_breaks,   &blur_across, &blur_along, &expose};

}  // namespace
}  // namespace arthronaut::simulator
