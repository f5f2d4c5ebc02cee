# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that a mirror shows undistorted: as images, UV maps, meshes and prints."""
