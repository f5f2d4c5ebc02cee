# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials on the GPU: their constants as a record texture, and their programs."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import Glass, MaterialArrays, SceneArrays
from ...scene.programs.bits import KIND_GLASS, KIND_GLOSSY_ONLY, KIND_REFRACTION, KIND_THIN_WALL
from ...scene.programs.program import Shape
from ..device.records import record_texture
from ..device.shaders import Piece, knows, named
from ..geometry.chunk import HOLDOUT, Batches, Triangles
from ..geometry.chunk_attributes import CORNER_ATTRIBUTES, CORNER_INSTANCES
from ..geometry.scene_geometry import SceneGeometry
from ..programs.buffers import Buffers, buffers_for, varies_bits
from ..programs.image_pages import DEFAULT_CAP
from ..programs.programs import Programs, Surroundings, program_piece
from .light_sets import links_of, set_of_kind, sets_of_varies
from .surface_buffer import SEEN_THROUGH

RECORDS = 11
"""Per material"""
TABLE = Piece(
    samplers={"materials": "FLOAT_2D"},
    defines={"MATERIAL_RECORDS": RECORDS, **{f"GLASS_{kind.name}": int(kind) for kind in Glass}},
)
"""What `material_records.glsl` needs: `Materials.table`"""
DRAWN = Piece(constants={"material": "FLOAT"})
PLAIN = Piece(constants={"base_color": "VEC3", **DRAWN.constants})
"""What passes over triangles need of each material, of one without a program: `Materials.bind`"""
OF_PATHS = Piece(constants={"seen_through": "FLOAT"}, defines={"PATHS": "", "SEEN_THROUGH": SEEN_THROUGH})
"""What the primary pass needs in scenes with paths"""
_HOLDOUT = MaterialArrays("holdout", base_color=(0.0, 0.0, 0.0))


