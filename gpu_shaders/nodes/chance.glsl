// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What is left of a random number (0 to 1) that is compared with `share`: even from 0 to 1 again, on either side.
float chance_inside(float number, float share)
{
  float left = number < share ? number / share : (number - share) / max(1.0 - share, 1e-6);
  return clamp(left, 0.0, 0.999999);
}
