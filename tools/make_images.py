# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pictures of the documents, docs/images: all of them, or those named.

    ./curvrefl images [NAME ..]

Pictures of the window are taken in the session that tests/gui/test_interface.py plays, so they need what the tests of
layer gui need, and ImageMagick there. All of them together take about two hours on two cores without a GPU.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parent.parent
IMAGES_FOLDER = ROOT / "docs" / "images"
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "gui"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.errors import InputError  # noqa: E402
from curvrefl.curvrefl_addon.output import folder_to_publish  # noqa: E402

QUALITY = 88
VIEW = (0, 28, 1050, 720)
"""The 3D view in the session's window of 1280 x 800: left, top, right, bottom in pixels"""
POPUP = (80, 160, 440, 480)
"""Where the session opens panels in it"""
DEMO_SIZE = (560, 420)
"""Of each of the three pictures of the demo"""
VIEWS = ("iterations", "status", "angle_error", "method", "zebra", "lines")
STEP_SIZE = (378, 250)
"""Of each picture of the quick start"""
STEPS = {
    "install": "Install the zip",
    "mark": "Tick: is a Mirror",
    "on": "Tick the panel's header",
    "view": "Look around: it follows",
    "inspect": "Inspect: zebra stripes",
    "compare": "Compare: Curvrefl | Cycles",
}
CHARTED = ("sphere", "ellipsoid", "bumpy")
type Maker = Callable[[Path, Path], None]
"""Writes a picture out of a folder of results: (results, picture)"""


class Picture(NamedTuple):
    """How a picture of the documents comes about."""

    results: str
    """The key in RESULTS of what it is made from"""
    make: Maker


def _strip(results: Path, picture: Path) -> None:
    """Curvrefl, Cycles and EEVEE side by side."""
    _save_grid([results / f"{name}.png" for name in ("auto", "reference", "eevee")], 3, None, DEMO_SIZE, picture)


def _views(results: Path, picture: Path) -> None:
    """All diagnostic views, at half their size."""
    size = ((VIEW[2] - VIEW[0]) // 2, (VIEW[3] - VIEW[1]) // 2)
    _save_grid([results / f"show_{name}.png" for name in VIEWS], 2, VIEW, size, picture)


def _placed_lights(results: Path, picture: Path) -> None:
    """A lamp placed in three ways, side by side."""
    _save_grid(
        [results / f"{name}.png" for name in ("reflection", "illumination", "rim")], 3, None, (420, 315), picture
    )


def _caustics(results: Path, picture: Path) -> None:
    """Scenes side by side, below them the same by Cycles."""
    names = ("ring", "bowl", "disco", "glass", "facade")
    pictures = [results / f"{name}{by}.png" for by in ("", "_cycles") for name in names]
    _save_grid(pictures, 5, None, (256, 192), picture)


def _cut(name: str, box: tuple[int, int, int, int]) -> Maker:
    """A part of one picture of the window."""
    size = (box[2] - box[0], box[3] - box[1])
    return lambda results, picture: _save_grid([results / f"{name}.png"], 1, box, size, picture)


def _copied(results: Path, picture: Path) -> None:
    picture.write_bytes((results / picture.name).read_bytes())


def _drawn_stability(results: Path, picture: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "draw_stability.py"), str(results), str(picture))


def _save_grid(
    paths: Sequence[Path], columns: int, box: tuple[int, int, int, int] | None, size: tuple[int, int], picture: Path
) -> None:
    """Pictures of one `size` in pixels, cut to `box` first, in rows of `columns`."""
    from PIL import Image

    rows = -(-len(paths) // columns)
    grid = Image.new("RGB", (columns * size[0], rows * size[1]))
    for number, path in enumerate(paths):
        if not path.is_file():
            raise InputError(f"There is no {path.name}: taking pictures of the window needs ImageMagick.")
        with Image.open(path) as opened:
            part = opened.convert("RGB").crop(box) if box else opened.convert("RGB")
        row, column = divmod(number, columns)
        grid.paste(part.resize(size, Image.Resampling.LANCZOS), (column * size[0], row * size[1]))
    grid.save(picture, quality=QUALITY)


def _demo(folder: Path) -> None:
    _verb("demo", "--output", str(folder))
    mirrors = "Kettle,Lacquer jar"
    given = ("--reflector", mirrors, "--samples", "64", "--output", str(folder / "auto.png"))
    _verb("render", str(folder / "demo.blend"), *given)


def _window(folder: Path) -> None:
    """Pictures of the window, by the session of the tests."""
    import build_extension
    from window import run_interface_session

    (folder / "zip").mkdir()
    found = run_interface_session(_window_blender(), folder, build_extension.build(folder / "zip"))
    if found.seen["error"]:
        raise RuntimeError(found.seen["error"])


def _window_blender() -> Any:
    from window_blender import NoWindowBlenderError, find_or_make

    try:
        return find_or_make()
    except NoWindowBlenderError as error:
        raise InputError(f"There is no Blender that opens a window: {str(error).rstrip('.')}.") from error


def _chart(folder: Path) -> None:
    _run(str(ROOT / "tools" / "make_scenes.py"), str(folder), *CHARTED)
    files = [str(folder / f"{name}.blend") for name in CHARTED]
    _verb("chart", *files, "--reflector", "Mirror", "--resolution", "640x480", "--output", str(folder))


def _costs(folder: Path) -> None:
    _verb("chart", "--against", "all", "--output", str(folder))


def _stability(folder: Path) -> None:
    _verb("stability", "--output", str(folder))


def _methods(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "measure_methods.py"), "--output", str(folder))


