// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// With WITH_CHOICE, the mirrors that a pass is for: records by their numbers. There are others that it leaves alone.
#include "common/records.glsl"

#ifdef WITH_CHOICE
bool is_chosen(float mirror)
{
  return fetch_record(chosen_mirrors, int(mirror + 0.5)).x > 0.5;
}
#endif
