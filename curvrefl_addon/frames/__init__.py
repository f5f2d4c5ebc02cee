# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranges of frames into files: which are left, how long they take, and videos of them."""
