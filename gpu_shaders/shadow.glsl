// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Look-ups in the depth maps of renderer/lighting_shadow_maps.py. Needs the samplers (DEPTH_2D_ARRAY)
// `lighting_lamp_depth` and `lighting_world_depth`.

// 1 where the light reaches window position `window` (texels, depth) of the layer, bilinear over four texels.
float lit_smooth(vec3 window, int layer)
{
  int size = textureSize(lighting_lamp_depth, 0).x;
  vec2 corner = window.xy - 0.5;
  ivec2 texel = ivec2(floor(corner));
  vec2 part = corner - vec2(texel);
  if (any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, ivec2(size - 2)))) {
    return 1.0;
  }
  float d00 = texelFetch(lighting_lamp_depth, ivec3(texel, layer), 0).r;
  float d10 = texelFetch(lighting_lamp_depth, ivec3(texel + ivec2(1, 0), layer), 0).r;
  float d01 = texelFetch(lighting_lamp_depth, ivec3(texel + ivec2(0, 1), layer), 0).r;
  float d11 = texelFetch(lighting_lamp_depth, ivec3(texel + ivec2(1, 1), layer), 0).r;
  vec4 lit = step(vec4(min(window.z, 1.0)), vec4(d00, d10, d01, d11));  // past the last caster: lit by the empty map
  return mix(mix(lit.x, lit.y, part.x), mix(lit.z, lit.w, part.x), part.y);
}

// The same for a world direction, one texel: many directions are averaged.
float lit_sharp(vec3 window, int layer)
{
  int size = textureSize(lighting_world_depth, 0).x;
  ivec2 texel = ivec2(floor(window.xy));
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(size)))) {
    return 1.0;
  }
  return step(min(window.z, 1.0), texelFetch(lighting_world_depth, ivec3(texel, layer), 0).r);
}
