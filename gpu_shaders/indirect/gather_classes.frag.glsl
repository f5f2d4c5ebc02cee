// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What there is to light where a ray for light between surfaces was followed, as a depth (renderer/indirect/gather.py).

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float of = texelFetch(gather_weight, pixel, 0).w;
  bool is_hit = texelFetch(vertex_position, pixel, 0).w > 0.5;
  float kind = of < 0.5 ? CLASS_COUNT : (of > 1.5 ? (is_hit ? LOBE_MEETS : LOBE_MISSES) : (is_hit ? BASE_MEETS : BASE_MISSES));
  gl_FragDepth = kind / CLASS_COUNT;
}
