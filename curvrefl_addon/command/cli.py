# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `./curvrefl VERB ...`, and `blender --command curvrefl VERB ...` once the extension is there.

Results go to stdout, progress and warnings to stderr. Blender and the renderer are imported by the verbs that need
them, so that help and usage errors come at once.
"""

from __future__ import annotations

import argparse
import io
import os
import signal
import sys
import traceback
from collections.abc import Callable, Sequence
from typing import NoReturn

from ..errors import InputError
from ..gpu_caches import clear_gpu_caches
from ..supervised import is_supervised
from ..written_files import NO_ROOM
from . import charts, dataset_verb, design_verbs, device_verbs, farm_verbs, film_verb, sequence_verbs, verbs
from .arguments import between, positive, resolution
from .inputs import say
from .scene_arguments import PEERS_HELP, add_comparison, add_reference_samples, add_scene_options, add_settings
from .signals import StoppedError, answered_signals

DONE, OUR_FAILURE, BAD_INPUT = 0, 1, 2


def main(arguments: Sequence[str]) -> int:
    """Run a verb and return the exit code: 0 done, 2 bad input or usage, 1 a failure of ours, 128 + n for signal n."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        # Names of files may be bytes that are no UTF-8: they are written as they came.
        sys.stdout.reconfigure(errors="surrogateescape")
    try:
        with answered_signals():
            code = run(arguments)
            sys.stdout.flush()
            return code
    except InputError as error:
        say(str(error))
        return BAD_INPUT
    except StoppedError as stopped:
        return _stopped(stopped)
    except KeyboardInterrupt:
        return _stopped(StoppedError(signal.SIGINT))
    except BrokenPipeError:
        # The reader of our output has left; there is nobody to tell.
        _drop_stdout()
        return OUR_FAILURE
    except OSError as error:
        if error.errno not in NO_ROOM:
            traceback.print_exc()
            return OUR_FAILURE
        _drop_stdout()
        say(f"Cannot write {error.filename or 'the output'} ({error.strerror}): make room first.")
        return OUR_FAILURE
    except MemoryError:
        say("There is not enough memory for this: choose a smaller picture, or close other programs.")
        return OUR_FAILURE
    except Exception:
        traceback.print_exc()
        return OUR_FAILURE
    finally:
        clear_gpu_caches()


def _stopped(stopped: StoppedError) -> int:
    if not is_supervised():  # (who stopped us then says so)
        say(str(stopped))
    return stopped.exit_code


