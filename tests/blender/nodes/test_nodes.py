# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node in every mode: drawn as Cycles draws it, or named among what is not."""

from __future__ import annotations

import pytest
from nodes.table import BATCHES, judged_rows

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize("batch", BATCHES)
def test_no_node_is_silently_wrong(batch: str) -> None:
    wrong = [
        f"{judged.row.node}, {judged.row.mode}: {'; '.join(map(str, judged.verdicts))}"
        for judged in judged_rows(BATCHES[batch])
        if judged.is_silently_wrong
    ]
    assert not wrong, "\n".join(wrong)
