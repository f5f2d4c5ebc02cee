// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of materials in surface buffers of scenes with paths: back faces have a quarter more.

int material_number(float coded)
{
  return int(floor(coded + 0.5));
}

bool is_back_face(float coded)
{
  return coded - floor(coded) > 0.1;
}
