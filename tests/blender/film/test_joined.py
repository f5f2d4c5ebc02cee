# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Films by Blender's own renders: no seam, EEVEE's bits beside the mirrors, and whole files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.engine.engine import TROUBLE
from curvrefl.curvrefl_addon.engine.passes import MIRROR
from curvrefl.curvrefl_addon.engine.session import RenderSession
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.film.film import remove, set_up
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.report.display import display_transform
from curvrefl.curvrefl_addon.report.images import load_exr
from film.film_scene import BALL, SIZE, WORLD, blur, build, picture

LEVEL = 1.0 / 255.0
BLURS = ("sharp", "depth of field", "jittered depth of field", "motion")


@pytest.fixture(scope="module", autouse=True)
def _extension(gpu: None) -> Iterator[None]:
    registration.register()
    yield
    registration.unregister()


def shown(linear: Any) -> np.ndarray:
    """As on a display, to count in levels of it."""
    return display_transform(np.asarray(linear, np.float32))


@pytest.mark.parametrize("kind", BLURS)
def test_a_mirror_of_the_background_leaves_no_seam_in_it(tmp_path: Path, kind: str) -> None:
    scene = build()
    blur(scene, kind)
    set_up(scene)
    film = picture(scene, tmp_path / "film.exr")
    seam = np.abs(shown(film[..., :3]) - shown(WORLD)).max()
    assert seam < 2.0 * LEVEL
    assert (film[..., 3] == 1.0).all()


