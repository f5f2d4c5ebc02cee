# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every mistake in files and scenes, through the command line: one sentence, exit code 2, nothing written."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest
from blender_process import run_script
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.report.images import load_exr
from mathutils import Matrix
from small_scene import RUN_VERB, SIZE, Change, saved

pytestmark = pytest.mark.usefixtures("gpu")


def render(path: Path, *more: str, reflector: str = "Mirror Ball") -> tuple[int, Path]:
    """Exit code of the verb `render`, and its output's path."""
    output = path.parents[1] / "out" / "picture.exr"
    arguments = ["render", str(path), "--reflector", reflector, "--samples", "1", "--output", str(output), *more]
    return cli.main(arguments), output


def refused(code: int, output: Path, capfd: pytest.CaptureFixture[str]) -> str:
    """What was said: one sentence and no more; nothing was written."""
    err = capfd.readouterr().err
    assert code == 2, err
    assert re.fullmatch(r"curvrefl: .*[.?]\n", err), err
    assert not output.parent.exists()
    return err


def test_a_missing_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "files").mkdir()
    code, output = render(tmp_path / "files" / "none.blend")
    assert "none.blend" in refused(code, output, capfd)


@pytest.mark.parametrize("content", [b"", b"BLENDER-v502", b"not a scene at all" * 100, None])
def test_a_broken_file(content: bytes | None, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = saved(tmp_path)
    # None: a whole file that breaks off in the middle.
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2] if content is None else content)
    code, output = render(path)
    assert "scene.blend" in refused(code, output, capfd)


def test_a_folder_instead_of_a_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, output = render(saved(tmp_path).parent / ".")
    assert "files" in refused(code, tmp_path / "out" / "picture.exr", capfd)
    assert not output.exists()


