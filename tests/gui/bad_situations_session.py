# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: one bad situation after the other while the viewport draws, then the way back.

Each situation starts with the file opened and drawing. Its function causes it, waits, and puts the cause right again
where the file alone does not; then drawing is switched off and on. What was seen at both ends goes to `seen.json`.

Arguments after `--`: the zip, a .blend file with the objects Mirror Ball and Block, the folder for what was seen; after
`--only` the names of the situations to play, separated by commas, where these are not all.
"""

from __future__ import annotations

import json
import sys
import traceback
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import bmesh
import bpy
import gpu

sys.path.insert(0, str(Path(__file__).resolve().parent))
from scripted import EXTENSION, Script, Wait, arguments, extension, in_view, install, play, view_3d

ARCHIVE, BLEND, FOLDER = arguments()[:3]
MIRROR, BLOCK = "Mirror Ball", "Block"
SAMPLES = 2
REDRAWS = 6
"""Enough to see a traceback that comes with every redraw"""

CAUSED = "caused"
type Steps = Generator[Wait | str]
"""Waits; after CAUSED the cause is put right"""

SITUATIONS: dict[str, Callable[[], Steps]] = {}
seen: dict[str, Any] = {"situations": {}}
"""By name, in the order played; and "all", the names of those there are"""


def situation(function: Callable[[], Steps]) -> Callable[[], Steps]:
    SITUATIONS[function.__name__] = function
    return function


def mirror() -> bpy.types.Object:
    return bpy.data.objects[MIRROR]


def block() -> bpy.types.Object:
    return bpy.data.objects[BLOCK]


def drawn() -> int:
    return extension("curvrefl_addon.viewport.handlers").counters().get("sub-frames", 0)


def redraws(count: int = REDRAWS) -> Script:
    for _ in range(count):
        view_3d()[0].tag_redraw()
        yield 0.1


def opened() -> Script:
    """The file in the window, drawing."""
    if bpy.context.object and bpy.context.object.mode != "OBJECT":
        with in_view():
            bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.window_manager.curvrefl_enabled = False
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 0.2
    _area, space, _region = view_3d()
    space.overlay.show_overlays = False
    space.shading.type = "SOLID"
    space.region_3d.view_perspective = "CAMERA"
    bpy.context.scene.curvrefl.samples = SAMPLES
    mirror().curvrefl.is_mirror = True
    yield from switched_on()


def switched_on() -> Script:
    """Off and on again, until something is drawn."""
    bpy.context.window_manager.curvrefl_enabled = False
    yield 0.1
    before = drawn()
    bpy.context.window_manager.curvrefl_enabled = True
    yield lambda: drawn() >= before + SAMPLES or bool(extension("curvrefl_addon.viewport.handlers").messages())
    yield 0.1


def look(before: int) -> dict[str, Any]:
    return {
        "messages": extension("curvrefl_addon.viewport.handlers").messages(),
        "enabled": bpy.context.window_manager.curvrefl_enabled,
        "drawn": drawn() - before,
    }


def played() -> Script:
    seen["all"] = list(SITUATIONS)
    only = sys.argv[sys.argv.index("--only") + 1].split(",") if "--only" in sys.argv else list(SITUATIONS)
    for name in only:
        found: dict[str, Any] = {}
        seen["situations"][name] = found
        # Should Blender end in it, its name is the last one.
        save()
        try:
            yield from _played_one(SITUATIONS[name](), name, found)
        except Exception:
            found["error"] = traceback.format_exc()
        save()


def _played_one(steps: Steps, name: str, found: dict[str, Any]) -> Script:
    print(f"\n== opened {name}", flush=True)
    yield from opened()
    found["at start"] = look(0)
    print(f"\n== caused {name}", flush=True)
    before = drawn()
    for wait in steps:
        if not isinstance(wait, str):
            yield wait
            continue
        yield from redraws()
        found["caused"] = look(before)
        print(f"\n== repaired {name}", flush=True)
    before = drawn()
    yield from switched_on()
    yield from redraws(2)
    found["repaired"] = look(before)


def active(item: bpy.types.Object) -> None:
    for other in bpy.context.view_layer.objects:
        other.select_set(other == item)
    bpy.context.view_layer.objects.active = item


def mode(name: str) -> None:
    with in_view():
        bpy.ops.object.mode_set(mode=name)


# Objects and meshes


@situation
def scenery_deleted() -> Steps:
    bpy.data.objects.remove(block())
    yield CAUSED


@situation
def mirror_deleted() -> Steps:
    bpy.data.objects.remove(mirror())
    yield CAUSED
    yield from opened()


def emptied(item: bpy.types.Object) -> Steps:
    active(item)
    mode("EDIT")
    with in_view():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.delete(type="VERT")
    yield from redraws(2)
    mode("OBJECT")
    yield CAUSED
    yield from opened()


@situation
def scenery_emptied() -> Steps:
    yield from emptied(block())


@situation
def mirror_emptied() -> Steps:
    yield from emptied(mirror())


def edited(item: bpy.types.Object) -> Steps:
    active(item)
    mode("EDIT")
    yield from redraws(2)
    with in_view():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.transform.resize(value=(0.9, 0.9, 0.9))
    yield CAUSED
    mode("OBJECT")


@situation
def scenery_in_edit_mode() -> Steps:
    yield from edited(block())


@situation
def mirror_in_edit_mode() -> Steps:
    yield from edited(mirror())


def sculpted(item: bpy.types.Object) -> Steps:
    active(item)
    mode("SCULPT")
    yield from redraws(2)
    with in_view():
        bpy.ops.sculpt.mesh_filter("EXEC_DEFAULT", type="SCALE", strength=0.2)
    yield from redraws(2)
    with in_view():
        # A filter changes nothing without a mouse; this does.
        bpy.ops.sculpt.symmetrize()
    yield CAUSED
    mode("OBJECT")


@situation
def scenery_in_sculpt_mode() -> Steps:
    yield from sculpted(block())


@situation
def mirror_in_sculpt_mode() -> Steps:
    yield from sculpted(mirror())


def library() -> str:
    """A file to link from: the one that is open, its ball a mirror."""
    path = str(Path(FOLDER) / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    return path


def linked(name: str) -> Steps:
    path = library()
    bpy.data.objects.remove(bpy.data.objects[name])
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.objects = [name]
    bpy.context.scene.collection.objects.link(here.objects[0])
    yield CAUSED


@situation
def scenery_linked() -> Steps:
    yield from linked(BLOCK)


@situation
def mirror_linked() -> Steps:
    yield from linked(MIRROR)


def changed_mesh(item: bpy.types.Object, change: Callable[[bmesh.types.BMesh], None]) -> None:
    faces = bmesh.new()
    faces.from_mesh(item.data)
    change(faces)
    faces.to_mesh(item.data)
    faces.free()
    item.data.update()


def cut_in_half(faces: bmesh.types.BMesh) -> None:
    bmesh.ops.delete(faces, geom=[vertex for vertex in faces.verts if vertex.co.z < 0.0], context="VERTS")


def grown_fin(faces: bmesh.types.BMesh) -> None:
    """A third face at an edge."""
    faces.edges.ensure_lookup_table()
    one, other = faces.edges[0].verts
    faces.faces.new((one, other, faces.verts.new(one.co * 1.5)))


@situation
def mirror_open() -> Steps:
    bpy.context.scene.curvrefl.method = "secant_star"
    changed_mesh(mirror(), cut_in_half)
    yield CAUSED
    yield from opened()


@situation
def mirror_open_under_rays() -> Steps:
    bpy.context.scene.curvrefl.method = "exact"
    changed_mesh(mirror(), cut_in_half)
    yield CAUSED
    yield from opened()


@situation
def mirror_not_manifold() -> Steps:
    changed_mesh(mirror(), grown_fin)
    yield CAUSED
    yield from opened()


@situation
def scenery_open_and_not_manifold() -> Steps:
    changed_mesh(block(), grown_fin)
    changed_mesh(block(), cut_in_half)
    yield CAUSED


@situation
def scenery_scaled_negative() -> Steps:
    block().scale = (-1.0, 1.0, 1.0)
    yield CAUSED


@situation
def mirror_scaled_negative() -> Steps:
    mirror().scale = (-1.0, 1.0, 1.0)
    yield CAUSED


@situation
def mirror_scaled_to_nothing() -> Steps:
    mirror().scale = (0.0, 0.0, 0.0)
    yield CAUSED
    mirror().scale = (1.0, 1.0, 1.0)


def with_nan(item: bpy.types.Object) -> None:
    # (of an infinity Blender makes the largest number, which is finite)
    item.data.vertices[0].co = (float("nan"), 0.0, 0.0)
    item.data.vertices[1].co = (0.0, float("nan"), 0.0)
    item.data.update()


@situation
def scenery_with_nan() -> Steps:
    with_nan(block())
    yield CAUSED
    yield from opened()


@situation
def mirror_with_nan() -> Steps:
    with_nan(mirror())
    yield CAUSED
    yield from opened()


# Time and renders


def animate() -> None:
    for item in (block(), mirror()):
        item.keyframe_insert("location", frame=1)
        item.location.z += 0.5
        item.keyframe_insert("location", frame=10)
    bpy.context.scene.frame_end = 10


@situation
def playback() -> Steps:
    animate()
    with in_view():
        bpy.ops.screen.animation_play()
    frames: set[int] = set()

    def has_played() -> bool:
        frames.add(bpy.context.scene.frame_current)
        return len(frames) > 3

    yield has_played
    with in_view():
        bpy.ops.screen.animation_cancel()
    yield CAUSED


def rendered(animation: bool) -> Steps:
    """While it renders, what is drawn changes."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.render.filepath = str(Path(FOLDER) / "render_")
    bpy.context.preferences.view.render_display_type = "NONE"
    animate()
    scene.frame_end = 4
    ended: list[str] = []

    def complete(*_: Any) -> None:
        ended.append("complete")

    def cancelled(*_: Any) -> None:
        ended.append("cancelled")

    bpy.app.handlers.render_complete.append(complete)
    bpy.app.handlers.render_cancel.append(cancelled)
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT", animation=animation)
    for _ in range(4):
        if not animation:
            block().location.x += 0.01
        yield from redraws(1)
    yield lambda: bool(ended)
    assert ended == ["complete"], ended
    yield CAUSED


