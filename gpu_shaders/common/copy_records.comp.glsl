// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Records into another texture; `range`: first of the source, first of the target, how many.
#include "common/invocation.glsl"
#include "common/records.glsl"

void main()
{
  int index = invocation();
  if (index < range.z) {
    imageStore(target, texel_of_record(range.y + index), fetch_record(source, range.x + index));
  }
}
