// What rays meet of the solids. Part of the loops that are compiled once for each kind of processor; see
// picture_loops.h.
#pragma once

#include "navigation/simulator/picture_vectors.h"

namespace arthronaut::simulator {
namespace {

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

void begin_samples(const PixelRays& pixel, const SamplePlaces& places, int count, float ground_mm,
                   float nothing_mm, float* x, float* y, float* grounds_mm, const MetRow& met) {
  for (int i = 0; i < count; i += kTogether) {
    const Floats along = load(places.x + i), down = load(places.y + i);
    store(pixel.middle[0] + along * pixel.along[0] + down * pixel.down[0], x + i);
    store(pixel.middle[1] + along * pixel.along[1] + down * pixel.down[1], y + i);
    store(Floats{} + ground_mm, grounds_mm + i);
    store(Floats{} + nothing_mm, met.depth_mm + i);
    store(Ints{}, met.part + i);
  }
}

int count_parts(const std::int32_t* parts, int count, int room, PartCount* counts) {
  static_assert(PictureKernel::kMostSamples == 64);
  std::uint64_t left = ~std::uint64_t{0} >> (64 - count);
  int found = 0;
  while (left != 0 && found < room) {
    const int first = __builtin_ctzll(left);
    const std::int32_t part = parts[first];
    std::uint64_t same = 0;
    for (int i = first / kTogether * kTogether; i < count; i += kTogether)
      same |= std::uint64_t{bits_of(load(parts + i) == part)} << i;
    same &= left;
    left &= ~same;
    if (part != 0) counts[found++] = {part, first, __builtin_popcountll(same)};
  }
  return found;
}

Seams seams(const std::int32_t* upper, const std::int32_t* lower) {
  const Ints part = load(upper);
  const Ints is_one = (part == load(upper + 1)) & (part == load(lower)) & (part == load(lower + 1));
  return {bits_of(~is_one), bits_of(is_one & (part != 0))};
}

}  // namespace
}  // namespace arthronaut::simulator
