# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenEXR files with any channels: the same numbers back, the same bytes again, and what is no such file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from curvrefl.curvrefl_addon.study.dataset.exr_layers import load_layers, save_layers
from curvrefl.curvrefl_addon.written_files import require_whole


@pytest.mark.parametrize("size", [(1, 1), (16, 5), (37, 53)])
def test_what_is_written_is_read_bit_for_bit(size: tuple[int, int], tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    channels = {
        name: random.normal(size=size).astype(np.float32) for name in ("L.b.X", "L.a.Y", "L.Long name of a pass.Z")
    }
    channels["L.flat"] = np.full(size, 1e10, np.float32)
    channels["L.a.Y"][0, 0] = np.nan
    path, again = tmp_path / "a.exr", tmp_path / "b.exr"
    save_layers(path, channels, {"said": "text"})
    require_whole(path)
    found = load_layers(path)
    assert set(found) == set(channels)
    for name, values in channels.items():
        np.testing.assert_array_equal(found[name], values)
    save_layers(again, dict(reversed(channels.items())), {"said": "text"})
    assert path.read_bytes() == again.read_bytes()


def test_another_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    for content in (b"", b"no picture", b"\x76\x2f\x31\x01" + bytes(40)):
        path.write_bytes(content)
        with pytest.raises(OSError, match="is not a file of passes"):
            load_layers(path)
