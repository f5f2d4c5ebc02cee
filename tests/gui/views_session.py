# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: shading modes, projections, quad view, a second window, local view.

For each, a picture of the window and, for every region, what should be in it: the mirrors' picture as it is on the GPU.
Arguments after `--`: the zip, a .blend file with the object Mirror Ball, the folder for what was seen.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from scripted import Script, arguments, extension, in_view, install, play, rests, screenshot, view_3d

ARCHIVE, BLEND, FOLDER = arguments()[:3]
seen: dict[str, Any] = {"captures": {}}


def pictures() -> Mapping[int, Any]:
    return extension("curvrefl_addon.viewport.handlers").pictures()


def regions() -> list[bpy.types.Region]:
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return [region for region in area.regions if region.type == "WINDOW" and region.as_pointer() in pictures()]


def engine_draws() -> bool:
    """EEVEE shows the block: before, while it compiles shaders, it leaves the view empty.

    (Blender adds the theme's background wherever an engine has left alpha at 0, also behind what is drawn later.)
    """
    if not shutil.which("import"):
        return True
    from bpy_extras.view3d_utils import location_3d_to_region_2d

    _area, space, region = view_3d()
    place = location_3d_to_region_2d(region, space.region_3d, bpy.data.objects["Block"].matrix_world.translation)
    path = Path(FOLDER) / "engine.png"
    screenshot(path)
    image = bpy.data.images.load(str(path))
    start = 4 * ((int(place.y) + region.y) * image.size[0] + int(place.x) + region.x)
    red, green, blue = image.pixels[start : start + 3]
    bpy.data.images.remove(image)
    seen.setdefault("block", []).append([red, green, blue])
    return abs(red - 0.2392) > 0.03


def capture(name: str) -> None:
    places = []
    for number, region in enumerate(regions()):
        np.save(Path(FOLDER) / f"{name}_{number}.npy", pictures()[region.as_pointer()].pixels())
        places.append([region.x, region.y, region.width, region.height])
    screenshot(Path(FOLDER) / f"{name}.png")
    viewport = extension("curvrefl_addon.viewport.handlers")
    seen["captures"][name] = {"regions": places, "messages": viewport.messages(), "pictures": len(pictures())}


def settled() -> Script:
    yield 0.3
    yield rests
    view_3d()[0].tag_redraw()
    yield 0.5


def script() -> Script:
    install(ARCHIVE)
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 1.0
    area, space, _region = view_3d()
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    scene.curvrefl.samples = 4
    scene.eevee.taa_samples = 1
    space.overlay.show_overlays = False
    space.show_gizmo = space.show_region_header = space.show_region_toolbar = False
    space.show_region_tool_header = space.show_region_ui = False
    mirror = bpy.data.objects["Mirror Ball"]
    mirror.curvrefl.is_mirror = True
    bpy.context.window_manager.curvrefl_enabled = True
    space.region_3d.view_perspective = "CAMERA"
    for kind in ("SOLID", "MATERIAL", "RENDERED"):
        space.shading.type = kind
        yield from settled()
        if kind != "SOLID":
            space.region_3d.view_perspective = "PERSP"
            space.region_3d.view_rotation = scene.camera.matrix_world.to_quaternion()
            space.region_3d.view_location = (0.5, 0.0, 0.0)
            space.region_3d.view_distance = 8.0
            yield engine_draws
            yield from settled()
        capture(kind.lower())
    space.shading.type = "SOLID"
    space.region_3d.view_perspective = "ORTHO"
    space.region_3d.view_location = mirror.matrix_world.translation
    space.region_3d.view_distance = 4.0 * max(mirror.dimensions)
    yield from settled()
    capture("orthographic")
    yield from moved(space)
    yield from quad(area)
    yield from two_windows()
    yield from local_view(mirror)
    bpy.context.window_manager.curvrefl_enabled = False
    yield 0.5
    seen["pictures when switched off"] = len(pictures())


def moved(space: bpy.types.SpaceView3D) -> Script:
    """Coarse at once, fine after a rest."""
    space.region_3d.view_distance *= 1.05
    found: list[bool] = []

    def is_coarse() -> bool:
        found.extend(item.is_coarse for item in pictures().values())
        return any(found)

    yield is_coarse
    seen["coarse while moving"] = True
    yield from settled()
    seen["fine at rest"] = rests()


def quad(area: bpy.types.Area) -> Script:
    with in_view():
        bpy.ops.screen.region_quadview()
    yield lambda: len(regions()) == 4
    yield from settled()
    capture("quad")
    with in_view():
        bpy.ops.screen.region_quadview()
    yield 0.5
    area.tag_redraw()
    yield from settled()
    capture("after_quad")


def two_windows() -> Script:
    bpy.ops.wm.window_new()
    yield 0.5
    window = bpy.context.window_manager.windows[-1]
    window.screen.areas[0].type = "VIEW_3D"
    other = window.screen.areas[0].spaces[0]
    other.shading.type = "SOLID"
    yield lambda: len(pictures()) == 2
    yield rests
    seen["pictures in two windows"] = len(pictures())
    with bpy.context.temp_override(window=window):
        bpy.ops.wm.window_close()
    yield 0.5
    view_3d()[1].region_3d.view_distance *= 1.01
    yield from settled()
    seen["pictures after closing one"] = len(pictures())


def local_view(mirror: bpy.types.Object) -> Script:
    for obj in bpy.context.scene.objects:
        obj.select_set(obj is mirror)
    bpy.context.view_layer.objects.active = mirror

    def shown() -> int:
        return len(next(iter(pictures().values())).renderer.scene.instances)

    everything = shown()
    with in_view():
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.5
    yield from settled()
    seen["local view"] = [everything, shown()]
    capture("local")
    with in_view():
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.5
    yield from settled()
    seen["after local view"] = shown()


def end(error: str) -> None:
    seen["error"] = error
    (Path(FOLDER) / "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), end)
