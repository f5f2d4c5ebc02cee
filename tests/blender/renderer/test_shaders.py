# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of pieces: slots, shared names, and what is said of one that does not compile."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.compile_log import captured_output, explain
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, ShaderError, build_shader, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.gpu_shaders.loader import Snippet, load

pytestmark = pytest.mark.usefixtures("gpu")

COLOR = Piece(outputs={"color": "VEC4"})


def of_text(text: str) -> Piece:
    return Piece(fragment=Snippet("a test", text))


def test_a_broken_file_is_named_with_its_line(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Below an include, whose lines come before it in the text that the driver sees."""
    file = tmp_path / "broken.frag.glsl"
    file.write_text('// One\n#include "common/vectors.glsl"\nvoid main()\n{\n  color = vec4(nowhere);\n}\n')
    with pytest.raises(ShaderError) as caught:
        build_shader("of a test", FULL_SCREEN, COLOR, Piece(defines={"LARGEST_COORDINATE": 1e18}), Piece(fragment=file))
    said = str(caught.value)
    assert "of a test" in said
    assert f"{file}, line 5" in said
    assert "nowhere" in said
    assert "nowhere" not in "".join(capfd.readouterr()), "the log is in the error and nowhere else"


def test_an_error_in_an_include_is_named_there() -> None:
    """vectors.glsl needs a define that is missing here."""
    with pytest.raises(ShaderError, match=r"common/vectors\.glsl, line \d+: .*LARGEST_COORDINATE"):
        build_shader(
            "of a test",
            FULL_SCREEN,
            COLOR,
            of_text('#include "common/vectors.glsl"\nvoid main() { color = vec4(1.0); }'),
        )


def test_an_error_in_a_vertex_shader_is_named_there() -> None:
    vertex = Piece(inputs={"pos": "VEC2"}, vertex=Snippet("vertices", "void main()\n{\n  gl_Position = missing;\n}\n"))
    with pytest.raises(ShaderError, match=r"vertices, line 3: .*missing"):
        build_shader("of a test", vertex, COLOR, of_text("void main() { color = vec4(1.0); }"))


def test_an_error_without_a_line_has_the_drivers_words() -> None:
    with pytest.raises(ShaderError, match="absent"):
        build_shader(
            "of a test", FULL_SCREEN, COLOR, of_text("vec4 absent();\nvoid main()\n{\n  color = absent();\n}\n")
        )


def test_pieces_share_what_they_name_alike() -> None:
    first, second = (texture_2d(np.full((2, 2, 4), value, np.float32)) for value in (0.25, 0.5))
    shader = build_shader(
        "of a test",
        FULL_SCREEN,
        COLOR,
        Piece(samplers=named("FLOAT_2D", "one", "two"), constants={"scale": "FLOAT"}),
        Piece(samplers=named("FLOAT_2D", "two"), constants={"scale": "FLOAT"}, defines={"HALF": 0.5, "SIX": 6}),
        of_text(
            "void main() { color = scale * HALF * float(SIX / 4) * vec4(texelFetch(one, ivec2(0), 0).x, "
            "texelFetch(two, ivec2(0), 0).x, 1.0, 1.0); }"
        ),
    )
    target = empty_texture(2, 2)
    with drawing_state(), frame_buffer(target).bind():
        set_viewport(0, 0, 2, 2)
        shader.bind()
        shader.uniform_float("scale", 2.0)
        shader.uniform_sampler("one", first)
        shader.uniform_sampler("two", second)
        full_screen_triangle().draw(shader)
    np.testing.assert_array_equal(read_texture(target), np.tile([0.25, 0.5, 1.0, 1.0], (2, 2, 1)))


def test_one_name_cannot_mean_two_things() -> None:
    with pytest.raises(ValueError, match="both FLOAT_2D and FLOAT_CUBE"):
        build_shader(
            "of a test", FULL_SCREEN, Piece(samplers={"map": "FLOAT_2D"}), Piece(samplers={"map": "FLOAT_CUBE"})
        )


def test_output_goes_where_it_went_afterwards(capfd: pytest.CaptureFixture[str]) -> None:
    """Also after an error; what is not of a shader is written again."""
    with pytest.raises(RuntimeError), captured_output():
        raise RuntimeError
    with captured_output() as output:
        os.write(1, b"kept\n00:00.1  gpu.shader  | ERROR name FragShader:\n         |   | words\nkept too\n")
        os.write(2, b"a warning\n")
    assert capfd.readouterr() == ("", "")
    output.write_rest()
    os.write(1, b"later\n")
    assert capfd.readouterr() == ("kept\nkept too\nlater\n", "a warning\n")
    assert "".join(output.errors).count("words") == 1


@pytest.mark.parametrize(
    "line",
    [
        "          |       | python_shader.glsl:2:16: Error: undefined variable",
        '          |       | 0(2) : error C1503: undefined variable "x"',
        "          |       | 0:2(16): error: undefined variable",
        "          |       | ERROR: 0:2: undefined variable",
    ],
)
def test_words_of_drivers_are_understood(line: str) -> None:
    sources = {"fragment": load(Snippet("file", "void main()\n{\n}\n"))}
    said = explain(["| ERROR pyGPU_Shader FragShader:", line], sources)
    assert said.startswith("file, line 2: ")
    assert "undefined variable" in said
