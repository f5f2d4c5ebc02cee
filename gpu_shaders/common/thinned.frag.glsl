// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One pixel of each square of a picture, times a weight. Which one differs from square to square, so that no row or
// column of the picture is left out.
void main()
{
  ivec2 square = ivec2(gl_FragCoord.xy);
  ivec2 place = ivec2(7 * square.x + 3 * square.y, 5 * square.x + 11 * square.y) % step_size;
  ivec2 pixel = min(square * step_size + place, textureSize(picture, 0) - 1);
  color = texelFetch(picture, pixel, 0) * weight;
}
