// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The world: seen, as diffuse light with the shadows of a few directions, and in glossy lobes.
// Needs the samplers `lighting_world_image`, with LIGHTING_SEEN `lighting_world_seen` (equirectangular: what mirrors
// show, what the camera sees), and `lighting_world_maps` (FLOAT_2D_ARRAY,
// octahedral: irradiance, irradiance over that of the directions, one radiance map per roughness level).
// Records of a direction: itself and its layer of the depth maps; rows to texel x, texel y and depth; weight (its red,
// green and blue as alpha), which without an image is that of all, in the header.

vec3 world_color()
{
  return lighting_data[1].rgb;
}

// Of a unit direction in the world's image.
vec2 world_place(vec3 direction)
{
  vec3 d = vec3(dot(lighting_data[2].xyz, direction),
                dot(lighting_data[3].xyz, direction),
                dot(lighting_data[4].xyz, direction));
  return vec2(0.5 - atan(d.y, d.x) / (2.0 * LIGHTING_PI), 0.5 + asin(clamp(d.z, -1.0, 1.0)) / LIGHTING_PI);
}

// Background radiance in the unit direction.
vec3 world_radiance(vec3 direction)
{
#ifdef LIGHTING_IMAGE
  if (lighting_data[0].z < 0.5) {
    return world_color();
  }
  return world_color() * textureLod(lighting_world_image, world_place(direction), 0.0).rgb;
#else
  return world_color();
#endif
}

// The same as the camera sees it, or as mirrors do.
vec3 world_seen(vec3 direction, bool by_camera)
{
  vec3 radiance = world_radiance(direction);
#ifdef LIGHTING_SEEN
  radiance = by_camera ? textureLod(lighting_world_seen, world_place(direction), 0.0).rgb : radiance;
#endif
#ifdef LIGHTING_PARTS
  radiance *= by_camera ? lighting_data[6].x : lighting_data[6].z;
#endif
  return radiance;
}

#ifdef PATH_LIGHT
// The same as a ray that was chosen with this density among many meets it: to rough surfaces its suns are lamps.
vec3 world_met(vec3 direction, bool by_camera, float density)
{
  vec3 radiance = world_seen(direction, by_camera);
#ifdef LIGHTING_IMAGE
  if (density > 0.0) {
    radiance *= min(1.0, lighting_data[1].w / max(radiance.r + radiance.g + radiance.b, 1e-9));
  }
#endif
  return radiance;
}
#endif

vec2 octahedral_place(vec3 direction)
{
  return (octahedral_of(direction) * (0.5 * (WORLD_MAP_SIZE - 1.0)) + 0.5 * WORLD_MAP_SIZE) / WORLD_MAP_SIZE;
}

vec4 world_map(vec2 place, int layer)
{
  return textureLod(lighting_world_maps, vec3(place, float(layer)), 0.0);
}

// What arrives about the normal at this place of the maps, without shadows.
vec3 world_irradiance(vec2 place)
{
#ifdef LIGHTING_IMAGE
  return world_map(place, 0).rgb;
#else
  return LIGHTING_PI * world_color();
#endif
}

// Mean radiance that a lobe of this roughness about `direction` sees, without shadows; alpha: the directions' weights
// under `lobe_window`.
vec4 world_lobe(vec3 direction, float roughness)
{
#ifndef LIGHTING_IMAGE
  return vec4(world_color(), world_map(octahedral_place(direction), WORLD_MAP_LOBES).a);
#else
  // Levels are evenly spaced but for the last; below the first the image itself takes over.
  float level = roughness < LOBE_LAST_BUT_ONE ?
    max((roughness - LOBE_FIRST) / LOBE_STEP, 0.0) :
    LOBE_STEPS + min((roughness - LOBE_LAST_BUT_ONE) / LOBE_LAST_STEP, 1.0);
  float below = min(floor(level), LOBE_STEPS);
  vec2 place = octahedral_place(direction);
  int layer = WORLD_MAP_LOBES + int(below);
  vec4 radiance = mix(world_map(place, layer), world_map(place, layer + 1), level - below);
  if (roughness < LOBE_FIRST) {
    // the image's suns are lamps to glossy surfaces
    vec3 sharp = world_radiance(direction);
    sharp *= min(1.0, lighting_data[1].w / max(sharp.r + sharp.g + sharp.b, 1e-9));
    radiance.rgb = mix(sharp, radiance.rgb, roughness / LOBE_FIRST);
  }
  return radiance;
#endif
}

#ifdef SURFACE_SHEEN
#define SHEEN_PART_ROUGHNESS 0.5
#endif

// How much a direction's shadow counts for a glossy lobe at this cosine to it.
float lobe_window(float cosine)
{
  float square = cosine * cosine;
  return cosine > 0.0 ? square * square : 0.0;
}

// Mean direction of the lobe: at grazing angles and on rough surfaces nearer to the normal than the mirror's.
vec3 lobe_middle(vec3 to_viewer, vec3 normal, float cos_normal)
{
  vec3 across = normal * dot(normal, to_viewer) - to_viewer;
  float sine = sqrt(max(1.0 - cos_normal * cos_normal, 0.0));
  return normal * cos_normal + across * (sine * inversesqrt(max(dot(across, across), 1e-12)));
}