@situation
def render_while_drawing() -> Steps:
    yield from rendered(animation=False)


@situation
def animation_rendered_while_drawing() -> Steps:
    yield from rendered(animation=True)


# The extension itself


@situation
def disabled_while_drawing() -> Steps:
    before = drawn()
    bpy.context.scene.curvrefl.samples = 64
    yield lambda: drawn() > before
    bpy.ops.preferences.addon_disable(module=EXTENSION)
    try:
        seen["handlers after disable"] = [
            f"{name}: {function.__module__}"
            for name in dir(bpy.app.handlers)
            if isinstance(functions := getattr(bpy.app.handlers, name), list)
            for function in functions
            if EXTENSION in function.__module__
        ]
        seen["switch after disable"] = hasattr(bpy.context.window_manager, "curvrefl_enabled")
        yield from redraws()
    finally:
        bpy.ops.preferences.addon_enable(module=EXTENSION)
    seen["switch when enabled again"] = bpy.context.window_manager.curvrefl_enabled
    bpy.context.scene.curvrefl.samples = SAMPLES
    yield CAUSED


def fresh_shaders() -> None:
    """As in a new Blender: nothing compiled, no file read."""
    bpy.context.window_manager.curvrefl_enabled = False
    extension("curvrefl_addon.gpu_caches").clear_gpu_caches()
    for module in [module for name, module in sys.modules.items() if name.startswith(EXTENSION)]:
        for value in list(vars(module).values()):
            if callable(clear := getattr(value, "cache_clear", None)):
                clear()


