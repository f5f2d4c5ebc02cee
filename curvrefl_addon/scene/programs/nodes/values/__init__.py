# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that are neither textures nor shaders: what is computed, looked up, and known of the place that is shaded."""