def _drop_stdout() -> None:
    """What is still to be written there would fail again when Python ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


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
    subparsers = parser.add_subparsers(title="verbs", metavar="VERB", required=True, parser_class=_Parser)

    def verb(name: str, action: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
        sub = subparsers.add_parser(name, help=text, description=text)
        sub.set_defaults(run=action)
        return sub

    demo = verb("demo", verbs.demo, "Build the demo scene and compare its picture with Cycles and EEVEE.")
    demo.add_argument("--output", default="output/demo", metavar="DIR", help="folder to write to (%(default)s)")

    test = verb("test", verbs.test, "Check the source and run all tests, or one layer of tests.")
    test.add_argument(
        "layers",
        nargs="*",
        metavar="LAYER",
        help=f"{', '.join(verbs.LAYERS)}; all of them where none is named; or {verbs.AWKWARD} with names of scenes",
    )
    test.add_argument("--keep", metavar="DIR", help=f"keep the pictures of {verbs.AWKWARD} scenes in this folder")

    render = verb(
        "render", verbs.render, "Render a picture of a .blend file with true reflections on the named mirrors."
    )
    add_scene_options(render)
    add_settings(render, "render")
    render.add_argument(
        "--passes",
        default="color",
        metavar="P[,P..]",
        help=f"of {', '.join(verbs.PASSES)}; all but color go to NAME_PASS.exr beside the output (%(default)s)",
    )
    render.add_argument(
        "--multilayer",
        action="store_true",
        help="all passes into the output, an .exr with channels named as in Blender's multilayer files",
    )
    render.add_argument("--output", required=True, metavar="FILE", help=".png (as shown) or .exr (scene-linear)")

    film = verb("film", film_verb.film, "Render a .blend file in EEVEE with true reflections on its mirrors.")
    add_scene_options(film, is_marked=True)
    add_settings(film, "render")
    film.add_argument("--layers", action="store_true", help="also NAME_layers.exr: film, EEVEE, held out, mirrors")
    film.add_argument(
        "--output",
        required=True,
        metavar="FILE|DIR",
        help=f"{', '.join(film_verb.SUFFIXES)}, # for the frame's digits; or a folder, for files as the scene has them",
    )

    compare = verb("compare", verbs.compare, "Compare methods with Cycles, and with EEVEE and quick Cycles as peers.")
    add_scene_options(compare)
    add_comparison(compare)
    compare.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    merge = verb("merge", sequence_verbs.merge, "Make the report over frames that were compared, wherever that was.")
    sequence_verbs.add_merge(merge)

    chunk = verb(
        "chunk",
        farm_verbs.chunk,
        "Compare some frames of a comparison, wherever that is: those that are left. Merge makes the report of all.",
    )
    farm_verbs.add_chunk(chunk)

    farm = verb("farm", farm_verbs.job_type, "Write what render farms need for comparisons over frames.")
    farm_verbs.add_farm(farm, _Parser)

    chart = verb(
        "chart",
        charts.chart,
        "Chart time against error, of methods with all their settings, and against vertices; or against other amounts.",
    )
    chart.add_argument("files", nargs="*", metavar="FILE.blend", help="without, --against uses scenes of its own")
    chart.add_argument(
        "--against",
        metavar="A[,A..]",
        help=f"chart time and its slope against amounts in place of errors: of {', '.join(charts.AGAINST)}",
    )
    chart.add_argument(
        "--reflector", metavar="A[,B..]", help="names of the mirror objects in all files (those marked as mirrors)"
    )
    chart.add_argument("--resolution", type=resolution, metavar="WxH", help="in pixels (the scene's)")
    chart.add_argument("--method", metavar="M[,M..]", help="or all (all; five of them with --against)")
    add_reference_samples(chart, charts.OF_ERRORS["samples"], "of the references")
    chart.add_argument("--light", default="direct", metavar="L", help="direct or full, as for compare (%(default)s)")
    chart.add_argument("--peers", default=charts.OF_ERRORS["peers"], metavar="P[,P..]", help=PEERS_HELP)
    chart.add_argument(
        "--sub-frames",
        default=charts.OF_ERRORS["sub_frames"],
        metavar="N[,N..]",
        help="chart pictures of so many sub-frames, in place of what else each method can vary",
    )
    chart.add_argument(
        "--vertices",
        type=between(1000, 10_000_000),
        default=charts.OF_ERRORS["vertices"],
        metavar="N",
        help="largest number in the chart of time against vertices (%(default)s)",
    )
    chart.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    stability = verb("stability", verbs.stability, "Try methods where they fail: motion, contact, caustics, any input.")
    stability.add_argument(
        "--vertices",
        type=between(10, 100_000),
        default=400,
        metavar="N",
        help="per reflector and regime of the solver table (%(default)s)",
    )
    stability.add_argument(
        "--fuzz",
        type=between(1000, 100_000_000),
        default=1_000_000,
        metavar="N",
        help="random eyes, vertices and reflectors a method (%(default)s)",
    )
    stability.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    benchmark = verb(
        "benchmark", device_verbs.benchmark, "Measure vertex solves and mirror rays per second on this device."
    )
    benchmark.add_argument(
        "--vertices",
        type=between(1000, 10_000_000),
        default=10_000_000,
        metavar="N",
        help="largest number to solve (%(default)s)",
    )
    benchmark.add_argument(
        "--triangles",
        type=between(1000, 10_000_000),
        default=2_000_000,
        metavar="N",
        help="of the largest scene to follow rays in (%(default)s)",
    )
    benchmark.add_argument(
        "--calibrate", action="store_true", help="measure in two seconds what auto counts with, and nothing else"
    )
    benchmark.add_argument("--bandwidth", type=positive, metavar="GB/s", help="of the device's memory, to compare with")
    benchmark.add_argument("--flops", type=positive, metavar="TFLOP/s", help="of the device in float32, likewise")
    benchmark.add_argument(
        "--output", default="output/benchmark", metavar="DIR", help="folder to write to (%(default)s)"
    )

    text = "Make scenes with references that methods can be judged by, or judge results."
    dataset_verb.add_arguments(verb("dataset", dataset_verb.dataset, text))

    bake = verb("bake", verbs.bake, "Bake a reflector into cube maps and say how well they fit it.")
    bake.set_defaults(camera=None, frame=None, resolution=None)
    bake.add_argument("file", metavar="FILE.blend")
    bake.add_argument("--reflector", required=True, metavar="A", help="name of the mirror object")
    add_settings(bake, "bake")
    bake.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    design_verbs.add_anamorphosis(verb)

    build = verb("build", verbs.build, "Validate and pack the extension as a .zip to install in Blender.")
    build.add_argument("--output", default="dist", metavar="DIR", help="folder to write to (%(default)s)")

    check = verb("check", verbs.check, "Check the source by reading it: lint, types, imports, sizes, spelling.")
    check.add_argument("checks", nargs="*", metavar="CHECK", help="all of them where none is named")

    images = verb("images", verbs.images, "Make the pictures of the documents anew, in docs/images.")
    images.add_argument("images", nargs="*", metavar="NAME", help="all of them where none is named")

    release = verb("release", verbs.release, "Set the version, close the changelog, check, and pack the extension.")
    release.add_argument("version", metavar="VERSION", help="such as 0.2.0")
    release.add_argument("--tag", action="store_true", help="commit and tag it (never pushed)")
    release.add_argument("--images", action="store_true", help="make the pictures of the documents anew, too")
    release.add_argument("--output", default="dist", metavar="DIR", help="folder to write to (%(default)s)")
    return parser
