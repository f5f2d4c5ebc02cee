// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What there is to light where a ray for light between surfaces was followed, as a depth
// (renderer/indirect/gather.py).
#include "gather/ray_kinds.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float of = texelFetch(gather_weight, pixel, 0).w;
  bool is_hit = texelFetch(vertex_position, pixel, 0).w > 0.5;
  float kind = CLASS_COUNT;
  if (of == RAY_OFF_BASE || of == RAY_THROUGH) {
    kind = is_hit ? BASE_MEETS : BASE_MISSES;
  }
  else if (of == RAY_OFF_LOBE) {
    kind = is_hit ? LOBE_MEETS : LOBE_MISSES;
  }
  else if (of == RAY_TO_EMITTER && is_hit) {
    kind = SHINES;
  }
  gl_FragDepth = kind / CLASS_COUNT;
}
