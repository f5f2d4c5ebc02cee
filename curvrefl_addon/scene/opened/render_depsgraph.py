# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The open scene as F12 would render it: its levels of detail, its modifiers, and who is hidden.

Blender makes a depsgraph of that kind for a render engine alone. So one of our own is registered for the time of a
render without a picture, in which the scene is read.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import bpy

from ...errors import InputError
from ..arrays import MaterialArrays, SceneArrays
from ..camera.shutter import Moment, read_moments
from ..camera.view import View
from ..changes import Changes
from ..extract import SceneReader
from .blend_file import find_camera, find_reflectors, view_of_camera
from .temporary_settings import TemporarySettings, temporary_settings

_READER = "CURVREFL_READER"


def read_render_scene(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflectors: Sequence[str],
    width: int,
    height: int,
    camera: str | None = None,
    reader: SceneReader | None = None,
    overrides: Mapping[int, MaterialArrays] | None = None,
) -> tuple[SceneArrays, View]:
    """What a render of the scene's present frame shows, and the view of it on `width` x `height` pixels.

    `reflectors`: names of objects, also of those that are only in a collection that is instanced. `camera`: the name of
    a camera object, or that which Blender would render by. `reader`: one that has read the scene before. Raises
    InputError for a camera or a reflector that cannot be one, and where Blender renders something else at the time.
    """
    chosen = find_reflectors(scene, reflectors)
    seen_by = find_camera(scene, camera)

    def read(depsgraph: bpy.types.Depsgraph) -> tuple[SceneArrays, View]:
        view = view_of_camera(scene, seen_by, width, height, depsgraph)
        changes = Changes(everything=True)
        return (reader or SceneReader()).read(depsgraph, scene, chosen, changes, overrides), view

    return with_render_depsgraph(scene, view_layer, read, width, height, seen_by)


def read_render_moments(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflectors: Sequence[str],
    width: int,
    height: int,
    samples: int,
    camera: str | None = None,
    reader: SceneReader | None = None,
    overrides: Mapping[int, MaterialArrays] | None = None,
    may_be_hidden: bool = False,
) -> tuple[Moment, tuple[Moment, ...], tuple[str, ...]]:
    """As `read_render_scene`: the frame itself, and what `shutter.read_moments` finds of its motion.

    `may_be_hidden`: reflectors that are not there at the frame are no error, but a sentence among those returned.
    """
    chosen = find_reflectors(scene, reflectors)
    seen_by = find_camera(scene, camera)
    reading = reader or SceneReader()

    def read(
        engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph
    ) -> tuple[Moment, tuple[Moment, ...], tuple[str, ...]]:
        here = shown_of(depsgraph, chosen) if may_be_hidden else chosen

        def read_now(changes: Changes) -> tuple[SceneArrays, View]:
            view = view_of_camera(scene, seen_by, width, height, depsgraph)
            return reading.read(depsgraph, scene, here, changes, overrides), view

        def read_moment(changes: Changes) -> tuple[SceneArrays, View]:
            view = view_of_camera(scene, seen_by, width, height, depsgraph)
            return reading.read(depsgraph, scene, shown_of(depsgraph, here), changes, overrides), view

        def go_to(frame: int, subframe: float) -> None:
            engine.frame_set(frame, subframe=subframe)

        still = Moment(*read_now(Changes(everything=True)))
        moments, untold = read_moments(scene, still, samples, read_moment, go_to)
        hidden = [f'"{obj.name}" is hidden in some frames: they are without it.' for obj in chosen if obj not in here]
        return still, moments, (*hidden, *untold)

    return _in_render(scene, view_layer, read, width, height, seen_by)


