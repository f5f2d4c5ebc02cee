// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Record textures: record i of a texture TEXTURE_WIDTH (renderer/device/gpu_objects.py) wide.

ivec2 texel_of_record(int index)
{
  return ivec2(index & 2047, index >> 11);
}

vec4 fetch_record(sampler2D records, int index)
{
  return texelFetch(records, texel_of_record(index), 0);
}
