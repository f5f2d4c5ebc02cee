# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every proof is right here, and finds a device that is wrong; what is wrong goes another way."""

from __future__ import annotations

import subprocess
import sys
from ast import literal_eval
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.catalog import METHODS, REFRACTIONS
from curvrefl.curvrefl_addon.renderer.device.ways.features import FEATURES, Features, features
from curvrefl.curvrefl_addon.renderer.proofs.proof import Found, Proof, Work
from curvrefl.curvrefl_addon.renderer.proofs.proving import Proving, prove_all
from curvrefl.curvrefl_addon.renderer.proofs.table import FIRST, PROOFS
from curvrefl.curvrefl_addon.renderer.proofs.verdict import Failure, Verdict, known_verdict, take_verdict
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from proofs.broken import broken, by_compute
from scenes.mirror_room import Room
from scenes.radial_maps import SURFACES
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

BY_NAME = {proof.name: proof for proof in PROOFS}
LINE = "  WRITE_RECORD(reflection_points, index, vec4(solved.point, float(solved.status + 4 * solved.iterations)));"
SHIFTED = LINE.replace("solved.point,", "solved.point + vec3(0.01, 0.0, 0.0),")


@pytest.fixture(autouse=True)
def as_before() -> Iterator[None]:
    yield
    take_verdict(Verdict())


def of(*names: str) -> tuple[Proof, ...]:
    return tuple(BY_NAME[name] for name in names)


def test_all_is_right_here() -> None:
    proving = prove_all()
    assert proving.verdict.failures == (), proving.found
    assert proving.verdict.proven == tuple(BY_NAME) == tuple(proving.found)
    assert proving.verdict.sentence == ""
    assert features() == Features()


def test_every_solver_has_a_proof() -> None:
    solving = {name for name, entry in (METHODS | REFRACTIONS).items() if entry.solves_vertices}
    assert solving | {"exact"} == {method for proof in PROOFS for method in proof.methods}
    assert {feature for proof in PROOFS for feature in proof.features} == set(FEATURES)


@pytest.mark.parametrize("lacks", FEATURES)
def test_the_other_ways_are_right_too(lacks: str) -> None:
    before = Verdict(failures=(Failure("list", "", lacks),))
    proving = Proving(FIRST, before)
    assert before.features.missing == (lacks,)
    list(proving.work())
    assert [item for item in proving.verdict.failures if item.name != "list"] == []


