// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// World position and object that an environment lookup shows at a mirror's pixels; for the background its direction
// and 0.
#include "surfaces/mirror_pixel.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  MirrorPixel at = mirror_pixel(pixel);
  if (!at.is_mirror) {
    discard;
  }
  color = shown_position(pixel, at);
  if (color.w == 0.0) {
    color.xyz = normalize(environment_direction(at.point, at.ray));
  }
}
