# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws docs/images/inspection.jpg: the views of docs/inspection.md, saved by the operator *Save Inspection Picture*.

    draw_inspection.py FOLDER FILE.jpg

FOLDER is for what is made on the way.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import bootstrap

bootstrap.load_package()

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon import registration  # noqa: E402
from curvrefl.curvrefl_addon.demo.scene import build_demo  # noqa: E402
from mathutils import Vector  # noqa: E402

SIZE = (480, 360)
"""Of each picture"""
COLUMNS = 3
SAMPLES = 32
KETTLE: dict[str, dict[str, Any]] = {
    "isophotes": {"show": "ISOPHOTES", "stripe_count": 24},
    "highlights": {"show": "HIGHLIGHTS", "stripe_count": 32, "stripe_softness": 0.5},
    "mean": {"show": "CURVATURE", "curvature_kind": "MEAN"},
    "directions": {"show": "CURVATURE", "curvature_kind": "STRONGEST", "curvature_directions": True},
    "combs": {"comb_show": True, "comb_axis": "Y", "comb_teeth": 400, "comb_scale": 0.4},
}
"""Settings of each picture of the demo's kettle"""
JOINTS = {"show": "ZEBRA", "stripe_count": 40, "stripe_direction": (0.0, 1.0, 0.2)}
PIECES = ((0.0, -0.2), (0.0, 0.5), (0.0, 0.5), (8.0, -0.3))
"""Of the sheet with joints: the turn in degrees with which each piece begins, and its curvature, 1 / m"""
STEPS, ROWS = 24, 49


def operators() -> Any:
    """The extension's."""
    return bpy.ops.curvrefl  # type: ignore[attr-defined]


def of(owner: Any) -> Any:
    """The extension's settings of a scene or an object."""
    return owner.curvrefl


def settings(values: dict[str, Any]) -> None:
    """Of the open scene; the others are as new."""
    chosen = of(bpy.context.scene)
    for item in chosen.bl_rna.properties:
        if item.identifier not in ("rna_type", "name", "version"):
            chosen.property_unset(item.identifier)
    for name, value in values.items():
        setattr(chosen, name, value)


def save(path: Path) -> None:
    scene: Any = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    operators().save_inspection(filepath=str(path), from_camera=True, samples=SAMPLES)


def look(camera: bpy.types.Object, place: Vector, target: Vector) -> None:
    camera.matrix_world.translation = place
    camera.rotation_euler = (target - place).to_track_quat("-Z", "Y").to_euler()
    camera.location = place
    bpy.context.view_layer.update()


def draw_kettle(folder: Path) -> list[Path]:
    build_demo(folder / "demo.blend")
    bpy.ops.wm.open_mainfile(filepath=str(folder / "demo.blend"))
    kettle: Any = bpy.data.objects["Kettle"]
    camera: Any = bpy.context.scene.camera
    of(kettle).is_mirror = True
    corners = [kettle.matrix_world @ Vector(corner) for corner in kettle.bound_box]
    middle = sum(corners, Vector()) / 8.0
    camera.data.lens *= 1.9
    look(camera, camera.matrix_world.translation.copy(), middle)
    paths = []
    for name, values in KETTLE.items():
        settings(values)
        paths.append(folder / f"{name}.png")
        save(paths[-1])
    return paths


def sheet() -> bpy.types.Object:
    """Pieces of circles along x, swept along y, a little bowed; seams where pieces meet."""
    line = [np.zeros(2)]
    heading, seams = 0.0, []
    for turn, curvature in PIECES:
        seams.append(len(line) - 1)
        heading -= np.radians(turn)
        for _ in range(STEPS):
            step = 0.9 / STEPS
            middle = heading - 0.5 * step * curvature
            # (The chord of an arc.)
            chord = step if curvature == 0.0 else 2.0 * np.sin(0.5 * step * curvature) / curvature
            line.append(line[-1] + chord * np.array([np.cos(middle), np.sin(middle)]))
            heading -= step * curvature
    profile = np.array(line)
    y = np.linspace(-1.0, 1.0, ROWS)
    places = [(x, along, z - 0.1 * along**2) for along in y for x, z in profile]
    count = len(profile)
    faces = [
        (row * count + i, row * count + i + 1, (row + 1) * count + i + 1, (row + 1) * count + i)
        for row in range(ROWS - 1)
        for i in range(count - 1)
    ]
    mesh: Any = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(places, [], faces)
    mesh.shade_smooth()
    for edge in mesh.edges:
        columns = {index % count for index in edge.vertices}
        edge.use_seam = len(columns) == 1 and columns <= set(seams[1:])
        # (The last joint is a crease, and is to be seen as one.)
        edge.use_edge_sharp = len(columns) == 1 and columns == {seams[-1]}
    made = bpy.data.objects.new("Sheet", mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def draw_joints(folder: Path) -> list[Path]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    world = scene.world = bpy.data.worlds.new("World")
    world.color = (0.2, 0.2, 0.2)
    made = sheet()
    of(made).is_mirror = True
    bpy.context.view_layer.objects.active = made
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.data.lens = 44.0
    look(scene.camera, Vector((1.9, -3.4, 2.6)), Vector((1.75, 0.0, -0.1)))
    settings(JOINTS)
    operators().check_joints(edges="SEAM")
    path = folder / "joints.png"
    save(path)
    return [path]


def main(folder: Path, picture: Path) -> None:
    import gpu
    from PIL import Image

    gpu.init()
    registration.register()
    try:
        paths = [*draw_kettle(folder), *draw_joints(folder)]
    finally:
        registration.unregister()
    rows = -(-len(paths) // COLUMNS)
    grid = Image.new("RGB", (COLUMNS * SIZE[0], rows * SIZE[1]))
    for number, path in enumerate(paths):
        row, column = divmod(number, COLUMNS)
        with Image.open(path) as opened:
            grid.paste(opened.convert("RGB"), (column * SIZE[0], row * SIZE[1]))
    grid.save(picture, quality=82)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
