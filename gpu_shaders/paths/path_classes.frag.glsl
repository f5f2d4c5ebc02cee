// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What there is to do at each pixel of a path's vertex, as a depth (renderer/tracing/path_classes.py): with ON_PATH of
// what the step before has met where paths went on, else of what the eye sees.
#include "surfaces/chosen_mirrors.glsl"
#ifdef ON_PATH
#include "paths/path_state.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float shown = texelFetch(vertex_color, pixel, 0).w;
  float kind = CLASS_COUNT;
#ifdef ON_PATH
  vec4 throughput = texelFetch(path_throughput, pixel, 0);
  if (texelFetch(classes_before, pixel, 0).x == GOES_ON / CLASS_COUNT &&
      max(throughput.r, max(throughput.g, throughput.b)) > 0.0) {
    bool goes_on = shown > 0.5 || shown == SEEN_THROUGH;
    kind = texelFetch(vertex_position, pixel, 0).w == 0.0 ? MISSES :
           (goes_on && !unpack_state(throughput.w).ends ? GOES_ON : STOPS);
  }
#else
  bool is_mirror = shown > 0.5;
#ifdef WITH_CHOICE
  is_mirror = is_mirror && is_chosen(shown);
#endif
  if (is_mirror || (seen_through > 0.5 && shown == SEEN_THROUGH)) {
    kind = GOES_ON;
  }
#endif
  gl_FragDepth = kind / CLASS_COUNT;
}
