// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a path knows of its way beside where it is, packed into a whole number that a float holds.

// What kind of ray it is, as Cycles tells them apart for visibility.
#define RAY_CAMERA 0
#define RAY_REFLECTED 1
#define RAY_TRANSMITTED 2
// Most events of a kind that are counted.
#define STATE_MOST 63

struct PathState {
  int kind;
  bool ends;        // what it meets next shows its own light alone
  int reflected;    // how often it was reflected, went through an interface, went straight on
  int transmitted;
  int passed;
};

PathState unpack_state(float packed_state)
{
  int bits = int(packed_state + 0.5);
  PathState state;
  state.kind = bits & 3;
  state.ends = (bits & 4) != 0;
  state.reflected = (bits >> 3) & STATE_MOST;
  state.transmitted = (bits >> 9) & STATE_MOST;
  state.passed = (bits >> 15) & STATE_MOST;
  return state;
}

float pack_state(PathState state)
{
  return float(state.kind + (state.ends ? 4 : 0) + (min(state.reflected, STATE_MOST) << 3) +
               (min(state.transmitted, STATE_MOST) << 9) + (min(state.passed, STATE_MOST) << 15));
}

// The way to a vertex: its direction as a place on an octahedron, its density, and what it is in (media.glsl).
vec4 pack_way(vec3 direction, float density, float media)
{
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = (1.0 - abs(d.yx)) * vec2(d.x < 0.0 ? -1.0 : 1.0, d.y < 0.0 ? -1.0 : 1.0);
  return vec4(d.z < 0.0 ? folded : d.xy, density, media);
}

vec3 way_direction(vec4 way)
{
  vec3 d = vec3(way.xy, 1.0 - abs(way.x) - abs(way.y));
  vec2 folded = (1.0 - abs(d.yx)) * vec2(d.x < 0.0 ? -1.0 : 1.0, d.y < 0.0 ? -1.0 : 1.0);
  d.xy = d.z < 0.0 ? folded : d.xy;
  return normalize(d);
}
