// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What lamps' nodes do to their light (renderer/lighting/programs/lamps.py). Needs lighting_data and, with
// LIGHTING_LOOKS, the sampler `lighting_looks` (FLOAT_2D_ARRAY).

// From -1 to 1 across an octahedral map.
vec2 octahedral_of(vec3 direction)
{
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  if (d.z < 0.0) {
    vec2 side = vec2(d.x < 0.0 ? -1.0 : 1.0, d.y < 0.0 ? -1.0 : 1.0);
    d.xy = (1.0 - abs(d.yx)) * side;
  }
  return d.xy;
}

#ifdef LIGHTING_LOOKS
// What the nodes of a lamp multiply its light with, that leaves it in a unit direction at a place.
vec3 lamp_look(int base, float layer, int kind, vec3 from_lamp, vec3 place)
{
  vec3 axis_x = lighting_data[base + 4].xyz, shines = lighting_data[base + 3].xyz;
  vec2 at = 0.5 + octahedral_of(from_lamp) * (0.5 * (LOOK_SIZE - 1.0) / LOOK_SIZE);
  if (lighting_data[base + 12].z < 3.5) {
    vec2 across = vec2(0.0);
    if (kind == LAMP_SPOT) {
      float edge = lighting_data[base + 3].w;
      across = vec2(dot(from_lamp, axis_x), dot(from_lamp, cross(axis_x, shines))) /
               (max(dot(from_lamp, shines), 1e-6) * sqrt(max(1.0 - edge * edge, 1e-12)) / max(edge, 1e-6));
    }
    else if (kind == LAMP_SUN) {
      vec2 away = -vec2(dot(from_lamp, axis_x), dot(from_lamp, lighting_data[base + 5].xyz));
      float sine = length(away);
      across = away * (asin(min(sine, 1.0)) / max(sine * acos(lighting_data[base + 3].w), 1e-9));
    }
    else if (kind == LAMP_AREA) {
      vec3 axis_y = lighting_data[base + 5].xyz, away = place - lighting_data[base + 2].xyz;
      across = vec2(dot(away, axis_x) / dot(axis_x, axis_x), dot(away, axis_y) / dot(axis_y, axis_y));
    }
    at = 0.5 + 0.5 * across;
  }
  return layer < 0.0 ? vec3(1.0) : textureLod(lighting_looks, vec3(at, layer), 0.0).rgb;
}
#endif

#ifdef LIGHTING_FALLOFF
float lamp_falloff(int base, float range)
{
  int power = int(lighting_data[base + 12].z) & 3;
  float smoothness = lighting_data[base + 12].w, square = range * range;
  float strength = power == 0 ? 1.0 : (power == 1 ? range : square);
  return smoothness > 0.0 ? strength * square / (smoothness + square) : strength;
}
#endif
