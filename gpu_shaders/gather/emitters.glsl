// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that shine (renderer/indirect/emitters.py), one of them chosen as often as it is strong. Needs the
// sampler `emitters` and the push constant `emitter_count` (INT). EMITTER_RECORDS each: corner, sum of chances up to
// here; edges to the others, the first with the density of a place on it over area, the second with bits of the shadow
// sets in the way of its light.
#include "common/records.glsl"

struct EmitterPlace {
  vec3 position;
  vec3 normal;     // unit, of either side
  float density;   // over area, of all places that shine
#ifdef LIGHTING_SHADOWS_LINKED
  int blocked_by;
#endif
};

EmitterPlace emitter_place(vec3 random)
{
  int low = 0;
  int high = emitter_count - 1;
  while (low < high) {
    int middle = (low + high) >> 1;
    bool is_before = fetch_record(emitters, EMITTER_RECORDS * middle).w <= random.z;
    low = is_before ? middle + 1 : low;
    high = is_before ? high : middle;
  }
  int record = EMITTER_RECORDS * low;
  vec4 ab = fetch_record(emitters, record + 1);
  vec3 ac = fetch_record(emitters, record + 2).xyz;
  float root = sqrt(random.x);
  EmitterPlace place;
  place.position = fetch_record(emitters, record).xyz + ab.xyz * (1.0 - root) + ac * (root * random.y);
  place.normal = normalize(cross(ab.xyz, ac));
  place.density = ab.w;
#ifdef LIGHTING_SHADOWS_LINKED
  place.blocked_by = int(fetch_record(emitters, record + 2).w);
#endif
  return place;
}
