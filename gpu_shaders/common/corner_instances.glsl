// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which instance a corner of a chunk is of.
// Needs the sampler `corner_instance_records` (renderer/geometry/chunk_attributes.py).
#include "common/records.glsl"

// The row of instance_table.
int instance_of_corner(int corner)
{
  return int(fetch_record(corner_instance_records, corner / 4)[corner % 4] + 0.5);
}
