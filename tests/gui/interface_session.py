# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: panels, menus, diagnostic views, tracing by a click, a comparison that is canceled.

Events are simulated (`--enable-event-simulate`). Pictures of the window are what the documentation shows.
Arguments after `--`: the zip, the demo's .blend file, one with a Mirror Ball without a UV map, the folder for what was
seen.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from scripted import Script, arguments, extension, in_view, install, play, rests, screenshot, view_3d

ARCHIVE, DEMO, SMALL, FOLDER = arguments()[:4]
PANELS = ("main", "mirror", "quality", "environment", "diagnostics", "inspection", "tools", "statistics")
seen: dict[str, Any] = {}


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def keep(name: str) -> None:
    """A picture for the documentation."""
    screenshot(Path(FOLDER) / f"{name}.png")


def event(kind: str, value: str = "PRESS", place: tuple[int, int] = (400, 400)) -> None:
    window().event_simulate(type=kind, value=value, x=place[0], y=place[1])


def is_modal(name: str) -> bool:
    return any(operator.bl_idname == name for operator in window().modal_operators)


def settings() -> list[Any]:
    """What a comparison changes for the time being."""
    scene = bpy.context.scene
    render = scene.render
    return [
        render.engine,
        render.resolution_x,
        render.filepath,
        render.image_settings.file_format,
        render.film_transparent,
        scene.cycles.samples,
        scene.cycles.max_bounces,
        scene.camera.name,
        scene.camera.data.dof.use_dof,
        sorted(material.name for material in bpy.data.materials),
        sorted(image.name for image in bpy.data.images),
        sorted(obj.name for obj in bpy.context.selected_objects),
    ]


def script() -> Script:
    install(ARCHIVE)
    bpy.ops.wm.open_mainfile(filepath=DEMO, load_ui=False)
    yield 1.0
    area, space, _region = view_3d()
    space.shading.type = "MATERIAL"
    space.shading.use_scene_world = space.shading.use_scene_lights = True
    space.region_3d.view_perspective = "CAMERA"
    kettle = bpy.data.objects["Kettle"]
    bpy.context.view_layer.objects.active = kettle
    kettle.select_set(True)
    kettle.curvrefl.is_mirror = True
    bpy.context.scene.eevee.taa_samples = bpy.context.scene.curvrefl.samples = 4
    bpy.context.window_manager.curvrefl_enabled = True
    space.show_region_ui = True
    yield 2.0
    sidebar = next(region for region in area.regions if region.type == "UI")
    sidebar.active_panel_category = "Curvrefl"
    yield rests
    area.tag_redraw()
    yield 1.0
    yield from panels()
    # (by now EEVEE has compiled its shaders and draws what is under the mirror)
    keep("sidebar")
    yield from diagnostics(space)
    yield from trace(area)
    yield from canceled_comparison()
    yield from comparison()


def panels() -> Script:
    for name in PANELS:
        event("MOUSEMOVE", "NOTHING", (300, 600))
        yield 0.2
        with in_view():
            bpy.ops.wm.call_panel(name=f"CURVREFL_PT_{name}", keep_open=True)
        yield 1.0
        keep(f"panel_{name}")
        event("ESC")
        yield 0.4
        event("ESC", "RELEASE")
        yield 0.2
    for name, call in (
        ("overlay", lambda: bpy.ops.wm.call_panel(name="VIEW3D_PT_overlay", keep_open=True)),
        ("context_menu", lambda: bpy.ops.wm.call_menu(name="VIEW3D_MT_object_context_menu")),
        ("presets", lambda: bpy.ops.wm.call_menu(name="CURVREFL_MT_presets")),
    ):
        event("MOUSEMOVE", "NOTHING", (300, 500))
        yield 0.2
        with in_view():
            call()
        yield 1.0
        keep(name)
        event("ESC")
        yield 0.4
        event("ESC", "RELEASE")
        yield 0.2


def diagnostics(space: bpy.types.SpaceView3D) -> Script:
    space.show_region_ui = False
    settings = bpy.context.scene.curvrefl
    for name in ("ITERATIONS", "STATUS", "ANGLE_ERROR", "METHOD", "ZEBRA", "LINES"):
        settings.show = name
        yield 1.0
        yield rests
        keep(f"show_{name.lower()}")
    settings.show = "REFLECTION"
    yield 1.0
    yield rests


def inspection(ball: bpy.types.Object) -> Script:
    """Patterns of the surface, combs, joints, a picture of the view and tables."""
    settings = bpy.context.scene.curvrefl
    for name in ("ISOPHOTES", "HIGHLIGHTS", "CURVATURE"):
        settings.show = name
        yield rests
    settings.comb_show, settings.comb_axis = True, "Y"
    yield 0.3
    yield rests
    lines = extension("curvrefl_addon.inspection.shown")
    seen["combs"] = dict(lines.comb_rows())
    mesh = ball.data
    for edge in mesh.edges:
        edge.use_seam = bool({*edge.vertices} & {*mesh.polygons[0].vertices})
    yield 0.3
    folder = Path(FOLDER)
    with in_view():
        bpy.ops.curvrefl.check_joints(edges="SEAM")
        bpy.ops.curvrefl.save_inspection(filepath=str(folder / "view.png"), samples=1)
        for what in ("CURVATURE", "COMBS", "JOINTS"):
            bpy.ops.curvrefl.export_inspection(filepath=str(folder / f"{what.lower()}.csv"), what=what)
    yield 0.3
    keep("inspection")
    seen["joints"] = dict(lines.shown_joints().rows())
    ball.location.x += 0.001
    yield 0.3
    seen["joints are stale"] = lines.joints_are_stale()
    bpy.ops.curvrefl.clear_joints()
    ball.location.x -= 0.001
    settings.comb_show, settings.show = False, "REFLECTION"
    yield 0.3
    yield rests


