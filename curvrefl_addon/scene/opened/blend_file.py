# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user names: the .blend file, the camera, the reflectors."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np

from ...errors import InputError
from ..camera.lens import lens_of
from ..camera.view import View
from ..finite import problem_of_place

EXACT_DEPTHS = 1.001e4
"""Blender's projections, in single precision, tell where they end as long as that is no more times where they begin"""
SURFACE_TYPES = ("MESH", "CURVE", "SURFACE", "FONT", "META")
"""Object types that may evaluate to a mesh"""
# Uncompressed, Zstandard and (before Blender 3.0) gzip.
_FILE_STARTS = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")


def open_blend(path: str | Path) -> None:
    """Make the .blend file at `path` the open one, without its window layout.

    Python scripts in the file run only where the user's preferences allow it. Raises InputError for a file that is
    missing or that Blender cannot read; what was open before may then be gone.
    """
    path = Path(path)
    try:
        if not path.exists():
            raise InputError(f'There is no file "{path}": check the path of the .blend file.')
        if not path.is_file():
            raise InputError(f'"{path}" is not a file: name a .blend file.')
        with path.open("rb") as file:
            start = file.read(8)
    except OSError as error:
        raise InputError(f'Cannot read "{path}" ({error.strerror}): check its path and permissions.') from error
    if not start.startswith(_FILE_STARTS):
        raise InputError(f'"{path}" is not a .blend file: choose one that Blender saved.')
    trust = bpy.context.preferences.filepaths.use_scripts_auto_execute
    try:
        result = bpy.ops.wm.open_mainfile(filepath=str(path.absolute()), load_ui=False, use_scripts=trust)
    except RuntimeError as error:
        reason = " ".join(str(error).removeprefix("Error:").split()).rstrip(".")
        raise InputError(
            f'Blender cannot open "{path}" ({reason}): the file is damaged or from a newer version.'
        ) from error
    if "FINISHED" not in result:
        raise InputError(f'Blender cannot open "{path}": the file is damaged or from a newer version.')


def find_camera(scene: bpy.types.Scene, name: str | None = None) -> bpy.types.Object:
    """The camera object called `name`, or the one that Blender would render by. Raises InputError for none."""
    if name is None:
        active = _camera_of_markers(scene) or scene.camera
        if active is None:
            raise InputError(f'Scene "{scene.name}" has no camera: add one or make one active.')
        camera = active
    else:
        found = scene.objects.get(name)
        if found is None:
            cameras = (obj.name for obj in scene.objects if obj.type == "CAMERA")
            raise InputError(f'There is no camera "{name}" in scene "{scene.name}"{_near(name, cameras)}')
        camera = found
    if not isinstance(camera.data, bpy.types.Camera):
        raise InputError(f'"{camera.name}" is not a camera: choose a camera object.')
    return camera


@contextmanager
def camera_in_use(scene: bpy.types.Scene, name: str | None) -> Iterator[None]:
    """`scene.camera` is for the time being the camera object called `name`, or the one that Blender renders by."""
    before = scene.camera
    scene.camera = find_camera(scene, name)
    try:
        yield
    finally:
        scene.camera = before