#ifdef QUADS
bool world_is_shared = false;  // the pixel's quad lies on one surface (quad.glsl)
bool world_is_parted = false;  // it does not, but a part of the directions stands for all: where chance rules anyway
int world_turn = 0;            // whose part which is changes from sub-frame to sub-frame and from quad to quad
#endif

#ifdef SURFACE_SHEEN
// Mean radiance that the lobe sees: of four places that stand for a quarter of it each.
vec3 world_in_sheen(Surface s, Lobes lobes, vec3 to_viewer)
{
  vec3 x = along_to_viewer(s.normal, to_viewer), sum = vec3(0.0);
  mat3 frame = mat3(x, cross(s.normal, x), s.normal);
  for (int k = 0; k < 4; k++) {
    vec2 disk = vec2(k % 2, k / 2) - 0.5;
    sum += world_lobe(frame * sheen_direction(lobes.sheen_transform, disk), SHEEN_PART_ROUGHNESS).rgb;
  }
  return 0.25 * sum;
}
#endif

#ifdef SURFACE_DIFFUSE_ROUGHNESS
// What arrives for a rough base, in parts of what arrives for an even one: it looks back to the viewer's side.
vec3 world_on_rough_base(Surface s, Lobes lobes, vec3 to_viewer, vec3 irradiance)
{
  float c = lobes.cos_viewer;
  float sine = sqrt(max(1.0 - c * c, 0.0));
  OrenNayar o = lobes.rough_base;
  // Its mean direction, as optics/scattering/oren_nayar.py: oren_nayar_tilt.
  float along = o.rough * sine * (11.0 + c * (c * c - 6.0)) * LIGHTING_PI / 24.0;
  float up = sine * (0.274037 + c * (-0.002556 + c * (-0.314822 + c * (-0.045698 + c * 0.088027))));
  float sigma = clamp(s.diffuse_roughness, 0.0, 1.0);
  float level = 1.0 / (LIGHTING_PI + sigma * (0.5 * LIGHTING_PI - 2.0 / 3.0));
  float twice = 2.0 / 3.0 * LIGHTING_PI * (1.0 - level * LIGHTING_PI) - sigma * level * 0.321012;
  up = LIGHTING_PI * 2.0 / 3.0 * o.level + o.rough * up + mean_of(o.again) * twice;
  vec3 middle = normalize(s.normal * up + along_to_viewer(s.normal, to_viewer) * along);
  vec3 turned = world_irradiance(octahedral_place(middle)) / max(irradiance, 1e-9);
  return oren_nayar_albedo(o, s.diffuse_roughness, c) * turned;
}
#endif

