# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A baked reflector in a folder: OpenEXR files with its cube maps, and reflector.json with everything else.

A cube map is one 32-bit picture, n wide and 6 n high: the faces in OpenGL order, the first at the bottom, each with
t = 0 at its bottom. Saving and loading keeps every bit.
"""

from __future__ import annotations

import json
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...scene.arrays import Float32Array
from ...scene.exr_files import load_exr, save_exr
from .reflector_map import ReflectorMap, Spread

DESCRIPTION = "reflector.json"
VERSION = 1
_CUBES = ("radial", "positions", "normals")
_POINTS = "error_points"
_SPREADS = ("radius_error", "normal_error_degrees")
_NUMBERS = ("r_min", "r_max", "multiple_hits", "holes", "grazing")


def save(reflector: ReflectorMap, folder: Path | str) -> None:
    """Write the map into `folder`, which is made when missing; files of the same names are replaced.

    Raises OSError when the folder cannot be written to.
    """
    folder = Path(folder)
    description: dict[str, Any] = {"version": VERSION}
    for field in fields(reflector):
        if field.name not in (*_CUBES, _POINTS):
            description[field.name] = getattr(reflector, field.name)
    description["world_to_map"] = reflector.world_to_map.tolist()
    for name in _SPREADS:
        description[name] = asdict(getattr(reflector, name))
    folder.mkdir(parents=True, exist_ok=True)
    for name in _CUBES:
        save_exr(_picture(folder, name), getattr(reflector, name).reshape(-1, reflector.resolution, 4))
    _picture(folder, _POINTS).unlink(missing_ok=True)
    if len(reflector.error_points):
        save_exr(_picture(folder, _POINTS), reflector.error_points[None])
    # Last: where the description is, the pictures are.
    (folder / DESCRIPTION).write_text(json.dumps(description, indent=2) + "\n", encoding="utf-8")


def load(folder: Path | str) -> ReflectorMap:
    """Read what `save` has written. Raises InputError for files that are missing or damaged."""
    folder = Path(folder)
    if not (folder / DESCRIPTION).is_file():
        raise InputError(f'There is no baked reflector in "{folder}" (no {DESCRIPTION}): bake one into it first.')
    try:
        description = json.loads((folder / DESCRIPTION).read_text(encoding="utf-8"))
        version = description.pop("version")
        if version != VERSION:
            raise InputError(
                f'The reflector in "{folder}" is of version {version}, not {VERSION}: bake it again with this version.'
            )
        resolution = int(description["resolution"])
        pictures = {name: load_exr(_picture(folder, name)) for name in _CUBES}
        points = _picture(folder, _POINTS)
        error_points = load_exr(points)[0] if points.is_file() else np.zeros((0, 4), np.float32)
        spreads = {name: Spread(**description.pop(name)) for name in _SPREADS}
        numbers = {name: float(description.pop(name)) for name in _NUMBERS}
        fields: dict[str, Any] = {
            "world_to_map": _rigid(description.pop("world_to_map")),
            "warnings": tuple(description.pop("warnings")),
            "error_points": error_points,
            **{name: _cube(name, picture, resolution) for name, picture in pictures.items()},
            **spreads,
            **numbers,
            **description,
        }
        reflector = ReflectorMap(**fields)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f'The baked reflector in "{folder}" is damaged ({error}): bake it again.') from error
    return reflector


def _picture(folder: Path, name: str) -> Path:
    return folder / f"{name}.exr"


def _cube(name: str, picture: Float32Array, resolution: int) -> Float32Array:
    """Faces of a picture. Raises ValueError for wrong sizes and values."""
    if resolution < 1 or picture.shape != (6 * resolution, resolution, 4):
        raise ValueError(
            f"{name}.exr has {picture.shape[1]}x{picture.shape[0]} pixels, not {resolution}x{6 * resolution}"
        )
    if not np.isfinite(picture).all():
        raise ValueError(f"{name}.exr has values that are not finite")
    return picture.reshape(6, resolution, resolution, 4)


def _rigid(rows: Any) -> np.ndarray:
    """The matrix. Raises ValueError where it does more than turn and move."""
    matrix = np.array(rows, np.float64)
    if matrix.shape != (4, 4) or not np.allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-9):
        raise ValueError("world_to_map is not a rigid transform")
    return matrix
