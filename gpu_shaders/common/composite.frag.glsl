// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The mirrors' sum of sub-frames over the viewport's picture; alpha is their coverage. The picture has the region's
// size or, while something moves, a fraction of it.
void main()
{
  color = texture(picture, (gl_FragCoord.xy - region.xy) / region.zw) / sub_frames;
}
