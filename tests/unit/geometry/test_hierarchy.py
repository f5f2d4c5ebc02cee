# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies hold every item once, in boxes that hold it, whatever the input."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.rays.hierarchy import Boxes, Hierarchy
from curvrefl.curvrefl_addon.renderer.rays.hierarchy_build import (
    HEURISTIC_LEVELS,
    LEAF,
    HierarchyBuild,
    build,
    build_all,
    build_all_quickly,
    build_quickly,
    quick_steps,
)

BUILDS = {"best": build, "quick": build_quickly}


def boxes_about(centers: np.ndarray, half: np.ndarray | float) -> Boxes:
    return (centers - half).astype(np.float32), (centers + half).astype(np.float32)


def cloud(count: int, scale: float = 1.0) -> Boxes:
    rng = np.random.default_rng(count)
    return boxes_about(scale * rng.normal(size=(count, 3)), scale * 0.1 * rng.random((count, 3)))


def many_scales() -> Boxes:
    """Sizes and distances from 1e-4 to 1e4."""
    rng = np.random.default_rng(1)
    return boxes_about(
        rng.normal(size=(3000, 3)) * 10.0 ** rng.uniform(-4, 4, (3000, 1)), 10.0 ** rng.uniform(-4, 4, (3000, 1))
    )


def flat() -> Boxes:
    low, high = cloud(2000)
    low[:, 2] = high[:, 2] = 0.5
    return low, high


def halving() -> Boxes:
    """Each item half as far as the one before: splits that take off one item at a time."""
    return boxes_about(np.outer(0.5 ** np.arange(120.0), [1.0, 1.0, 1.0]), 0.0)


CASES: dict[str, Callable[[], Boxes]] = {
    "one": lambda: cloud(1),
    "two": lambda: cloud(2),
    "a leaf and one": lambda: cloud(LEAF + 1),
    "cloud": lambda: cloud(5000),
    "tiny": lambda: cloud(2000, 1e-4),
    "huge": lambda: cloud(2000, 1e4),
    "all the same point": lambda: boxes_about(np.ones((1000, 3)), 0.0),
    "all the same box": lambda: boxes_about(np.zeros((1000, 3)), 1.0),
    "flat": flat,
    "a line": lambda: boxes_about(np.outer(np.arange(1000.0), [1.0, 0.0, 0.0]), 0.0),
    "halving": halving,
    "many scales": many_scales,
}


def check(tree: Hierarchy, low: np.ndarray, high: np.ndarray) -> None:
    items, nodes = len(low), len(tree.link)
    is_leaf = tree.count > 0
    inner = np.flatnonzero(~is_leaf)
    # Every item in exactly one leaf.
    np.testing.assert_array_equal(np.sort(tree.order), np.arange(items))
    leaves = np.flatnonzero(is_leaf)
    held = np.concatenate([tree.link[n] + np.arange(tree.count[n]) for n in leaves])
    np.testing.assert_array_equal(np.sort(held), np.arange(items))
    assert tree.count.max() <= LEAF
    # Every node but the root is the child of one node, which comes before it.
    children = np.concatenate([tree.link[inner], tree.link[inner] + 1])
    np.testing.assert_array_equal(np.sort(children), np.arange(1, nodes))
    assert (tree.link[inner] > inner).all()
    assert np.isfinite(tree.low).all() and np.isfinite(tree.high).all()
    assert np.isfinite(tree.cost())
    for child in (tree.link[inner], tree.link[inner] + 1):
        assert (tree.low[inner] <= tree.low[child]).all() and (tree.high[inner] >= tree.high[child]).all()
    of_item = np.repeat(leaves, tree.count[leaves])
    assert (tree.low[of_item] <= low[tree.order[held]]).all()
    assert (tree.high[of_item] >= high[tree.order[held]]).all()
    # No larger than it must be.
    np.testing.assert_array_equal(tree.low[0], low.min(axis=0))
    np.testing.assert_array_equal(tree.high[0], high.max(axis=0))
    # By the heuristic, then by number: of the quick build twice by number.
    assert tree.depth <= 1 + HEURISTIC_LEVELS + 2 * int(np.ceil(np.log2(items + 1)))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("way", BUILDS)
def test_a_tree_holds_all_items_once_in_boxes_that_hold_them(case: str, way: str) -> None:
    low, high = CASES[case]()
    with np.errstate(invalid="raise", divide="raise"):
        tree = BUILDS[way](low, high)
    check(tree, low, high)


@pytest.mark.parametrize("way", BUILDS)
def test_fitted_boxes_are_those_of_the_items(way: str) -> None:
    tree = BUILDS[way](*cloud(3000))
    rng = np.random.default_rng(9)
    low, high = boxes_about(rng.normal(size=(3000, 3)) * 3.0, 0.2)
    fitted = tree.fitted(low, high)
    check(fitted, low, high)
    np.testing.assert_array_equal(fitted.link, tree.link)
    # Boxes that have not changed give the tree back.
    same = tree.fitted(*cloud(3000))
    np.testing.assert_array_equal(same.low, tree.low)
    np.testing.assert_array_equal(same.high, tree.high)


def test_a_build_in_steps_is_the_build_at_once() -> None:
    low, high = cloud(5000)
    growth = HierarchyBuild(low, high)
    steps = 0
    while growth.step():
        steps += 1
    stepped, whole = growth.finished(), build(low, high)
    assert steps > np.log2(5000 / LEAF)
    np.testing.assert_array_equal(stepped.order, whole.order)
    np.testing.assert_array_equal(stepped.link, whole.link)


def test_the_heuristic_pays() -> None:
    """The better build expects less of a ray, both far less than leaves of items at random."""
    low, high = cloud(5000)
    best, quick = build(low, high), build_quickly(low, high)
    shuffled = np.random.default_rng(0).permutation(5000)
    assert best.cost() <= quick.cost() < 0.2 * best.fitted(low[shuffled], high[shuffled]).cost()


@pytest.mark.parametrize(("one", "many"), [(build, build_all), (build_quickly, build_all_quickly)])
def test_trees_that_grow_side_by_side_are_those_that_grow_alone(
    one: Callable[..., Hierarchy], many: Callable[..., list[Hierarchy]]
) -> None:
    """Of sizes from one item to thousands, deep ones beside flat ones."""
    boxes = [case() for case in CASES.values()]
    for (low, high), together in zip(boxes, many(boxes), strict=True):
        check(together, low, high)
        alone = one(low, high)
        assert together.levels == alone.levels
        for name in ("order", "link", "count", "low", "high"):
            np.testing.assert_array_equal(getattr(together, name), getattr(alone, name), err_msg=name)


def test_a_quick_build_in_steps_is_the_build_at_once() -> None:
    """Its steps are many, so that none takes long, and in each only a share of all there is to do is done."""
    low, high = cloud(20_000)
    steps = quick_steps([(low, high)])
    count = 0
    while True:
        try:
            next(steps)
        except StopIteration as end:
            (stepped,) = end.value
            break
        count += 1
    whole = build_quickly(low, high)
    assert count > 15
    check(stepped, low, high)
    for name in ("order", "link", "count", "low", "high"):
        np.testing.assert_array_equal(getattr(stepped, name), getattr(whole, name))
