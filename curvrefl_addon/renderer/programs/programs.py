# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of a scene's materials on the GPU: which there are, and their parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ....gpu_shaders.loader import Snippet
from ...scene.arrays import Float32Array, SceneArrays
from ...scene.programs.program import IMAGE_RECORDS, Attribute, Program, Shape
from ..device.records import record_texture
from ..device.shaders import Piece, flags
from .buffers import NONE, Buffers, buffers_for
from .image_pages import ImagePages
from .instance_table import INSTANCE_TABLE, InstanceTable

MOST_PROGRAMS = 4095
"""That a depth texture tells apart"""


class Programs:
    """Of one scene."""

    def __init__(self, scene: SceneArrays, image_memory: int) -> None:
        """`image_memory`: bytes that images may take on the GPU."""
        self._pages = ImagePages(image_memory)
        self._instances = InstanceTable()
        self._admitted: set[Shape] | None = None
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        self._programs = [item.program for item in scene.materials]
        programs = [program for program in self._programs if program is not None]
        self.shapes: list[Shape] = list(dict.fromkeys(program.shape for program in programs))[:MOST_PROGRAMS]
        """In the order of their numbers"""
        self.buffers: Buffers = NONE.union(*(buffers_for(shape.channels) for shape in self.shapes))
        """That any of them fills"""
        self._attributes = scene_attributes(scene)
        self._names = sorted({name for program in programs for name in program.instance_attributes})
        self._pages.follow(scene.images if programs else ())
        self._instances.follow(scene, self._names, any("PROGRAM_INSTANCE" in shape.needs for shape in self.shapes))
        self._texture: Any = None
        self.firsts = self._upload()
        """By material, the first of its parameters; 0 where it has no program"""

    def move(self, scene: SceneArrays) -> None:
        """Know a state that differs in its objects' places alone."""
        self._instances.move(scene)

    def number_of(self, material: int) -> int:
        """Of a material's program; -1 where there is none yet, or none at all."""
        shape = self.shape_of(material)
        return -1 if shape is None else self.shapes.index(shape)

    def shape_of(self, material: int) -> Shape | None:
        """Of a material's program; None where it is drawn by its constants."""
        program = self._programs[material] if 0 <= material < len(self._programs) else None
        if program is None or (self._admitted is not None and program.shape not in self._admitted):
            return None
        return program.shape

    def hold_back(self) -> None:
        """Draw materials by their constants until their programs are let in, one by one: `admit`."""
        if self._admitted is None:
            self._admitted = set()

    def admit(self) -> bool:
        """Let in one more program; whether there was one."""
        waiting = self.waiting
        if waiting:
            assert self._admitted is not None
            self._admitted.add(waiting[0])
        return bool(waiting)

    def admit_all(self) -> None:
        """Let in all of them."""
        self._admitted = None

    @property
    def waiting(self) -> list[Shape]:
        """Those that are held back."""
        return [] if self._admitted is None else [shape for shape in self.shapes if shape not in self._admitted]

    @property
    def pages(self) -> ImagePages:
        return self._pages

    def bind(self, shader: Any, shape: Shape) -> None:
        """Set what `program_piece` names on a bound shader."""
        shader.uniform_sampler("program_records", self._texture)
        if "PROGRAM_INSTANCE" in shape.needs:
            self._instances.bind(shader)
        if "PROGRAM_IMAGES" in shape.needs:
            self._pages.bind(shader)

    def _upload(self) -> list[int]:
        firsts = []
        blocks: list[Float32Array] = []
        size = 0
        for program in self._programs:
            if program is None:
                firsts.append(0)
                continue
            block = self._block(program)
            firsts.append(size + len(block) - len(program.records))
            blocks.append(block)
            size += len(block)
        records = np.concatenate(blocks) if blocks else np.zeros((1, 4), np.float32)
        self._texture = record_texture(records)
        return firsts

    def _block(self, program: Program) -> Float32Array:
        """A program's parameters, and before them, backwards, the numbers of its attributes and instance values."""
        numbers = [self._attributes.index(attribute) for attribute in program.attributes]
        numbers += [self._names.index(name) for name in program.instance_attributes]
        head = np.zeros((len(numbers), 4), np.float32)
        head[:, 0] = numbers[::-1]
        records = np.array(program.records, np.float32)
        for use in program.images:
            place = records[use.record : use.record + IMAGE_RECORDS]
            place[...] = self._pages.filled(use.image, place)
        return np.concatenate([head, records])


def scene_attributes(scene: SceneArrays) -> list[Attribute]:
    """All that programs of the scene read of meshes, in the order of their numbers."""
    programs = [item.program for item in scene.materials if item.program is not None]
    return sorted({attribute for program in programs for attribute in program.attributes})


def program_piece(shape: Shape, others: Sequence[Piece] = ()) -> Piece:
    """The program itself; `Programs.bind` sets what it names. Goes before what calls it."""
    includes = ("programs/shading_point.glsl", "programs/material.glsl", *shape.files)
    text = "".join(f'#include "{file}"\n' for file in includes) + shape.text
    samplers = {"program_records": "FLOAT_2D"}
    defines: dict[str, str | int | float] = {"ATTRIBUTES": shape.attributes, "PROGRAM": "", **flags(*sorted(shape.needs))}
    for piece in others:
        samplers.update(piece.samplers)
        defines.update(piece.defines)
    if "PROGRAM_INSTANCE" in shape.needs:
        samplers.update(INSTANCE_TABLE.samplers)
        defines.update(INSTANCE_TABLE.defines)
    return Piece(samplers=samplers, defines=defines, fragment=Snippet("material program", text))
