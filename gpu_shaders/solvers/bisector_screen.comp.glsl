// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Search over position and normal targets of the current view (Estalella et al. 2006, section 4), one invocation per
// vertex: the texel of a 3 x 3 neighborhood with the largest N . B becomes the next center, until the center wins.
// A texel at the silhouette covers many normals.
#define LARGEST_MISS 0.5
#include "solver_pieces/bisector.glsl"

#define MOST_STEPS 4096
#define NOWHERE -1.0

// Angle between bisector and normal as 1 - error, NOWHERE off the reflector.
float score(vec4 eye, vec3 vertex, ivec2 texel, bool inverse, out Bisector b)
{
  ivec2 size = textureSize(screen_position, 0);
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) {
    return NOWHERE;
  }
  vec4 position = texelFetch(screen_position, texel, 0);
  if (position.w == 0.0) {
    return NOWHERE;
  }
  vec3 point = in_map(position.xyz);
  vec3 normal = safe_unit(mat3(solver.world_to_map) * texelFetch(screen_normal, texel, 0).xyz);
  // A concave part shows its inner side: what faces the eye reflects.
  normal *= dot(normal, towards_eye(eye, point)) < 0.0 ? -1.0 : 1.0;
  b = bisector_at(eye, vertex, point, normal, inverse);
  return 1.0 - error_of(b);
}

bool improve(
    vec4 eye, vec3 vertex, ivec2 texel, bool inverse, inout ivec2 best, inout float best_score, inout Bisector b)
{
  Bisector other;
  float other_score = score(eye, vertex, texel, inverse, other);
  if (other_score > best_score) {
    best = texel;
    best_score = other_score;
    b = other;
    return true;
  }
  return false;
}

// The crosshair first, the corners only where none of its four arms is better.
bool climb(vec4 eye, vec3 vertex, bool inverse, inout ivec2 texel, inout Bisector b, inout int iterations)
{
  float best = score(eye, vertex, texel, inverse, b);
  for (int i = 0; i < MOST_STEPS; i++) {
    iterations++;
    ivec2 center = texel;
    bool better = improve(eye, vertex, center + ivec2(1, 0), inverse, texel, best, b);
    better = improve(eye, vertex, center + ivec2(-1, 0), inverse, texel, best, b) || better;
    better = improve(eye, vertex, center + ivec2(0, 1), inverse, texel, best, b) || better;
    better = improve(eye, vertex, center + ivec2(0, -1), inverse, texel, best, b) || better;
    if (!better) {
      better = improve(eye, vertex, center + ivec2(1, 1), inverse, texel, best, b);
      better = improve(eye, vertex, center + ivec2(-1, 1), inverse, texel, best, b) || better;
      better = improve(eye, vertex, center + ivec2(1, -1), inverse, texel, best, b) || better;
      better = improve(eye, vertex, center + ivec2(-1, -1), inverse, texel, best, b) || better;
    }
    if (!better) {
      return true;
    }
  }
  return false;
}

bool is_on_reflector(ivec2 texel)
{
  ivec2 size = textureSize(screen_position, 0);
  return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size)) &&
         texelFetch(screen_position, texel, 0).w > 0.0;
}

// The nearest texel of the reflector on rings of eight about `texel`, each twice as wide as the one before.
bool find_reflector(inout ivec2 texel)
{
  if (is_on_reflector(texel)) {
    return true;
  }
  for (int radius = 1; radius < 4096; radius *= 2) {
    for (int k = 0; k < 9; k++) {
      ivec2 other = texel + radius * ivec2(k % 3 - 1, k / 3 - 1);
      if (is_on_reflector(other)) {
        texel = other;
        return true;
      }
    }
  }
  return false;
}

// Where the vertex was reflected in the last frame (2006, section 5.3), else the middle of the mirror; whether its
// search was an inverse one.
ivec2 start_texel(int index, out bool was_hidden)
{
  was_hidden = false;
  if (solver.has_last_frame != 0) {
    vec4 before = fetch_record(previous_points, index);
    vec4 point = solver.world_to_map * vec4(before.xyz, 1.0);
    vec4 texel = solver.map_to_search * point;
    int code = int(before.w + 0.5) % 4;
    if (code != INVALID && texel.w > 0.0) {
      was_hidden = code != REFLECTED;
      return ivec2(floor(texel.xy / texel.w));
    }
  }
  return ivec2(floor(solver.search_start));
}

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  int iterations = 0;
  bool was_hidden;
  ivec2 texel = start_texel(index, was_hidden);
  if (!find_reflector(texel)) {
    texel = ivec2(floor(solver.search_start));
    if (!find_reflector(texel)) {
      return as_unsolved(0, vertex, vec3(0.0));
    }
  }
  ivec2 first_texel = texel;
  Bisector b;
  bool done = climb(eye, vertex, false, texel, b, iterations);
  bool inverse = !is_in_front(vertex, b);
  if (inverse) {
    // An inverse search ended there: it stays where it is when nothing moves.
    texel = was_hidden ? first_texel : texel;
    done = climb(eye, vertex, true, texel, b, iterations) && done;
  }
  return done ? as_bisector(iterations, vertex, b, inverse) : as_unsolved(iterations, vertex, b.point);
}
