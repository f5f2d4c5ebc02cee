// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels of an earlier frame (renderer/reuse/kept_frame.py) that show a certain object in a certain mirror.

// What is looked for: its number in `then_shown`, with its mirrors, and that of the mirror in `then_tint`.
float wanted_code, wanted_mirror;

bool fits(ivec2 place)
{
  ivec2 size = textureSize(then_shown, 0);
  if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size))) {
    return false;
  }
  return abs(texelFetch(then_tint, place, 0).w - wanted_mirror) < 0.5 &&
         abs(texelFetch(then_shown, place, 0).w - wanted_code) < 0.5 * STEP_SHARE;
}

vec3 point_at(ivec2 place)
{
  return texelFetch(then_shown, place, 0).xyz;
}
