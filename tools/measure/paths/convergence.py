# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast rough metal becomes clean, and whether it becomes right: ours and Cycles, judged by Mitsuba.

    .venv/bin/python tools/measure/paths/convergence.py OUT [--roughness 0.1,0.3,0.5,1.0]
        [--sub-frames 1,4,16,64] [--mitsuba PYTHON]

One smooth sphere of white metal under one sky, seen by all three. The truth is Mitsuba's analytic sphere with 1,024
samples, divided by what that leaves of a white world: microfacets that scatter once lose energy, which Cycles and we
put back in proportion. Writes convergence.json, convergence.md and convergence.png into the folder OUT: FLIP over the
inner 95 % of the sphere's outline, and the mean color's error of the most samples.

Mitsuba comes with pip into an environment of its own, build/mitsuba, unless a Python that has it is named. Needs
matplotlib.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(HERE), str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, principled  # noqa: E402
from curvrefl.curvrefl_addon.demo.shapes import Shape, cube_sphere_directions  # noqa: E402
from curvrefl.curvrefl_addon.report.metrics import flip_in_mask  # noqa: E402
from scenes.paths.judged import cycles_picture, read_open  # noqa: E402
from scenes.paths.registry import OBJECT  # noqa: E402
from scenes.paths.stage import empty  # noqa: E402
from surroundings import ANGLE, DISTANCE, SIZE, blender_map, disc  # type: ignore[import-not-found]  # noqa: E402

matplotlib.use("Agg")

TRUTH_SAMPLES = 1024
SEEDS = (7, 8)
CELLS = 96
ENGINES = {"ours": ("Curvrefl", "#0077BB"), "cycles": ("Cycles", "#777777"), "mitsuba": ("Mitsuba", "#EE7733")}
type Pictures = dict[str, dict[int, np.ndarray]]


def build(roughness: float) -> None:
    """The sphere in Blender, in place of the open file."""
    scene: Any = empty((0.0, 0.0, 0.0))
    directions, quads = cube_sphere_directions(CELLS)
    metal = principled("Metal", (1.0, 1.0, 1.0), metallic=1.0, roughness=roughness)
    add_object(OBJECT, Shape(directions, quads), metal, smooth=True, normals=directions)
    pixels = blender_map()
    image: Any = bpy.data.images.new("Sky", pixels.shape[1], pixels.shape[0], float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(np.concatenate([pixels, np.ones((*pixels.shape[:2], 1), np.float32)], -1).ravel())
    image.pack()
    tree: Any = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    camera: Any = add_camera((0.0, -DISTANCE, 0.0), (0.0, 0.0, 0.0))
    camera.data.angle = np.radians(ANGLE)
    scene.render.resolution_x = scene.render.resolution_y = SIZE


def by_mitsuba(python: Path, roughness: float, numbers: list[int]) -> tuple[dict[int, np.ndarray], np.ndarray]:
    """Pictures by the number of samples, with the energy put back, and the truth."""
    with tempfile.TemporaryDirectory() as folder:
        found = []
        for seed, counts in zip(SEEDS, (numbers, [TRUTH_SAMPLES]), strict=True):
            path = Path(folder) / f"{seed}.npz"
            said = ",".join(str(count) for count in counts)
            command = [str(python), str(HERE / "mitsuba_sphere.py"), str(path), str(roughness), said, str(seed)]
            subprocess.run(command, check=True)
            with np.load(path) as kept:
                left = np.where(disc(1.0)[..., None], np.maximum(kept["furnace"], 0.1), 1.0)
                found.append({int(key): kept[key] / left for key in kept.files if key != "furnace"})
    return found[0], found[1][TRUTH_SAMPLES]


def measure(python: Path, roughness: float, numbers: list[int]) -> dict[str, Any]:
    """FLIP by engine and number of samples, and the mean color's largest relative error at the most."""
    pictures: Pictures = {}
    pictures["mitsuba"], truth = by_mitsuba(python, roughness, numbers)
    with dropped(STDOUT):
        build(roughness)
        opened = read_open((OBJECT,))
        pictures["ours"] = {number: opened.picture(number)[0][..., :3] for number in numbers}
        pictures["cycles"] = {number: cycles_picture(number, SEEDS[0])[..., :3] for number in numbers}
    mask = disc()
    right = truth[mask].mean(0)
    flips = {
        engine: {number: flip_in_mask(picture, truth, mask) for number, picture in found.items()}
        for engine, found in pictures.items()
    }
    means = {
        engine: float(np.abs(found[max(numbers)][mask].mean(0) / right - 1.0).max())
        for engine, found in pictures.items()
    }
    return {"roughness": roughness, "flip": flips, "mean": means}


def table(rows: list[dict[str, Any]], numbers: list[int]) -> str:
    """Markdown."""
    head = " | ".join(str(number) for number in numbers)
    lines = [f"| roughness | | {head} | mean color at {max(numbers)} |", "|---|---|" + "---|" * (len(numbers) + 1)]
    for row in rows:
        for engine, (label, _) in ENGINES.items():
            shown = " | ".join(f"{row['flip'][engine][number]:.4f}" for number in numbers)
            first = f"{row['roughness']:g}" if engine == "ours" else ""
            lines.append(f"| {first} | {label} | {shown} | {100.0 * row['mean'][engine]:.2f} % |")
    return "\n".join(lines) + "\n"


def draw(rows: list[dict[str, Any]], numbers: list[int], path: Path) -> None:
    """A panel for each roughness."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(rows), figsize=(2.3 * len(rows), 2.6), sharey=True, squeeze=False)
    for axis, row in zip(axes[0], rows, strict=True):
        for engine, (label, color) in ENGINES.items():
            axis.loglog(numbers, list(row["flip"][engine].values()), "o-", color=color, label=label, markersize=3)
        axis.set_title(f"roughness {row['roughness']:g}", fontsize=9)
        axis.set_xlabel("samples a pixel", fontsize=8)
        axis.set_xticks(numbers, [str(number) for number in numbers], fontsize=7)
        axis.minorticks_off()
        axis.grid(alpha=0.3)
    axes[0, 0].set_ylabel("FLIP against Mitsuba, 1,024 samples", fontsize=8)
    axes[0, 0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def mitsuba_python() -> Path:
    """An environment in build/ that has Mitsuba; made where there is none."""
    folder = ROOT / "build" / "mitsuba"
    python = folder / "bin" / "python"
    if not python.is_file():
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    if subprocess.run([str(python), "-c", "import mitsuba"], check=False, stderr=subprocess.DEVNULL).returncode:
        subprocess.run([str(python), "-m", "pip", "install", "--quiet", "mitsuba", "numpy"], check=True)
    return python


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=Path)
    parser.add_argument("--roughness", default="0.1,0.3,0.5,1.0")
    parser.add_argument("--sub-frames", default="1,4,16,64")
    parser.add_argument("--mitsuba", type=Path, help="a Python that has mitsuba")
    arguments = parser.parse_args()
    numbers = [int(number) for number in arguments.sub_frames.split(",")]
    python = arguments.mitsuba or mitsuba_python()
    arguments.output.mkdir(parents=True, exist_ok=True)
    rows = [measure(python, float(value), numbers) for value in arguments.roughness.split(",")]
    (arguments.output / "convergence.json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    (arguments.output / "convergence.md").write_text(table(rows, numbers), encoding="utf-8")
    print(table(rows, numbers), end="")
    draw(rows, numbers, arguments.output / "convergence.png")


if __name__ == "__main__":
    main()
