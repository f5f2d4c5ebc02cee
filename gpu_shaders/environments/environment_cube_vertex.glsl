// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Blinn & Newell's environment looked up at the mirror's vertices and interpolated over its triangles, as smooth
// shading does with light (COMP 557, lecture 18, its first answer).
// Needs the sampler `environment` (FLOAT_2D): the picture that environment_vertex.*.glsl draws.

// Only of the picture of positions, and there where it shows the background.
vec3 environment_direction(vec3 point, vec3 ray)
{
  return texelFetch(environment, ivec2(gl_FragCoord.xy), 0).xyz;
}

vec4 environment_at(vec3 point, vec3 ray)
{
  return texelFetch(environment, ivec2(gl_FragCoord.xy), 0);
}
