// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the mirrors of a moving picture to a picture.
void main()
{
  vec4 mirror = texelFetch(calm_picture, ivec2(gl_FragCoord.xy), 0);
  color = mirror.a > 0.5 ? vec4(mirror.rgb, 1.0) * weight : vec4(0.0);
}
