// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light along the first ways of paths, times what the first surface makes of it. The four pixels of a quad that lie on
// one surface share their ways: each is weighted by the pixel's own lobes over the density with which all four could
// have chosen it, so that none is worth more than one of its own (balance heuristic, as light paths are shared in
// Bekaert, Sbert and Halton, "Accelerating path tracing by re-using paths", 2002). What another pixel's way finds is
// taken for what the same direction would find from here: that is the error.
#include "paths/path_state.glsl"
#include "paths/path_vertex.glsl"

// Cosine between normals of one surface.
#define ALIKE 0.9

bool is_shared(ivec2 pixel)
{
  return unpack_state(texelFetch(path_throughput, pixel, 0).w).is_shared;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 arriving = texelFetch(path_light, pixel, 0);
  vec3 sum = is_shared(pixel) ? vec3(0.0) : arriving.rgb;
  vec4 here = texelFetch(vertex_position, pixel, 0);
  float shows = texelFetch(vertex_color, pixel, 0).w;
  vec3 normal = texelFetch(vertex_normal, pixel, 0).xyz;
  ivec2 size = textureSize(vertex_position, 0);
  vec3 to_viewer[4];
  PathVertex vertices[4];
  bool shared_with[4];
  bool any_way = false;
  for (int k = 0; k < 4; k++) {
    ivec2 other = min((pixel & ~1) + ivec2(k & 1, k >> 1), size - 1);
    vertices[k] = vertex_at(other);
    to_viewer[k] = normalize(view.eye.xyz - vertices[k].position * view.eye.w);
    shared_with[k] = other == pixel ||
      (vertices[k].object_id == here.w && texelFetch(vertex_color, other, 0).w == shows &&
       dot(vertices[k].facing.normal, normal) > ALIKE && ((pixel & ~1) + ivec2(k & 1, k >> 1)) == other);
  }
  int own = (pixel.x & 1) + 2 * (pixel.y & 1);
  for (int j = 0; j < 4; j++) {
    ivec2 other = min((pixel & ~1) + ivec2(j & 1, j >> 1), size - 1);
    if (shared_with[j] && is_shared(other)) {
      vec3 direction = way_direction(texelFetch(path_way, other, 0));
      float density, all = 0.0;
      vec3 value = vec3(0.0);
      for (int k = 0; k < 4; k++) {
        if (shared_with[k]) {
          vec3 lobes = scattered(vertices[k].material, vertices[k].facing, to_viewer[k], direction, density);
          all += density;
          value = k == own ? lobes : value;
        }
      }
      if (all > 0.0) {
        sum += value * texelFetch(path_light, other, 0).rgb / all;
      }
    }
  }
  color = vec4(sum, arriving.a) * weight;
}
