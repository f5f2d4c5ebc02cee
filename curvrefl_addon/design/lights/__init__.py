# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights placed by what they do in a picture: where they are reflected, what they light most, which edge they graze."""
