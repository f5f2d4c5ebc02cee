# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as something that is placed: its sun is turned to where it is to be seen.

A Sky Texture has its sun's elevation and rotation; an Environment Texture is turned by its Mapping node, so that the
brightest place of the image goes there.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from ...errors import InputError
from ...optics.surfaces.radial_surfaces import unit
from ...renderer.lighting.suns import split_suns
from ...scene.arrays import Float32Array, Float64Array, WorldArrays
from ...scene.materials.images import ImageReader
from ...scene.materials.mappings import euler_matrix
from ...scene.materials.node_links import Source, find_input, output_source
from ...scene.world import equirectangular_directions
from .goals import Goal, upright
from .moved import Change

BLOCKS = 64
"""Rows of blocks in which the brightest place of an image without a sun is looked for"""
_PLACED = 1e-4
"""Radians by which a sun may be off in what Blender stores"""


class MovedWorld:
    """The world of a scene and how it was when it was taken up; as `Moved`."""

    item = None
    is_sun = True
    extent = 0.0

    def __init__(self, world: bpy.types.World | None, keeps_level: bool) -> None:
        """`keeps_level`: it is turned about the vertical alone. Raises InputError for a world that cannot be turned."""
        if world is None:
            raise InputError("The scene has no world: add one in the world properties.")
        if not world.is_editable:
            raise InputError(f'World "{world.name}" is linked and cannot be turned: make a library override.')
        self.name = world.name
        self._keeps_level = keeps_level
        self._background = _background_of(world)
        self._sun: _SkySun | _ImageSun = _sun_of(world)
        self._strength = None if self._background is None else float(self._background.default_value)

    @property
    def place(self) -> Float64Array:
        """(3,) nowhere."""
        return np.zeros(3)

    @property
    def direction(self) -> Float64Array:
        """(3,) unit, to its sun or to what is brightest in it, as it is now."""
        return self._sun.direction

    def move(self, goal: Goal, change: Change) -> None:
        """From how it was to the goal."""
        if change.size != 1.0:
            raise InputError("The size of a world's sun is set in its nodes: only a light's size changes here.")
        if change.power != 1.0 and self._strength is None:
            raise InputError(f'World "{self.name}" has no Background node with a strength of its own.')
        self._sun.turn(-goal.shines, self._keeps_level)
        if self._background is not None and self._strength is not None:
            strength = self._strength * change.power
            if self._background.default_value != np.float32(strength):
                self._background.default_value = strength

    def restore(self) -> None:
        """As it was."""
        self._sun.restore()
        if self._background is not None:
            self._background.default_value = self._strength

    def insert_keys(self, _aims: bool) -> None:
        """A world's nodes are keyed by hand."""

    def held(self, goal: Goal, _depsgraph: bpy.types.Depsgraph) -> str:
        """A sentence where its sun is not seen where it was asked for."""
        cosine = float(np.clip(self.direction @ -goal.shines, -1.0, 1.0))
        if cosine >= np.cos(_PLACED):
            return ""
        degrees = np.degrees(np.arccos(cosine))
        return f'"{self.name}" is kept level: its sun is {degrees:.1f}° from where you clicked.'


class _SkySun:
    """Of a Sky Texture."""

    def __init__(self, node: Any) -> None:
        self._node = node
        self._has_angles = node.sky_type not in ("PREETHAM", "HOSEK_WILKIE")
        names = ("sun_elevation", "sun_rotation") if self._has_angles else ("sun_direction",)
        self._values = {name: _plain(getattr(node, name)) for name in names}

    @property
    def direction(self) -> Float64Array:
        if not self._has_angles:
            return unit(np.array(self._node.sun_direction, np.float64))
        elevation, rotation = self._node.sun_elevation, self._node.sun_rotation
        flat = np.cos(elevation)
        return np.array([flat * np.sin(rotation), flat * np.cos(rotation), np.sin(elevation)])

    def turn(self, direction: Float64Array, keeps_level: bool) -> None:
        x, y, z = direction
        if not self._has_angles:
            height = self._values["sun_direction"][2] if keeps_level else z
            flat = np.sqrt(max(1.0 - height**2, 0.0)) / max(np.hypot(x, y), 1e-12)
            self._node.sun_direction = (x * flat, y * flat, height)
            return
        self._node.sun_rotation = float(np.arctan2(x, y))
        self._node.sun_elevation = self._values["sun_elevation"] if keeps_level else float(np.arcsin(np.clip(z, -1, 1)))

    def restore(self) -> None:
        for name, value in self._values.items():
            setattr(self._node, name, value)