def trace(area: bpy.types.Area) -> Script:
    from bpy_extras.view3d_utils import location_3d_to_region_2d

    tracing = extension("curvrefl_addon.viewport.tracing")
    _area, space, region = view_3d()
    kettle = bpy.data.objects["Kettle"]
    middle = sum((kettle.matrix_world @ vertex.co for vertex in kettle.data.vertices), start=kettle.location * 0.0)
    place = location_3d_to_region_2d(region, space.region_3d, middle / len(kettle.data.vertices))
    # A little below the middle: there the kettle shows the table.
    place = (int(place.x) + region.x - 60, int(place.y) + region.y - 40)
    with in_view():
        bpy.ops.curvrefl.trace_at_cursor("INVOKE_DEFAULT")
    yield 0.5
    seen["trace is modal"] = is_modal("CURVREFL_OT_trace_at_cursor")
    event("ESC", place=place)
    yield 0.5
    event("ESC", "RELEASE", place)
    yield 0.2
    seen["trace after escape"] = [is_modal("CURVREFL_OT_trace_at_cursor"), tracing.shown() is not None]
    with in_view():
        bpy.ops.curvrefl.trace_at_cursor("INVOKE_DEFAULT")
    yield 0.5
    event("MOUSEMOVE", "NOTHING", place)
    yield 0.2
    event("LEFTMOUSE", "PRESS", place)
    yield 0.5
    event("LEFTMOUSE", "RELEASE", place)
    yield 1.0
    found = tracing.shown()
    seen["trace"] = None if found is None else dict(found.rows())
    space.region_3d.view_perspective = "PERSP"
    space.region_3d.view_distance = 1.2
    yield 1.0
    yield rests
    area.tag_redraw()
    yield 0.5
    keep("trace")
    tracing.clear()
    space.region_3d.view_perspective = "CAMERA"
    yield 1.0


def options(output: Path) -> dict[str, Any]:
    # (the mirror has no UV map: a method that needs one is left out)
    methods = {"secant_star", "secant_uv", "environment_cube"}
    return {
        "width": 96,
        "height": 72,
        "samples": 4,
        "peers": {"cycles1"},
        "methods": methods,
        "output": str(output),
    }


def canceled_comparison() -> Script:
    """In the demo, where it takes long enough."""
    before = settings()
    output = Path(FOLDER) / "canceled"
    with in_view():
        bpy.ops.curvrefl.compare_with_cycles("INVOKE_DEFAULT", **options(output))
    yield 0.5
    seen["comparison is modal"] = is_modal("CURVREFL_OT_compare_with_cycles")
    keep("compare_running")
    event("ESC")
    yield lambda: not is_modal("CURVREFL_OT_compare_with_cycles")
    event("ESC", "RELEASE")
    yield 0.5
    seen["comparison after escape"] = {
        "settings are back": settings() == before,
        "files": [path.name for path in output.iterdir()] if output.exists() else [],
        "left": [path.name for path in Path(FOLDER).glob(".curvrefl-*")],
        "text": "Curvrefl comparison" in bpy.data.texts,
    }


def comparison() -> Script:
    """By the modal operator and by a script's call, where Cycles has little to do."""
    bpy.context.window_manager.curvrefl_enabled = False
    bpy.ops.wm.open_mainfile(filepath=SMALL, load_ui=False)
    view_3d()[1].shading.type = "SOLID"
    ball = bpy.data.objects["Mirror Ball"]
    ball.curvrefl.is_mirror = True
    for obj in bpy.context.scene.objects:
        obj.select_set(obj == ball)
    bpy.context.window_manager.curvrefl_enabled = True
    yield rests
    bpy.context.view_layer.objects.active = ball
    yield from inspection(ball)
    before = settings()
    output = Path(FOLDER) / "comparison"
    window().screen.areas[0].type = "IMAGE_EDITOR" if window().screen.areas[0].type != "VIEW_3D" else "VIEW_3D"
    editor = next((area for area in window().screen.areas if area.type == "IMAGE_EDITOR"), None)
    with in_view():
        bpy.ops.curvrefl.compare_with_cycles("INVOKE_DEFAULT", **options(output))
    yield lambda: not is_modal("CURVREFL_OT_compare_with_cycles")
    yield 0.5
    keep("compare_done")
    seen["report of the modal run"] = json.loads((output / "report.json").read_text(encoding="utf-8"))
    seen["image editor shows"] = None if editor is None else getattr(editor.spaces.active.image, "name", "")
    seen["settings after all"] = settings()[:9] == before[:9]
    bpy.ops.curvrefl.compare_with_cycles(**options(output))
    seen["report of the script"] = json.loads((output / "report.json").read_text(encoding="utf-8"))


def end(error: str) -> None:
    seen["error"] = error
    (Path(FOLDER) / "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), end)
