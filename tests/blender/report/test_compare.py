# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A comparison from a .blend file to its report, with renderers that are right or wrong by construction."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.report.compare import Comparison, compare_open_scene
from curvrefl.curvrefl_addon.report.html import report_page
from curvrefl.curvrefl_addon.report.table import format_table
from report.stand_ins import HEIGHT, SAMPLES, SOLVE, WIDTH, BlackRenderer, CyclesRenderer, run


def test_report_of_a_perfect_renderer(blend: Path, tmp_path: Path) -> None:
    output = tmp_path / "new" / "folder"
    said: list[str] = []
    report = run(blend, output, progress=said.append)

    method = report["methods"]["secant_star"]
    assert method["image"] == {"flip": 0.0, "psnr": None}
    assert method["geometry"] == {"angle_deg": {"median": 0.0, "p95": 0.0, "p99": 0.0}, "wrong_object": 0.0}
    assert method["solve"] == SOLVE
    assert report["mask_pixels"] > 300

    assert json.loads((output / "report.json").read_text()) == report
    assert {path.name for path in output.iterdir()} == {
        "report.json", "report.html", "reference.png", "secant_star.png", "secant_star_error.png", "cycles1.png",
    }  # fmt: skip
    assert list(output.parent.iterdir()) == [output], "nothing is left beside the folder"
    assert any("4 samples" in line for line in said)


def test_report_has_the_agreed_shape(blend: Path, tmp_path: Path) -> None:
    def shape(value: Any) -> Any:
        return {key: shape(inner) for key, inner in value.items()} if isinstance(value, dict) else type(value)

    report = run(blend, tmp_path / "out")
    assert report.pop("warnings") == ["A warning <of the renderer>."]
    angle = {"median": float, "p95": float, "p99": float}
    assert shape(report) == {
        "scene": str,
        "reflectors": list,
        "resolution": list,
        "blender": str,
        "gpu": str,
        "reference": {"engine": str, "samples": int, "light": str, "time_s": float},
        "mask_pixels": int,
        "methods": {
            "secant_star": {
                "image": {"flip": float, "psnr": type(None)},
                "geometry": {"angle_deg": angle, "wrong_object": float},
                "time_ms": {"extract": float, "bake": float, "solve": float, "draw": float, "frame": float},
                "solve": shape(SOLVE),
            }
        },
        "peers": {"cycles1": {"image": {"flip": float, "psnr": float}, "time_ms": float}},
    }
    assert report["scene"] == "ball & floor.blend"
    assert report["reflectors"] == ["ball"]
    assert report["resolution"] == [WIDTH, HEIGHT]
    assert re.fullmatch(r"\d+\.\d+\.\d+", report["blender"])
    assert report["reference"] | {"time_s": 0} == {"engine": "CYCLES", "samples": 4, "light": "direct", "time_s": 0}


def test_times_are_medians_without_the_first_frame(blend: Path, tmp_path: Path) -> None:
    freed = CyclesRenderer.freed
    report = run(blend, tmp_path / "out", peers=[])
    times = report["methods"]["secant_star"]["time_ms"]
    assert times["frame"] == 20.0 and times["draw"] == 19.0 and times["bake"] == 7.0
    assert times["extract"] > 0.0
    assert CyclesRenderer.freed == freed + 1
    assert report["peers"] == {}


def test_a_wrong_renderer_is_told(blend: Path, tmp_path: Path) -> None:
    method = run(blend, tmp_path / "out", BlackRenderer, peers=[])["methods"]["secant_star"]
    assert method["image"]["flip"] > 0.3
    assert method["image"]["psnr"] < 15.0
    assert method["geometry"]["angle_deg"]["median"] > 20.0
    assert 0.2 < method["geometry"]["wrong_object"] < 0.9, "the floor's share of the ball"


