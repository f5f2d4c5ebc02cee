# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `./curvrefl VERB ...`, and `blender --command curvrefl VERB ...` once the extension is there.

Results go to stdout, progress and warnings to stderr. Blender and the renderer are imported by the verbs that need
them, so that help and usage errors come at once.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import re
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import NoReturn

from .errors import InputError

DONE, OUR_FAILURE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

ROOT = Path(__file__).resolve().parent.parent
LAYERS = ("unit", "blender", "gui")
PASSES = ("color", "position", "object", "iterations")
MAX_SIDE = 16384
"""Largest side of a picture: the texture size that OpenGL 4.3 drivers grant"""
MAX_FRAME = 1048574
"""Blender's own limit"""


def main(arguments: Sequence[str]) -> int:
    """Run a verb and return the exit code: 0 done, 2 bad input or usage, 1 a failure of ours, 130 interrupted."""
    try:
        return run(arguments)
    except InputError as error:
        _say(str(error))
        return BAD_INPUT
    except KeyboardInterrupt:
        _say("Interrupted.")
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of our output has left; there is nobody to tell.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OUR_FAILURE
    except Exception:
        traceback.print_exc()
        return OUR_FAILURE


def run(arguments: Sequence[str]) -> int:
    """As `main`, but errors come out: InputError for bad input and usage, others for failures of ours."""
    try:
        options = _parser().parse_args(list(arguments))
    except SystemExit as finished:
        # argparse has printed the help.
        return int(finished.code or 0)
    verb: Callable[[argparse.Namespace], int] = options.run
    return verb(options)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message[:1].upper()}{message[1:].rstrip('.')}: see {self.prog} --help.")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="curvrefl", description="What curved mirrors reflect, true for near objects too.")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True, parser_class=_Parser)

    def verb(name: str, action: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
        sub = verbs.add_parser(name, help=text, description=text)
        sub.set_defaults(run=action)
        return sub

    demo = verb("demo", _demo, "Build the demo scene and compare its picture with Cycles and EEVEE.")
    demo.add_argument("--output", default="output/demo", metavar="DIR", help="folder to write to (%(default)s)")

    test = verb("test", _test, "Check the source: lint, types and all tests, or one layer of tests.")
    test.add_argument("layers", nargs="*", metavar="LAYER", help=f"{', '.join(LAYERS)}; all of them where none is named")

    render = verb("render", _render, "Render a picture of a .blend file with true reflections on the named mirrors.")
    _add_scene_options(render)
    render.add_argument("--method", default="secant_star", metavar="M", help="how to reflect (%(default)s)")
    render.add_argument("--samples", type=int, default=16, metavar="N", help="for anti-aliasing (%(default)s)")
    render.add_argument(
        "--passes",
        default="color",
        metavar="P[,P..]",
        help=f"of {', '.join(PASSES)}; others than color go to NAME_PASS.exr beside the output (%(default)s)",
    )
    render.add_argument("--output", required=True, metavar="FILE", help=".png (as shown) or .exr (scene-linear)")

    compare = verb("compare", _compare, "Compare methods with Cycles, and with EEVEE and quick Cycles as peers.")
    _add_scene_options(compare)
    compare.add_argument(
        "--method", default="secant_star,environment_cube", metavar="M[,M..]", help="or all (%(default)s)"
    )
    compare.add_argument("--samples", type=int, default=256, metavar="N", help="of the reference (%(default)s)")
    compare.add_argument(
        "--light",
        default="direct",
        metavar="L",
        help="direct: no indirect diffuse light; full: as the scene renders in Cycles (%(default)s)",
    )
    compare.add_argument(
        "--peers", default="eevee,cycles1,cycles8", metavar="P[,P..]", help="of %(default)s, or none (%(default)s)"
    )
    compare.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    bake = verb("bake", _bake, "Bake a reflector into cube maps and say how well they fit it.")
    bake.add_argument("file", metavar="FILE.blend")
    bake.add_argument("--reflector", required=True, metavar="A", help="name of the mirror object")
    bake.add_argument("--resolution", type=int, default=128, metavar="N", help="texels along an edge (%(default)s)")
    bake.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    build = verb("build", _build, "Validate and pack the extension as a .zip to install in Blender.")
    build.add_argument("--output", default="dist", metavar="DIR", help="folder to write to (%(default)s)")
    return parser


def _add_scene_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE.blend")
    parser.add_argument("--reflector", required=True, metavar="A[,B..]", help="names of the mirror objects")
    parser.add_argument("--camera", metavar="C", help="name of a camera object (the scene's)")
    parser.add_argument("--frame", type=_frame, metavar="N", help="frame of the animation (the file's)")
    parser.add_argument("--resolution", type=_resolution, metavar="WxH", help="in pixels (the scene's)")


def _frame(text: str) -> int:
    """A frame number that Blender can go to."""
    if not re.fullmatch(r"[+-]?\d{1,9}", text) or abs(int(text)) > MAX_FRAME:
        raise argparse.ArgumentTypeError(f"'{text}' is not a frame number between -{MAX_FRAME} and {MAX_FRAME}")
    return int(text)


def _resolution(text: str) -> tuple[int, int]:
    """Width and height in pixels."""
    match = re.fullmatch(r"(\d{1,9})[xX](\d{1,9})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}' is not a resolution like 640x480")
    width, height = int(match[1]), int(match[2])
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
        raise argparse.ArgumentTypeError(f"{width}x{height} is out of range: 1 to {MAX_SIDE} pixels a side")
    return width, height


def _names(text: str, what: str) -> list[str]:
    """The parts of a list with commas, once each. Raises InputError when there are none."""
    names = list(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    if not names:
        raise InputError(f"Name at least one {what}.")
    return names


def _known(names: Sequence[str], known: Sequence[str], what: str) -> None:
    for name in names:
        if name not in known:
            raise InputError(f'There is no {what} "{name}": choose from {", ".join(known)}.')


def _say(text: str) -> None:
    print(f"curvrefl: {text}", file=sys.stderr, flush=True)


def _warn(warnings: Sequence[str]) -> None:
    for warning in dict.fromkeys(warnings):
        _say(f"Warning: {warning}")


@contextlib.contextmanager
def _standard_error_dropped() -> Iterator[None]:
    """What C libraries write to file descriptor 2 meanwhile goes nowhere."""
    sys.stderr.flush()
    kept = os.dup(2)
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def _start_gpu() -> None:
    """Make the GPU context. Raises InputError, with how to get one, where there is none."""
    import bpy  # noqa: F401  (with the wheel, before gpu)

    from .renderer.gpu_objects import GpuUnavailableError, require_gpu

    try:
        # EGL tries configurations that do not match and says so, at length, though all is well.
        with _standard_error_dropped():
            require_gpu()
    except GpuUnavailableError as error:
        message = str(error).rstrip(".")
        raise InputError(f"{message[:1].upper()}{message[1:]}.") from error


def _repository_tool(name: str, verb: str) -> ModuleType:
    """`tools/<name>.py`, which is there in a copy of the source and not in the installed extension."""
    path = ROOT / "tools" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"curvrefl_tools_{name}", path) if path.is_file() else None
    if spec is None or spec.loader is None:
        raise InputError(f"The verb {verb} needs a copy of Curvrefl's source: call ./curvrefl {verb} there.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _test(options: argparse.Namespace) -> int:
    _known(options.layers, LAYERS, "layer of tests")
    return int(_repository_tool("run_tests", "test").main(options.layers))


def _build(options: argparse.Namespace) -> int:
    from .output import checked_folder

    tool = _repository_tool("build_extension", "build")
    print(tool.build(checked_folder(options.output)))
    return DONE
