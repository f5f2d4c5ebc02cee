# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window, for as long as asked: orbits, edits, undo, file loads; notes what is alive after each
round.

A round opens a file and ends in the state that the round before it ended in, so that nothing has a reason to grow.
Arguments after `--`: the zip, two .blend files with Mirror Ball and Block, the folder for what was seen,
and for how many seconds to go on.
"""

from __future__ import annotations

import ctypes
import gc
import itertools
import json
import random
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from scripted import EXTENSION, Script, arguments, extension, in_view, install, play, rests, view_3d

ARCHIVE, *BLENDS, FOLDER, SECONDS = arguments()[:5]
METHODS = ("auto", "exact", "newton", "secant_star", "environment_cube", "exact")
SHOWN = ("REFLECTION", "ZEBRA", "STATUS", "REFLECTION")
TURNS = 8
seen: dict[str, Any] = {"rounds": []}


def viewport() -> Any:
    return extension("curvrefl_addon.viewport.handlers")


def drawn() -> int:
    return int(viewport().counters().get("sub-frames", 0))


def resident() -> float:
    """Memory in use, in MB, without what the C library keeps for later."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024.0
    return 0.0


def alive() -> dict[str, int]:
    """How many objects there are of each class of ours, and of Blender's data-blocks and handlers."""
    classes = Counter(type(item) for item in gc.get_objects())
    # (`__module__` of a class that C made may be no text)
    named = [(str(kind.__module__), kind.__name__, count) for kind, count in classes.items()]
    kinds = Counter({f"{module}.{name}": count for module, name, count in named if module.startswith(EXTENSION)})
    for kind in ("images", "meshes", "materials", "objects", "scenes", "texts"):
        kinds[f"data.{kind}"] = len(getattr(bpy.data, kind))
    handlers = bpy.app.handlers
    for name in ("depsgraph_update_post", "frame_change_post", "undo_post", "redo_post", "load_post"):
        kinds[f"handlers.{name}"] = len(getattr(handlers, name))
    return dict(sorted(kinds.items()))


def pictured() -> Script:
    """Until the picture of what is there now is complete."""
    yield 0.1
    view_3d()[0].tag_redraw()
    yield 0.1
    yield rests


def push(message: str) -> None:
    with in_view():
        bpy.ops.ed.undo_push(message=message)


def orbited(chance: random.Random) -> Script:
    """As with the mouse: a redraw for each step, and no waiting for the picture at rest until the end."""
    data = view_3d()[1].region_3d
    data.view_perspective = "PERSP"
    for _ in range(TURNS):
        with in_view():
            bpy.ops.view3d.view_orbit(angle=chance.uniform(-0.4, 0.4), type=chance.choice(["ORBITLEFT", "ORBITUP"]))
        data.view_distance = chance.uniform(4.0, 9.0)
        view_3d()[0].tag_redraw()
        yield 0.02
    yield from pictured()


def edited(chance: random.Random) -> Script:
    """Objects, meshes, materials, lamps: each drawn, then all undone, done again and undone."""
    push("before")
    block, ball = bpy.data.objects["Block"], bpy.data.objects["Mirror Ball"]
    block.location.z += chance.uniform(-0.5, 0.5)
    push("moved")
    yield from pictured()
    block.data.vertices[0].co.x += 0.1
    block.data.update()
    push("edited")
    yield from pictured()
    ball.scale.z = chance.uniform(0.8, 1.2)
    push("stretched the mirror")
    yield from pictured()
    ball.active_material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.9, 0.6, 0.3, 1.0)
    push("painted")
    yield from pictured()
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))
    lamp.location.z = 4.0
    bpy.context.scene.collection.objects.link(lamp)
    copy = block.copy()
    copy.data = block.data.copy()
    copy.location.y += 2.0
    copy.curvrefl.is_mirror = True
    bpy.context.scene.collection.objects.link(copy)
    push("added")
    yield from pictured()
    bpy.data.objects.remove(copy)
    push("removed")
    yield from pictured()
    for _ in range(6):
        with in_view():
            bpy.ops.ed.undo()
        yield 0.05
    yield from pictured()
    with in_view():
        bpy.ops.ed.redo()
    yield from pictured()
    with in_view():
        bpy.ops.ed.undo()
    yield 0.05


def played_back() -> Script:
    scene = bpy.context.scene
    for frame in range(1, 6):
        scene.frame_set(frame)
        yield 0.02
    scene.frame_set(1)
    yield from pictured()


def opened(blend: str) -> Script:
    bpy.ops.wm.open_mainfile(filepath=blend, load_ui=False)
    yield 0.2
    space = view_3d()[1]
    space.overlay.show_overlays = False
    space.shading.type = "SOLID"
    space.region_3d.view_perspective = "CAMERA"
    bpy.context.scene.curvrefl.samples = 2
    bpy.data.objects["Mirror Ball"].curvrefl.is_mirror = True
    bpy.context.window_manager.curvrefl_enabled = True
    yield from pictured()


def round_of(number: int) -> Script:
    """The same steps in every round; only amounts differ."""
    chance = random.Random(number)
    for blend in BLENDS:
        yield from opened(blend)
        for method, shown in zip(METHODS, itertools.cycle(SHOWN)):
            bpy.context.scene.curvrefl.method = method
            bpy.context.scene.curvrefl.show = shown
            yield from orbited(chance)
        bpy.context.scene.curvrefl.show = "REFLECTION"
        yield from edited(chance)
        yield from played_back()
        bpy.context.window_manager.curvrefl_enabled = False
        yield 0.1
        bpy.context.window_manager.curvrefl_enabled = True
        yield from pictured()


def script() -> Script:
    install(ARCHIVE)
    bpy.context.preferences.edit.undo_steps = 16
    end_at = time.monotonic() + float(SECONDS)
    for number in itertools.count():
        if time.monotonic() > end_at:
            break
        before = drawn() if number else 0
        yield from round_of(number)
        messages = viewport().messages()
        seen["rounds"].append({"memory": resident(), "alive": alive(), "messages": messages, "drawn": drawn() - before})
        save()
    seen["finished"] = True


def save() -> None:
    part = Path(FOLDER) / "seen.part"
    part.write_text(json.dumps(seen), encoding="utf-8")
    part.replace(Path(FOLDER) / "seen.json")


def end(error: str) -> None:
    if error:
        seen["error"] = error
    save()
    bpy.ops.wm.quit_blender()


play(script(), end)
