// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The world: seen, as diffuse light with the shadows of a few directions, and in glossy lobes.
// Needs the samplers `lighting_world_image` (FLOAT_2D, equirectangular) and `lighting_world_maps` (FLOAT_2D_ARRAY,
// octahedral: irradiance, irradiance over that of the directions, one radiance map per roughness level).
// Records of a direction: itself and its layer of the depth maps; weight; rows to texel x, texel y and depth.
#define WORLD_MAP_SIZE 64.0
#define WORLD_MAP_LOBES 2

vec3 world_color()
{
  return lighting_data[1].rgb;
}

// Background radiance in the unit direction.
vec3 world_radiance(vec3 direction)
{
  if (lighting_data[0].z < 0.5) {
    return world_color();
  }
  vec3 d = vec3(dot(lighting_data[2].xyz, direction),
                dot(lighting_data[3].xyz, direction),
                dot(lighting_data[4].xyz, direction));
  float u = 0.5 - atan(d.y, d.x) / (2.0 * LIGHTING_PI);
  float v = 0.5 + asin(clamp(d.z, -1.0, 1.0)) / LIGHTING_PI;
  return world_color() * textureLod(lighting_world_image, vec2(u, v), 0.0).rgb;
}

vec2 octahedral_place(vec3 direction)
{
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  if (d.z < 0.0) {
    vec2 side = vec2(d.x < 0.0 ? -1.0 : 1.0, d.y < 0.0 ? -1.0 : 1.0);
    d.xy = (1.0 - abs(d.yx)) * side;
  }
  return (d.xy * (0.5 * (WORLD_MAP_SIZE - 1.0)) + 0.5 * WORLD_MAP_SIZE) / WORLD_MAP_SIZE;
}

vec3 world_map(vec2 place, int layer)
{
  return textureLod(lighting_world_maps, vec3(place, float(layer)), 0.0).rgb;
}

// Mean radiance that a lobe of this roughness about `direction` sees, without shadows.
vec3 world_lobe(vec3 direction, float roughness)
{
  // levels 0.2, 0.35, 0.5, 0.65, 0.8, 1.0; below the first the image itself takes over
  float level = roughness < 0.8 ? max((roughness - 0.2) / 0.15, 0.0) : 4.0 + min((roughness - 0.8) / 0.2, 1.0);
  float below = min(floor(level), 4.0);
  vec2 place = octahedral_place(direction);
  int layer = WORLD_MAP_LOBES + int(below);
  vec3 radiance = mix(world_map(place, layer), world_map(place, layer + 1), level - below);
  if (roughness < 0.2) {
    radiance = mix(world_radiance(direction), radiance, roughness / 0.2);
  }
  return radiance;
}

// Radiance towards the viewer from the world. The directions' shadows are taken off the exact irradiance, scaled so
// that a point that sees none of them gets nothing. One sub-frame alone may take off too much: only the mean is right.
vec3 world_on(Surface s, Lobes lobes, vec3 to_viewer)
{
  vec3 sum = vec3(0.0);
  if (max(world_color().r, max(world_color().g, world_color().b)) > 0.0) {
    vec2 place = octahedral_place(s.normal);
    vec3 irradiance = world_map(place, 0);
    vec3 lost = vec3(0.0);
    int count = int(lighting_data[0].y);
    vec4 p = vec4(s.position, 1.0);
    int i = 0;
    do {
      int record = HEADER_RECORDS + MAX_LAMPS * LAMP_RECORDS + DIRECTION_RECORDS * i;
      vec4 light = lighting_data[record];
      float cos_light = max(dot(s.normal, light.xyz), 0.0);
      vec3 window = vec3(dot(lighting_data[record + 2], p),
                         dot(lighting_data[record + 3], p),
                         dot(lighting_data[record + 4], p) - 2e-6);
      lost += lighting_data[record + 1].rgb * (cos_light * (1.0 - lit_sharp(window, int(light.w))));
      i++;
    } while (i < count);
    vec3 seen = irradiance - world_map(place, 1) * lost;
    sum = lobes.diffuse * seen / LIGHTING_PI;
    if (max(lobes.specular_albedo.r, max(lobes.specular_albedo.g, lobes.specular_albedo.b)) > 0.0) {
      vec3 share = seen / max(irradiance, vec3(1e-9));
      vec3 reflected = reflect(-to_viewer, s.normal);
      sum += lobes.specular_albedo * world_lobe(reflected, clamp(s.roughness, 0.0, 1.0)) * share;
    }
  }
  return sum;
}