def test_all_beside_the_mirrors_are_the_bits_of_eevee(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A lamp on a floor, noise of shadows and all, and the ball small above it.

    The mirrors are the bits of those of a render of all, though nothing else is drawn.
    """
    drawn, kinds = mirrors_drawn(monkeypatch)
    scene = build()
    bpy.data.objects[BALL].scale = (0.3,) * 3
    bpy.ops.mesh.primitive_plane_add(size=40.0, location=(0.0, 0.0, -1.0))
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "AREA"))
    lamp.data.energy, lamp.data.size, lamp.location = 300.0, 2.0, (1.0, -1.0, 3.0)
    scene.collection.objects.link(lamp)
    alone = picture(scene, tmp_path / "eevee.exr")
    set_up(scene)
    film = picture(scene, tmp_path / "film.exr")
    row, column = np.mgrid[:SIZE, :SIZE] - 0.5 * SIZE + 0.5
    # (The ball's outline, by where it is seen from: 3 / sqrt(60^2 - 3^2) of a lens of 50 mm before a sensor of 36.)
    radius = SIZE * 50.0 / 36.0 * 0.3 / np.sqrt(6.0**2 - 0.3**2)
    beside = np.hypot(row, column) > radius + 2.5
    assert 0.9 < beside.mean() < 0.99 and alone[beside].std() > 0.05
    assert np.array_equal(film[beside], alone[beside])
    assert not np.array_equal(film[~beside], alone[~beside])
    assert set(kinds) == {True} and len(kinds) == scene.curvrefl.render_samples
    remove(scene)
    scene.render.engine = "CURVREFL"
    bpy.context.view_layer.curvrefl.use_pass_mirror = True
    picture(scene, tmp_path / "render.exr")
    of_film, of_render = drawn
    assert set(kinds) == {True, False} and of_render[..., 3].any()
    assert np.array_equal(of_film, of_render)


def mirrors_drawn(monkeypatch: pytest.MonkeyPatch) -> tuple[list[np.ndarray], list[bool]]:
    """What mirrors show in the pictures that are drawn from now on, and of each sub-frame whether nothing else is."""
    drawn: list[np.ndarray] = []
    kinds: list[bool] = []
    draw, add = RenderSession.draw, Renderer.add_sub_frame

    def kept(*arguments: Any, **keywords: Any) -> Any:
        area, pixels = draw(*arguments, **keywords)
        drawn.append(pixels[MIRROR])
        return area, pixels

    def counted(
        renderer: Renderer, canvas: Any, reflection: Any, index: int, weight: float, mirrors_only: bool = False
    ) -> None:
        kinds.append(mirrors_only)
        add(renderer, canvas, reflection, index, weight, mirrors_only)

    monkeypatch.setattr(RenderSession, "draw", kept)
    monkeypatch.setattr(Renderer, "add_sub_frame", counted)
    return drawn, kinds


def test_edges_mix_the_mirror_and_what_is_behind_it_and_nothing_else(tmp_path: Path) -> None:
    """With a tint of one third, on a transparent film, cut to a border: EEVEE's green is nowhere."""
    scene = build()
    bpy.data.objects[BALL].curvrefl.tint = (1.0 / 3.0,) * 3
    render = scene.render
    render.film_transparent = render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.625, 0.25, 1.0
    set_up(scene)
    film = picture(scene, tmp_path / "film.exr")
    assert film.shape == (SIZE * 3 // 4, SIZE * 3 // 8, 4)
    covered = film[..., 3:]
    assert ((covered > 0.02) & (covered < 0.98)).mean() > 0.01 and 0.3 < (covered == 1.0).mean() < 0.7
    np.testing.assert_allclose(film[..., :3], covered * np.array(WORLD) / 3.0, atol=2e-3)


def test_mirrors_that_are_only_instances_are_joined_by_our_own_coverage(tmp_path: Path) -> None:
    scene = build()
    ball, group = bpy.data.objects[BALL], bpy.data.collections.new("library")
    group.objects.link(ball)
    scene.collection.objects.unlink(ball)
    place: Any = bpy.data.objects.new("place", None)
    place.instance_type, place.instance_collection = "COLLECTION", group
    scene.collection.objects.link(place)
    (told,) = set_up(scene)
    assert f'"{BALL}"' in told and "instances" in told
    film = picture(scene, tmp_path / "film.exr")
    middle = slice(SIZE // 2 - 4, SIZE // 2 + 4)
    assert np.abs(shown(film[middle, middle, :3]) - shown(WORLD)).max() < LEVEL


def test_mirrors_that_cannot_be_drawn_are_an_error_and_pink(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def torn(*_arguments: Any, **_keywords: Any) -> None:
        raise InputError("It is torn: mend it.")

    monkeypatch.setattr(RenderSession, "draw", torn)
    scene = build()
    set_up(scene)
    film = picture(scene, tmp_path / "film.exr")
    assert "It is torn" in "".join(capfd.readouterr())
    np.testing.assert_allclose(film[SIZE // 2, SIZE // 2], TROUBLE, atol=2e-3)


def moving(folder: Path) -> Path:
    """A file in which the ball goes across, and that has been saved."""
    build()
    ball = bpy.data.objects[BALL]
    for frame, place in ((1, -1.0), (3, 1.0)):
        ball.location.x = place
        ball.keyframe_insert("location", frame=frame)
    path = folder / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    return path


def said(capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    capfd.readouterr()
    code = cli.main(["film", *arguments])
    out, err = capfd.readouterr()
    assert (code, err) == (0, "")
    return out


def test_the_verb_writes_a_range_and_goes_on_where_it_was_stopped(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file, out = moving(tmp_path), tmp_path / "out"
    given = (str(file), "--samples", "2", "--resolution", "24x24", "--output", str(out / "film_##.exr"))
    assert "Frame 2 (2 of 2)" in said(capfd, *given, "--frames", "1-2")
    assert sorted(path.name for path in out.iterdir()) == ["film_01.exr", "film_02.exr"]
    first, second = (load_exr(out / f"film_0{frame}.exr") for frame in (1, 2))
    for film in (first, second):
        assert film.shape == (24, 24, 4) and np.abs(shown(film[..., :3]) - shown(WORLD)).max() < 2.0 * LEVEL
    (out / "film_01.exr").write_bytes((out / "film_01.exr").read_bytes()[:-100])
    kept = (out / "film_02.exr").stat().st_mtime_ns
    told = said(capfd, *given, "--frames", "1-2", "--resume")
    assert "1 of 2 frames are there already" in told and "Rendered 1 frames" in told
    assert np.array_equal(load_exr(out / "film_01.exr"), first)
    assert (out / "film_02.exr").stat().st_mtime_ns == kept


def test_the_verb_writes_a_video_with_all_its_frames(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file, out = moving(tmp_path), tmp_path / "out"
    told = said(
        capfd, str(file), "--reflector", BALL, "--samples", "1", "--resolution", "24x24", "--frames", "1-2",
        "--layers", "--output", str(out / "film.mp4"),
    )  # fmt: skip
    assert "Frame 2 (2 of 2)" in told
    assert bpy.data.movieclips.load(str(out / "film.mp4")).frame_duration == 2
    layers = sorted(path for path in out.iterdir() if path.suffix == ".exr")
    assert [path.name for path in layers] == [f"film_layers_000{frame}.exr" for frame in (1, 2)]
    header = layers[0].read_bytes()[:8000]
    for name in (b"Film", b"EEVEE", b"Held Out", b"Mirror.R", b"Mirror Position.X", b"Mirror Object"):
        assert name in header
