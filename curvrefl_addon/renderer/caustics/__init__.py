# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics: what lamps throw over mirrors and through glass onto other surfaces."""
