// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Record textures, 1 << ROW_BITS wide (renderer/device/records.py).

ivec2 texel_of_record(int index)
{
  return ivec2(index & ((1 << ROW_BITS) - 1), index >> ROW_BITS);
}

vec4 fetch_record(sampler2D records, int index)
{
  return texelFetch(records, texel_of_record(index), 0);
}

// Three numbers of many that lie one after the other, whichever records they are in (`packed_texture`).
vec3 fetch_three(sampler2D records, int index)
{
  int first = 3 * index;
  vec4 one = fetch_record(records, first >> 2);
  vec4 next = fetch_record(records, (first >> 2) + 1);
  int skipped = first & 3;
  vec3 odd = skipped == 1 ? one.yzw : vec3(one.w, next.xy);
  vec3 even = skipped == 0 ? one.xyz : vec3(one.zw, next.x);
  return (skipped & 1) == 1 ? odd : even;
}

#ifdef RECORD_IMAGES
vec4 fetch_record(restrict readonly image2D records, int index)
{
  return imageLoad(records, texel_of_record(index));
}
#endif
