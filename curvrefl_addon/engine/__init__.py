# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: what F12, `blender -b FILE -E CURVREFL` and the verb `render` draw by."""
