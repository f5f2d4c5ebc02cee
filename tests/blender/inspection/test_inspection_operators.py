# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Combs, joints, tables and pictures of the open scene, by the operators, without a window."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticColors, ramp_colors
from curvrefl.curvrefl_addon.inspection import shown as surface_lines
from curvrefl.curvrefl_addon.report.display import display_transform

pytestmark = pytest.mark.usefixtures("gpu")
WIDTH, HEIGHT = 320, 240


@pytest.fixture
def scene() -> Iterator[Any]:
    """A smooth ball of radius 0.5 at (1, 2, 3), a mirror, and a camera two meters before it."""
    registration.register()
    try:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        made: Any = bpy.context.scene
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1.0, location=(1.0, 2.0, 3.0))
        ball = bpy.context.object
        ball.name = "Ball"
        ball.scale = (0.5, 0.5, 0.5)
        bpy.ops.object.shade_smooth()
        ball.curvrefl.is_mirror = True
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        camera.location, camera.rotation_euler = (1.0, 0.0, 3.0), (np.pi / 2, 0.0, 0.0)
        made.collection.objects.link(camera)
        made.camera = camera
        made.world = bpy.data.worlds.new("World")
        made.render.resolution_x, made.render.resolution_y = WIDTH, HEIGHT
        made.curvrefl.method = "exact"
        bpy.context.view_layer.update()
        yield made
        surface_lines.clear_joints()
    finally:
        registration.unregister()


