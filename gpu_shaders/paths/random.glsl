// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers of a vertex of a path, as optics/scattering/sampler.py: a block of a scrambled Sobol sequence for
// each pixel, in scrambled Morton order; Burley, "Practical Hash-based Owen Scrambling" (2020), Ahmed and Wonka,
// "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error" (2020). Needs the push constant `path_point`
// (IVEC4), which path_point() makes for each sub-frame and bounce.

#include "common/hash.glsl"

// A bit turns those below it.
uint scrambled(uint bits, uint seed)
{
  uint x = bitfieldReverse(bits);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return bitfieldReverse(x);
}

// In 0 .. 1, without 1.
float unit_float(uint bits)
{
  return float(bits >> 8u) * 5.9604644775390625e-8;
}

// The lower half's bits apart, zeros between them.
uint spread_bits(uint x)
{
  x &= 0xfffu;
  x = (x | (x << 8u)) & 0x00ff00ffu;
  x = (x | (x << 4u)) & 0x0f0f0f0fu;
  x = (x | (x << 2u)) & 0x33333333u;
  return (x | (x << 1u)) & 0x55555555u;
}

// Four axes of the Sobol sequence, by the recurrences of their direction numbers.
uvec4 sobol_point(uint number)
{
  uvec4 point = uvec4(0u);
  uvec4 now = uvec4(1u << 31u);
  uint c_next = 3u << 30u;
  uint d_next = 3u << 30u;
  uint d_after = 1u << 29u;
  for (int bit = 0; bit < 32; bit++) {
    point ^= now * ((number >> uint(bit)) & 1u);
    uint c_after = c_next ^ now.z ^ (now.z >> 2u);
    uint d_last = d_next ^ now.w ^ (now.w >> 3u);
    now = uvec4(now.x >> 1u, now.y ^ (now.y >> 1u), c_next, d_next);
    c_next = c_after;
    d_next = d_after;
    d_after = d_last;
  }
  return point;
}

vec4 path_random(ivec2 pixel)
{
  uvec2 at = uvec2(pixel);
  uint seed = uint(path_point.z);
  uint block = uint(path_point.w);
  uint place = scrambled((spread_bits(at.x) | (spread_bits(at.y) << 1u)) << 8u, seed) >> 8u;
  uint within = hashed(seed ^ hashed(at.x ^ hashed(at.y))) & ((1u << block) - 1u);
  uvec4 point = sobol_point((place << block) | within);
  uvec2 moved = uvec2(path_point.xy);
  point ^= uvec4(moved.x << 16u, moved.x & 0xffff0000u, moved.y << 16u, moved.y & 0xffff0000u);
  vec4 random;
  for (int axis = 0; axis < 4; axis++) {
    random[axis] = unit_float(scrambled(point[axis], hashed(seed + uint(axis + 1))));
  }
  return random;
}
