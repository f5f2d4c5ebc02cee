// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// For renderer/proofs/paths.py: what a surface across z does to paths, one for each pixel. viewers: the unit way to
// where the path comes from, and the number of the material; randoms: four numbers. path_way: where it goes on, and
// the density; path_weight: what its throughput is multiplied by, and the kind of the decision.
#include "paths/scatter.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 viewer = texelFetch(viewers, pixel, 0);
  int index = int(viewer.w + 0.5);
  Material m = material_at(pixel, index, fetch_record(materials, MATERIAL_RECORDS * index + 2).rgb);
  Facing f = Facing(vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), false);
  Scatter s = scatter(m, f, viewer.xyz, texelFetch(randoms, pixel, 0));
  path_way = vec4(s.direction, s.pdf);
  path_weight = vec4(s.weight, float(s.kind));
}
