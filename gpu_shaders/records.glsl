// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Record textures: record i of a texture TEXTURE_WIDTH (renderer/gpu_objects.py) wide.

vec4 fetch_record(sampler2D records, int index)
{
  return texelFetch(records, ivec2(index % 2048, index / 2048), 0);
}
