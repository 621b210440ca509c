// Eight numbers at a time. Part of the loops that are compiled once for each kind of processor; see
// picture_loops.h.
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
// Bit k: whether the mask's value k, which is 0 or -1, is -1.
inline std::uint32_t bits_of(const Ints& mask) {
#if defined(__AVX__)
  __m256 values;
  __builtin_memcpy(&values, &mask, sizeof values);
  return static_cast<std::uint32_t>(_mm256_movemask_ps(values));
#elif defined(__SSE2__)
  __m128 halves[2];
  __builtin_memcpy(halves, &mask, sizeof halves);
  return static_cast<std::uint32_t>(_mm_movemask_ps(halves[0]) | _mm_movemask_ps(halves[1]) << 4);
#else
  std::uint32_t bits = 0;
  for (int k = 0; k < kTogether; ++k) bits |= (mask[k] & 1U) << k;
  return bits;
#endif
}
inline bool any(const Ints& mask) { return bits_of(mask) != 0; }
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

}  // namespace
}  // namespace arthronaut::simulator
