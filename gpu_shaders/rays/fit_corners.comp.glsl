// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Normals of the corners of a mesh that has deformed (records as in rays/ray_walk.glsl). `corners`: first record, how
// many.
#include "common/invocation.glsl"
#include "common/records.glsl"

void main()
{
  int index = invocation();
  if (index < corners.y) {
    ivec2 texel = texel_of_record(corners.x + index);
    imageStore(rays, texel, vec4(fetch_three(mesh_normals, index), imageLoad(rays, texel).w));
  }
}
