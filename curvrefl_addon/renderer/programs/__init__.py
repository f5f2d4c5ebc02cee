# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Material programs on the GPU: their parameters, what they read and the buffers that they fill."""
