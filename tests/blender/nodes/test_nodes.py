# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node in every mode, and random trees: drawn as Cycles draws them, or named among what is not."""

from __future__ import annotations

import pytest
from nodes.judge import judge_all
from nodes.page import PAGE
from nodes.random_trees import random_trees
from nodes.table import BATCHES, judged_rows
from nodes.trees import Row

pytestmark = pytest.mark.usefixtures("gpu")
SLOW = ("Noise Texture", "Voronoi Texture")
"""Nodes whose shaders take long to compile: one tree of each mode will do here"""


@pytest.mark.parametrize("batch", BATCHES)
def test_no_node_is_silently_wrong(batch: str) -> None:
    rows = [Row(row.node, row.mode, row.trees[:1]) if row.node in SLOW else row for row in BATCHES[batch]]
    wrong = [
        f"{judged.row.node}, {judged.row.mode}: {'; '.join(map(str, judged.verdicts))}"
        for judged in judged_rows(rows)
        if judged.is_silently_wrong
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("batch", ["inputs", "vectors"])
def test_no_node_is_silently_wrong_on_backs(batch: str) -> None:
    # (On backs Cycles mirrors slopes of attributes, in one direction: its differences are those of the front.)
    judged = judged_rows((row for row in BATCHES[batch] if row.node != "Bump"), is_back=True)
    wrong = [f"{item.row.node}, {item.row.mode}: {item.error}" for item in judged if item.is_silently_wrong]
    assert not wrong, "\n".join(wrong)


def test_no_random_tree_is_silently_wrong() -> None:
    """(tools/nodes/judge_random_trees.py judges 500.)"""
    verdicts = judge_all(random_trees(0, 40))
    wrong = [f"{name}: {verdict}" for name, verdict in verdicts.items() if verdict.is_silently_wrong]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("batch", BATCHES)
def test_page_has_all_nodes_and_modes(batch: str) -> None:
    lines = {line.split(" | ")[0].removeprefix("| "): line for line in PAGE.read_text(encoding="utf-8").splitlines()}
    missing = [f"{row.node}, {row.mode}" for row in BATCHES[batch] if row.mode not in lines.get(row.node, "")]
    assert not missing, f"call tools/nodes/write_nodes.py: {missing} missing"
