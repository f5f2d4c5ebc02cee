// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// See curvature.vert.glsl. `number` is the mirror's.

void main()
{
#ifdef LINEAR_DEPTH
  // (As primary.frag.glsl.)
  float distance_ahead = 1.0 / gl_FragCoord.w;
  if (distance_ahead > depths.y) {
    discard;
  }
  gl_FragDepth = distance_ahead / depths.z;
#endif
  // As the seen normal, which looks at the eye: of a back face what bends outwards bends inwards.
  float side = gl_FrontFacing ? 1.0 : -1.0;
  curved_diagonal = vec4(side * diagonal, number);
  curved_across = vec4(side * across, 0.0);
}
