# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The data set: the same again, whole or not at all, references against closed forms and against what others would make
of its files, and judgments of results whose errors are known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.surfaces.mesh_rays import MeshRays
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.report.images import save_exr
from curvrefl.curvrefl_addon.study.dataset.dataset import EXACT, Size, make_dataset
from curvrefl.curvrefl_addon.study.dataset.exr_layers import load_layers
from curvrefl.curvrefl_addon.study.dataset.files import read_ply, whole_report
from curvrefl.curvrefl_addon.study.dataset.judge import judge
from curvrefl.curvrefl_addon.study.dataset.scenes import SCENES
from rendered import channels

WIDTH, HEIGHT = 72, 54
SIZE = Size(WIDTH, HEIGHT, 1)
FLOOR = -1.01


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The ball and two mirrors."""
    folder = tmp_path_factory.mktemp("dataset")
    assert make_dataset(["two", "sphere"], SIZE, folder, lambda _: None) == ["sphere", "two"]
    return folder


def layer(folder: Path, name: str, letters: str) -> np.ndarray:
    """(h, w, letters) of a scene's references, row 0 at the bottom."""
    found = load_layers(folder / "passes.exr")
    return np.stack([found[f"ViewLayer.{name}.{letter}"] for letter in letters], axis=-1).astype(np.float64)


def test_there_are_ten_scenes_of_different_kinds() -> None:
    assert len(SCENES) == 10 and len({entry.text for entry in SCENES.values()}) == 10


def test_it_is_the_same_again_and_what_is_whole_stays(made: Path, tmp_path: Path) -> None:
    make_dataset(["sphere"], SIZE, tmp_path, lambda _: None)
    first, second = (whole_report(folder / "sphere") for folder in (made, tmp_path))
    assert first is not None and second is not None
    exact = [name for name in first["sha256"] if name in EXACT or name.endswith(".ply")]
    assert len(exact) > 5
    assert all(first["sha256"][name] == second["sha256"][name] for name in exact)
    said: list[str] = []
    assert make_dataset(["sphere"], SIZE, tmp_path, said.append) == [] and said == ["sphere: is there"]
    (tmp_path / "sphere" / "mesh_000.ply").write_bytes(b"ply")
    assert make_dataset(["sphere"], SIZE, tmp_path, said.append) == ["sphere"]
    assert json.loads((tmp_path / "dataset.json").read_text())["scenes"]["sphere"]["made"]["samples"] == 1

    def stop(text: str) -> None:
        if "Cycles" in text:
            raise KeyboardInterrupt

    before = sorted(path.name for path in tmp_path.rglob("*"))
    with pytest.raises(KeyboardInterrupt):
        make_dataset(["ellipsoid"], SIZE, tmp_path, stop)
    assert sorted(path.name for path in tmp_path.rglob("*")) == before


