// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Copies a strip of pixels into rows of a page (renderer/programs/image_pages.py).

void main()
{
  vec4 values = texelFetch(strip, ivec2(gl_FragCoord.xy) - ivec2(0, first_row), 0);
  if (is_packed != 0) {
    // Three bytes are one number below 2^24, which any driver keeps.
    uint bytes = uint(values.r);
    values = vec4(bytes & 255u, (bytes >> 8) & 255u, bytes >> 16, is_opaque != 0 ? 255.0 : values.g) / 255.0;
  }
  color = values;
}
