# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of a picture's parts."""

from __future__ import annotations

from curvrefl.curvrefl_addon.design.anamorphosis.placed import Landing


def test_nothing_is_said_of_what_is_not() -> None:
    assert Landing(1.0, 0.0, 0.0, 0.0, 4e-4).sentences('"Paper"') == ['100.0 % of the picture is on "Paper".']


def test_the_largest_other_things_are_named() -> None:
    others = {f"Thing {number}": 0.1 - 0.01 * number for number in range(8)}
    found = Landing(0.2, 0.0, 0.15, 0.01, 0.1, others).sentences('"Paper" and "Wall"')
    assert found == [
        '20.0 % of the picture is on "Paper" and "Wall".',
        "15.0 % shows the background.",
        '10.0 % lands on "Thing 0".',
        '9.0 % lands on "Thing 1".',
        '8.0 % lands on "Thing 2".',
        '7.0 % lands on "Thing 3".',
        '6.0 % lands on "Thing 4".',
        "12.0 % lands on other things.",
        "1.0 % would be where another part of it is seen, too.",
        "10.0 % lands past the edges of the image.",
    ]
