// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One sub-frame's light, to be blended into the picture.
void main()
{
  color = texelFetch(light, ivec2(gl_FragCoord.xy), 0);
}