def shown_of(depsgraph: Any, objects: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """Those of the objects that a depsgraph shows, themselves or by instances."""
    shown = {instance.object.original for instance in depsgraph.object_instances if instance.show_self}
    return [obj for obj in objects if obj in shown]


def read_rendered(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, reflectors: Sequence[str]) -> SceneArrays:
    """As `read_render_scene`, of a scene that needs no camera."""
    chosen = find_reflectors(scene, reflectors)
    return with_render_depsgraph(
        scene, view_layer, lambda depsgraph: SceneReader().read(depsgraph, scene, chosen, Changes(everything=True))
    )


def with_render_depsgraph[T](
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    read: Callable[[bpy.types.Depsgraph], T],
    width: int = 0,
    height: int = 0,
    camera: bpy.types.Object | None = None,
) -> T:
    """What `read` makes of the scene's render depsgraph, which is gone afterwards. Settings are as before then.

    `width`, `height`: of the picture that would be rendered, the scene's own if 0. `camera`: what sees it; without one
    the scene is read as seen from nowhere in particular. Raises what `read` raises, and InputError where Blender does
    not begin: while it renders something else, for one.
    """
    return _in_render(scene, view_layer, lambda _engine, depsgraph: read(depsgraph), width, height, camera)


def _in_render[T](
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    work: Callable[[bpy.types.RenderEngine, bpy.types.Depsgraph], T],
    width: int,
    height: int,
    camera: bpy.types.Object | None,
) -> T:
    """What `work` makes of an engine and its depsgraph, while Blender renders by it."""
    found: list[T] = []
    failed: list[BaseException] = []

    def render(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
        try:
            found.append(work(engine, depsgraph))
        except BaseException as error:
            # (Blender would print it and go on.)
            failed.append(error)

    # With a GPU context of its own: else Blender's drawing of grease pencil, which follows, leaves none active.
    about = {"bl_idname": _READER, "bl_label": "", "bl_use_gpu_context": True, "render": render}
    engine_type = type("CurvreflReader", (bpy.types.RenderEngine,), about)
    bpy.utils.register_class(engine_type)
    try:
        with temporary_settings() as changes:
            if camera is None:
                camera = _stand_in_camera(changes, scene)
            _use_reader(changes, scene, width, height)
            use_camera(changes, scene, camera)
            try:
                bpy.ops.render.render(scene=scene.name, layer=view_layer.name)
            except RuntimeError as error:
                reason = " ".join(str(error).removeprefix("Error:").split()).rstrip(".")
                raise InputError(f'Blender does not render scene "{scene.name}" ({reason}).') from error
    finally:
        bpy.utils.unregister_class(engine_type)
    if failed:
        raise failed[0]
    if not found:
        raise InputError(f'Blender does not render scene "{scene.name}" now: wait for the render that goes on.')
    return found[0]


def use_camera(changes: TemporarySettings, scene: bpy.types.Scene, camera: bpy.types.Object | None) -> None:
    """Render by this camera, whatever markers say."""
    before = scene.camera
    for marker in scene.timeline_markers:
        # A marker with a camera would replace the chosen one as the render starts.
        changes.set(marker, camera=None)
    # (Taking one marker's camera makes another's that of the scene: it is not what is to be restored.)
    scene.camera = before
    # Giving a marker its camera back makes that the scene's camera: restore this after the markers.
    changes.set(scene, camera=camera)


def _stand_in_camera(changes: TemporarySettings, scene: bpy.types.Scene) -> bpy.types.Object:
    """Blender does not render without one."""
    data = changes.remove_at_end(bpy.data.cameras, bpy.data.cameras.new("curvrefl reader"))
    camera = changes.remove_at_end(bpy.data.objects, bpy.data.objects.new("curvrefl reader", data))
    scene.collection.objects.link(camera)
    return camera


def _use_reader(changes: TemporarySettings, scene: bpy.types.Scene, width: int, height: int) -> None:
    render: Any = scene.render
    changes.set(
        render,
        engine=_READER,
        use_border=False,
        use_multiview=False,
        use_compositing=False,
        use_sequencer=False,
        use_freestyle=False,
        use_persistent_data=False,
    )
    if width and height:
        changes.set(render, resolution_x=width, resolution_y=height, resolution_percentage=100)
