// What exposed_kernel.h declares, to be compiled once for each kind of processor: of no use to anyone else.
// Only what lanes.h says may stand here.
#pragma once

#include "navigation/markers/exposed_kernel.h"
#include "navigation/markers/lanes.h"

namespace arthronaut::markers {
namespace {

// What the two lines at the ends of a cell make of the three cells along one axis: each line lets the next
// cell in by the share of the smear that reaches over it. `place` counts cells from the first line.
struct Shares {
  Floats level[2], by_place[2], by_smear[2];
};

inline void find_shares(const Floats& place, const Floats& scale, Shares& shares) {
  const Floats z[2] = {place * scale, (place - 1.0F) * scale};
  const Floats away[2] = {z[0] < 0 ? -z[0] : z[0], z[1] < 0 ? -z[1] : z[1]};
  const Ints is_first = away[0] < away[1];
  Floats density[2];
  if (all_of((is_first ? away[1] : away[0]) >= kFarOut)) {
    // The smear reaches over one line at most.
    const Floats other = is_first ? z[1] : z[0];
    Floats near_density, near_level;
    normal_at(is_first ? z[0] : z[1], near_density, near_level);
    const Floats far_level = other < 0 ? Floats{} + kFarTail : Floats{} + 1.0F;
    shares.level[0] = is_first ? near_level : far_level;
    shares.level[1] = is_first ? far_level : near_level;
    density[0] = is_first ? near_density : Floats{} + kFarDensity;
    density[1] = is_first ? Floats{} + kFarDensity : near_density;
  } else {
    normal_at(z[0], density[0], shares.level[0]);
    normal_at(z[1], density[1], shares.level[1]);
  }
  for (int line = 0; line < 2; ++line) {
    shares.by_place[line] = density[line] * scale;
    shares.by_smear[line] = -z[line] * density[line];
  }
}

inline void brightness(const Ints& neighbours, int bit, Floats& cell) {
  cell = __builtin_convertvector((neighbours >> bit) & 1, Floats);
}

// Without the derivatives the levels are the same to the bit.
template <bool kWithDerivatives>
inline void look(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen) {
  Floats ray_x, ray_y, ray_z, sigma_x, sigma_y;
  load(at.ray_x, ray_x);
  load(at.ray_y, ray_y);
  load(at.ray_z, ray_z);
  load(at.sigma_x, sigma_x);
  load(at.sigma_y, sigma_y);
  const Floats scale_x = 1.0F / sigma_x, scale_y = 1.0F / sigma_y;
  const float middle = 0.5F * static_cast<float>(code.cells);
  const Floats last = Floats{} + (static_cast<float>(code.cells) + 0.99F);
  Floats level{}, smear{};
  // In the plane: along x, along y, about the normal; out of it: along the normal, about x, about y.
  Floats in_plane[3]{}, out_of_plane[3]{}, by_velocity[3]{}, by_change[3]{};
  for (int k = 0; k < code.count; ++k) {
    const ExposedMoments::Moment& moment = code.moments[k];
    const float* r = moment.marker_from_camera;
    const Floats along = -moment.eye[2] / (r[6] * ray_x + r[7] * ray_y + r[8] * ray_z);
    const Floats dx = along * (r[0] * ray_x + r[1] * ray_y + r[2] * ray_z);
    const Floats dy = along * (r[3] * ray_x + r[4] * ray_y + r[5] * ray_z);
    const Floats x = moment.eye[0] + dx, y = moment.eye[1] + dy;
    const Floats column = x * code.cells_per_mm + middle, row = middle - y * code.cells_per_mm;
    // The cell that is looked at, one to the outside at most.
    Floats inner_column = column < -1.0F ? Floats{} - 1.0F : column;
    inner_column = inner_column > last ? last : inner_column;
    Floats inner_row = row < -1.0F ? Floats{} - 1.0F : row;
    inner_row = inner_row > last ? last : inner_row;
    const Ints c = __builtin_convertvector(inner_column + 1.0F, Ints) - 1;
    const Ints down = __builtin_convertvector(inner_row + 1.0F, Ints) - 1;
    const Ints place = (down + 2) * code.width + c + 2;
    Ints neighbours;
    for (int i = 0; i < kPixelsTogether; ++i) neighbours[i] = code.neighbours[place[i]];
    Shares across, over;
    find_shares(column - __builtin_convertvector(c, Floats), scale_x, across);
    find_shares(row - __builtin_convertvector(down, Floats), scale_y, over);
    Floats here{}, by_column{}, by_row{}, here_smear{}, above{}, above_by_column{}, above_by_smear{};
    for (int line = 0; line < 3; ++line) {
      Floats left, centre, right;
      brightness(neighbours, 3 * line, left);
      brightness(neighbours, 3 * line + 1, centre);
      brightness(neighbours, 3 * line + 2, right);
      const Floats first = centre - left, second = right - centre;
      const Floats mixed = left + across.level[0] * first + across.level[1] * second;
      const Floats rise = mixed - above;
      here = line == 0 ? mixed : here + over.level[line - 1] * rise;
      above = mixed;
      if constexpr (!kWithDerivatives) continue;
      const Floats mixed_by_column = across.by_place[0] * first + across.by_place[1] * second;
      const Floats mixed_by_smear = across.by_smear[0] * first + across.by_smear[1] * second;
      if (line == 0) {
        by_column = mixed_by_column;
        here_smear = mixed_by_smear;
      } else {
        by_row += over.by_place[line - 1] * rise;
        by_column += over.level[line - 1] * (mixed_by_column - above_by_column);
        here_smear +=
            over.level[line - 1] * (mixed_by_smear - above_by_smear) + over.by_smear[line - 1] * rise;
      }
      above_by_column = mixed_by_column;
      above_by_smear = mixed_by_smear;
    }
    level += here;
    if constexpr (!kWithDerivatives) continue;
    smear += here_smear;
    // When the marker moves, the ray wanders over the code the other way; what moves along the normal or
    // tilts moves along the line of sight.
    const Floats gx = -by_column * code.cells_per_mm, gy = by_row * code.cells_per_mm;
    const Floats gz = (gx * dx + gy * dy) / moment.eye[2];
    const Floats about = gy * x - gx * y;
    const float time = moment.time, half_square = 0.5F * time * time;
    in_plane[0] += gx;
    in_plane[1] += gy;
    in_plane[2] += about;
    by_velocity[0] += time * gx;
    by_velocity[1] += time * gy;
    by_velocity[2] += time * about;
    by_change[0] += half_square * gx;
    by_change[1] += half_square * gy;
    by_change[2] += half_square * about;
    out_of_plane[0] += gz;
    out_of_plane[1] += gz * y;
    out_of_plane[2] -= gz * x;
  }
  const float share = 1 / static_cast<float>(code.count);
  store(share * level, seen.level);
  if constexpr (!kWithDerivatives) return;
  store(share * smear, seen.by_smear);
  store(share * in_plane[0], seen.by_pose[0]);
  store(share * in_plane[1], seen.by_pose[1]);
  store(share * in_plane[2], seen.by_pose[5]);
  for (int i = 0; i < 3; ++i) {
    store(share * out_of_plane[i], seen.by_pose[2 + i]);
    store(share * by_velocity[i], seen.by_velocity[i]);
    store(share * by_change[i], seen.by_change[i]);
  }
}

// grey = 255 (light / 255)^(1 / gamma), and light = bias + gain * level of the code.
inline void explain(const FittedLight& light, const SeenPixels& pixels, const SeenLevels& levels,
                    ExplainedPixels& explained) {
  using At = DirectUnknowns;
  constexpr float kMinLight = 0.3F, kTukey = 4.685F, kFull = 255;
  Floats grey, x, y, level;
  load(pixels.grey, grey);
  load(pixels.place_x, x);
  load(pixels.place_y, y);
  load(levels.level, level);
  const Floats terms[At::kBiasTerms] = {Floats{} + 1.0F, x,         y,         x * x,     x * y,
                                        y * y,           x * x * x, x * x * y, x * y * y, y * y * y};
  Floats bias{}, gain{};
  for (int i = 0; i < At::kBiasTerms; ++i) bias += light.terms[i] * terms[i];
  for (int i = 0; i < At::kGainTerms; ++i) gain += light.terms[At::kBiasTerms + i] * terms[i];
  Floats there = bias + gain * level, logarithm, part;
  there = there > kMinLight ? there : Floats{} + kMinLight;
  logarithm_of(there / kFull, logarithm);
  power_of_two(1.44269504F / light.gamma * logarithm, part);
  const Floats modelled = kFull * part, slope = modelled / (light.gamma * there);
  const Floats residual = grey - modelled;
  Floats weight;
  if (light.has_weights) {
    load(pixels.weight, weight);
  } else {
    const Floats ratio = residual / (kTukey * light.noise), left = 1.0F - ratio * ratio;
    weight = left > 0.0F ? left * left : Floats{};
  }
  Floats root;
  for (int k = 0; k < kPixelsTogether; ++k) root[k] = weight[k] > 0 ? __builtin_sqrtf(weight[k]) : 0;
  store(residual, explained.residual);
  store(weight, explained.weight);
  store(slope * gain * (level - 0.5F), explained.code);
  const Floats by_code = root * slope * gain;
  Floats columns[kProductSize];
  const auto take = [&](const float* from, int column) {
    Floats value;
    load(from, value);
    columns[column] = by_code * value;
  };
  for (int i = 0; i < At::kSmear; ++i) take(levels.by_pose[i], i);
  for (int i = 0; i < 3; ++i) take(levels.by_velocity[i], At::kVelocity + i);
  for (int i = 0; i < 3; ++i) take(levels.by_change[i], At::kChange + i);
  take(levels.by_smear, At::kSmear);
  columns[At::kGamma] = -root * modelled * logarithm / (light.gamma * light.gamma);
  for (int i = 0; i < At::kBiasTerms; ++i) columns[At::kLight + i] = root * slope * terms[i];
  for (int i = 0; i < At::kGainTerms; ++i)
    columns[At::kLight + At::kBiasTerms + i] = root * slope * level * terms[i];
  for (int i = At::kCount; i < kProductSize; ++i) columns[i] = Floats{};
  for (int first = 0; first < kProductSize; first += kPixelsTogether) {
    Floats square[kPixelsTogether];
    for (int i = 0; i < kPixelsTogether; ++i) square[i] = columns[first + i];
    transpose(square);
    for (int k = 0; k < kPixelsTogether; ++k) store(square[k], &explained.rows[k][first]);
  }
}

// Eight columns at a time, which take the same of the rows.
inline void add_up(const float (&rows)[kPixelsTogether][kProductSize], int count,
                   float (&sum)[kProductSize][kProductSize]) {
  constexpr int kWide = 8, kColumns = 8;
  static_assert(kWide % kColumns == 0);
  for (int column = 0; column < count; column += kColumns) {
    for (int first = column / kWide * kWide; first < count; first += kWide) {
      Floats parts[kColumns], row;
      for (int i = 0; i < kColumns; ++i) load(&sum[column + i][first], parts[i]);
      for (int k = 0; k < kPixelsTogether; ++k) {
        load(&rows[k][first], row);
        for (int i = 0; i < kColumns; ++i) parts[i] += rows[k][column + i] * row;
      }
      for (int i = 0; i < kColumns; ++i) store(parts[i], &sum[column + i][first]);
    }
  }
}

}  // namespace
}  // namespace arthronaut::markers
