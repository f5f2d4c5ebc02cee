# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured on the surfaces that meshes stand for: curvature, sections, joints."""
