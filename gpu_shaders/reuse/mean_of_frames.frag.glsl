// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of a frame's picture and of those of earlier frames that were found for each pixel.
void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  color = (texelFetch(now_picture, pixel, 0) + texelFetch(added_before, pixel, 0)) /
          (1.0 + texelFetch(count_before, pixel, 0).x);
}
