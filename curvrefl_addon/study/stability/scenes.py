# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes, made of arrays, where methods are known to fail: pictures say what each does there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...scene.arrays import InstanceArrays, LightArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from ...scene.camera.view import View
from ...scene.programs.program import GEOMETRY, Attribute, Program, Shape
from ..solvers.solver_table import study_view
from ..solvers.study_reflector import study_mesh
from ..solvers.study_surfaces import STUDIES

FACES = ((0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1))
PAINTS = ((0.75, 0.12, 0.08), (0.08, 0.3, 0.75), (0.1, 0.5, 0.15), (0.85, 0.6, 0.1), (0.6, 0.15, 0.6))
COLORS = Attribute(GEOMETRY, "")
_OF_COLORS = Program(
    Shape(
        "void material_program(ShadingPoint s, inout Material m)\n{\n  m.base_color = s.attributes[0].rgb;\n}\n",
        attributes=1,
        channels=("base_color",),
    ),
    np.zeros((0, 4), np.float32),
    (COLORS,),
)
"""The base color is that of the corners"""


@dataclass(frozen=True, slots=True)
class Trial:
    """A scene and what it is there for."""

    name: str
    sentence: str
    scene: SceneArrays
    view: View


def trials() -> list[Trial]:
    """All of them."""
    return [
        _trial(
            "contact",
            "Environment maps show what touches the mirror as if it were far away, Secant Search in UV and Bisector "
            "Field on Grids lose vertices next to it; use Automatic, Exact, Newton or Secant Search.",
            "sphere",
            (2.6, -3.2, 1.6),
            [
                _floor(-1.0),
                _box((0.75, -0.95, -0.7), 0.3),
                _box((-0.6, -1.05, -0.75), 0.25),
                _box((1.35, 0.3, -0.7), 0.3),
            ],
        ),
        _trial(
            "long triangles",
            "A floor of two triangles and bars of twelve (Roger & Holzschuch 2006, figure 12): edges between vertices "
            "are drawn straight, so all methods that solve vertices split them first, and Bisector Field on Grids, "
            "which solves few of the new ones, still loses the floor; use Automatic or Exact, or a finer Pixel "
            "Tolerance.",
            "sphere",
            (2.6, -3.2, 1.6),
            [_plain_floor(-1.0), _box((0.0, -1.9, -0.5), (2.5, 0.06, 0.06)), _box((-1.9, 0.2, 0.2), (0.06, 0.06, 1.2))],
        ),
        _trial(
            "thin layers",
            "Six plates a hundredth apart, each smaller than the one below (Roger & Holzschuch 2006, figure 13): "
            "distances interpolated between vertices would let lower ones show through, so distance is measured again "
            "at every pixel; only Secant Search in UV and Bisector Field on Grids still tear them; use Automatic or "
            "Exact.",
            "sphere",
            (2.6, -3.2, 1.6),
            [
                _floor(-1.0),
                *(_box((0.85, -1.35, -0.6 + 0.016 * k), (0.5 - 0.07 * k, 0.5 - 0.07 * k, 0.003)) for k in range(6)),
            ],
        ),
        _trial(
            "hollow mirror",
            "Things before and past the focus of a bowl: past it images stand on their heads, a point has up to three, "
            "and the bowl is seen in itself; methods that solve vertices find one image of each and tear where "
            "neighbors found different ones, Secant Search and Newton refuse open mirrors, and environment maps see "
            "no focus at all; use Automatic or Exact.",
            "bowl",
            (0.4, -0.9, 3.4),
            [_box((-0.25, 0.1, -0.45), 0.12), _box((0.75, 0.55, 0.9), 0.16), _box((-1.0, -0.3, 1.1), 0.2)],
        ),
        _trial(
            "several images",
            "A mirror that bends both ways shows the box and the post beside it two or three times: methods that solve "
            "vertices find one image of each, Newton one more in each region of the mirror, and triangles between "
            "different images are left out; use Automatic or Exact.",
            "strongly bumpy",
            (2.6, -3.2, 1.6),
            [
                _floor(-1.3),
                _box((-2.0, -2.0, 1.4), 0.4),
                _box((-1.7, -1.2, 0.4), (0.12, 0.12, 1.7)),
                _box((0.8, -2.4, -0.8), 0.3),
            ],
        ),
        _trial(
            "pole of a UV map",
            "The mirror's pole looks at the eye: parameters crowd there, and Secant Search in UV tears what it shows; "
            "use Automatic, Exact, or another search, none of which needs a UV map.",
            "sphere",
            (0.4, -0.6, 4.0),
            [
                _floor(-1.0),
                _box((0.9, 0.9, 0.9), 0.3),
                _box((-1.2, 0.2, 0.8), 0.3),
                _box((0.2, -1.5, 0.6), 0.3),
            ],
        ),
    ]


