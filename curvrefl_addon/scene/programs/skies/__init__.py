# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's Sky Texture computes before it is looked at: numpy, no bpy."""