def _camera_of_markers(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """The camera that a marker binds to the frame: the last one until then, else the first one after."""
    bound = [marker for marker in scene.timeline_markers if marker.camera is not None and not marker.camera.hide_render]
    begun = [marker for marker in bound if marker.frame <= scene.frame_current]
    if begun:
        return max(begun, key=lambda marker: marker.frame).camera
    return min(bound, key=lambda marker: marker.frame).camera if bound else None


def view_of_camera(
    scene: bpy.types.Scene,
    camera: bpy.types.Object,
    width: int,
    height: int,
    depsgraph: bpy.types.Depsgraph | None = None,
) -> View:
    """What `camera` sees on a picture of `width` x `height` pixels: shift, sensor fit and pixel aspect included.

    As in Blender's renders, the scale of the camera object is ignored. Raises InputError for a size without pixels,
    a camera that is neither perspective nor orthographic, and a matrix that cannot be inverted.
    """
    if width < 1 or height < 1:
        raise InputError(f"A picture of {width}x{height} has no pixels: choose at least 1x1.")
    if depsgraph is None:
        depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = camera.evaluated_get(depsgraph)
    data = evaluated.data
    if not isinstance(data, bpy.types.Camera):
        raise InputError(f'"{camera.name}" is not a camera: choose a camera object.')
    if data.type not in ("PERSP", "ORTHO"):
        raise InputError(f'Camera "{camera.name}" is panoramic: make it perspective or orthographic.')
    placed = np.array(evaluated.matrix_world, dtype=np.float64)
    if problem := problem_of_place(placed, 0.0):
        raise InputError(f'Camera "{camera.name}" {problem}: clear its location, rotation and scale.')
    lengths = np.linalg.norm(placed[:3, :3], axis=0)
    if lengths.min() == 0.0:
        raise InputError(f'Camera "{camera.name}" has a zero or endless scale: clear its scale.')
    placed[:3, :3] /= lengths
    if abs(np.linalg.det(placed[:3, :3])) < 1e-6:
        raise InputError(f'Camera "{camera.name}" is flattened by its parents: clear their scale.')
    projection = evaluated.calc_matrix_camera(
        depsgraph,
        x=width,
        y=height,
        scale_x=scene.render.pixel_aspect_x,
        scale_y=scene.render.pixel_aspect_y,
    )
    if not np.isfinite(np.array(projection)).all():
        raise InputError(f'Camera "{camera.name}" has a lens, shift or clip range that is not a usable number: set it.')
    return View(
        world_to_view=np.linalg.inv(placed),
        view_to_clip=np.array(projection, dtype=np.float64),
        width=width,
        height=height,
        lens=lens_of(data, placed, depsgraph),
        clip=(data.clip_start, data.clip_end) if data.clip_end > EXACT_DEPTHS * data.clip_start else None,
    )


def find_reflectors(scene: bpy.types.Scene, names: Sequence[str]) -> list[bpy.types.Object]:
    """The objects called `names`, once each, in that order.

    An object may be one that is only in a collection that is instanced. Raises InputError, with what to do, for no
    name at all, a name that the file does not have (near names are offered), an object that has no surface, or is a
    mesh without faces or modifiers. What only shows in a depsgraph (hidden, no faces, wild coordinates) is found by
    `SceneReader`.
    """
    if not names:
        raise InputError("No reflector is chosen: name at least one object.")
    return [_find_reflector(scene, name) for name in dict.fromkeys(names)]


def objects_of(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Those of the scene, and those that are only in a collection that one of them instances."""
    found = {obj.session_uid: obj for obj in scene.objects}
    unseen = list(found.values())
    while unseen:
        group = unseen.pop().instance_collection
        for obj in () if group is None else group.all_objects:
            if obj.session_uid not in found:
                found[obj.session_uid] = obj
                unseen.append(obj)
    return list(found.values())


def _find_reflector(scene: bpy.types.Scene, name: str) -> bpy.types.Object:
    obj = scene.objects.get(name) or bpy.data.objects.get(name)
    if obj is None:
        surfaces = (other.name for other in scene.objects if other.type in SURFACE_TYPES)
        raise InputError(f'There is no object "{name}" in scene "{scene.name}"{_near(name, surfaces)}')
    if obj.type not in SURFACE_TYPES:
        kind = obj.type.lower().replace("_", " ")
        raise InputError(f'"{name}" is not a mesh but of type {kind}: choose a mesh object as the reflector.')
    if isinstance(obj.data, bpy.types.Mesh) and len(obj.data.polygons) == 0 and len(obj.modifiers) == 0:
        raise InputError(f'"{name}" has no faces: choose a mesh with a surface as the reflector.')
    return obj


def _near(name: str, known: Iterable[str]) -> str:
    """The end of a sentence: up to three of the names `known` that look like `name`, letter case aside."""
    by_lower = {other.lower(): other for other in known}
    close = difflib.get_close_matches(name.lower(), by_lower, n=3, cutoff=0.5)
    if close:
        return ": did you mean " + " or ".join(f'"{by_lower[other]}"' for other in close) + "?"
    if by_lower:
        return ": choose from " + ", ".join(f'"{other}"' for other in sorted(by_lower.values())[:5]) + "."
    return ", which has nothing of the kind: add one."
