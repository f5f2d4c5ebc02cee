// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether any path goes on in a part of the picture: a fragment for each part.

void main()
{
  ivec2 size = textureSize(classes, 0);
  ivec2 first = ivec2(gl_FragCoord.xy) * size / PARTS_ACROSS;
  ivec2 end = (ivec2(gl_FragCoord.xy) + 1) * size / PARTS_ACROSS;
  float found = 0.0;
  for (int y = first.y; y < end.y; y++) {
    for (int x = first.x; x < end.x; x++) {
      found = max(found, texelFetch(classes, ivec2(x, y), 0).x == GOES_ON / CLASS_COUNT ? 1.0 : 0.0);
    }
  }
  color = vec4(found);
}
