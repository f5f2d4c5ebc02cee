// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers of a vertex of a path, as optics/scattering/sampler.py: points of a Sobol sequence, scrambled at each
// pixel as Owen by a hash; Burley, "Practical Hash-based Owen Scrambling" (JCGT 2020). Needs the push constant
// `path_point` (IVEC4), which path_point() makes for each sub-frame and bounce.

uint hashed(uint x)
{
  x ^= x >> 16u;
  x *= 0x7feb352du;
  x ^= x >> 15u;
  x *= 2221713035u;
  x ^= x >> 16u;
  return x;
}

// Of bits in reverse order: a bit turns those above it here, which are of less worth.
uint scrambled(uint reversed_bits, uint seed)
{
  uint x = reversed_bits;
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// In 0 .. 1, without 1.
float unit_float(uint bits)
{
  return float(bits >> 8u) * 5.9604644775390625e-8;
}

vec4 path_random(ivec2 pixel)
{
  uint seed = hashed(uint(path_point.z) ^ hashed(uint(pixel.x) ^ hashed(uint(pixel.y))));
  uvec2 axes = uvec2(path_point.xy);
  uvec4 point = uvec4(axes.x & 0xffffu, axes.x >> 16u, axes.y & 0xffffu, axes.y >> 16u);
  vec4 random;
  for (int axis = 0; axis < 4; axis++) {
    random[axis] = unit_float(bitfieldReverse(scrambled(point[axis], hashed(seed + uint(axis)))));
  }
  return random;
}
