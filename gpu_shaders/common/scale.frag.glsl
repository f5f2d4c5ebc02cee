// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One factor for all pixels and channels; drawn with the blend that multiplies.
void main()
{
  color = vec4(factor);
}