// Radiance towards the viewer from the world. The directions' shadows are taken off the exact light, scaled so that a
// point that sees none of them gets nothing. One sub-frame alone may take off too much: only the mean is right.
vec3 world_on(Surface s, Lobes lobes, vec3 to_viewer)
{
  vec3 sum = vec3(0.0);
#if defined(LIGHTING_WORLD) && !defined(SKY_GATHERED)
  if (max(world_color().r, max(world_color().g, world_color().b)) > 0.0) {
    vec2 place = octahedral_place(s.normal);
    vec4 shapes = ggx_table(s.roughness, lobes.cos_viewer, float(GGX_IOR_SLICES));
    vec2 shape = lobes.dielectric_weight.g > 0.0 ? mix(shapes.zw, shapes.xy, clamp(s.metallic, 0.0, 1.0)) : shapes.xy;
    vec3 middle = lobe_middle(to_viewer, s.normal, shape.x);
    vec3 lost = vec3(0.0);
    float lobe_lost = 0.0;
#ifdef SURFACE_TRANSLUCENT
    vec3 lost_behind = vec3(0.0);
#endif
#if defined(SURFACE_SHEEN) || defined(SURFACE_COAT)
    vec3 lost_above = vec3(0.0);  // of the coat; of sheen, and the directions' weights in that
    vec3 towards = along_to_viewer(s.normal, to_viewer);
#endif
#ifdef SURFACE_COAT
    vec2 coat_shape = ggx_table(s.coat_roughness, lobes.cos_viewer, float(GGX_IOR_SLICES)).zw;
    vec3 coat_middle = lobe_middle(to_viewer, s.normal, coat_shape.x);
#endif
    vec4 p = vec4(s.position, 1.0);
    int count = int(lighting_data[0].y);
#ifdef QUADS
    // The four pixels of a quad take a quarter of the directions each.
    // (Of few directions none is left out: there are many sub-frames then, and little to gain.)
    int parts = count < 4 ? 1 : 4;
    int i = world_is_shared ? quad_lane() : (world_is_parted ? (quad_lane() + world_turn) % parts : 0);
    int stride = world_is_shared ? 4 : (world_is_parted ? parts : 1);
#else
    int i = 0;
    int stride = 1;
#endif
    do {
      int record = HEADER_RECORDS + MAX_LAMPS * LAMP_RECORDS + DIRECTION_RECORDS * i;
      vec4 light = lighting_data[record];
#ifdef LIGHTING_IMAGE
      vec4 weight = lighting_data[record + 4];
#else
      vec4 weight = lighting_data[5];
#endif
      float cos_light = max(dot(s.normal, light.xyz), 0.0);
      bool may_light = cos_light > 0.0;
#ifdef SURFACE_TRANSLUCENT
      float cos_behind = max(-dot(s.normal, light.xyz), 0.0);
      may_light = may_light || largest(lobes.translucent) > 0.0;
#endif
#ifdef WORLD_RAYS
#ifdef SURFACE_TRANSLUCENT
      Surface side = s;
      side.normal *= cos_behind > 0.0 ? -1.0 : 1.0;
      LIT dark = may_light ? LIT(1.0) - lit_by_ray(side, light.xyz, 1e30) : LIT(0.0);
#else
      LIT dark = may_light ? LIT(1.0) - lit_by_ray(s, light.xyz, 1e30) : LIT(0.0);
#endif
      float mean_dark = dot(dark, LIT(1.0)) / LIT_CHANNELS;
#else
      vec3 window = vec3(dot(lighting_data[record + 1], p),
                         dot(lighting_data[record + 2], p),
                         dot(lighting_data[record + 3], p) - 2e-6);
      float dark = may_light ? 1.0 - lit_sharp(window, int(light.w)) : 0.0;
      float mean_dark = dark;
#endif
      lost += weight.rgb * (cos_light * dark);
#ifdef SURFACE_TRANSLUCENT
      lost_behind += weight.rgb * (cos_behind * dark);
      mean_dark *= cos_light > 0.0 ? 1.0 : 0.0;
#endif
      lobe_lost += weight.w * lobe_window(dot(middle, light.xyz)) * mean_dark;
#ifdef SURFACE_COAT
      lost_above.x += weight.w * lobe_window(dot(coat_middle, light.xyz)) * mean_dark;
#endif
#ifdef SURFACE_SHEEN
      vec3 local = vec3(dot(towards, light.xyz), dot(cross(s.normal, towards), light.xyz), cos_light);
      float in_sheen = weight.w * sheen_value(lobes.sheen_transform, local);
      lost_above.yz += vec2(in_sheen * mean_dark, in_sheen);
#endif
      i += stride;
    } while (i < count);
#ifdef QUADS
    vec4 all = quad_sum(vec4(lost, lobe_lost));
    lost = world_is_shared ? all.xyz : (world_is_parted ? float(parts) * lost : lost);
    lobe_lost = world_is_shared ? all.w : (world_is_parted ? float(parts) * lobe_lost : lobe_lost);
#ifdef SURFACE_TRANSLUCENT
    vec3 all_behind = quad_sum(vec4(lost_behind, 0.0)).xyz;
    lost_behind = world_is_shared ? all_behind : (world_is_parted ? float(parts) * lost_behind : lost_behind);
#endif
#if defined(SURFACE_SHEEN) || defined(SURFACE_COAT)
    vec3 all_above = quad_sum(vec4(lost_above, 0.0)).xyz;
    lost_above = world_is_shared ? all_above : (world_is_parted ? float(parts) * lost_above : lost_above);
#endif
#endif
    vec3 irradiance = world_irradiance(place);
    vec3 seen = irradiance - world_map(place, 1).rgb * lost;
#ifdef SURFACE_DIFFUSE_ROUGHNESS
    seen *= world_on_rough_base(s, lobes, to_viewer, irradiance);
#endif
    vec3 added = vec3(0.0);  // of diffuse parts beside the base
#ifdef SURFACE_TRANSLUCENT
    vec2 behind = octahedral_place(-s.normal);
    added += lobes.translucent * (world_irradiance(behind) - world_map(behind, 1).rgb * lost_behind) / LIGHTING_PI;
#endif
#ifdef SURFACE_SHEEN
    added += lobes.sheen * world_in_sheen(s, lobes, to_viewer) * (1.0 - lost_above.y / max(lost_above.z, 1e-9));
#endif
#ifdef SURFACE_COAT
    vec4 coat = world_lobe(coat_middle, coat_shape.y);
    coat.rgb *= lobes.coat_albedo * (1.0 - lost_above.x / max(coat.a, 1e-9));
#endif
#ifdef GATHERED
    // (Rays off the lobe find the world.)
    vec4 lobe = vec4(0.0);
#else
    vec4 lobe = world_lobe(middle, shape.y);
#endif
#ifdef LIGHTING_PARTS
    seen *= lighting_data[6].y;
    lobe.rgb *= lighting_data[6].z;
    added *= lighting_data[6].y;
#ifdef SURFACE_COAT
    coat.rgb *= lighting_data[6].z;
#endif
#endif
#ifdef SURFACE_COAT
    added += coat.rgb;
#endif
    sum = added + lobes.diffuse * seen / LIGHTING_PI +
          lobes.specular_albedo * lobe.rgb * (1.0 - lobe_lost / max(lobe.a, 1e-9));
  }
#endif
  return sum;
}
