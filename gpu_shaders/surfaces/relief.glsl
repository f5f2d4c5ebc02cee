// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Shading normals bent by a normal map or by heights, as Cycles' nodes Normal Map (in tangent space) and Bump bend
// them. Tangents come from screen-space derivatives. Needs the uniform block `view`, the interpolated `world_position`
// and `uv`, and of renderer/surfaces/materials.py: `relief` (is bump, strength, distance), `relief_transform`,
// `relief_turn` and `relief_image`. Goes behind raised_normal.glsl.

// `normal`: unit, outward.
vec3 bent_normal(vec3 normal)
{
  vec3 right = dFdx(world_position), up = dFdy(world_position);
  vec2 uv_right = dFdx(uv), uv_up = dFdy(uv);
  vec2 place = uv * relief_transform.xy + relief_transform.zw + relief_turn * uv.yx;
  vec3 bent = normal;
  if (relief.x > 0.5) {
    // Slope of the heights that are interpolated between texels, per screen pixel.
    vec2 half_texel = 0.5 / vec2(textureSize(relief_image, 0));
    vec2 u = vec2(half_texel.x, 0.0), v = vec2(0.0, half_texel.y);
    vec2 slope = vec2(texture(relief_image, place + u).r - texture(relief_image, place - u).r,
                      texture(relief_image, place + v).r - texture(relief_image, place - v).r) /
                 (2.0 * half_texel);
    // from the image's axes to those of the UV map
    slope = slope * relief_transform.xy + slope.yx * relief_turn.yx;
    vec3 across_right = cross(up, normal), across_up = cross(normal, right);
    float area = dot(right, across_right);
    vec3 gradient = dot(slope, uv_right) * across_right + dot(slope, uv_up) * across_up;
    bent = abs(area) * normal - relief.z * sign(area) * gradient;
    bent = dot(bent, bent) > 0.0 ? normalize(bent) : normal;
    bent = mix(normal, bent, relief.y);
  }
  else {
    vec3 map = 2.0 * texture(relief_image, place).rgb - 1.0;
    map = vec3(map.xy * relief.y, mix(1.0, map.z, relief.y));
    float orientation = sign(uv_right.x * uv_up.y - uv_up.x * uv_right.y);
    vec3 tangent = orientation * (right * uv_up.y - up * uv_right.y);
    vec3 other = orientation * (up * uv_right.x - right * uv_up.x);
    tangent -= dot(tangent, normal) * normal;
    if (orientation != 0.0 && dot(tangent, tangent) > 0.0) {
      tangent = normalize(tangent);
      vec3 bitangent = cross(normal, tangent);
      bitangent *= dot(bitangent, other) < 0.0 ? -1.0 : 1.0;
      bent = map.x * tangent + map.y * bitangent + map.z * normal;
    }
  }
  bent = dot(bent, bent) > 0.0 ? normalize(bent) : normal;
  return raised_normal(bent);
}
