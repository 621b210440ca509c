// Eight numbers at a time, for loops that are compiled once for each kind of processor: of no use to anyone
// else. Everything here is in the anonymous namespace and calls nothing that is shared with other files, so
// that no instruction of one kind gets into the code of the other.
#pragma once

namespace arthronaut::markers {
namespace {

using Floats = float __attribute__((vector_size(32)));
using Ints = int __attribute__((vector_size(32)));

inline void load(const float* from, Floats& to) { __builtin_memcpy(&to, from, sizeof to); }
inline void store(const Floats& from, float* to) { __builtin_memcpy(to, &from, sizeof from); }

inline bool all_of(const Ints& lanes) {
  using Pairs = long long __attribute__((vector_size(32)));
  Pairs pairs;
  __builtin_memcpy(&pairs, &lanes, sizeof pairs);
  return (pairs[0] & pairs[1] & pairs[2] & pairs[3]) == -1;
}

// Two to this power, from -126 to 126; to 1e-6 of it.
inline void power_of_two(const Floats& power, Floats& result) {
  const Ints whole = __builtin_convertvector(power + (power < 0 ? Floats{} - 0.5F : Floats{} + 0.5F), Ints);
  const Floats part = power - __builtin_convertvector(whole, Floats);
  const Floats factor =
      1.0F + part * (0.69314718F +
                     part * (0.24022651F + part * (0.05550411F + part * (0.00961813F + part * 0.00133336F))));
  const Ints exponent = (whole + 127) << 23;
  Floats scale;
  __builtin_memcpy(&scale, &exponent, sizeof scale);
  result = factor * scale;
}

// The natural logarithm of a number above 0; to 1e-6 (Cephes' logf).
inline void logarithm_of(const Floats& value, Floats& result) {
  Ints bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  Ints exponent = ((bits >> 23) & 255) - 126;
  const Ints mantissa_bits = (bits & 0x007FFFFF) | 0x3F000000;
  Floats mantissa;
  __builtin_memcpy(&mantissa, &mantissa_bits, sizeof mantissa);
  const Ints is_small = mantissa < 0.70710678F;  // -1 where it is
  exponent += is_small;
  const Floats x = (is_small ? mantissa + mantissa : mantissa) - 1.0F, square = x * x;
  Floats part = 7.0376836292E-2F * x - 1.1514610310E-1F;
  part = part * x + 1.1676998740E-1F;
  part = part * x - 1.2420140846E-1F;
  part = part * x + 1.4249322787E-1F;
  part = part * x - 1.6668057665E-1F;
  part = part * x + 2.0000714765E-1F;
  part = part * x - 2.4999993993E-1F;
  part = part * x + 3.3333331174E-1F;
  const Floats power = __builtin_convertvector(exponent, Floats);
  result = x + (part * x * square - 0.5F * square - 2.12194440E-4F * power) + 0.693359375F * power;
}

// Eight rows of eight to eight columns.
inline void transpose(Floats (&rows)[8]) {
  Floats pairs[8], fours[8];
  for (int k = 0; k < 8; k += 2) {
    pairs[k] = __builtin_shufflevector(rows[k], rows[k + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[k + 1] = __builtin_shufflevector(rows[k], rows[k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int k = 0; k < 8; k += 4) {
    for (int i = 0; i < 2; ++i) {
      fours[k + 2 * i] = __builtin_shufflevector(pairs[k + i], pairs[k + i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      fours[k + 2 * i + 1] =
          __builtin_shufflevector(pairs[k + i], pairs[k + i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int k = 0; k < 4; ++k) {
    rows[k] = __builtin_shufflevector(fours[k], fours[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    rows[k + 4] = __builtin_shufflevector(fours[k], fours[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

// Of the normal distribution: e^(-z^2 / 2) by a power of two, the integral by Abramowitz and Stegun 7.1.26;
// both to 1e-6.
inline void normal_at(const Floats& z, Floats& density, Floats& cumulative) {
  constexpr float kFar = 6;
  Floats away = z < 0 ? -z : z;
  away = away > kFar ? Floats{} + kFar : away;
  Floats bell;
  power_of_two(-0.72134752F * away * away, bell);
  density = 0.39894228F * bell;
  const Floats t = 1.0F / (1.0F + 0.23164190F * away);
  const Floats tail =
      0.5F * bell * t *
      (0.254829592F + t * (-0.284496736F + t * (1.421413741F + t * (-1.453152027F + t * 1.061405429F))));
  cumulative = z < 0 ? tail : 1.0F - tail;
}

// So far from the middle the normal distribution is at its end: what normal_at gives from there on.
constexpr float kFarOut = 6, kFarDensity = 0x1.a18826p-28F, kFarTail = 0x1.1029acp-30F;

// The same to the bit where z rises from lane to lane, for less where all of it is far out on one side.
inline void normal_along(const Floats& z, Floats& density, Floats& cumulative) {
  if (z[0] >= kFarOut) {
    density = Floats{} + kFarDensity;
    cumulative = Floats{} + 1.0F;
  } else if (z[7] <= -kFarOut) {
    density = Floats{} + kFarDensity;
    cumulative = Floats{} + kFarTail;
  } else {
    normal_at(z, density, cumulative);
  }
}

}  // namespace
}  // namespace arthronaut::markers