@situation
def shader_compile_failure() -> Steps:
    fresh_shaders()
    installed = Path(extension("gpu_shaders.loader").__file__).parent
    sources = {path: path.read_bytes() for path in installed.rglob("*.glsl")}
    assert sources
    try:
        for path in sources:
            path.write_text("This is not a shader.\n", encoding="utf-8")
        bpy.context.window_manager.curvrefl_enabled = True
        yield CAUSED
    finally:
        for path, source in sources.items():
            path.write_bytes(source)
    fresh_shaders()


def failing(*_arguments: Any, **_named: Any) -> None:
    raise SystemError("GPU error")


@situation
def no_compute_support() -> Steps:
    bpy.context.window_manager.curvrefl_enabled = False
    with (
        patch.object(gpu.compute, "dispatch", failing),
        patch.object(gpu.capabilities, "compute_shader_support_get", lambda: False),
    ):
        bpy.context.window_manager.curvrefl_enabled = True
        yield CAUSED


@situation
def gpu_memory_exhausted() -> Steps:
    bpy.context.window_manager.curvrefl_enabled = False
    texture = gpu.types.GPUTexture
    calls = 0

    def exhausted(*arguments: Any, **named: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > 4:
            # Blender's own words
            raise RuntimeError("gpu.texture.new(...) failed with ''")
        return texture(*arguments, **named)

    with patch.object(gpu.types, "GPUTexture", exhausted):
        bpy.context.window_manager.curvrefl_enabled = True
        yield CAUSED


# Files and history


@situation
def undo_and_redo() -> Steps:
    with in_view():
        bpy.ops.ed.undo_push(message="before")
        active(block())
        bpy.ops.object.delete()
        bpy.ops.ed.undo_push(message="deleted")
    yield from redraws(2)
    with in_view():
        bpy.ops.ed.undo()
    yield from redraws(2)
    seen["block after undo"] = BLOCK in bpy.data.objects
    with in_view():
        bpy.ops.ed.redo()
    yield from redraws(2)
    with in_view():
        bpy.ops.ed.undo()
    yield CAUSED


@situation
def new_file() -> Steps:
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=False)
    yield CAUSED
    yield from opened()


