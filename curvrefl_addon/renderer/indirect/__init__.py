# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that comes from other surfaces: what arrives at patches of the scene's surfaces, and rays that ask them."""
