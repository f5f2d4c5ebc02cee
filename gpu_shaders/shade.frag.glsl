// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light for every pixel of the surface buffers: the seen surface for the eye, the reflected one for the mirror point.
#include "lighting.glsl"
#include "records.glsl"

Surface surface_of(vec4 position, vec4 normal, vec3 color)
{
  int record = 2 * int(normal.w + 0.5);
  vec4 first = fetch_record(materials, record);
  vec4 second = fetch_record(materials, record + 1);
  Surface s;
  s.position = position.xyz;
  s.normal = normal.xyz;
  s.base_color = color;
  s.metallic = first.x;
  s.roughness = first.y;
  s.ior = first.z;
  s.specular_level = first.w;
  s.emission = second.xyz;
  s.glossy_only = second.w > 0.5;
  return s;
}

vec3 world_point(vec2 ndc, float depth)
{
  vec4 point = view.clip_to_world * vec4(ndc, depth, 1.0);
  return point.xyz / point.w;
}

vec3 over_lamps(vec3 behind, vec3 origin, vec3 direction, float distance)
{
  vec4 lamps = lamps_seen(origin, direction, distance);
  return mix(behind, lamps.rgb, lamps.a);
}

vec3 shade_reflection(ivec2 pixel, Surface mirror, vec3 to_eye)
{
  vec3 direction = reflect(-to_eye, mirror.normal);
#ifdef ENVIRONMENT_CUBE
  return texture(environment, direction).rgb;
#else
  vec4 position = texelFetch(reflected_position, pixel, 0);
  if (position.w == 0.0) {
    return over_lamps(world_radiance(direction), mirror.position, direction, 1e30);
  }
  Surface seen = surface_of(
      position, texelFetch(reflected_normal, pixel, 0), texelFetch(reflected_color, pixel, 0).rgb);
  vec3 to_mirror = mirror.position - seen.position;
  float range = length(to_mirror);
  return over_lamps(shade_surface(seen, to_mirror / range), mirror.position, direction, range);
#endif
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(seen_position, pixel, 0);
#ifdef ENVIRONMENT_CUBE
  // One pass per mirror; the first also does all that is no mirror.
  float number = texelFetch(seen_color, pixel, 0).w;
  if (max(position.w > 0.0 ? number : 1.0, 1.0) != mirror) {
    discard;
  }
#endif
  vec2 ndc = 2.0 * gl_FragCoord.xy / vec2(textureSize(seen_position, 0)) - 1.0;
  vec3 from = world_point(ndc, -1.0);
  vec3 direction = normalize(world_point(ndc, 1.0) - from);
  if (position.w == 0.0) {
    color = vec4(over_lamps(world_radiance(direction), from, direction, 1e30), 1.0) * weight;
    return;
  }
  vec4 normal = texelFetch(seen_normal, pixel, 0);
  if (normal.w < -0.5) {  // holdout
    color = vec4(0.0);
    return;
  }
  vec4 base = texelFetch(seen_color, pixel, 0);
  Surface seen = surface_of(position, normal, base.rgb);
  vec3 radiance;
  if (base.w > 0.5) {
    vec3 reflection = shade_reflection(pixel, seen, -direction);
    radiance = shade_under_mirror(seen, -direction) +
               mirror_reflectance(seen, max(dot(seen.normal, -direction), 0.0)) * reflection;
  }
  else {
    radiance = shade_surface(seen, -direction);
  }
  color = vec4(over_lamps(radiance, from, direction, distance(from, seen.position)), 1.0) * weight;
}
