// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which of mixed shaders a ShadingPoint shows.
#include "common/hash.glsl"

// 0 to 1: of a pixel another number in each sub-frame and bounce (`turn`), all of them well spread.
float chance_at(uvec2 pixel, ivec2 turn)
{
  uint seed = hashed(pixel.x | (pixel.y << 16u)) + uint(turn.y);
  return fract(float(hashed(seed) >> 8u) * 5.9604644775390625e-8 + 0.61803398875 * float(turn.x));
}
