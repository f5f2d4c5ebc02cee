# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees as programs: GLSL by the tree's shape, its constants and images as parameters."""
