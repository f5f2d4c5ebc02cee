// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The mirrors' sum of sub-frames over the viewport's picture; alpha is their coverage.
void main()
{
  color = texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(corner), 0) / sub_frames;
}
