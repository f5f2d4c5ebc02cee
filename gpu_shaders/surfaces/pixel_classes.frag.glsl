// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What each pixel shows, as a depth: class over CLASS_COUNT (renderer/surfaces/pixel_classes.py). Passes that light
// one class only are drawn at its depth and tested for equality before their shader runs, as there is no stencil.
#include "surfaces/chosen_mirrors.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float kind = texelFetch(seen_color, pixel, 0).w;
  float shown = kind < -1.5 ? NOTHING : (kind < -0.5 ? SURFACE : BACKGROUND);
  if (kind > 0.5) {
    shown = MIRROR;
#ifdef SHOWS_SURFACES
    shown = texelFetch(reflected_position, pixel, 0).w > 0.0 ? MIRROR_OF_SURFACE : MIRROR;
#ifdef TELLS_MIRRORS
    if (texelFetch(reflected_color, pixel, 0).w > 0.5) {
      shown = MIRROR_OF_MIRROR;
    }
#endif
#endif
  }
#ifdef WITH_CHOICE
  if (kind > 0.5 && !is_chosen(kind)) {
    shown = NOTHING;
  }
#endif
  gl_FragDepth = shown / CLASS_COUNT;
}
