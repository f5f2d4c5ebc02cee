# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is found out about the device at its first use: a run that is spread over redraws, and what it measures."""
