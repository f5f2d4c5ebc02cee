// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What programs read at the corners of a chunk: attributes by `number` in the scene's list.
// Needs the sampler `corner_attribute_records` (renderer/geometry/chunk_attributes.py).
#include "common/records.glsl"

// What the mesh lacks: 0, or (0, 0, 0, 1) of what has a name.
vec4 corner_attribute(int corner, int number)
{
  // (place among the chunk's own, all that the scene has, the chunk's own)
  vec4 head = fetch_record(corner_attribute_records, number);
  int place = int(round(head.x));
  if (place < 0) {
    return vec4(0.0, 0.0, 0.0, place == LACKING_BY_NAME ? 1.0 : 0.0);
  }
  return fetch_record(corner_attribute_records, int(head.y + 0.5) + int(head.z + 0.5) * corner + place);
}
