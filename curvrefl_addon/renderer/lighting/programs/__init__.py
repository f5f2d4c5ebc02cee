# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds and lamps whose light is a program's: baked into images over directions."""
