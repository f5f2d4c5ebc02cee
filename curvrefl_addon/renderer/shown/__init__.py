# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mirror shows in one view: solved vertices, followed rays, a looked-up environment, or nothing."""
