# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All 3D viewports of all windows."""

from __future__ import annotations

from collections.abc import Iterator

import bpy


def view_3d_areas() -> Iterator[bpy.types.Area]:
    """One after the other."""
    for manager in bpy.data.window_managers:
        for window in manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    yield area


def redraw_views() -> None:
    """Draw them again, as they are."""
    for area in view_3d_areas():
        area.tag_redraw()
