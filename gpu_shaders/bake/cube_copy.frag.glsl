// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One face of a cube map from one layer of an array texture.
void main()
{
  color = texelFetch(source, ivec3(ivec2(gl_FragCoord.xy), face), 0);
}
