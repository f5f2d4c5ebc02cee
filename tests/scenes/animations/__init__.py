# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The animations by which the papers show their methods, built anew: what is in each, and how large it is."""