BROKEN = {
    "a list with gaps": (
        ("imageAtomicAdd(straggler_count, ivec2(0), 1u)", "imageAtomicAdd(straggler_count, ivec2(0), 2u)"),
        {"list": "atomics"},
    ),
    "no atomics": (("imageAtomicAdd(straggler_count, ivec2(0), 1u)", "0u"), {"list": "atomics"}),
    "a list that is not read": (
        ("int(imageLoad(straggler_count, ivec2(0)).x)", "0"),
        {"newton": "atomics"},
    ),
    "a shader that does not compile": (
        by_compute("    uint place = imageAtomicAdd", "    uint place = no_such_function"),
        {"list": "atomics"},
    ),
    "points by compute": (by_compute(LINE, SHIFTED), {"newton": "compute", "secant_star": ""}),
    "normals by compute": (
        ("    WRITE_RECORD(corners, 2 * corner, first);", "    WRITE_RECORD(corners, 2 * corner, first.yxzw);"),
        {"records": "compute"},
    ),
    "copies by compute": (
        by_compute("  int index = record_from(range.y);", "  int index = record_from(range.y) & ~1;"),
        {"records": "compute"},
    ),
    "points by all ways": ((LINE, SHIFTED), {"newton": ""}),
    "vertices that deform": (
        ("fetch_three(mesh_positions, index - range.x)", "fetch_three(mesh_positions, index)"),
        {"records": ""},
    ),
    "boxes of what deforms": (
        ("min(record_of(child).xyz, record_of(child + 2).xyz)", "record_of(child).xyz"),
        {"fits": "fits"},
    ),
    "rows of quads": (("dFdy(row)", "dFdx(row)"), {"quads": "quads"}),
    "derivatives": (("dFdx(here.z)", "0.5 * dFdx(here.z)"), {"quads": "quads"}),
    "what rays hit": (
        ("          hit.range = range;", "          hit.range = 1.001 * range;"),
        {"rays": "", "fits": ""},
    ),
    "which triangles rays hit": (
        ("place.y >= -OVERLAP &&", "place.y >= 0.1 &&"),
        {"rays": "", "fits": ""},
    ),
    "light": (
        ("vec3 sum = emission_of(s, lobes) + lamps_on", "vec3 sum = emission_of(s, lobes) + 1.05 * lamps_on"),
        None,
    ),
    "paths": (("s.weight = s.pdf > 0.0 ? value", "s.weight = s.pdf > 0.0 ? 1.05 * value"), {"paths": ""}),
    "materials": (("sin(dot(P(0).xyz, s.position))", "sin(dot(P(0).xyz, 1.1 * s.position))"), None),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_wrong_is_found(name: str) -> None:
    """And goes another way, if there is one that is right."""
    (text, wrong), expected = BROKEN[name]
    expected = {"pictures": ""} if expected is None else expected
    proofs = tuple(item for item in FIRST if item.name != "pictures")
    if expected.keys() & {"pictures", "paths"}:
        proofs = of(*expected)
    if "secant_star" in expected:
        proofs += of("secant_star")
        # Once compute shaders are given up it is right.
        expected = {key: value for key, value in expected.items() if value}
    with broken(text, wrong):
        verdict = prove_all(proofs).verdict
    is_lacking = any(verdict.features.missing) or verdict.features.distrusted
    assert features() == Features() and take_verdict(verdict) == bool(is_lacking)
    assert not take_verdict(verdict) and known_verdict() is verdict
    assert {item.name: item.without for item in verdict.failures} == expected
    assert set(features().missing) == {value for value in expected.values() if value}
    wrong = {key for key, value in expected.items() if not value}
    assert features().distrusted == {method for key in wrong for method in BY_NAME[key].methods}
    assert all(item.words for item in verdict.failures)
    sentence = verdict.sentence
    assert sentence.count(". ") == 0 and sentence.endswith(".")
    assert all(BY_NAME[key].subject in sentence for key in expected)
    assert ("another way" in sentence) == any(expected.values())
    assert Verdict.from_json(verdict.as_json()) == verdict


def test_each_method_is_proven_by_its_own_shader() -> None:
    """Points that are shifted are found whatever the method."""
    searching = [proof for proof in PROOFS if proof.methods and proof.name not in ("rays", "newton")]
    with broken(*by_compute(LINE, SHIFTED)):
        found = {}
        for proof in searching:
            proving = Proving((proof,))
            list(proving.work())
            found[proof.name] = [item.without for item in proving.verdict.failures]
    assert found == {proof.name: ["compute"] for proof in searching}


def test_auto_solves_no_points_that_are_wrong() -> None:

    room = Room()
    room.add_mirror(SURFACES["sphere"], 64)
    room.add_rectangle((0.0, 0.0, -1.5), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    renderer = Renderer(room.arrays(), Settings(method="auto", samples=1))
    view = look_at(np.array([0.0, -3.0, 1.0]), np.zeros(3), 1200, 900, np.radians(60))
    try:
        chosen = renderer.reflect(view).choice
        assert chosen is not None and chosen.methods == ("newton",)
        assert take_verdict(Verdict(failures=(Failure("newton", "off"),)))
        chosen = renderer.reflect(view).choice
        assert chosen is not None and chosen.methods == ("exact",)
        assert "gets reflection points wrong: rays are followed" in chosen.why
    finally:
        renderer.free()


def _stub(results: list[float], seen: list[Features]) -> Work:
    seen.append(features())
    yield
    seen.append(features())
    yield
    return Found(results.pop(0), 1.0, "units")


def test_others_draw_as_before_between_slices() -> None:
    """A proof that tries another way has it in its own slices alone, also when it is canceled."""
    seen: list[Features] = []
    results = [2.0, 0.5]
    proof = Proof("quads", "something", lambda: _stub(results, seen), ("quads",))
    proving = Proving((proof,))
    between = []
    for _ in proving.work():
        between.append(features())
    assert between == [Features()] * 4
    assert [item.quads for item in seen] == [True, True, False, False]
    assert features() == Features()
    assert proving.verdict.features.missing == ("quads",)
    assert proving.found == {"quads": "off by 0.5 units, 1 allowed, without quads"}
    assert proving.verdict.failures == (Failure("quads", "off by 2 units, 1 allowed", "quads"),)

    work = Proving((Proof("quads", "", lambda: _stub([2.0], seen), ("quads",)),)).work()
    next(work)
    work.close()  # type: ignore[attr-defined]
    assert features() == Features()


def test_what_is_not_a_number_is_wrong() -> None:
    assert not Found(float("nan"), 1.0, "").is_right
    assert not Found(float("inf"), 1.0, "").is_right
    assert Found(0.0, 0.0, "").is_right


@pytest.mark.parametrize("kept", [{}, {"proven": 3, "failures": {}}, {"proven": [], "failures": {"list": 1}}])
def test_what_was_not_kept_by_us_is_refused(kept: dict[str, object]) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        Verdict.from_json(kept)
    with pytest.raises(ValueError, match="nothing that a device has"):
        Verdict.from_json({"proven": [], "failures": {"list": {"words": "", "without": "luck"}}})
    gone = {"proven": ["gone", "list"], "failures": {"gone": {"words": "", "without": ""}}}
    assert Verdict.from_json(gone) == Verdict(("list",))


def test_a_session_whose_device_is_known_imports_no_proof() -> None:
    code = (
        "import sys; sys.path.insert(0, 'tools'); import bootstrap; bootstrap.load_package(); import bpy;"
        "import curvrefl.curvrefl_addon.viewport.device_run;"
        "print([name.rpartition('.')[2] for name in sys.modules if 'renderer.proofs.' in name])"
    )
    root = Path(__file__).resolve().parents[3]
    found = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True)
    assert set(literal_eval(found.stdout.splitlines()[-1])) == {"proof", "proving", "report", "table", "verdict"}
