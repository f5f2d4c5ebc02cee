// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps of renderer/lighting/lamps.py. Records of a lamp:
//   0: place of this sub-frame's sample (sun: direction to it), kind
//   1: intensity (sun: irradiance; area: radiance times area), width of the sample for highlights
//   2: middle (sun: direction to it), radius (area, with a spread: 1 over what its cone lets through)
//   3: direction in which it shines, cosine of the cone's or the sun's half angle (area: tangent of the half spread, 0
//      for all sides)
//   4, 5: half axes of an area lamp (else unit; but 5.x of a ball or spot: 1 without soft falloff), with: ellipse or
//      smoothness of a spot's edge; seen in mirrors
//   6: radiance of its body, kind of shadow (0 none, 1 one map, 2 cube)
//   7..10: one map: rows that give texel x, texel y, depth and w
//   11: layer of that map; whether it lights diffuse parts of surfaces, and glossy ones; seen by the camera
//   7, 8: cube: layers of +X -X +Y -Y | +Z -Z, depth terms; 9: half a face in texels, texels per slope
//   12: layer of its map (renderer/lighting/programs/lamps.py) and of what is seen of it, falloff, smoothness
// Of a scene without some kind of lamp or shadow the define LIGHTING_KIND is missing (renderer/lighting/lighting.py),
// as many drivers run all branches.
#if defined(LIGHTING_POINT) || defined(LIGHTING_SPOT) || defined(LIGHTING_AREA)
#define LIGHTING_NEAR_LAMPS
#endif
#if defined(LIGHTING_SUN) || defined(LIGHTING_NEAR_LAMPS)
#define LIGHTING_LAMPS
#endif
#if defined(LIGHTING_PICKED) && defined(RAY_SHADOWS)
#define PICKS_LAMP
#endif
#if (defined(PATH_LOBES) && defined(PATHS_GLASS)) || defined(SURFACE_TRANSLUCENT)
#define LIT_FROM_BEHIND
#endif

