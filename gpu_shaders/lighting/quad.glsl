// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The two by two pixels that a fragment shader runs on at once: they can share work without another pass, as a
// derivative is the difference to a neighbor. Only outside of branches and loops that some of the four leave.

vec2 quad_odd()
{
  return vec2(ivec2(gl_FragCoord.xy) & 1);
}

// Which of the four this pixel is.
int quad_lane()
{
  vec2 odd = quad_odd();
  return int(odd.x + 2.0 * odd.y);
}

// Sum over the four. (A derivative's sign is that of the axis, which some drivers turn upside down.)
vec4 quad_sum(vec4 value)
{
  vec2 odd = quad_odd();
  vec4 row = 2.0 * value + (1.0 - 2.0 * odd.x) * dFdx(odd.x) * dFdx(value);
  return 2.0 * row + (1.0 - 2.0 * odd.y) * dFdy(odd.y) * dFdy(row);
}

// Normals of pixels that share turn no further (cosine), and points leave each other's tangent plane no further
// (sine).
#define QUAD_NORMALS 0.97
#define QUAD_PLANE 0.25

bool quad_joins(vec3 step, vec3 normal, vec3 turn)
{
  return 0.5 * dot(turn, turn) <= 1.0 - QUAD_NORMALS && abs(dot(step, normal)) <= QUAD_PLANE * length(step);
}

// Whether the four are neighbors on one surface. `ids` are equal on one surface only. Never where a driver gives both
// rows the same derivative: then they cannot know of each other.
bool quad_is_one_surface(vec3 position, vec3 normal, vec3 ids)
{
  vec2 odd = quad_odd();
  float both = odd.x * odd.y;
  bool tells_apart = abs(dFdx(both)) == odd.y && abs(dFdy(both)) == odd.x;
  vec3 change = abs(dFdx(ids)) + abs(dFdy(ids));
  bool joins = quad_joins(dFdx(position), normal, dFdx(normal)) && quad_joins(dFdy(position), normal, dFdy(normal));
  bool agrees = tells_apart && joins && change.x + change.y + change.z == 0.0;
  // (Where rows or columns are not told apart the sum is wrong, too: whoever does not agree stays out of it.)
  float agreeing = quad_sum(vec4(agrees ? 1.0 : 0.0)).x;
  return agrees && agreeing == 4.0;
}
