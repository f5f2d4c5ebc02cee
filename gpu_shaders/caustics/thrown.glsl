// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light that lamps throw over mirrors and through glass: the pieces of it at a place, by the lists of
// renderer/caustics/lists.py. Needs the sampler `thrown`.

// Radiance towards the viewer of one piece, whose irradiance is that across the light.
vec3 piece_on(Surface s, Lobes lobes, vec3 to_viewer, vec3 to_light, vec3 irradiance)
{
  float cos_light = dot(s.normal, to_light);
  vec3 scattered = vec3(0.0);
#ifdef SURFACE_TRANSLUCENT
  scattered += lobes.translucent * (max(-cos_light, 0.0) / LIGHTING_PI);
#endif
  if (cos_light > 0.0) {
    scattered += diffuse_lobes(s, lobes, to_viewer, to_light, cos_light);
    bool is_above = lobes.metal_weight.g + lobes.dielectric_weight.g > 0.0;
    if (lobes.alpha > GGX_SINGULAR_ALPHA && is_above) {
      scattered += glossy_lobe(lobes, lobes.alpha, s.normal, to_viewer, to_light, cos_light);
    }
#ifdef SURFACE_COAT
    if (lobes.coat_alpha > GGX_SINGULAR_ALPHA && lobes.coat_weight > 0.0) {
      scattered += vec3(coat_lobe(lobes, lobes.coat_alpha, s.normal, to_viewer, to_light, cos_light));
    }
#endif
  }
  return scattered * irradiance;
}

vec3 thrown_on(Surface s, Lobes lobes, vec3 to_viewer)
{
  vec4 head = fetch_record(thrown, 0);
  vec3 sum = vec3(0.0);
  vec3 position = s.position + head.w * vec3(0.371, 0.593, 0.717);
  int level = 0;
  while (level < int(head.x)) {
    vec4 about = fetch_record(thrown, 1 + level);
    uvec3 cell = uvec3(ivec3(floor(position / about.x)));
    uint key = hashed(cell.x ^ hashed(cell.y ^ hashed(cell.z)));
    vec4 bucket = fetch_record(thrown, int(about.y) + int(key & uint(about.z)));
    int entry = int(bucket.x);
    int end = entry + int(bucket.y);
    while (entry < end) {
      int piece = int(head.z) + PIECE_RECORDS * int(fetch_record(thrown, int(head.y) + (entry >> 2))[entry & 3]);
      vec4 corner = fetch_record(thrown, piece);
      vec4 first = fetch_record(thrown, piece + 1);
      vec4 second = fetch_record(thrown, piece + 2);
      vec3 offset = position - corner.xyz;
      vec2 place = vec2(dot(first.xyz, offset), dot(second.xyz, offset));
      if (place.x >= 0.0 && place.y >= 0.0 && place.x + place.y <= 1.0) {
        vec4 light = fetch_record(thrown, piece + 3);
        // (The pieces' thickness tells surfaces behind each other apart.)
        if (abs(dot(vec3(first.w, second.w, light.w), offset)) <= corner.w) {
          vec3 to_light = -fetch_record(thrown, piece + 4).xyz;
          sum += piece_on(s, lobes, to_viewer, to_light, light.rgb);
        }
      }
      entry++;
    }
    level++;
  }
  return sum;
}
