# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From where on the lens and at which moment of the shutter the sub-frames of a picture look."""
