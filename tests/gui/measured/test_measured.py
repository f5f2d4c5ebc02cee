# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A device is measured at its first use in a window: by and by, unseen, once."""

from __future__ import annotations

from pathlib import Path

import pytest
from curvrefl.curvrefl_addon.renderer.costs.table import SHIPPED, Costs
from curvrefl.curvrefl_addon.renderer.proofs.table import PROOFS
from small_scene import saved
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "measured_session.py"


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    folder = tmp_path_factory.mktemp(request.param)
    small = saved(folder, lambda _ball: None)
    found = in_window(SCRIPT, folder, small, folder, backend=request.param)
    assert not found.seen["error"], found.seen["error"]
    assert "Traceback" not in found.printed, found.printed[-3000:]
    return found


def test_it_is_spread_over_redraws_and_kept(session: Session) -> None:
    seen = session.seen
    assert seen["running"]["running"] and "..." in seen["running"]["rows"]["Measured"]
    measured = seen["measured"]
    assert not measured["running"] and measured["messages"] == [] and measured["enabled"]
    (content,) = seen["kept"]
    (entry,) = content["devices"]
    # Before and after that all results have been proven.
    (proofs,) = content["proofs"]
    assert proofs["proven"] == [proof.name for proof in PROOFS] and proofs["failures"] == {}
    assert f"{len(PROOFS)} of {len(PROOFS)} proofs are right" == measured["rows"]["Results"]
    assert Costs(**entry["costs"]).pixel_by_ray == measured["costs"] != SHIPPED.pixel_by_ray
    assert entry["device"]["renderer"] == measured["rows"]["Device"]
    assert entry["measured"][:10] == measured["rows"]["Measured"][:10]


def test_another_file_ends_it_and_it_begins_anew(session: Session) -> None:
    assert not session.seen["another file"]["running"]
    assert session.seen["another file"]["costs"] == SHIPPED.pixel_by_ray
    assert session.seen["first slice of another file"] == 1


def test_it_does_not_show(session: Session) -> None:
    assert session.seen["picture"]["same"]


def test_it_is_done_once_and_can_be_forgotten(session: Session) -> None:
    seen = session.seen
    assert seen["slices again"] == 0 and seen["again"]["costs"] == seen["measured"]["costs"]
    assert seen["forgot"] == ["FINISHED"] and seen["forgotten"]["costs"] == SHIPPED.pixel_by_ray
    assert seen["forgotten"]["rows"]["Measured"] == "Not yet"