def test_open_scene_is_compared_without_reopening(blend: Path, tmp_path: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    bpy.data.objects["floor"].location.z = -3.0  # not saved
    bpy.context.view_layer.update()
    comparison = Comparison(("secant_star",), WIDTH, HEIGHT, SAMPLES, "direct", ())
    report = compare_open_scene(
        bpy.context.scene, bpy.context.view_layer, ["ball"], comparison, tmp_path / "out", make_renderer=CyclesRenderer
    )
    assert report["scene"] == "ball & floor.blend"
    assert bpy.data.objects["floor"].location.z == -3.0
    assert [material.name for material in bpy.data.materials] == ["chrome", "red"]


def test_the_camera_and_frame_that_are_asked_for(blend: Path, tmp_path: Path) -> None:
    """A second camera looks away from the ball, until at frame 5 it is turned round."""
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    second = bpy.data.objects.new("second", bpy.data.cameras.new("second"))
    bpy.context.scene.collection.objects.link(second)
    second.location = (0, 5, 1.5)
    for frame, turn in ((1, 0.0), (5, np.pi)):
        second.rotation_euler = (np.radians(75.0), 0, turn)
        second.keyframe_insert("rotation_euler", frame=frame)
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), copy=True)
    away = run(blend, tmp_path / "away", camera="second", frame=1, peers=[])
    assert away["mask_pixels"] == 0
    assert away["methods"]["secant_star"]["image"] == {"flip": None, "psnr": None}
    assert any("in view" in warning for warning in away["warnings"])
    assert bpy.context.scene.camera.name == "camera"
    turned = run(blend, tmp_path / "turned", camera="second", frame=5, peers=[])
    assert turned["mask_pixels"] > 300


def test_an_existing_folder_keeps_its_other_files(blend: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("kept")
    (tmp_path / "out" / "report.json").write_text("old")
    report = run(blend, tmp_path / "out", peers=[])
    assert (tmp_path / "out" / "mine.txt").read_text() == "kept"
    assert json.loads((tmp_path / "out" / "report.json").read_text()) == report


class Page(HTMLParser):
    """Collects what a page links to and checks that its elements are closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.links: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "img"):
            self.open.append(tag)
        self.links += [value for name, value in attrs if name in ("src", "href") and value]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_page_shows_every_picture_and_number(blend: Path, tmp_path: Path) -> None:
    output = tmp_path / "out"
    report = run(blend, output)
    page = Page()
    page.feed((output / "report.html").read_text(encoding="utf-8"))
    assert page.open == []
    assert {path.name for path in output.glob("*.png")} == set(page.links), "relative links, all pictures"
    assert "A warning <of the renderer>." in page.text
    assert "ball & floor.blend" in page.text
    assert f"{report['peers']['cycles1']['image']['flip']:.4f}" in page.text


def test_page_and_table_without_numbers() -> None:
    nothing = {"median": None, "p95": None, "p99": None}
    report = {
        "scene": "a.blend",
        "reflectors": ["ball"],
        "resolution": [4, 3],
        "blender": "5.2.3",
        "gpu": "a GPU",
        "reference": {"engine": "CYCLES", "samples": 1, "light": "full", "time_s": 1.0},
        "mask_pixels": 0,
        "methods": {
            "secant_star": {
                "image": {"flip": None, "psnr": None},
                "geometry": {"angle_deg": nothing, "wrong_object": None},
                "time_ms": {"extract": 1.0, "bake": 2.0, "solve": 0.123, "draw": 4.0, "frame": 1234.5},
                "solve": SOLVE,
            }
        },
        "peers": {"eevee": {"image": {"flip": 0.25, "psnr": 12.34}, "time_ms": 150.2}},
    }
    lines = format_table(report).splitlines()
    assert lines[3].split() == ["secant_star", *["-"] * 6, "0.12", "4.0", "1234"]
    assert lines[4].split() == ["eevee", "0.2500", "12.3", *["-"] * 6, "150"]
    page = Page()
    page.feed(report_page(report))
    assert page.open == [] and "eevee.png" in page.links
