// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One corner of each patch that may throw a lamp's light on, as the first vertex of a path whose light comes from the
// lamp (paths/step.frag.glsl follows it): how much light gets there. Records of `corners`, CORNER_RECORDS each:
// place and lamp; shading normal and material, a quarter more for back faces; facet's normal towards the lamp and
// object_id; what it shows, as in surface buffers, and its light set; with WITH_HITS what a ray would have hit there.
#include "lighting/lighting.glsl"
#include "surfaces/reflecting_outward.glsl"
#include "surfaces/material_records.glsl"
#include "surfaces/material_number.glsl"
#include "paths/path_state.glsl"
#include "patches/white_surface.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int number = pixel.y * PICTURE_SIDE + pixel.x;
  surface_position = surface_normal = surface_color_out = way_out = throughput_out = vec4(0.0);
#ifdef WITH_HITS
  hit_out = vec4(0.0);
#endif
  gl_FragDepth = 1.0;
  if (number >= patches) {
    return;
  }
  int record = CORNER_RECORDS * number;
  vec4 place = fetch_record(corners, record);
  vec4 normal = fetch_record(corners, record + 1);
  vec4 facet = fetch_record(corners, record + 2);
  vec4 shows = fetch_record(corners, record + 3);
  int lamp = int(place.w + 0.5);
  int base = HEADER_RECORDS + lamp * LAMP_RECORDS;
  LampLight light = lamp_light(lamp, place.xyz, int(shows.y + 0.5));
  // (A lamp that mirrors do not see throws nothing over them. Patches know at which angle they are met.)
  bool is_met = lighting_data[base + 5].w > 0.5 && dot(facet.xyz, light.to_light) > 0.0;
  vec3 power = is_met ? light.irradiance : vec3(0.0);
  if (power != vec3(0.0) && int(lighting_data[base + 6].w) != 0) {
#ifdef LIGHTING_SHADOWS_LINKED
    lamp_blockers = int(lighting_data[LINK_RECORDS + lamp].y);
#endif
    power *= lit_by_ray(white_surface(place.xyz, facet.xyz), light.to_light, light.range);
  }
  if (max(power.r, max(power.g, power.b)) <= 0.0) {
    return;
  }
  int material = material_number(normal.w);
  vec4 color = fetch_record(materials, MATERIAL_RECORDS * material + 2);
  surface_position = vec4(place.xyz, facet.w);
  surface_normal = vec4(reflecting_outward(facet.xyz, light.to_light, normal.xyz), normal.w);
  surface_color_out = vec4(color.rgb, shows.x);
  way_out = pack_way(-light.to_light, 0.0, 0.0);
  // (The limits of mirrors and interfaces are counted from here.)
  throughput_out = vec4(power, pack_state(PathState(RAY_CAMERA, false, 0, 0, 0)));
#ifdef WITH_HITS
  hit_out = fetch_record(corners, record + 4);
#endif
  gl_FragDepth = GOES_ON;
}