def _materials(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "paths" / "draw_materials.py"), str(folder / "materials.jpg"))


def _lights(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "light" / "draw_lights.py"), str(folder))


def _anamorphosis(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "design" / "draw_anamorphosis.py"), str(folder / "anamorphosis.jpg"))


def _thrown(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "caustics" / "draw_caustics.py"), str(folder))


def _convergence(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "paths" / "convergence.py"), str(folder))


def _passes(folder: Path) -> None:
    scene, file = str(folder / "moving.blend"), str(folder / "passes.exr")
    _run(str(ROOT / "tools" / "measure" / "truth" / "moving_demo.py"), scene)
    asked = "object,normal,albedo,uv,depth,incidence,vector,mirror_id"
    given = ("--reflector", "Kettle,Lacquer jar", "--frame", "1", "--resolution", "640x480", "--samples", "32")
    _verb("render", scene, *given, "--passes", asked, "--multilayer", "--output", file)
    _run(str(ROOT / "tools" / "measure" / "truth" / "draw_passes.py"), file, str(folder / "passes.jpg"))


def _inspection(folder: Path) -> None:
    _run(
        str(ROOT / "tools" / "measure" / "inspection" / "draw_inspection.py"),
        str(folder),
        str(folder / "inspection.jpg"),
    )


def _film(folder: Path) -> None:
    _run(str(ROOT / "tools" / "make_scenes.py"), str(folder), "demo")
    given = (str(folder / "demo.blend"), "Kettle,Lacquer jar", str(folder / "film.jpg"), "--focus", "Kettle")
    _run(str(ROOT / "tools" / "measure" / "film" / "draw_film.py"), *given)


def _calm(folder: Path) -> None:
    _run(str(ROOT / "tools" / "make_scenes.py"), str(folder), "bumpy")
    tool = str(ROOT / "tools" / "measure" / "reuse" / "measure_reuse.py")
    given = ("--reflector", "Mirror", "--roughness", "0.3", "--frames", "1", "--picture", str(folder / "calm.jpg"))
    _run(tool, str(folder / "bumpy.blend"), *given)


def _animations(folder: Path) -> None:
    _run(str(ROOT / "tools" / "measure" / "motion" / "draw_films.py"), str(folder / "animations.jpg"))


def _dataset(folder: Path) -> None:
    _verb("dataset", "--output", str(folder / "dataset"), "--resolution", "320x240", "--samples", "64")
    tool = str(ROOT / "tools" / "measure" / "truth" / "draw_dataset.py")
    _run(tool, str(folder / "dataset"), str(folder / "dataset.jpg"))


def _sequence(folder: Path) -> None:
    tool = str(ROOT / "tools" / "measure" / "sequence" / "draw_sequence.py")
    _run(tool, str(folder), str(folder / "sequence.jpg"))


def _quick_start(folder: Path) -> None:
    """The steps in a window, and the demo by us and by Cycles."""
    import build_extension
    from window import run_session

    _run(str(ROOT / "tools" / "make_scenes.py"), str(folder), "demo")
    (folder / "zip").mkdir()
    archive, demo = build_extension.build(folder / "zip"), folder / "demo.blend"
    session = ROOT / "tests" / "gui" / "strip" / "strip_session.py"
    found = run_session(_window_blender(), session, folder, archive, demo, folder)
    if found.seen["error"]:
        raise RuntimeError(found.seen["error"])
    given = ("--reflector", "Kettle,Lacquer jar", "--method", "exact", "--peers", "none", "--samples", "64")
    size = ("--resolution", f"{STEP_SIZE[0]}x{STEP_SIZE[1]}")
    _verb("compare", str(demo), *given, *size, "--output", str(folder / "compared"))


