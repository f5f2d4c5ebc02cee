# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons over frames: what each frame keeps, and the report that is made of it, with what changes over time."""
