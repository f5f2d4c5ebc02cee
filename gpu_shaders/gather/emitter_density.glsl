// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Per solid angle, of a place in this direction and so far away.
float emitter_density(float over_area, float range, float cosine)
{
  return over_area * range * range / max(abs(cosine), 1e-4);
}