@situation
def file_loaded_while_drawing() -> Steps:
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(FOLDER) / "other.blend"), copy=True)
    bpy.ops.wm.open_mainfile(filepath=str(Path(FOLDER) / "other.blend"), load_ui=False)
    yield from redraws(2)
    bpy.context.window_manager.curvrefl_enabled = True
    yield CAUSED


@situation
def file_of_a_newer_version() -> Steps:
    path = str(Path(FOLDER) / "newer.blend")
    stored = bpy.context.scene.bl_system_properties_get(do_create=True)["curvrefl"]
    stored["method"] = 57
    stored["from_the_future"] = "mirrors in mirrors"
    if "version" in bpy.context.scene.curvrefl.bl_rna.properties:
        stored["version"] = 1000
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    bpy.context.window_manager.curvrefl_enabled = True
    yield CAUSED
    yield from opened()


def save() -> None:
    part = Path(FOLDER) / "seen.part"
    part.write_text(json.dumps(seen, indent=1), encoding="utf-8")
    # Whole at any time, for Blender may end at any time.
    part.replace(Path(FOLDER) / "seen.json")


def end(error: str) -> None:
    seen["error"] = error
    seen["finished"] = not error
    save()
    bpy.ops.wm.quit_blender()


install(ARCHIVE)
play(played(), end)
