# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the ways of showing a mirror cost in a view: the units, and how many of them there are."""