def _trial(
    name: str, sentence: str, reflector: str, eye: tuple[float, float, float], things: Sequence[MeshArrays]
) -> Trial:
    mirror = replace(study_mesh(STUDIES[reflector], 256, 128), name="mirror")
    meshes = [mirror, *things]
    materials = [
        MaterialArrays("mirror", (0.95, 0.95, 0.95), metallic=1.0, roughness=0.0),
        *(
            MaterialArrays(
                mesh.name, PAINTS[index % len(PAINTS)], program=_OF_COLORS if COLORS in mesh.attributes else None
            )
            for index, mesh in enumerate(things)
        ),
    ]
    sun = np.eye(4)
    away = np.array([0.4, -0.5, 0.77])
    sun[:3, 2] = away / np.linalg.norm(away)
    sun[:3, 0] = np.cross([0.0, 1.0, 0.0], sun[:3, 2])
    sun[:3, 0] /= np.linalg.norm(sun[:3, 0])
    sun[:3, 1] = np.cross(sun[:3, 2], sun[:3, 0])
    scene = SceneArrays(
        meshes=tuple(meshes),
        instances=tuple(
            InstanceArrays(mesh.name, index + 1, index, np.eye(4), (index,)) for index, mesh in enumerate(meshes)
        ),
        materials=tuple(materials),
        images=(),
        lights=(LightArrays("sun", "SUN", (2.0, 2.0, 2.0), sun),),
        world=WorldArrays((0.35, 0.45, 0.6)),
        reflectors=(1,),
    )
    return Trial(name, sentence, scene, study_view(np.array([*eye, 1.0])))


def _box(center: tuple[float, float, float], half: float | tuple[float, float, float]) -> MeshArrays:
    halves = np.broadcast_to(np.asarray(half, np.float64), 3)
    positions: list[np.ndarray] = []
    normals: list[np.ndarray] = []
    triangles: list[list[int]] = []
    for axis, end in FACES:
        sign = 2.0 * end - 1.0
        first, second = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
        normal = sign * np.eye(3)[axis]
        corners = [normal + x * first + sign * y * second for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        start = len(positions)
        positions += [np.asarray(center) + halves * corner for corner in corners]
        normals += [normal] * 4
        triangles += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
    return _mesh("box", np.array(positions), np.array(normals), np.array(triangles))


def _plain_floor(height: float, size: float = 6.0) -> MeshArrays:
    positions = np.array([[x * size, y * size, height] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    return _mesh("floor", positions, np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def _floor(height: float, tiles: int = 16, size: float = 6.0) -> MeshArrays:
    """A checkerboard."""
    edge = 2.0 * size / tiles
    positions: list[list[float]] = []
    colors: list[list[float]] = []
    triangles: list[list[int]] = []
    for row in range(tiles):
        for column in range(tiles):
            start = len(positions)
            x, y = -size + column * edge, -size + row * edge
            positions += [[x, y, height], [x + edge, y, height], [x + edge, y + edge, height], [x, y + edge, height]]
            shade = 0.75 if (row + column) % 2 else 0.12
            colors += [[shade, shade, shade, 1.0]] * 4
            triangles += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
    normals = np.tile([0.0, 0.0, 1.0], (len(positions), 1))
    return _mesh("floor", np.array(positions), normals, np.array(triangles), np.array(colors))


def _mesh(
    name: str, positions: np.ndarray, normals: np.ndarray, triangles: np.ndarray, colors: np.ndarray | None = None
) -> MeshArrays:
    return MeshArrays(
        name=name,
        positions=positions.astype(np.float32),
        corner_vertex=np.arange(len(positions), dtype=np.int32),
        corner_normals=normals.astype(np.float32),
        corner_uv=None,
        triangles=triangles.astype(np.int32),
        triangle_slot=np.zeros(len(triangles), np.int32),
        attributes=() if colors is None else (COLORS,),
        corner_attributes=None if colors is None else colors.astype(np.float32)[:, None],
    )
