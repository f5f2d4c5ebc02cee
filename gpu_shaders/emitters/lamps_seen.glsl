// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps' own bodies, which rays meet. Records of a lamp: lamps.glsl.

#ifdef PATH_LIGHT
// Density with which the ray was chosen among all that leave a rough surface, whose lobes samples of lamps light too;
// 0 of other rays.
float ray_density = 0.0;

// Share of a lamp that is met by chance in what rays and samples find of it (Veach and Guibas, "Optimally combining
// sampling techniques for Monte Carlo rendering", 1995: the balance heuristic). `cosine` at the lamp, 1 over `falloff`
// the squared distance.
float share_of_ray(int base, float falloff, float cosine)
{
  vec3 intensity = abs(lighting_data[base + 1].rgb), body = abs(lighting_data[base + 6].rgb);
  float area = (intensity.r + intensity.g + intensity.b) / max(body.r + body.g + body.b, 1e-30);
  float density = 1.0 / max(area * falloff * cosine, 1e-30);
  return ray_density > 0.0 ? ray_density / (ray_density + density) : 1.0;
}
#endif

// Radiance of the lamps' bodies along the ray, nearer than `distance`, to be added to what lies behind (rays pass
// through lamps in Cycles); alpha 1 where any is hit. `by_camera`: those that the camera sees, else those in mirrors.
vec4 lamps_seen(vec3 origin, vec3 direction, float distance, bool by_camera)
{
  vec4 sum = vec4(0.0);
#ifdef LIGHTING_LAMPS
  int count = int(lighting_data[0].x);
  int i = 0;
  do {
    int base = HEADER_RECORDS + i * LAMP_RECORDS;
    int kind = int(lighting_data[base].w);
    vec3 radiance = lighting_data[base + 6].rgb;
    vec3 shines = lighting_data[base + 3].xyz;
    bool hit = false;
    float away_from_it = 1.0;
    if (kind == LAMP_SUN) {
      hit = distance > 1e30 && dot(direction, lighting_data[base + 2].xyz) > lighting_data[base + 3].w;
#ifdef PATH_LIGHT
      radiance *= share_of_ray(base, 1.0, 1.0);
#endif
    }
#ifdef LIGHTING_NEAR_LAMPS
    else {
      vec3 middle = lighting_data[base + 2].xyz - origin;
      if (kind == LAMP_AREA) {
        float facing = dot(direction, shines);
        float t = dot(middle, shines) / (facing == 0.0 ? 1e-30 : facing);
        vec3 place = t * direction - middle;
        vec3 axis_x = lighting_data[base + 4].xyz;
        vec3 axis_y = lighting_data[base + 5].xyz;
        vec2 across = vec2(dot(place, axis_x) / dot(axis_x, axis_x), dot(place, axis_y) / dot(axis_y, axis_y));
        bool inside = lighting_data[base + 4].w > 0.5 ? dot(across, across) <= 1.0 :
                                                       max(abs(across.x), abs(across.y)) <= 1.0;
        hit = facing < 0.0 && t > 0.0 && t < distance && inside;
        away_from_it = t;
#ifdef PATH_LIGHT
        float nearest2 = lighting_data[base + 1].w * lighting_data[base + 1].w;
        radiance *= share_of_ray(base, 1.0 / max(t * t, nearest2), -facing);
#endif
#ifdef LIGHTING_SPREAD
        radiance *= spread_share(base, -facing);
#endif
      }
      else {
        // a disk that faces the ray's origin
        float away = length(middle);
        vec3 axis = middle / max(away, 1e-30);
        float facing = dot(direction, axis);
        float t = away / max(facing, 1e-30);
        away_from_it = t;
        vec3 place = t * direction - middle;
        float radius = lighting_data[base + 2].w;
        hit = facing > 0.0 && t < distance && dot(place, place) <= radius * radius;
#ifdef PATH_LIGHT
        float falloff = 1.0 / max(t * t, 1e-30);
#ifdef LIGHTING_BALLS
        if (lighting_data[base + 5].x > 0.5) {
          falloff = 1.0 / max(away * away - radius * radius, 1e-30);
          facing = 1.0;
        }
#endif
        radiance *= share_of_ray(base, falloff, facing);
#endif
#ifdef LIGHTING_BALLS
        if (lighting_data[base + 5].x > 0.5) {
          float nearest = away * facing;
          float deep2 = radius * radius - (away * away - nearest * nearest);
          hit = nearest > 0.0 && deep2 >= 0.0 && nearest - sqrt(max(deep2, 0.0)) < distance;
        }
#endif
        if (kind == LAMP_SPOT) {
          radiance *= spot_share(base, -direction);
        }
      }
    }
#endif
#ifdef LIGHTING_LOOKS
    radiance *= lamp_look(base, lighting_data[base + 12].y, kind, -direction, origin + away_from_it * direction);
#endif
#ifdef LIGHTING_FALLOFF
    radiance *= kind == LAMP_SUN ? 1.0 : lamp_falloff(base, away_from_it);
#endif
    float is_visible = by_camera ? lighting_data[base + 11].w : lighting_data[base + 5].w;
#ifdef LIGHTING_LINKED
    hit = hit && (lamps_met_from < 0 || is_for_set(int(lighting_data[LINK_RECORDS + i].x), lamps_met_from));
#endif
    if (hit && is_visible > 0.5 && radiance != vec3(0.0)) {
      sum += vec4(radiance, 1.0);
    }
    i++;
  } while (i < count);
#endif
  return vec4(sum.rgb, min(sum.a, 1.0));
}