def test_no_camera(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def change(_ball: bpy.types.Object) -> None:
        bpy.data.objects.remove(bpy.data.objects["Eye"])

    code, output = render(saved(tmp_path, change))
    assert "no camera" in refused(code, output, capfd)


def test_an_unknown_camera(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, output = render(saved(tmp_path), "--camera", "Eie")
    assert '"Eye"' in refused(code, output, capfd)


def test_an_unknown_reflector_gets_near_names(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, output = render(saved(tmp_path), reflector="mirorball")
    said = refused(code, output, capfd)
    assert "mirorball" in said
    assert '"Mirror Ball"' in said


def test_a_reflector_that_is_not_a_mesh(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, output = render(saved(tmp_path), reflector="Eye")
    assert "mesh" in refused(code, output, capfd)


def without_faces(ball: bpy.types.Object) -> None:
    ball.data.clear_geometry()


def with_loose_edges_only(ball: bpy.types.Object) -> None:
    ball.data.clear_geometry()
    ball.data.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])


def with_a_nan(ball: bpy.types.Object) -> None:
    ball.data.vertices[7].co.x = float("nan")


def with_an_infinity(ball: bpy.types.Object) -> None:
    positions = np.empty(3 * len(ball.data.vertices), np.float32)
    attribute = ball.data.attributes["position"].data
    attribute.foreach_get("vector", positions)
    positions[20] = np.inf
    # (setting a single vertex clamps it to the largest number there is)
    attribute.foreach_set("vector", positions)


def with_a_vertex_far_out(ball: bpy.types.Object) -> None:
    ball.data.vertices[7].co.z = float("inf")
    assert np.isfinite(ball.data.vertices[7].co.z)


def flattened(ball: bpy.types.Object) -> None:
    ball.scale = (1.0, 1.0, 0.0)


def shrunk_to_nothing(ball: bpy.types.Object) -> None:
    ball.scale = (0.0, 0.0, 0.0)


def singular(ball: bpy.types.Object) -> None:
    ball.parent = bpy.data.objects["Block"]
    ball.matrix_parent_inverse = Matrix(((1, 1, 0, 0), (1, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)))


def hidden_in_renders(ball: bpy.types.Object) -> None:
    ball.hide_render = True


def bent_to_a_horseshoe(ball: bpy.types.Object) -> None:
    """Closed, and not star-shaped however the center is chosen: a long ellipsoid, bent by 270 degrees."""
    for vertex in ball.data.vertices:
        x, y, z = vertex.co
        angle, radius = 0.75 * np.pi * x, 1.0 + 0.3 * z
        vertex.co = (radius * np.sin(angle), 0.3 * y, radius * np.cos(angle))


def turned_to_a_bowl(ball: bpy.types.Object) -> None:
    """The upper half of the ball pushed in: about any center in the wall, directions pass the wall twice."""
    for vertex in ball.data.vertices:
        if vertex.co.z > 0.0:
            vertex.co.z *= -0.8


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (without_faces, "Mirror Ball"),
        (with_loose_edges_only, "Mirror Ball"),
        (with_a_nan, "finite|not numbers|not a number"),
        (with_an_infinity, "finite|not numbers|not a number"),
        (with_a_vertex_far_out, "too far"),
        (flattened, "scale"),
        (shrunk_to_nothing, "scale"),
        (singular, "Mirror Ball"),
        (hidden_in_renders, "hidden"),
        (bent_to_a_horseshoe, "star-shaped"),
        (turned_to_a_bowl, "star-shaped"),
    ],
)
@pytest.mark.parametrize("verb", ["render", "bake", "compare"])
def test_a_reflector_that_cannot_be_one(
    verb: str, change: Change, named: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = saved(tmp_path, change)
    output = tmp_path / "out" / "x.exr"
    destination = output if verb == "render" else output.parent
    # (rays need no map)
    method = () if verb == "bake" else ("--method", "secant_star")
    code = cli.main([verb, str(path), "--reflector", "Mirror Ball", *method, "--output", str(destination)])
    said = refused(code, output, capfd)
    assert "Mirror Ball" in said
    assert re.search(named, said), said


@pytest.mark.parametrize("change", [bent_to_a_horseshoe, turned_to_a_bowl])
def test_rays_take_any_shape(change: Change, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, output = render(saved(tmp_path, change))
    assert code == 0, capfd.readouterr().err
    assert np.isfinite(load_exr(output)).all()


def test_triangles_too_far_out_are_left_out_with_a_warning(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = saved(tmp_path, lambda _ball: with_a_vertex_far_out(bpy.data.objects["Block"]))
    code, output = render(file, "--method", "exact")
    assert 'of "Block" have a corner at no finite place or too far out' in warned(code, capfd)
    assert np.isfinite(load_exr(output)).all()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_an_output_folder_that_is_write_protected(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = saved(tmp_path)
    protected = tmp_path / "protected"
    protected.mkdir(mode=0o500)
    code = cli.main(["render", str(path), "--reflector", "Mirror Ball", "--output", str(protected / "new" / "x.png")])
    assert str(protected) in refused(code, protected / "new" / "x.png", capfd)


def test_a_folder_that_cannot_be_made(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = saved(tmp_path)
    (tmp_path / "file").write_text("mine")
    for arguments in (["render"], ["compare"], ["bake"]):
        output = tmp_path / "file" / "x.png"
        code = cli.main([*arguments, str(path), "--reflector", "Mirror Ball", "--output", str(output)])
        assert code == 2
        assert "which is a file" in capfd.readouterr().err
    assert (tmp_path / "file").read_text() == "mine"


GPU_VERBS = ("render", "compare", "bake", "demo")


def arguments_without_scene(verb: str, output: Path) -> list[str]:
    file = [] if verb == "demo" else ["x.blend", "--reflector", "Ball"]
    return [verb, *file, "--output", str(output if verb == "render" else output.parent)]


@pytest.mark.parametrize("verb", GPU_VERBS)
def test_no_gpu_context(
    verb: str, tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    import gpu

    def fail() -> None:
        raise SystemError("no display")

    monkeypatch.setattr(gpu, "init", fail)
    output = tmp_path / "out" / "x.exr"
    said = refused(cli.main(arguments_without_scene(verb, output)), output, capfd)
    assert "OpenGL" in said
    assert "install" in said


@pytest.mark.skipif(sys.platform != "linux" or bool(bpy.app.binary_path), reason="drives Mesa of the bpy wheel")
@pytest.mark.parametrize(
    "driver",
    [
        {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json"},
        {"LIBGL_DRIVERS_PATH": "/nonexistent"},
        {"MESA_GL_VERSION_OVERRIDE": "3.3", "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe"},
    ],
)
def test_a_driver_that_crashes_blender(driver: dict[str, str], tmp_path: Path) -> None:
    """Where there is no driver, Blender itself ends with a signal: it must not come to that."""
    output = tmp_path / "out" / "x.exr"
    result = run_script(RUN_VERB, "--", *arguments_without_scene("render", output), **driver)
    if "OpenGL" not in result.stderr and "x.blend" in result.stderr:
        pytest.skip("this system's driver takes no notice of the variable")
    assert (result.returncode, result.stderr.count("\n")) == (2, 1), result.stderr
    assert re.fullmatch(r"curvrefl: .*OpenGL.*install.*\.\n", result.stderr)
    assert not output.parent.exists()


def warned(code: int, capfd: pytest.CaptureFixture[str]) -> str:
    """The warnings of a verb that has done its work."""
    err = capfd.readouterr().err
    assert code == 0, err
    said = [line for line in err.splitlines() if line.startswith("curvrefl: Warning: ")]
    assert said, err
    return "\n".join(said)


def test_a_camera_inside_the_reflector(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def change(_ball: bpy.types.Object) -> None:
        bpy.data.objects["Eye"].location = (0.0, 0.0, 0.0)

    code, output = render(saved(tmp_path, change), "--method", "secant_star")
    assert "inside" in warned(code, capfd)
    assert np.isfinite(load_exr(output)).all()


def test_nothing_to_reflect(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def change(_ball: bpy.types.Object) -> None:
        bpy.data.objects.remove(bpy.data.objects["Block"])

    code, output = render(saved(tmp_path, change))
    assert "nothing" in warned(code, capfd).lower()
    # Chrome before a white world: its base color 0.8 in the middle, white around it.
    picture = load_exr(output)
    np.testing.assert_allclose(picture[SIZE[1] // 2, SIZE[0] // 2, :3], 0.8, atol=0.02)
    np.testing.assert_allclose(picture[0, 0, :3], 1.0, atol=1e-3)


def test_a_reflector_out_of_view(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def change(_ball: bpy.types.Object) -> None:
        bpy.data.objects["Eye"].rotation_euler = (-np.pi / 2.0, 0.0, 0.0)

    code, output = render(saved(tmp_path, change))
    assert "in view" in warned(code, capfd)
    np.testing.assert_allclose(load_exr(output)[..., :3], 1.0, atol=1e-3)
