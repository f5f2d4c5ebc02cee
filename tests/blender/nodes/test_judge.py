# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The judge of node trees itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from nodes.judge import compared, judge_all

pytestmark = pytest.mark.usefixtures("gpu")


def test_constants_are_right_and_unknown_nodes_are_named() -> None:
    def constant(tree: Any) -> Any:
        node = tree.nodes.new("ShaderNodeRGB")
        node.outputs[0].default_value = (0.25, 0.5, 2.0, 1.0)
        return node.outputs[0]

    def unknown(tree: Any) -> Any:
        return tree.nodes.new("ShaderNodeWireframe").outputs[0]

    verdicts = judge_all({"constant": constant, "unknown": unknown})
    assert verdicts["constant"].is_right and not verdicts["constant"].notes
    np.testing.assert_allclose(verdicts["constant"].cycles[3, 5], (0.25, 0.5, 2.0))
    assert "Wireframe nodes" in verdicts["unknown"].notes[0]


def test_edges_may_be_a_pixel_off_and_slopes_may_not() -> None:
    x = np.broadcast_to(np.arange(48)[:, None], (48, 48, 3)).transpose(1, 0, 2)
    edge, moved = (x > 20) * 1.0, (x > 19) * 1.0
    verdict = compared(edge, moved * (x[..., :1].transpose(1, 0, 2) < 8) + edge * (x.transpose(1, 0, 2) >= 8))
    assert verdict.is_right and 0.0 < verdict.jumps < 0.01
    assert not compared(edge, moved).is_right
    assert not compared(x / 48.0, (x + 0.4) / 48.0).is_right
    assert not compared(edge, edge + 0.01).is_right
    assert compared(edge, edge + 0.003).is_right
