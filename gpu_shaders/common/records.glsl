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