def table(path: Path) -> tuple[list[dict[str, str]], Any]:
    """Rows, and a way to a column of numbers."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))

    def column(name: str) -> np.ndarray:
        return np.array([float(row[name] or "nan") for row in rows])

    return rows, column


def saved(tmp_path: Path, **options: Any) -> np.ndarray:
    """(h, w, 3) what a picture file holds."""
    path = tmp_path / "picture.png"
    assert bpy.ops.curvrefl.save_inspection(filepath=str(path), samples=1, **options) == {"FINISHED"}
    image: Any = bpy.data.images.load(str(path), check_existing=False)
    pixels = np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    return pixels[..., :3]


def test_curvature_of_every_vertex(scene: Any, tmp_path: Path) -> None:
    assert bpy.ops.curvrefl.export_inspection(filepath=str(tmp_path / "c.csv"), what="CURVATURE") == {"FINISHED"}
    rows, column = table(tmp_path / "c.csv")
    assert len(rows) == len(bpy.data.objects["Ball"].data.vertices)
    assert rows[0]["object"] == "Ball"
    places = np.column_stack([column(axis) for axis in "xyz"]) - [1.0, 2.0, 3.0]
    np.testing.assert_allclose(np.linalg.norm(places, axis=1), 0.5, atol=1e-5)
    # (By normals of Blender's, which are not the exact ones, least so at the poles.)
    np.testing.assert_allclose(column("mean"), 2.0, rtol=0.02)
    np.testing.assert_allclose(column("gaussian"), 4.0, rtol=0.04)


@pytest.mark.parametrize(
    ("plane", "axis", "offset", "radius"),
    [("OBJECT", "X", 0.0, 0.5), ("OBJECT", "Z", 0.3, 0.4), ("WORLD", "Y", 2.3, 0.4), ("CURSOR", "X", -0.3, 0.4)],
)
def test_combs_of_circles(scene: Any, tmp_path: Path, plane: str, axis: str, offset: float, radius: float) -> None:
    settings = scene.curvrefl
    settings.comb_plane, settings.comb_axis, settings.comb_offset, settings.comb_teeth = plane, axis, offset, 60
    # The cursor's X axis is the world's Y axis.
    scene.cursor.location, scene.cursor.rotation_euler = (9.0, 2.0, 9.0), (0.0, 0.0, np.pi / 2)
    path = tmp_path / "combs.csv"
    assert bpy.ops.curvrefl.export_inspection(filepath=str(path), what="COMBS") == {"FINISHED"}
    rows, column = table(path)
    assert len(rows) == 60 and {row["closed"] for row in rows} == {"1"}
    np.testing.assert_allclose(column("curvature"), 1.0 / radius, rtol=0.02)
    across = {"OBJECT": axis.lower(), "WORLD": "y", "CURSOR": "y"}[plane]
    center = {"x": 1.0, "y": 2.0, "z": 3.0}[across]
    expected = {"OBJECT": center + offset, "WORLD": offset, "CURSOR": center + offset}[plane]
    np.testing.assert_allclose(column(across), expected, atol=1e-6)
    steps = np.diff(column("length"))
    assert steps.max() < 1.01 * steps.min()


def test_a_plane_that_cuts_nothing_is_said(scene: Any, tmp_path: Path) -> None:
    scene.curvrefl.comb_offset = 7.0
    with pytest.raises(RuntimeError, match="cuts no mirror: move it"):
        bpy.ops.curvrefl.export_inspection(filepath=str(tmp_path / "combs.csv"), what="COMBS")
    assert not (tmp_path / "combs.csv").exists()
    bpy.data.objects["Ball"].curvrefl.is_mirror = False
    with pytest.raises(RuntimeError, match="No object is marked as a mirror"):
        bpy.ops.curvrefl.export_inspection(filepath=str(tmp_path / "c.csv"), what="CURVATURE")


def test_a_picture_has_the_colors_of_the_legend(scene: Any, tmp_path: Path) -> None:
    plain = saved(tmp_path)
    scene.view_settings.view_transform = "AgX"
    settings = scene.curvrefl
    settings.show, settings.curvature_range = "CURVATURE", 4.0
    shown = saved(tmp_path)
    assert shown.shape == (HEIGHT, WIDTH, 3)
    middle = shown[HEIGHT // 2, WIDTH // 2]
    color = ramp_colors(DiagnosticColors().two_sided, 401)[300]
    np.testing.assert_allclose(middle, display_transform(color), atol=0.02)
    assert np.abs(middle - plain[HEIGHT // 2, WIDTH // 2]).max() > 0.1
    settings.pattern_transparency = 1.0
    clear = saved(tmp_path)
    assert np.abs(clear - shown)[HEIGHT // 2, WIDTH // 2].max() > 0.1
    settings.show, settings.pattern_transparency = "REFLECTION", 0.0
    without = saved(tmp_path)
    settings.comb_show = True
    combs = saved(tmp_path)
    changed = np.abs(combs - without).max(axis=2) > 0.1
    # The section in the plane x = 1 is seen edge on: its teeth are a vertical line.
    assert changed[:, WIDTH // 2 - 3 : WIDTH // 2 + 3].sum() > 0.8 * changed.sum() > 60


def cube(tmp_path: Path) -> Any:
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(4.0, 0.0, 0.0))
    made = bpy.context.object
    modifier = made.modifiers.new("finer", "SUBSURF")
    modifier.subdivision_type, modifier.levels = "SIMPLE", 3
    for edge in made.data.edges:
        edge.use_edge_sharp = edge.use_seam = True
    bpy.context.view_layer.update()
    return made


def test_joints_of_a_cube(scene: Any, tmp_path: Path) -> None:
    """The modifier makes eight edges of each of twelve, all of a right angle."""
    made = cube(tmp_path)
    for marks in ("SHARP", "SEAM"):
        assert bpy.ops.curvrefl.check_joints(edges=marks) == {"FINISHED"}
        checked = surface_lines.shown_joints()
        assert checked is not None
        assert checked.counts() == [("G0", 96)] and not checked.messages
    path = tmp_path / "joints.csv"
    assert bpy.ops.curvrefl.export_inspection(filepath=str(path), what="JOINTS") == {"FINISHED"}
    rows, column = table(path)
    assert len(rows) == 96 and {row["grade"] for row in rows} == {"G0"}
    np.testing.assert_allclose(column("angle_degrees"), 90.0, atol=1e-4)
    np.testing.assert_allclose(column("curvature_difference"), 0.0, atol=1e-4)
    assert not column("gap").any()
    with pytest.raises(RuntimeError, match="has no edges that are marked for Freestyle"):
        bpy.ops.curvrefl.check_joints(edges="FREESTYLE")
    # What has moved, or has another shape, is not what was checked.
    for change in (_move, _reshape):
        assert bpy.ops.curvrefl.check_joints(edges="SHARP") == {"FINISHED"}
        assert not surface_lines.joints_are_stale()
        change(made)
        bpy.context.view_layer.update()
        assert surface_lines.joints_are_stale()
    with pytest.raises(RuntimeError, match="check the joints again"):
        bpy.ops.curvrefl.export_inspection(filepath=str(path), what="JOINTS")
    assert bpy.ops.curvrefl.clear_joints() == {"FINISHED"}
    assert surface_lines.shown_joints() is None


def _move(made: Any) -> None:
    made.location.x += 1.0


def _reshape(made: Any) -> None:
    made.data.vertices[0].co.x *= 1.1
    made.data.update()


def test_edges_selected_in_edit_mode(scene: Any, tmp_path: Path) -> None:
    made = cube(tmp_path)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    top = [edge for edge in made.data.edges if all(made.data.vertices[i].co.z > 0 for i in edge.vertices)]
    for edge in top:
        edge.select = True
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.curvrefl.check_joints(edges="SELECTED") == {"FINISHED"}
    checked = surface_lines.shown_joints()
    assert checked is not None
    assert checked.counts() == [("G0", 32)]
    bpy.ops.object.mode_set(mode="OBJECT")


def sheet(name: str, low: float, high: float, height: float, slope: float) -> Any:
    """z = height + slope (x - low) over x from low to high."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=12, y_subdivisions=12, size=2.0)
    made = bpy.context.object
    made.name = name
    for vertex in made.data.vertices:
        x = low + (high - low) * (vertex.co.x + 1.0) / 2.0
        vertex.co = (x, vertex.co.y, height + slope * (x - low))
    return made


