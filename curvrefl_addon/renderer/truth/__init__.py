# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ground truth of what mirrors show, in float64 as far as the numbers go: what render passes and data sets hold."""
