// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What there is to light where a ray for light between surfaces was followed, as a depth
// (renderer/indirect/gather.py).

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float of = texelFetch(gather_weight, pixel, 0).w;
  bool is_hit = texelFetch(vertex_position, pixel, 0).w > 0.5;
  float kind = CLASS_COUNT;
  if (of == 1.0 || of == 6.0) {
    kind = is_hit ? BASE_MEETS : BASE_MISSES;
  }
  else if (of == 2.0) {
    kind = is_hit ? LOBE_MEETS : LOBE_MISSES;
  }
  else if (of == 3.0 && is_hit) {
    kind = SHINES;
  }
  gl_FragDepth = kind / CLASS_COUNT;
}
