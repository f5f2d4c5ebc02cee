// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Multiplications and shifts by which each bit of the input flips each of the output about half of the time
// (constants: Wellons, "Hash Function Prospector", 2018).
uint hashed(uint x)
{
  x = (x ^ (x >> 16u)) * 2146121005u;
  x = (x ^ (x >> 15u)) * 2221713035u;
  return x ^ (x >> 16u);
}
