// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Depth PATH_DEPTH where a surface buffer has a mirror, else 1. A pass at that depth, tested for equality, runs only
// there.
#include "surfaces/chosen_mirrors.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  bool is_mirror = texelFetch(surface_color, pixel, 0).w > 0.5;
#ifdef WITH_CHOICE
  is_mirror = is_mirror && is_chosen(texelFetch(surface_color, pixel, 0).w);
#endif
#ifdef ON_PATH
  // (The rest of a path buffer is old.)
  is_mirror = is_mirror && texelFetch(surface_depth, pixel, 0).x < 1.0;
#endif
  gl_FragDepth = is_mirror ? PATH_DEPTH : 1.0;
}
