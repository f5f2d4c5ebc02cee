// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (failed.x == 0.0 || failed.y > 0.0 || texelFetch(mirror_color, pixel, 0).w != mirror) {
    discard;
  }
  // Hatched: a hole in the picture, not a surface.
  mark = vec4(((pixel.x + pixel.y) & 7) < 4 ? failed_color : 0.35 * failed_color, 1.0);
}
