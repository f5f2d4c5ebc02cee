// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Full-screen triangle at the depth of one class of pixels (see pixel_classes.frag.glsl). Classes are eighths: exact.
void main()
{
  gl_Position = vec4(pos, 2.0 * pixel_class / CLASS_COUNT - 1.0, 1.0);
}
