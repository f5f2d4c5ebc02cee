# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Setting up a film, keeping it like its scene, and taking it away again."""

from __future__ import annotations

from typing import Any, Literal

import bpy

from ..engine.engine import ENGINE
from ..errors import InputError
from ..options import marked_mirrors
from .layers import filmed_layer, follow_layer, held_out_layer, make_held_out_layer, set_value
from .untold import untold
from .wiring import unwire, wire

EEVEE: Literal["BLENDER_EEVEE"] = "BLENDER_EEVEE"
OF_RENDER = (
    "fps",
    "fps_base",
    "frame_map_old",
    "frame_map_new",
    "use_simplify",
    "simplify_subdivision_render",
    "simplify_child_particles_render",
    "simplify_volumes",
    "use_simplify_normals",
    "hair_type",
    "hair_subdiv",
)
"""What objects are evaluated by; all else the engine reads from the filmed scene itself"""


def film_of(scene: bpy.types.Scene) -> bpy.types.Scene | None:
    """The scene that renders the mirrors for `scene`, where it is filmed."""
    return next((other for other in bpy.data.scenes if other.curvrefl.film_source == scene), None)


def set_up(scene: bpy.types.Scene) -> list[str]:
    """Set up the film of a scene, or set it up anew; returns what of it stays as EEVEE shows it, a sentence each.

    Raises InputError, with what to do, where the scene cannot be filmed; then it is as it was.
    """
    mirrors = marked_mirrors(scene)
    if problem := _problem(scene, mirrors):
        raise InputError(problem)
    remove(scene)
    film: Any = bpy.data.scenes.new(f"{scene.name} Mirrors")
    try:
        film.curvrefl.film_source = scene
        film.curvrefl.film_composited = scene.render.use_compositing
        film.background_set = scene
        film.render.engine = ENGINE
        for name in ("use_pass_mirror", "use_pass_position", "use_pass_object"):
            setattr(film.view_layers[0].curvrefl, name, True)
        group = film.curvrefl.film_collection = bpy.data.collections.new(f"{scene.name} Mirrors")
        scene.collection.children.link(group)
        double = make_held_out_layer(scene)
        follow(scene, film)
        scene.render.use_compositing = True
        told, has_instances = untold(scene, mirrors)
        wire(scene, filmed_layer(scene), double, film, has_instances)
    except BaseException:
        remove(scene)
        raise
    return told


def remove(scene: bpy.types.Scene) -> bool:
    """Take the film away: the file is as it was before it. Returns whether there was one."""
    film = film_of(scene)
    if film is None:
        return False
    unwire(scene)
    if (double := held_out_layer(scene)) is not None:
        scene.view_layers.remove(double)
    if (group := film.curvrefl.film_collection) is not None:
        bpy.data.collections.remove(group)
    set_value(scene.render, "use_compositing", film.curvrefl.film_composited)
    bpy.data.scenes.remove(film)
    return True


def follow(scene: Any, film: Any) -> None:
    """Make the film like its scene again: camera and markers, objects' evaluation, view layers, and mirrors."""
    set_value(film, "camera", scene.camera)
    _follow_markers(scene, film)
    for name in OF_RENDER:
        set_value(film.render, name, getattr(scene.render, name))
    set_value(film, "use_gravity", scene.use_gravity)
    if tuple(film.gravity) != tuple(scene.gravity):
        film.gravity = scene.gravity
    layer, own = filmed_layer(scene), film.view_layers[0]
    for name in ("material_override", "world_override", "use_sky"):
        set_value(own, name, getattr(layer, name))
    group = film.curvrefl.film_collection
    if group is None or held_out_layer(scene) is None:
        # (The user has taken a part away: setting up again brings it back.)
        return
    mirrors = {obj for obj in marked_mirrors(scene) if obj.name in layer.objects and layer.objects[obj.name] == obj}
    for obj in set(group.objects) - mirrors:
        group.objects.unlink(obj)
    for obj in mirrors - set(group.objects):
        group.objects.link(obj)
    follow_layer(scene, group)


def _follow_markers(scene: bpy.types.Scene, film: bpy.types.Scene) -> None:
    """Those that bind cameras."""
    bound = [(marker.frame, marker.camera) for marker in scene.timeline_markers if marker.camera is not None]
    if [(marker.frame, marker.camera) for marker in film.timeline_markers] == bound:
        return
    film.timeline_markers.clear()
    for frame, camera in bound:
        film.timeline_markers.new(camera.name, frame=frame).camera = camera
    # (To bind a camera makes it the scene's.)
    set_value(film, "camera", scene.camera)


def _problem(scene: bpy.types.Scene, mirrors: list[bpy.types.Object]) -> str:
    """Why a scene cannot be filmed, or nothing."""
    if scene.curvrefl.film_source is not None:
        return f'Scene "{scene.name}" is itself the film of "{scene.curvrefl.film_source.name}": set up that one.'
    if scene.library is not None:
        return f'Scene "{scene.name}" is linked from another file: set up its film there.'
    if scene.render.engine != EEVEE:
        return "A film puts mirrors into EEVEE's pictures: choose EEVEE as the render engine."
    if not mirrors:
        return "No object is marked as a mirror: mark one first."
    if scene.camera is None:
        return f'Scene "{scene.name}" has no camera: add one or make one active.'
    if scene.render.use_multiview:
        return "Stereoscopy is not rendered: switch it off in the output properties."
    if scene.render.use_single_layer:
        return "A film needs two view layers: switch Render Single Layer off in the view layer properties."
    return ""
