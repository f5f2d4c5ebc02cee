// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What there is to light where a ray for light between surfaces was followed, as a depth (renderer/indirect/gather.py).

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float of = texelFetch(gather_weight, pixel, 0).w;
  bool is_hit = texelFetch(vertex_position, pixel, 0).w > 0.5;
  float kind = CLASS_COUNT;
  if (of > 0.5 && of < 3.5) {
    kind = is_hit ? (of > 2.5 ? SHINES : (of > 1.5 ? LOBE_MEETS : BASE_MEETS)) : (of > 1.5 ? LOBE_MISSES : BASE_MISSES);
    kind = of > 2.5 && !is_hit ? CLASS_COUNT : kind;
  }
  gl_FragDepth = kind / CLASS_COUNT;
}