def test_two_sheets_that_nearly_touch(scene: Any, tmp_path: Path) -> None:
    first = sheet("First", -1.0, 0.0, 0.0, 0.0)
    second = sheet("Second", 0.0, 1.0, 0.002, np.tan(np.radians(10.0)))
    with pytest.raises(RuntimeError, match="Select two objects"):
        bpy.ops.curvrefl.check_joints(edges="OBJECTS")
    first.select_set(True)
    bpy.context.view_layer.update()
    assert bpy.ops.curvrefl.check_joints(edges="OBJECTS") == {"FINISHED"}
    checked = surface_lines.shown_joints()
    assert checked is not None and checked.objects == ("Second", "First")
    assert checked.counts() == [("Gap", 12)]
    np.testing.assert_allclose(checked.joints.gap, 0.002, atol=1e-6)
    np.testing.assert_allclose(np.degrees(checked.joints.angle), 10.0, atol=1e-3)
    assert bpy.ops.curvrefl.check_joints(edges="OBJECTS", gap=0.01) == {"FINISHED"}
    checked = surface_lines.shown_joints()
    assert checked is not None and checked.counts() == [("G0", 12)]
    with pytest.raises(RuntimeError, match="make the reach larger"):
        bpy.ops.curvrefl.check_joints(edges="OBJECTS", reach=0.001)
    second.select_set(False)
    bpy.data.objects["Ball"].select_set(True)
    bpy.context.view_layer.objects.active = first
    with pytest.raises(RuntimeError, match='"Ball" has no open edge'):
        bpy.ops.curvrefl.check_joints(edges="OBJECTS")


def test_joints_in_a_picture(scene: Any, tmp_path: Path) -> None:
    """Edges that look away are faint, those in front have the color of their grade."""
    ball = bpy.data.objects["Ball"]
    bpy.context.view_layer.objects.active = ball
    mesh = ball.data
    for edge in mesh.edges:
        edge.use_seam = all(abs(mesh.vertices[i].co.z) < 1e-4 for i in edge.vertices)
    bpy.context.view_layer.update()
    before = saved(tmp_path)
    assert bpy.ops.curvrefl.check_joints(edges="SEAM") == {"FINISHED"}
    checked = surface_lines.shown_joints()
    assert checked is not None and checked.counts() == [("G2", 96)]
    after = saved(tmp_path)
    changed = np.abs(after - before).max(axis=2) > 0.1
    row = changed[HEIGHT // 2 - 3 : HEIGHT // 2 + 3]
    assert row.sum() > 200
    color = display_transform(np.array(DiagnosticColors().converged, np.float32))
    assert np.abs(after[HEIGHT // 2, WIDTH // 2] - color).max() < 0.05