def test_references_of_the_ball_are_those_of_closed_forms(made: Path) -> None:
    told = json.loads((made / "sphere" / "scene.json").read_text())
    assert told["mirrors"][0]["surface"]["semi_axes"] == [1.0, 1.0, 1.0]
    eye = np.array(told["camera"]["eye"])
    seen, facing = layer(made / "sphere", "Mirror Position", "XYZ"), layer(made / "sphere", "Mirror Normal", "XYZ")
    shown = layer(made / "sphere", "Position", "XYZW")
    on_mirror = layer(made / "sphere", "Mirror ID", "X")[..., 0] > 0
    assert 800 < on_mirror.sum() < on_mirror.size
    assert np.abs(np.linalg.norm(seen[on_mirror], axis=1) - 1.0).max() < 1e-3, "facets are a little inside"
    assert np.linalg.norm(facing - seen, axis=-1)[on_mirror].max() < 2e-3
    sight = unit(seen[on_mirror] - eye)
    normal = seen[on_mirror] / np.linalg.norm(seen[on_mirror], axis=1, keepdims=True)
    ray = sight - 2.0 * np.einsum("ij,ij->i", sight, normal)[:, None] * normal
    way = unit(shown[on_mirror][:, :3] - shown[on_mirror][:, 3:] * seen[on_mirror])
    steep = np.einsum("ij,ij->i", sight, normal) < -0.2
    assert np.linalg.norm(way - ray, axis=1)[steep].max() < 5e-3
    floor = {item["name"]: item["id"] for item in told["objects"]}["Floor"]
    on_floor = layer(made / "sphere", "Object", "X")[..., 0] == floor
    assert on_floor.sum() > 200
    np.testing.assert_allclose(shown[on_floor][:, 2], FLOOR, atol=1e-6)
    depth, incidence = layer(made / "sphere", "Depth", "Z")[..., 0], layer(made / "sphere", "Incidence", "X")[..., 0]
    whole = np.linalg.norm(seen - eye, axis=-1) + np.linalg.norm(shown[..., :3] - seen, axis=-1)
    np.testing.assert_allclose(depth[on_floor], whole[on_floor], rtol=1e-6)
    np.testing.assert_allclose(
        incidence[on_mirror], np.arccos(-np.einsum("ij,ij->i", sight, facing[on_mirror])), atol=1e-6
    )
    np.testing.assert_allclose(
        layer(made / "sphere", "Normal", "XYZ")[on_floor], np.tile([0, 0, 1], (on_floor.sum(), 1))
    )
    uv = layer(made / "sphere", "UV", "UVA")
    assert (uv[on_floor][:, 2] == 1.0).all()
    # (The floor's map goes on with 0.25 a meter.)
    spread = np.ptp(uv[on_floor][:, 0] - 0.25 * shown[on_floor][:, 0])
    assert spread < 1e-5 or abs(spread - round(spread)) < 1e-5


def test_its_files_are_all_that_one_needs(made: Path) -> None:
    """From the JSON and the PLY files alone, by the conventions that they state, the same references."""
    folder = made / "two"
    told = json.loads((folder / "scene.json").read_text())
    camera = told["camera"]
    back = np.linalg.inv(np.array(camera["projection"]) @ np.array(camera["world_to_camera"]))
    y, x = (axis.ravel() + 0.5 for axis in np.mgrid[0:HEIGHT, 0:WIDTH])
    clip = np.column_stack([2.0 * x / WIDTH - 1.0, 2.0 * y / HEIGHT - 1.0, 0.0 * x, 0.0 * x + 1.0]) @ back.T
    eye = np.array(camera["eye"])
    sight = unit(clip[:, :3] / clip[:, 3:] - eye)
    parts: list[tuple[np.ndarray, np.ndarray, np.ndarray, int]] = []
    for item in told["objects"]:
        corners, triangles = read_ply(folder / item["mesh"])
        matrix = np.array(item["object_to_world"])
        place = np.stack([corners[name] for name in "xyz"], axis=-1).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        normal = np.stack([corners[f"n{name}"] for name in "xyz"], axis=-1).astype(float)
        parts.append((place, normal @ np.linalg.inv(matrix[:3, :3]), triangles, item["id"]))
    starts = np.cumsum([0, *(len(part[0]) for part in parts)])
    mesh = MeshRays(
        np.concatenate([part[0] for part in parts]),
        np.concatenate([part[1] for part in parts]),
        np.concatenate([part[2] + start for part, start in zip(parts, starts, strict=False)]),
    )
    owner = np.concatenate([np.full(len(part[2]), part[3]) for part in parts])
    first = mesh.first_hits(np.broadcast_to(eye, sight.shape), sight)
    mirrors = [item["object"] for item in told["mirrors"]]
    assert len(mirrors) == 2
    on_mirror = (first.triangle >= 0) & np.isin(owner[first.triangle], mirrors)
    wanted = layer(folder, "Mirror ID", "X").ravel()
    np.testing.assert_array_equal(on_mirror, wanted > 0)
    seen = eye + first.distance[on_mirror, None] * sight[on_mirror]
    cosine = np.einsum("ij,ij->i", sight[on_mirror], first.normal[on_mirror])
    ray = unit(sight[on_mirror] - 2.0 * cosine[:, None] * first.normal[on_mirror])
    onward = mesh.first_hits(seen, ray, 1e-3)
    shown = layer(folder, "Position", "XYZW").reshape(-1, 4)[on_mirror]
    numbers = layer(folder, "Object", "X").ravel()[on_mirror]
    steep = cosine < -0.25
    assert np.mean(np.where(onward.triangle >= 0, owner[onward.triangle], 0)[steep] == numbers[steep]) > 0.998
    met = steep & (onward.triangle >= 0) & (owner[onward.triangle] == numbers)
    assert np.isin(numbers[met], mirrors).sum() > 10, "the mirrors show each other"
    np.testing.assert_allclose((seen + onward.distance[:, None] * ray)[met], shown[met][:, :3], atol=1e-5)
    # Other programs read the references, too.
    found = channels(folder / "passes.exr")
    np.testing.assert_array_equal(found["ViewLayer.Mirror ID.X"][::-1].ravel(), wanted)
    longer = layer(folder, "Path Length", "X") > layer(folder, "Depth", "Z") + 1e-3
    assert longer[np.isin(layer(folder, "Object", "X"), mirrors)].mean() > 0.9


