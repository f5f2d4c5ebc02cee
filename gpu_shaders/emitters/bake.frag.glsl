// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a program emits, by directions: those of an equirectangular image (SHAPE_SKY), of a disc of the sky about z
// (SHAPE_DISC: x and y its radii, as long as its angular radius), all directions from a lamp with these axes,
// octahedral about the world's (SHAPE_LAMP), those in the cone of a spot that shines along z (SHAPE_SPOT: x and y as
// long as its half angle's tangent); or by places on an area lamp that shines along z (SHAPE_AREA: half axes x and y).
// Records of `bake`: 0..2: x, y, z; 3: place and radius of a lamp; 4: width, height, shape, first of the program's
//   parameters; 5: depths and kind of the rays; 6: which attributes are a UV map, as bits

#define BAKE_PI 3.14159265358979

vec3 octahedral_direction(vec2 at)
{
  vec3 d = vec3(at, 1.0 - abs(at.x) - abs(at.y));
  if (d.z < 0.0) {
    vec2 side = vec2(d.x < 0.0 ? -1.0 : 1.0, d.y < 0.0 ? -1.0 : 1.0);
    d.xy = (1.0 - abs(d.yx)) * side;
  }
  return normalize(d);
}

void main()
{
  vec2 size = bake[4].xy;
  int shape = int(bake[4].z);
  int uvs = int(bake[6].x);
  vec2 at = gl_FragCoord.xy / size;
  vec2 centered = 2.0 * at - 1.0;
  vec3 direction;
  if (shape == SHAPE_SKY) {
    float azimuth = -BAKE_PI * centered.x, elevation = 0.5 * BAKE_PI * centered.y;
    direction = vec3(cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
  }
  else if (shape == SHAPE_DISC) {
    vec3 across = centered.x * bake[0].xyz + centered.y * bake[1].xyz;
    float angle = length(across);
    direction = bake[2].xyz * cos(angle) + across * (angle > 0.0 ? sin(angle) / angle : 1.0);
  }
  else if (shape == SHAPE_LAMP) {
    // (Texels on the border lie exactly on the fold.)
    direction = octahedral_direction(2.0 * (gl_FragCoord.xy - 0.5) / (size - 1.0) - 1.0);
  }
  else if (shape == SHAPE_SPOT) {
    direction = normalize(bake[2].xyz + centered.x * bake[0].xyz + centered.y * bake[1].xyz);
  }
  else {
    direction = bake[2].xyz;
  }
  bool is_sky = shape == SHAPE_SKY || shape == SHAPE_DISC;
  vec2 uv = at;
  ShadingPoint s;
  s.position = is_sky ? direction : bake[3].xyz + bake[3].w * direction;
  if (shape == SHAPE_AREA) {
    s.position += centered.x * bake[0].xyz + centered.y * bake[1].xyz;
  }
  s.normal = is_sky ? -direction : direction;
  s.true_normal = s.normal;
  s.incoming = s.normal;
  if (shape == SHAPE_LAMP) {
    vec3 own = vec3(dot(bake[0].xyz, direction), dot(bake[1].xyz, direction), dot(bake[2].xyz, direction));
    uv = vec2(own.x == 0.0 && own.y == 0.0 ? 0.0 : 0.5 - atan(own.x, own.y) / (2.0 * BAKE_PI),
              1.0 - acos(clamp(own.z, -1.0, 1.0)) / BAKE_PI);
  }
  s.is_back = false;
  s.instance = 0;
  s.parametric = vec2(uv.y, 1.0 - uv.x - uv.y);
  s.ray = int(bake[5].w);
  s.ray_length = is_sky ? 3.4028235e38 : 1.0;
  s.depths = bake[5].xyz;
  s.more_depths = vec2(0.0);
  s.origin = vec3(0.0);
  s.random = 0.5;
  s.records = int(bake[4].w);
  for (int k = 0; k <= ATTRIBUTES; k++) {
    s.attributes[k] = ((uvs >> k) & 1) != 0 ? vec4(uv, 0.0, 1.0) : vec4(0.0);
#ifdef PROGRAM_BUMP
    s.attributes_across[k] = s.attributes_up[k] = vec4(0.0);
#endif
  }
#ifdef PROGRAM_BUMP
  s.position_across = s.position_up = vec3(0.0);
#endif
  Material m;
  m.emission = vec3(0.0);
  material_program(s, m);
  color = vec4(m.emission, 1.0);
}
