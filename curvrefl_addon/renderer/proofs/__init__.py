# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the device's results are right: small fixed cases through the real shaders, against float64."""