class _ImageSun:
    """Of an Environment Texture behind a Mapping node."""

    def __init__(self, image: Float64Array, mapping: Any, after: Float64Array) -> None:
        """`image`: (3,) where the sun is in the image; `after`: (3, 3) what comes between the mapping and the image."""
        self._mapping = mapping
        self._rotation = find_input(mapping, "Rotation")
        self._angles = tuple(self._rotation.default_value)
        self._target = unit(np.linalg.solve(after, image))
        """(3,) where the mapping is to take the sun's direction"""
        self._start = self.direction

    def _turn(self, angles: Any) -> Float64Array:
        """(3, 3) from the world to behind the mapping."""
        turn = euler_matrix(np.array(angles, np.float64))
        return turn.T if self._mapping.vector_type == "TEXTURE" else turn

    @property
    def direction(self) -> Float64Array:
        return self._turn(self._rotation.default_value).T @ self._target

    def turn(self, direction: Float64Array, keeps_level: bool) -> None:
        start = self._start
        if keeps_level:
            start, direction = (_level(axis) for axis in (start, direction))
        # The new direction goes to where the mapping has had the old one.
        turned = self._turn(self._angles) @ upright(start) @ upright(direction).T
        matrix = turned.T if self._mapping.vector_type == "TEXTURE" else turned
        self._rotation.default_value = Matrix(matrix.tolist()).to_euler("XYZ")

    def restore(self) -> None:
        self._rotation.default_value = self._angles


def _level(axis: Float64Array) -> Float64Array:
    """(3,) the unit horizontal direction below."""
    flat = np.array([axis[0], axis[1], 0.0])
    return unit(flat) if flat.any() else np.array([0.0, 1.0, 0.0])


def _plain(value: Any) -> Any:
    return float(value) if isinstance(value, float) else tuple(value)


def _sun_of(world: bpy.types.World) -> _SkySun | _ImageSun:
    source = output_source(world.node_tree, "Surface")
    found = None if source is None else _texture_of(source, set())
    if found is None:
        raise InputError(f'World "{world.name}" has no Sky Texture or Environment Texture that could be turned.')
    node: Any = found.node
    if node.type == "TEX_SKY":
        if _mappings(found):
            raise InputError(f'The Sky Texture of world "{world.name}" is mapped: unplug its Mapping node.')
        return _SkySun(node)
    mappings = _mappings(found)
    if not mappings:
        raise InputError(
            f'World "{world.name}" has no Mapping node: plug Texture Coordinate, Generated, over one into its '
            "Environment Texture."
        )
    for mapping in mappings:
        _require_rotation(mapping, world.name)
    *others, first = mappings
    after = np.eye(3)
    for mapping in others:
        turn = euler_matrix(np.array(find_input(mapping, "Rotation").default_value, np.float64))
        after = after @ (turn.T if mapping.vector_type == "TEXTURE" else turn)
    if node.image is None:
        raise InputError(f'The Environment Texture of world "{world.name}" has no image: choose one.')
    return _ImageSun(_brightest(node), first, after)


def _texture_of(source: Source, seen: set[int]) -> Source | None:
    """The first sky or environment that a shader is made of."""
    node = source.node
    if node is None or node.as_pointer() in seen:
        return None
    seen.add(node.as_pointer())
    if node.type in ("TEX_SKY", "TEX_ENVIRONMENT"):
        return source
    return next((found for inner in source.inputs() if (found := _texture_of(inner, seen)) is not None), None)


def _background_of(world: bpy.types.World) -> Any:
    """The unlinked strength of the world's Background, or None."""
    source = output_source(world.node_tree, "Surface")
    if source is None or source.node is None or source.node.type != "BACKGROUND":
        return None
    socket = source.node.inputs["Strength"]
    return None if socket.is_linked else socket


def _mappings(texture: Source) -> list[Any]:
    """Mapping nodes on the way to a texture, the last one first."""
    found = []
    vector = texture.input("Vector")
    while vector.node is not None and vector.node.type == "MAPPING":
        found.append(vector.node)
        vector = vector.input("Vector")
    return found


def _require_rotation(mapping: Any, world: str) -> None:
    rotation, scale = find_input(mapping, "Rotation"), find_input(mapping, "Scale")
    location = find_input(mapping, "Location") if mapping.vector_type in ("POINT", "TEXTURE") else None
    linked = [socket for socket in (rotation, scale, location) if socket is not None and socket.is_linked]
    is_plain = np.allclose(scale.default_value, 1.0) and (location is None or not any(location.default_value))
    if linked or not is_plain:
        raise InputError(f'A Mapping node of world "{world}" does more than turn: clear its location and scale.')


def _brightest(node: Any) -> Float64Array:
    """(3,) direction in an Environment Texture's image, as mapped to it: of its strongest sun, else of what is
    brightest."""
    if node.projection != "EQUIRECTANGULAR":
        raise InputError("The sun of a mirror ball image is not looked for: use an equirectangular one.")
    pixels = ImageReader().read(node.image, node.image_user)[..., :3]
    suns = split_suns(WorldArrays((1.0, 1.0, 1.0), np.ascontiguousarray(pixels))).suns
    if suns:
        return np.array(max(suns, key=lambda sun: sum(sun.color)).matrix[:3, 2], np.float64)
    return _brightest_block(pixels)


def _brightest_block(pixels: Float32Array) -> Float64Array:
    light = pixels.astype(np.float64).sum(axis=-1)
    height, width = light.shape
    side = max(height // BLOCKS, 1)
    rows, columns = height // side, width // side
    blocks = light[: rows * side, : columns * side].reshape(rows, side, columns, side).mean(axis=(1, 3))
    row, column = np.unravel_index(blocks.argmax(), blocks.shape)
    return np.asarray(equirectangular_directions(columns, rows)[row, column], np.float64)
