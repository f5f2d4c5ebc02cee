# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that comes from other surfaces: a cache of what arrives at cells of the scene's surfaces, and rays that ask it."""