class Materials:
    """GPU side of `SceneArrays.materials` and `.images`."""

    def __init__(
        self,
        scene: SceneArrays,
        image_memory: int = DEFAULT_CAP,
        is_gradual: bool = False,
        geometry: SceneGeometry | None = None,
    ) -> None:
        """`image_memory`: bytes that images may take; `is_gradual`: see `Programs`. `geometry`: what is drawn."""
        self._image_memory, self._is_gradual, self._geometry = image_memory, is_gradual, geometry
        self._programs: Programs | None = None
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Take over the materials of another state of the scene; images that were there are not uploaded again."""
        self._materials = scene.materials
        self.links = links_of(scene)
        """Defines of shaders in which rays find what shines, or shadows of that"""
        if self._programs is not None:
            self._programs.follow(scene)
        elif any(item.program is not None for item in scene.materials):
            self._programs = Programs(scene, self._image_memory, self._is_gradual)
        self._fill_table()

    def move(self, scene: SceneArrays) -> None:
        """Know a state that differs in its objects' places alone."""
        if self._programs is not None:
            self._programs.move(scene)

    def _fill_table(self) -> None:
        records = np.zeros((len(self._materials), RECORDS, 4), np.float32)
        for index, (record, material) in enumerate(zip(records, self._materials, strict=True)):
            shape = self.shape_of(index)
            first = 0 if self._programs is None else self._programs.firsts[index]
            number = -1 if self._programs is None else self._programs.number_of(index)
            varies = 0 if shape is None else varies_bits(buffers_for(shape.channels))
            varies |= sets_of_varies(material, self.links)
            record[0] = (material.metallic, material.roughness, material.ior, material.specular_level)
            record[1] = (*material.emission, float(kind_of(material) | set_of_kind(material)))
            record[2] = (*material.base_color, float(number))
            record[3] = (material.coat_weight, material.coat_roughness, material.coat_ior, material.transmission)
            record[4] = (*material.coat_tint, material.film_thickness)
            record[5] = (*material.specular_tint, material.film_ior)
            record[6] = (*material.absorption, float(material.is_seen_through))
            record[7] = (*material.transparent_tint, material.alpha)
            record[8, :2] = (material.anisotropy, material.anisotropic_rotation)
            record[8, 2:] = (material.diffuse_roughness, material.translucency)
            record[9] = (*material.sheen_tint, material.sheen_weight)
            record[10] = (material.sheen_roughness, material.subsurface, float(first), float(varies))
        self.table = record_texture(records.reshape(-1, 4))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is not drawn as it is, one sentence each."""
        return () if self._programs is None else self._programs.warnings

    @property
    def programs(self) -> Programs:
        """Of a scene that `has_programs`."""
        assert self._programs is not None
        return self._programs

    @property
    def around(self) -> Surroundings | None:
        """What programs are compiled for; None where there are none."""
        return None if self._programs is None else self._programs.around

    @property
    def buffers(self) -> Buffers:
        """That the scene's programs fill."""
        return frozenset() if self._programs is None else self._programs.buffers

    @property
    def has_programs(self) -> bool:
        return self._programs is not None and bool(self._programs.shapes)

    def shape_of(self, index: int) -> Shape | None:
        """Of a material's program; None where it is the same everywhere."""
        return None if self._programs is None else self._programs.shape_of(index)

    def by_shape(self, batches: Batches) -> dict[Shape | None, Batches]:
        """Batches of materials that one shader draws together."""
        groups: dict[Shape | None, Batches] = {}
        for item in batches:
            shape = self.shape_of(item[0])
            groups[shape] = (*groups.get(shape, ()), item)
        return groups

    @property
    def is_loading(self) -> bool:
        """Some materials are still drawn by their constants, or without their images."""
        return self._programs is not None and self._programs.is_loading

    def load_some(self, seconds: float) -> bool:
        """See `Programs.load_some`."""
        is_changed = self._programs is not None and self._programs.load_some(seconds)
        if is_changed:
            self._fill_table()
        return is_changed

    def bind_for_paths(self, shader: Any, index: int) -> None:
        """Set what `OF_PATHS` names."""
        shader.uniform_float("seen_through", float(self._of(index).is_seen_through))

    def bind(self, shader: Any, index: int) -> None:
        """Set a bound shader with `DRAWN` to a material, and one with `forward_pieces` to its program's parameters."""
        if self.shape_of(index) is None:
            shader.uniform_float("material", float(index))
            shader.uniform_float("base_color", self._of(index).base_color)
            return
        if knows(shader, "material"):
            shader.uniform_float("material", float(index))
        if knows(shader, "program_first"):
            shader.uniform_int("program_first", self.programs.firsts[index])

    def bind_program(self, shader: Any, shape: Shape, turn: tuple[int, int]) -> None:
        """Set what `forward_pieces` name on a bound shader, but for its material and its chunk."""
        assert self._programs is not None
        self._programs.bind(shader, shape)
        shader.uniform_sampler("materials", self.table)
        if knows(shader, "turn"):
            shader.uniform_int("turn", turn)

    def bind_triangles(self, shader: Any, triangles: Triangles, shape: Shape | None) -> None:
        """The triangles of a pass over them, and what a program reads of them."""
        shader.uniform_sampler("positions", triangles.positions)
        shader.uniform_sampler("corners", triangles.corners)
        if shape is not None:
            assert self._geometry is not None
            attributes = triangles.attributes
            shader.uniform_sampler("corner_attribute_records", attributes.texture(self.programs.attributes))
            rows = self._geometry.rows_of(triangles.placed_chunk)
            shader.uniform_sampler("corner_instance_records", attributes.instance_texture(rows))

    def _of(self, index: int) -> MaterialArrays:
        return _HOLDOUT if index == HOLDOUT else self._materials[index]


def kind_of(material: MaterialArrays) -> int:
    """KIND_ bits."""
    return (
        KIND_GLOSSY_ONLY * material.glossy_only
        | KIND_THIN_WALL * material.thin_wall
        | KIND_GLASS * (material.glass is Glass.GLASS)
        | KIND_REFRACTION * (material.glass is Glass.REFRACTION)
    )


def forward_pieces(shape: Shape, around: Surroundings) -> tuple[Piece, ...]:
    """For passes over triangles that make the surface of each fragment by a program: they go before the pass's own."""
    names = [f"attribute_{number}" for number in range(shape.attributes)]
    cases = " ".join(f"s.attributes[{k}] = {name};" for k, name in enumerate(names))
    across = " ".join(
        f"s.attributes_across[{k}] = dFdx({name}); s.attributes_up[{k}] = dFdy({name});" for k, name in enumerate(names)
    )
    first = "int(fetch_record(program_records, program_first - 1 - {}).x + 0.5)"
    vertex = " ".join(f"{name} = corner_attribute(index, {first.format(number)});" for number, name in enumerate(names))
    return (
        program_piece(shape, around),
        TABLE,
        CORNER_ATTRIBUTES,
        CORNER_INSTANCES,
        Piece(
            constants={"program_first": "INT", "turn": "IVEC2"},
            smooth=named("VEC4", *names),
            flat={"instance_number": "INT"},
            defines={"ATTRIBUTE_CASES": cases, "NEIGHBOR_CASES": across, "VERTEX_CASES": vertex},
        ),
    )
