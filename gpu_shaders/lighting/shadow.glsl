// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Look-ups in the depth maps of renderer/lighting/shadow_maps.py. Needs the samplers (DEPTH_2D_ARRAY)
// `lighting_lamp_depth` and `lighting_world_depth`.

// The maps' outermost texels are empty, and stand for all that lies outside; so does a depth past the last caster.

// 1 where the light reaches window position `window` (texels, depth) of the layer, bilinear over four texels.
float lit_smooth(vec3 window, int layer)
{
  vec2 corner = clamp(window.xy - 0.5, vec2(0.0), vec2(textureSize(lighting_lamp_depth, 0).xy) - 1.001);
  ivec3 texel = ivec3(ivec2(corner), layer);
  vec2 part = fract(corner);
  float d00 = texelFetch(lighting_lamp_depth, texel, 0).r;
  float d10 = texelFetch(lighting_lamp_depth, texel + ivec3(1, 0, 0), 0).r;
  float d01 = texelFetch(lighting_lamp_depth, texel + ivec3(0, 1, 0), 0).r;
  float d11 = texelFetch(lighting_lamp_depth, texel + ivec3(1, 1, 0), 0).r;
  vec4 lit = step(vec4(min(window.z, 1.0)), vec4(d00, d10, d01, d11));
  return mix(mix(lit.x, lit.y, part.x), mix(lit.z, lit.w, part.x), part.y);
}

// The same for a world direction, one texel: many directions are averaged.
float lit_sharp(vec3 window, int layer)
{
  vec2 place = clamp(window.xy, vec2(0.0), vec2(textureSize(lighting_world_depth, 0).xy) - 0.5);
  return step(min(window.z, 1.0), texelFetch(lighting_world_depth, ivec3(ivec2(place), layer), 0).r);
}