def results(folder: Path, shown: np.ndarray) -> Any:
    """The judgment of what is said to be shown on the ball."""
    folder.mkdir(exist_ok=True)
    save_exr(folder / "sphere_position.exr", shown.astype(np.float32))
    return folder


def test_judgments_of_results_whose_errors_are_known(made: Path, tmp_path: Path) -> None:
    shown = layer(made / "sphere", "Position", "XYZW")
    (verdict,) = judge(made, results(tmp_path / "same", shown))
    assert (verdict.wrong, verdict.median_px, verdict.flip) == (0.0, 0.0, None) and verdict.pixels > 800
    # One pixel to the side is off by one pixel (of the smaller of the sides, which one pixel is, a little more).
    (verdict,) = judge(made, results(tmp_path / "side", np.roll(shown, 1, axis=1)))
    assert verdict.median_px == pytest.approx(1.1, abs=0.25) and verdict.wrong is not None and verdict.wrong > 0.3
    half = shown.copy()
    half[:, : WIDTH // 2] = 0.0
    (verdict,) = judge(made, results(tmp_path / "half", half))
    assert verdict.wrong == pytest.approx(0.5, abs=0.05)
    half[:, : WIDTH // 2] = np.nan
    assert judge(made, results(tmp_path / "half", half))[0].wrong == verdict.wrong
    with pytest.raises(InputError, match="36 x 27 pixels"):
        judge(made, results(tmp_path / "small", shown[::2, ::2]))
    (tmp_path / "none").mkdir()
    with pytest.raises(InputError, match="no results"):
        judge(made, tmp_path / "none")
    with pytest.raises(InputError, match="no whole scene"):
        judge(tmp_path, tmp_path / "same")


@pytest.mark.usefixtures("gpu")
def test_our_own_rays_are_right_by_it(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, output = made / "two" / "scene.blend", tmp_path / "two.exr"
    given = ("--reflector", "Left mirror,Right mirror", "--passes", "color,position", "--samples", "4")
    size = ("--method", "exact", "--resolution", f"{WIDTH}x{HEIGHT}")
    assert cli.main(["render", str(file), *given, *size, "--output", str(output)]) == 0
    capsys.readouterr()
    assert cli.main(["dataset", "--judge", str(made), str(tmp_path), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["scenes"]
    assert found["scene"] == "two" and found["wrong"] < 2e-3 and found["median_px"] < 1e-3
    assert cli.main(["dataset", "--judge", str(made), str(tmp_path)]) == 0
    assert "two" in capsys.readouterr().out


def test_what_cannot_be_done_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, said in (
        ((), "--output DIR"),
        (("cube", "--output", str(tmp_path)), 'no scene "cube"'),
        (("--judge", str(tmp_path / "a"), str(tmp_path)), "no folder"),
    ):
        assert cli.main(["dataset", *arguments]) == 2
        assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