def _drawn_steps(results: Path, picture: Path) -> None:
    """Steps with their captions, in two rows; the last is ours and Cycles' half by half."""
    from PIL import Image, ImageDraw, ImageFont

    half = Image.new("RGB", STEP_SIZE)
    for name, side in (("exact", 0), ("reference", 1)):
        with Image.open(results / "compared" / f"{name}.png") as opened:
            part = (side * STEP_SIZE[0] // 2, 0, (side + 1) * STEP_SIZE[0] // 2, STEP_SIZE[1])
            half.paste(opened.convert("RGB").crop(part), part[:2])
    ImageDraw.Draw(half).line([(STEP_SIZE[0] // 2, 0), (STEP_SIZE[0] // 2, STEP_SIZE[1])], (255, 255, 255))
    grid = Image.new("RGB", (3 * STEP_SIZE[0], 2 * STEP_SIZE[1]))
    for number, (name, caption) in enumerate(STEPS.items()):
        if name == "compare":
            cell = half
        else:
            path = results / f"step_{name}.png"
            if not path.is_file():
                raise InputError(f"There is no {path.name}: taking pictures of the window needs ImageMagick.")
            with Image.open(path) as opened:
                cell = opened.convert("RGB").crop(VIEW).resize(STEP_SIZE, Image.Resampling.LANCZOS)
        drawing = ImageDraw.Draw(cell)
        drawing.rectangle((0, STEP_SIZE[1] - 24, STEP_SIZE[0], STEP_SIZE[1]), (20, 20, 20))
        font = ImageFont.load_default(15)
        drawing.text((8, STEP_SIZE[1] - 21), f"{number + 1}  {caption}", (255, 255, 255), font)
        row, column = divmod(number, 3)
        grid.paste(cell, (column * STEP_SIZE[0], row * STEP_SIZE[1]))
    grid.save(picture, quality=QUALITY)


def _verb(*arguments: str) -> None:
    _run(str(ROOT / "tools" / "run_verb.py"), "--", *arguments)


def _run(*arguments: str) -> None:
    subprocess.run([sys.executable, *arguments], cwd=ROOT, check=True)


RESULTS: dict[str, Callable[[Path], Any]] = {
    "demo": _demo,
    "window": _window,
    "chart": _chart,
    "costs": _costs,
    "stability": _stability,
    "methods": _methods,
    "materials": _materials,
    "convergence": _convergence,
    "lights": _lights,
    "caustics": _thrown,
    "passes": _passes,
    "inspection": _inspection,
    "film": _film,
    "calm": _calm,
    "animations": _animations,
    "dataset": _dataset,
    "sequence": _sequence,
    "quick_start": _quick_start,
    "anamorphosis": _anamorphosis,
}
"""What pictures are made from: each fills a folder"""

IMAGES: dict[str, Picture] = {
    "demo.jpg": Picture("demo", _strip),
    "viewport.jpg": Picture("window", _cut("sidebar", VIEW)),
    "panel_mirror.jpg": Picture("window", _cut("panel_mirror", POPUP)),
    "panel_quality.jpg": Picture("window", _cut("panel_quality", POPUP)),
    "panel_tools.jpg": Picture("window", _cut("panel_tools", POPUP)),
    "diagnostics.jpg": Picture("window", _views),
    "trace.jpg": Picture("window", _cut("trace", VIEW)),
    "chart.png": Picture("chart", _copied),
    "vertex_count.png": Picture("chart", _copied),
    "costs.png": Picture("costs", _copied),
    "stability.jpg": Picture("stability", _drawn_stability),
    "methods.png": Picture("methods", _copied),
    "materials.jpg": Picture("materials", _copied),
    "convergence.png": Picture("convergence", _copied),
    "lights.jpg": Picture("lights", _placed_lights),
    "caustics.jpg": Picture("caustics", _caustics),
    "passes.jpg": Picture("passes", _copied),
    "inspection.jpg": Picture("inspection", _copied),
    "film.jpg": Picture("film", _copied),
    "calm.jpg": Picture("calm", _copied),
    "animations.jpg": Picture("animations", _copied),
    "dataset.jpg": Picture("dataset", _copied),
    "sequence.jpg": Picture("sequence", _copied),
    "quick_start.jpg": Picture("quick_start", _drawn_steps),
    "anamorphosis.jpg": Picture("anamorphosis", _copied),
}
"""The pictures of the documents by their names in docs/images"""

KEPT = ("caches.png", "chart_full.png")
"""Pictures of scenes that are not in the repository, beside these: the documents say by which commands"""


def make(names: Sequence[str], folder: Path = IMAGES_FOLDER) -> None:
    """Make these pictures; they come into `folder` together at the end. Raises InputError for an unknown name."""
    for name in names:
        if name not in IMAGES:
            raise InputError(f'There is no picture "{name}": choose from {", ".join(IMAGES)}.')
    with tempfile.TemporaryDirectory() as work, folder_to_publish(folder) as part:
        for key in dict.fromkeys(IMAGES[name].results for name in names):
            results = Path(work) / key
            results.mkdir()
            RESULTS[key](results)
        for name in names:
            IMAGES[name].make(Path(work) / IMAGES[name].results, part / name)
