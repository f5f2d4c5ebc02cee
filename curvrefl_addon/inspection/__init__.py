# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured for designers on the objects of the open scene, and how it is written down."""
