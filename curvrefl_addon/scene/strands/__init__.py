# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is no mesh and is drawn as one: hair of curves and of particles, and points."""