float spot_share(int base, vec3 from_lamp)
{
  float cosine = dot(from_lamp, lighting_data[base + 3].xyz);
  float t = clamp((cosine - lighting_data[base + 3].w) * lighting_data[base + 4].w, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

#ifdef LIGHTING_SPREAD
// Share of an area lamp's radiance that leaves it at this cosine to its normal.
float spread_share(int base, float cosine)
{
  float half_spread = lighting_data[base + 3].w;
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 1e-6);
  return half_spread == 0.0 ? 1.0 : max(half_spread - tangent, 0.0) * lighting_data[base + 2].w;
}

// Its mean over the lamp: from sample to sample of few sub-frames a narrow one would be seen as rings.
float mean_spread_share(int base, vec3 position)
{
  float sum = 0.0;
  for (int k = 0; k < 16; k++) {
    vec2 at = 0.5 * vec2(k % 4, k / 4) - 0.75;
    vec3 point = lighting_data[base + 2].xyz + at.x * lighting_data[base + 4].xyz + at.y * lighting_data[base + 5].xyz;
    sum += spread_share(base, dot(normalize(position - point), lighting_data[base + 3].xyz));
  }
  return sum / 16.0;
}
#endif

float lamp_shadow(int base, vec3 position)
{
  int kind = int(lighting_data[base + 6].w);
  vec3 window = vec3(0.0);
  float layer = -1.0;
#ifdef LIGHTING_MAPS
  if (kind == 1) {
    vec4 p = vec4(position, 1.0);
    float w = dot(lighting_data[base + 10], p);
    window = vec3(dot(lighting_data[base + 7], p), dot(lighting_data[base + 8], p),
                  dot(lighting_data[base + 9], p)) / w;
    layer = w > 0.0 ? lighting_data[base + 11].x : -1.0;
  }
#endif
#ifdef LIGHTING_CUBES
  if (kind == 2) {
    vec3 ray = position - lighting_data[base].xyz;
    vec3 size = abs(ray);
    vec4 sides = lighting_data[base + 7];
    bool x_face = size.x >= size.y && size.x >= size.z;
    bool y_face = !x_face && size.y >= size.z;
    float depth = max(size.x, max(size.y, size.z));
    vec2 across = x_face ? ray.yz : (y_face ? ray.xz : ray.xy);
    vec2 layers = x_face ? sides.xy : (y_face ? sides.zw : lighting_data[base + 8].xy);
    float towards = x_face ? ray.x : (y_face ? ray.y : ray.z);
    layer = towards > 0.0 ? layers.x : layers.y;
    window = vec3(across / depth * lighting_data[base + 9].y + lighting_data[base + 9].x,
                  lighting_data[base + 8].z + lighting_data[base + 8].w / depth);
  }
#endif
  float lit = 1.0;
  if (layer >= 0.0) {
    lit = lit_smooth(window - vec3(0.0, 0.0, 1e-6), int(layer + 0.5));
  }
  return lit;
}

#ifdef PATH_LOBES
// Of lobes that rays follow as well (paths/vertex_light.glsl): their value times the cosine and this sample's share.
// `density`: of this sample, over directions; 0 where no ray can meet the lamp.
vec3 followed_lobes(vec3 to_viewer, vec3 to_light, float density);
#endif

#ifdef LIGHTING_CLAMPED
// What is left of the light from here on its way to the eye, where it has bounced there; else 0.
vec3 clamped_way = vec3(0.0);

// As Cycles clamps what a lamp's sample brings after bounces.
vec3 clamped(vec3 radiance)
{
  return radiance * min(1.0, lighting_data[7].x / max(mean_of(abs(radiance * clamped_way)), 1e-9));
}
#endif

#ifdef PICKS_LAMP
// In 0 .. 1; each pixel has a golden section's steps of its own, which go evenly over all lamps with the sub-frames.
float lamp_random()
{
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  return fract(float(hashed(pixel.x | (pixel.y << 16u)) >> 8u) / 16777216.0 + lighting_data[0].w);
}
#endif

#ifdef LIGHTING_LAMPS
// What of a lamp gets to a place, if nothing is in the way.
struct LampLight {
  vec3 to_light;    // unit
  vec3 irradiance;  // on a plane that faces the lamp
  float width;      // of the lamp's sample as seen from here, in radians
  float range;
#ifdef PATH_LOBES
  vec3 even_irradiance;  // of a lamp that shines alike to all sides
#endif
};

LampLight lamp_light(int i, vec3 position, int light_set)
{
  int base = HEADER_RECORDS + i * LAMP_RECORDS;
  vec4 place = lighting_data[base];
  int kind = int(place.w);
  vec3 to_light = place.xyz;
  vec3 irradiance = lighting_data[base + 1].rgb;  // on a plane that faces the lamp
  float width = lighting_data[base + 1].w;
  float range = 1e30;
#ifdef PATH_LOBES
  vec3 even_irradiance = irradiance;  // of a lamp that shines alike to all sides
#endif
#ifdef LIGHTING_NEAR_LAMPS
  if (kind != LAMP_SUN) {
    to_light = place.xyz - position;
    float facing = 1.0;
    if (kind != LAMP_AREA) {
      // a ball shines as a disk that faces the surface: the sample moved into that disk
      vec3 middle = lighting_data[base + 2].xyz - position;
      float away2 = max(dot(middle, middle), 1e-30);
      to_light -= middle * (dot(to_light, middle) / away2 - 1.0);
#ifdef LIGHTING_BALLS
      if (lighting_data[base + 5].x > 0.5) {
        // of a ball the disk inside the cone that touches it is as bright
        float radius = lighting_data[base + 2].w;
        float share = max(1.0 - radius * radius / away2, 0.0);
        to_light = middle * share + (to_light - middle) * sqrt(share);
        irradiance *= share;
        away2 *= share * share;
      }
#endif
      facing = sqrt(away2 / max(dot(to_light, to_light), 1e-30));
    }
    float distance2 = max(dot(to_light, to_light), 1e-30);
    range = sqrt(distance2);
    to_light *= inversesqrt(distance2);
    width *= inversesqrt(distance2);
    if (kind == LAMP_AREA) {
      facing = max(-dot(to_light, lighting_data[base + 3].xyz), 0.0);
      // no closer than a share of its own size: a point stands for its surroundings
      distance2 = max(distance2, lighting_data[base + 1].w * lighting_data[base + 1].w);
#ifdef LIGHTING_SPREAD
      irradiance *= mean_spread_share(base, position);
#endif
    }
    else if (kind == LAMP_SPOT) {
      irradiance *= spot_share(base, -to_light);
    }
    // (Not endless at the lamp's own place.)
    irradiance = clamp(irradiance * (facing / distance2), vec3(-1e20), vec3(1e20));
#ifdef PATH_LOBES
    even_irradiance = clamp(even_irradiance * (facing / distance2), vec3(-1e20), vec3(1e20));
#endif
  }
#endif
#ifdef LIGHTING_LOOKS
  irradiance *= lamp_look(base, lighting_data[base + 12].x, kind, -to_light, position + to_light * range);
#endif
#ifdef LIGHTING_FALLOFF
  irradiance *= kind == LAMP_SUN ? 1.0 : lamp_falloff(base, range);
#endif
#ifdef LIGHTING_LINKED
  irradiance *= is_for_set(int(lighting_data[LINK_RECORDS + i].x), light_set) ? 1.0 : 0.0;
#endif
  LampLight light;
  light.to_light = to_light;
  light.irradiance = irradiance;
  light.width = width;
  light.range = range;
#ifdef PATH_LOBES
  light.even_irradiance = even_irradiance;
#endif
  return light;
}
#endif

// Radiance towards the viewer from all lamps. With PICKS_LAMP one of them, by what they would send without shadows,
// stands for all that cast any (Talbot et al., "Importance resampling for global illumination", 2005).
vec3 lamps_on(Surface s, Lobes lobes, vec3 to_viewer)
{
  vec3 sum = vec3(0.0);
#ifdef LIGHTING_LAMPS
#ifdef PICKS_LAMP
  Surface picked = s;
  vec3 picked_light = vec3(0.0), picked_way = s.normal;
  float picked_range = 1.0, picked_weight = 0.0, weights = 0.0, random = lamp_random();
#ifdef LIGHTING_SHADOWS_LINKED
  int picked_blockers = EVERY_SET;
#endif
#endif
  int count = int(lighting_data[0].x);
  int i = 0;
  do {
    int base = HEADER_RECORDS + i * LAMP_RECORDS;
#ifdef LIGHTING_LINKED
    LampLight light = lamp_light(i, s.position, s.light_set);
#else
    LampLight light = lamp_light(i, s.position, 0);
#endif
    vec3 to_light = light.to_light;
    vec3 irradiance = light.irradiance;
    float width = light.width;
    float range = light.range;
#ifdef PATH_LOBES
    vec3 even_irradiance = light.even_irradiance;
#endif
    float cos_light = dot(s.normal, to_light);
    bool is_lit = cos_light > 0.0;
#ifdef LIT_FROM_BEHIND
    // (What lets light through and scatters it.)
    is_lit = true;
    s.normal *= cos_light < 0.0 ? -1.0 : 1.0;
#endif
    if (is_lit && irradiance != vec3(0.0)) {
      // (Without a kind of shadow it casts none, or nothing could be in it.)
      bool has_shadow = int(lighting_data[base + 6].w) != 0;
#if defined(RAY_SHADOWS) && !defined(PICKS_LAMP)
#ifdef LIGHTING_SHADOWS_LINKED
      lamp_blockers = has_shadow ? int(lighting_data[LINK_RECORDS + i].y) : EVERY_SET;
#endif
      irradiance *= has_shadow ? lit_by_ray(s, to_light, range) : LIT(1.0);
#elif !defined(RAY_SHADOWS)
      irradiance *= lamp_shadow(base, s.position);
#endif
      vec3 scattered = diffuse_lobes(s, lobes, to_viewer, to_light, cos_light);
#ifdef SURFACE_TRANSLUCENT
      scattered += lobes.translucent * (max(-cos_light, 0.0) / LIGHTING_PI);
#endif
#ifdef LIGHTING_PARTS
      scattered *= lighting_data[base + 11].y;
#endif
#if !defined(PATH_LOBES) || defined(PATHS_ALPHA)
      // highlights are as wide as the lamp, of which this is one sample: half its angle in the half vector
      float alpha = sqrt(lobes.alpha * lobes.alpha + 0.25 * width * width);
      bool is_above = lobes.metal_weight.g + lobes.dielectric_weight.g > 0.0;
#ifdef LIT_FROM_BEHIND
      is_above = is_above && cos_light > 0.0;
#endif
      if (alpha > GGX_SINGULAR_ALPHA && is_above) {
        vec3 glossy = glossy_lobe(lobes, alpha, s.normal, to_viewer, to_light, cos_light);
#ifdef LIGHTING_PARTS
        glossy *= lighting_data[base + 11].z;
#endif
        scattered += glossy;
      }
#ifdef SURFACE_COAT
      float coat_alpha = sqrt(lobes.coat_alpha * lobes.coat_alpha + 0.25 * width * width);
      if (coat_alpha > GGX_SINGULAR_ALPHA && lobes.coat_weight > 0.0 && cos_light > 0.0) {
        float coat = coat_lobe(lobes, coat_alpha, s.normal, to_viewer, to_light, cos_light);
#ifdef LIGHTING_PARTS
        coat *= lighting_data[base + 11].z;
#endif
        scattered += vec3(coat);
      }
#endif
#endif
#ifdef PATH_LOBES
      vec3 body = abs(lighting_data[base + 6].rgb) * (lighting_data[base + 5].w > 0.5 ? 1.0 : 0.0);
      vec3 even = abs(even_irradiance);
      float density = (body.r + body.g + body.b) / max(even.r + even.g + even.b, 1e-30);
      vec3 followed = followed_lobes(to_viewer, to_light, density);
#ifdef LIGHTING_PARTS
      followed *= lighting_data[base + 11].z;
#endif
      scattered += followed;
#endif
      scattered *= irradiance;
#ifdef PICKS_LAMP
      if (has_shadow) {
        float weight = mean_of(abs(scattered));
        weights += weight;
        float chance = weight / max(weights, 1e-30);
        bool is_picked = random < chance;
        random = is_picked ? random / chance : (random - chance) / max(1.0 - chance, 1e-6);
        if (is_picked) {
          picked_light = scattered;
          picked_weight = weight;
          picked_way = to_light;
          picked_range = range;
          picked.normal = s.normal;
#ifdef LIGHTING_SHADOWS_LINKED
          picked_blockers = int(lighting_data[LINK_RECORDS + i].y);
#endif
        }
        scattered = vec3(0.0);
      }
#endif
#ifdef LIGHTING_CLAMPED
      scattered = clamped(scattered);
#endif
      sum += scattered;
    }
#ifdef LIT_FROM_BEHIND
    s.normal *= cos_light < 0.0 ? -1.0 : 1.0;
#endif
    i++;
  } while (i < count);
#ifdef PICKS_LAMP
  if (picked_weight > 0.0) {
#ifdef LIGHTING_SHADOWS_LINKED
    lamp_blockers = picked_blockers;
#endif
    picked_light *= weights / picked_weight;
#ifdef LIGHTING_CLAMPED
    picked_light = clamped(picked_light);
#endif
    sum += picked_light * lit_by_ray(picked, picked_way, picked_range);
  }
#endif
#endif
  return sum;
}
