# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of a scene's materials on the GPU: which there are, and their parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....gpu_shaders.loader import Snippet
from ...scene.arrays import Float32Array, SceneArrays
from ...scene.programs.program import IMAGE_RECORDS, Program, Shape
from ..device.records import record_texture
from ..device.shaders import Piece, flags, named
from ..geometry.chunk_attributes import attributes_of
from .buffers import NONE, Buffers, buffers_for
from .image_pages import ImagePages
from .instance_table import NEED as INSTANCE
from .instance_table import InstanceTable, instance_piece, is_needed

MOST_PROGRAMS = 4095
"""That a depth texture tells apart"""
IMAGES = "PROGRAM_IMAGES"
"""Of a shape's needs"""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What of a scene a program is compiled for, beside its shape."""

    images: tuple[tuple[str, int], ...]
    """Defines of the array textures that hold images"""
    image_samplers: tuple[str, ...]
    names: tuple[str, ...]
    """Of values of instances"""
    buffers: Buffers
    """That any program of the scene fills"""


class Programs:
    """Of one scene."""

    def __init__(self, scene: SceneArrays, image_memory: int, is_gradual: bool = False) -> None:
        """`image_memory`: bytes that images may take on the GPU. With `is_gradual` materials are drawn by their
        constants until their programs are let in, and images get there, step by step: `load_some`."""
        self._pages = ImagePages(image_memory)
        self._instances: InstanceTable | None = None
        self._is_gradual = is_gradual
        self._admitted: set[Shape] = set()
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        self._scene = scene
        self._programs = [item.program for item in scene.materials]
        programs = [program for program in self._programs if program is not None]
        self.shapes: list[Shape] = list(dict.fromkeys(program.shape for program in programs))[:MOST_PROGRAMS]
        """In the order of their numbers"""
        numbers = {shape: number for number, shape in enumerate(self.shapes)}
        self._numbers = [-1 if item is None else numbers.get(item.shape, -1) for item in self._programs]
        """By material, into `shapes`"""
        self.attributes = attributes_of(scene)
        """All that they read of meshes, in the order of their numbers"""
        # (Others are the world's and lamps'.)
        self._pages.follow(scene.images, {use.image for program in programs for use in program.images})
        if is_needed(scene):
            self._instances = self._instances or InstanceTable()
            self._instances.follow(scene)
        if self._is_gradual:
            self._admitted &= set(self.shapes)
        else:
            self._admitted = set(self.shapes)
            self._pages.fill()
        names = () if self._instances is None else self._instances.names
        buffers = NONE.union(*(buffers_for(shape.channels) for shape in self.shapes))
        self.around = surroundings_of(self._pages, names, buffers)
        self.firsts = self._upload()
        """By material, the first of its parameters; 0 where it has no program"""

    def move(self, scene: SceneArrays) -> None:
        """Know a state that differs in its objects' places alone, and maybe in its origin."""
        is_elsewhere, self._scene = scene.origin != self._scene.origin, scene
        if is_elsewhere:
            self.firsts = self._upload()
        if self._instances is not None:
            self._instances.follow(scene)

    @property
    def buffers(self) -> Buffers:
        """That any of the programs fills."""
        return self.around.buffers

    def number_of(self, material: int) -> int:
        """Of a material's program; -1 where there is none yet, or none at all."""
        return -1 if self.shape_of(material) is None else self._numbers[material]

    def shape_of(self, material: int) -> Shape | None:
        """Of a material's program; None where it is drawn by its constants."""
        number = self._numbers[material] if 0 <= material < len(self._numbers) else -1
        return self.shapes[number] if number >= 0 and self.shapes[number] in self._admitted else None

    def is_whole(self, material: int) -> bool:
        """Whether a material is drawn as it is."""
        program = self._programs[material]
        return program is None or (
            program.shape in self._admitted and all(self._pages.is_there(use.image) for use in program.images)
        )

    @property
    def is_loading(self) -> bool:
        """Programs are to be let in, or images to get there."""
        return len(self._admitted) < len(self.shapes) or not self._pages.is_complete

    def load_some(self, seconds: float) -> bool:
        """Let in a program, or read and copy images for about so long; whether anything is drawn otherwise now."""
        for shape in self.shapes:
            if shape not in self._admitted:
                self._admitted.add(shape)
                return True
        if self._pages.is_complete:
            return False
        self._pages.fill(seconds)
        self.firsts = self._upload()
        return True

    @property
    def admitted(self) -> list[tuple[int, Shape]]:
        """Programs that are drawn, with their numbers."""
        return [(number, shape) for number, shape in enumerate(self.shapes) if shape in self._admitted]

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return self._pages.warnings

    def bind(self, shader: Any, shape: Shape) -> None:
        """Set what `program_piece` names on a bound shader."""
        shader.uniform_sampler("program_records", self._texture)
        if INSTANCE in shape.needs:
            assert self._instances is not None
            self._instances.bind(shader)
        if IMAGES in shape.needs:
            self._pages.bind(shader)

    def _upload(self) -> list[int]:
        firsts = []
        # (The first record is where the origin is.)
        blocks: list[Float32Array] = [np.array([[*self._scene.origin, 0.0]], np.float32)]
        size = 1
        for program in self._programs:
            if program is None:
                firsts.append(0)
                continue
            numbers = [self.attributes.index(attribute) for attribute in program.attributes]
            numbers += [self.around.names.index(name) for name in program.instance_attributes]
            block = parameters_of(program, numbers, self._pages)
            firsts.append(size + len(block) - len(program.records))
            blocks.append(block)
            size += len(block)
        self._texture: Any = record_texture(np.concatenate(blocks))
        return firsts


def surroundings_of(pages: ImagePages, names: tuple[str, ...] = (), buffers: Buffers = NONE) -> Surroundings:
    """For programs whose images are on these pages."""
    piece = pages.piece
    images = tuple((name, int(value)) for name, value in piece.defines.items())
    return Surroundings(images, tuple(piece.samplers), names, buffers)


def parameters_of(program: Program, numbers: Sequence[int], pages: ImagePages) -> Float32Array:
    """(n, 4) a program's parameters with the places of its images, and before them, backwards, the `numbers` of its
    attributes and of its values of instances."""
    head = np.zeros((len(numbers), 4), np.float32)
    head[:, 0] = numbers[::-1]
    records = np.array(program.records, np.float32)
    for use in program.images:
        records[use.record : use.record + IMAGE_RECORDS] = pages.records(use.image)
    return np.concatenate([head, records])


def program_piece(shape: Shape, around: Surroundings) -> Piece:
    """The program itself; `Programs.bind` sets what it names. Goes before what calls it."""
    includes = ("programs/shading_point.glsl", "programs/material.glsl", *shape.files)
    text = "".join(f'#include "{file}"\n' for file in includes) + shape.text
    samplers = {"program_records": "FLOAT_2D"}
    defines: dict[str, str | int | float] = {
        "ATTRIBUTES": shape.attributes,
        "PROGRAM": "",
        **flags(*sorted(shape.needs)),
        **dict(around.images),
    }
    if INSTANCE in shape.needs:
        instances = instance_piece(around.names)
        samplers.update(instances.samplers)
        defines.update(instances.defines)
    if IMAGES in shape.needs:
        samplers.update(named("FLOAT_2D_ARRAY", *around.image_samplers))
    else:
        defines.update(IMAGE_BYTES=0, IMAGE_HALVES=0)
    return Piece(samplers=samplers, defines=defines, fragment=Snippet("material program", text))
