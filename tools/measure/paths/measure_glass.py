# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far off what is seen through two interfaces of glass is, as an angle, against Cycles.

    .venv/bin/python tools/measure/paths/measure_glass.py [--size 320x240]

The glass refracts and does not reflect; in Cycles all else emits its own position, so that one sample through the
pixels' centers is exact. Ours is where the second step of paths has got to. Angles are seen from where they leave it.
Pixels count whose paths end on things after two refractions; those that meet something else in one of the two, as at
edges, are told apart.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.tracing import tracer  # noqa: E402
from curvrefl.curvrefl_addon.report.metrics import direction_angle_deg  # noqa: E402
from scenes.awkward.stage import surface  # noqa: E402
from scenes.paths.judged import judged_pixels, read_open  # noqa: E402
from scenes.paths.one_sample import centers  # noqa: E402
from scenes.paths.registry import OBJECT  # noqa: E402
from scenes.paths.stage import put_ball, put_box, put_lens, room  # noqa: E402

FARTHEST = 0.05
"""Meters between what both have met, above which they have met different things"""


def _glass(ior: float = 1.45) -> Any:
    return surface("Refraction", "BsdfRefraction", Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=ior)


def _ball() -> None:
    room()
    put_ball(_glass(), segments=128)


def _lens() -> None:
    room()
    put_lens(_glass(1.5), (0.0, -1.4, 1.25), 0.75, 0.18)


def _block() -> None:
    room()
    put_box(_glass(1.5), (1.3, 0.7, 1.5), (0.0, 0.0, 0.8), turn=0.5)


def _pane() -> None:
    room()
    put_box(_glass(1.5), (2.2, 0.06, 1.8), (0.0, -0.6, 1.0), turn=0.4)


SHAPES: dict[str, Callable[[], None]] = {"ball": _ball, "lens": _lens, "block": _block, "pane": _pane}


def emit_positions() -> None:
    """All but the glass emits its position, the world nothing."""
    material: Any = bpy.data.materials.new("Position")
    material.cycles.emission_sampling = "NONE"
    tree = material.node_tree
    tree.nodes.clear()
    emission, place = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(place.outputs["Position"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    scene: Any = bpy.context.scene
    for thing in scene.objects:
        if thing.type == "MESH" and thing.name != OBJECT:
            thing.data.materials.clear()
            thing.data.materials.append(material)
        if thing.type == "LIGHT":
            thing.hide_render = True
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Strength"].default_value = 0.0


def our_places() -> tuple[np.ndarray, np.ndarray]:
    """(h, w, 4) of what the first step has met, the glass's other side, and the second; w is an object, 0 nothing."""
    original, met = tracer.follow, {}

    def follow(*arguments: Any, **named: Any) -> None:
        original(*arguments, **named)
        vertices, step = arguments[4], arguments[7]
        met[step] = read_texture(vertices.position)

    opened = read_open((OBJECT,))
    with patch.object(tracer, "follow", follow):
        _, _ = opened.picture(1)
    return met[1], met[2]


def measure(name: str, size: list[int]) -> str:
    """A row of the table."""
    with dropped(STDOUT):
        SHAPES[name]()
        scene: Any = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = size
        inside, ours = our_places()
        mask = judged_pixels((OBJECT,))
        emit_positions()
        cycles = centers()[..., :3].astype(np.float64)
    met_there = (cycles != 0.0).any(-1)
    both = mask & (ours[..., 3] > 0.5) & met_there & (inside[..., 3] > 0.5)
    apart = np.linalg.norm(ours[..., :3] - cycles, axis=-1)
    other = (mask & ((ours[..., 3] > 0.5) != met_there)) | (both & (apart > FARTHEST))
    same = both & ~other
    one = np.ones((int(same.sum()), 1))
    seen_from = inside[same][:, :3].astype(np.float64)
    angle = direction_angle_deg(
        seen_from, np.hstack([ours[same][:, :3].astype(np.float64), one]), np.hstack([cycles[same], one])
    )
    median, high, highest = np.percentile(angle, (50.0, 99.0, 100.0))
    share = 100.0 * other.sum() / mask.sum()
    return f"| {name} | {same.sum():,} | {median:.4f} | {high:.4f} | {highest:.3f} | {share:.2f} % |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="320x240")
    size = [int(side) for side in parser.parse_args().size.split("x")]
    print("| glass | pixels | median | p99 | largest, degrees | something else |")
    print("|---|---|---|---|---|---|")
    for name in SHAPES:
        print(measure(name, size), flush=True)


if __name__ == "__main__":
    main()
