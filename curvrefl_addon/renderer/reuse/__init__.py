# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the frames before, drawn on where mirrors show the same scene point now."""
