# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the icon of the tool Lights by Reflection into curvrefl_addon/ui, in Blender's format of triangles.

    .venv/bin/python tools/icons/make_light_icon.py

A mirror's arc, a line of sight that it reflects, and the light at its end.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

ICON = Path(__file__).resolve().parents[2] / "curvrefl_addon" / "ui" / "light_tool.dat"
SIZE = 255
"""Of the square that it is drawn in; y goes up"""
GRAY, BLUE, YELLOW = (225, 225, 225, 255), (100, 170, 245, 255), (255, 205, 90, 255)
type Points = np.ndarray
type Part = tuple[Points, tuple[int, int, int, int]]


def line(points: Points, width: float) -> Points:
    """(t, 3, 2) triangles along points (n, 2)."""
    along = np.diff(points, axis=0)
    across = 0.5 * width * np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    a, b = points[:-1], points[1:]
    corners = [a + across, a - across, b - across, b + across]
    return np.concatenate([np.stack([corners[0], corners[k], corners[k + 1]], axis=1) for k in (1, 2)])


def disk(center: tuple[float, float], radius: float, corners: int = 20) -> Points:
    """(corners, 3, 2)"""
    turn = np.linspace(0.0, 2.0 * np.pi, corners + 1)
    rim = np.array(center) + radius * np.column_stack([np.cos(turn), np.sin(turn)])
    return np.stack([np.broadcast_to(center, (corners, 2)), rim[:-1], rim[1:]], axis=1)


def parts() -> list[Part]:
    """In the order in which they are drawn."""
    turn = np.linspace(np.radians(28.0), np.radians(152.0), 17)
    arc = np.array([127.0, -42.0]) + 130.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    foot, eye, light = np.array([127.0, 92.0]), np.array([52.0, 212.0]), np.array([196.0, 202.0])
    rays = [np.array([eye, foot]), np.array([foot, foot + 0.72 * (light - foot)])]
    return [
        (line(arc, 20.0), BLUE),
        *((line(ray, 12.0), GRAY) for ray in rays),
        (disk((float(light[0]), float(light[1])), 30.0), YELLOW),
        (disk((float(eye[0]), float(eye[1])), 13.0), GRAY),
    ]


def main() -> None:
    triangles = np.concatenate([points for points, _ in parts()])
    colors = np.concatenate([np.tile(np.array(color, np.uint8), (len(points), 3, 1)) for points, color in parts()])
    places = np.clip(np.rint(triangles), 0, SIZE).astype(np.uint8)
    head = b"VCO\0" + bytes((SIZE, SIZE, 0, 0))
    ICON.write_bytes(head + places.tobytes() + colors.tobytes())
    print(f"{ICON}: {len(places)} triangles")


if __name__ == "__main__":
    main()
