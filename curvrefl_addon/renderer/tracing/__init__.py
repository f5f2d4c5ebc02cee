# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light followed over surfaces that scatter, bend and let it through: a sub-frame is one sample of the paths."""
