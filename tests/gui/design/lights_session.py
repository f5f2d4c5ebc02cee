# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: the tool is chosen, a lamp dragged over a mirror, let go, undone, dragged and left.

Events are simulated (`--enable-event-simulate`). Arguments after `--`: the zip, a folder for what was seen.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from scripted import Script, arguments, extension, in_view, install, play, rests, screenshot, view_3d

ARCHIVE, FOLDER = arguments()[:2]
OPERATOR = "CURVREFL_OT_place_light"
seen: dict[str, Any] = {}


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def is_modal() -> bool:
    return any(operator.bl_idname == OPERATOR for operator in window().modal_operators)


def event(kind: str, value: str, place: tuple[int, int], **keys: bool) -> None:
    window().event_simulate(type=kind, value=value, x=place[0], y=place[1], **keys)


def build() -> None:
    """A mirror ball, and an active lamp of the file's own."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64, radius=1.0, location=(0.0, 0.0, 0.0))
    bpy.ops.object.shade_smooth()
    ball = bpy.context.object
    chrome = bpy.data.materials.new("Chrome")
    shader = chrome.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    ball.data.materials.append(chrome)
    ball.curvrefl.is_mirror = True
    bpy.context.scene.curvrefl.samples = 2
    lamp = bpy.data.objects["Light"]
    lamp.data.shadow_soft_size = 0.3
    bpy.context.view_layer.objects.active = lamp


def state() -> list[float]:
    lamp = bpy.data.objects["Light"]
    return [*lamp.matrix_world.translation, lamp.data.energy, lamp.data.shadow_soft_size]


def done(kind: str, value: str, place: tuple[int, int], **keys: bool) -> Script:
    """An event that changes something about the lamp, until it has."""
    before = state()
    event(kind, value, place, **keys)
    yield lambda: state() != before


def miss(place: tuple[int, int]) -> float:
    """Pixels between the lamp's reflection in the unit sphere, by its closed form, and the middle of a pixel."""
    import numpy as np

    sphere = extension("curvrefl_addon.optics.surfaces.sphere")
    region_file = extension("curvrefl_addon.viewport.region")
    _area, _space, region = view_3d()
    with in_view():
        view = region_file.view_of(bpy.context)
    lamp = np.array(bpy.data.objects["Light"].matrix_world.translation, np.float64)
    point = sphere.reflection_points(view.eye[:3], lamp[None], 1.0)
    at = view.project(point)[0] + (region.x, region.y)
    return float(np.linalg.norm(at - np.array(place) - 0.5))


def pick(place: tuple[int, int]) -> Script:
    """Another object is made active; a click on the lamp's reflection takes the lamp back, a drag takes it along."""
    overlay = extension("curvrefl_addon.viewport.light_overlay")
    _area, _space, region = view_3d()
    yield lambda: any(light.name == "Light" and len(light.centers) for light in overlay.shown_in(region))
    seen["lights shown"] = [(light.name, light.centers.tolist()) for light in overlay.shown_in(region)]
    seen["middle"] = [place[0] - region.x + 0.5, place[1] - region.y + 0.5]
    bpy.context.view_layer.objects.active = bpy.data.objects["Camera"]
    bpy.ops.ed.undo_push(message="Camera")
    yield 0.5
    before, beside = state(), (place[0] + 4, place[1] - 3)
    event("MOUSEMOVE", "NOTHING", beside)
    yield 0.2
    event("LEFTMOUSE", "PRESS", beside)
    yield 0.3
    event("LEFTMOUSE", "RELEASE", beside)
    yield lambda: not is_modal()
    seen["picked"] = [bpy.context.object.name, state() == before]
    event("LEFTMOUSE", "PRESS", beside)
    yield is_modal
    yield from done("MOUSEMOVE", "NOTHING", (beside[0] - 30, beside[1]))
    seen["missed by, taken along"] = miss((place[0] - 30, place[1]))
    event("ESC", "PRESS", beside)
    yield lambda: not is_modal()
    event("ESC", "RELEASE", beside)
    event("LEFTMOUSE", "RELEASE", beside)
    yield 0.3


def script() -> Script:
    install(ARCHIVE)
    with in_view():
        build()
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(FOLDER) / "scene.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(Path(FOLDER) / "scene.blend"), load_ui=False)
    yield 1.0
    _area, space, region = view_3d()
    space.shading.type = "SOLID"
    space.region_3d.view_perspective, space.region_3d.view_distance = "PERSP", 6.0
    bpy.context.window_manager.curvrefl_enabled = True
    yield rests
    with in_view():
        bpy.ops.wm.tool_set_by_id(name="curvrefl.lights")
    seen["tool"] = bpy.context.workspace.tools.from_space_view3d_mode("OBJECT", create=False).idname
    x, y = region.x + region.width // 2, region.y + region.height // 2
    before = state()
    first, last = (x - 20, y + 15), (x + 35, y + 30)
    event("MOUSEMOVE", "NOTHING", first)
    yield 0.5
    yield from done("LEFTMOUSE", "PRESS", first)
    seen["is modal"] = is_modal()
    for step in range(1, 6):
        yield from done("MOUSEMOVE", "NOTHING", (first[0] + 11 * step, first[1] + 3 * step))
    seen["missed by"] = miss(last)
    dragged = state()
    yield from done("WHEELUPMOUSE", "PRESS", last)
    yield from done("WHEELDOWNMOUSE", "PRESS", last, ctrl=True)
    yield from done("WHEELUPMOUSE", "PRESS", last, shift=True)
    seen["missed by, farther"] = miss(last)
    # (The picture follows.)
    yield 0.5
    screenshot(Path(FOLDER) / "dragging.png")
    event("LEFTMOUSE", "RELEASE", last)
    yield lambda: not is_modal()
    after = state()
    seen["moved"] = [before, dragged, after]
    yield from pick(last)
    for _ in range(3):
        bpy.ops.ed.undo()
        yield 0.1
    yield 0.5
    seen["undone"] = state() == before
    yield from done("LEFTMOUSE", "PRESS", first)
    yield from done("MOUSEMOVE", "NOTHING", last)
    seen["is away before escape"] = state() != before
    event("ESC", "PRESS", last)
    yield lambda: not is_modal()
    event("ESC", "RELEASE", last)
    event("LEFTMOUSE", "RELEASE", last)
    yield 0.3
    seen["back after escape"] = state() == before


def finish(error: str) -> None:
    seen["error"] = error
    Path(FOLDER, "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), finish)
