// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Records into another texture; `range`: first of the source, first of the target, how many.
#include "common/invocation.glsl"

void main()
{
  int index = record_from(range.y);
  if (index < range.y || index >= range.y + range.z) {
    WRITE_NONE;
  }
  WRITE_RECORD(target, index, fetch_record(source, range.x + index - range.y));
}
