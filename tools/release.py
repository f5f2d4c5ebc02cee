# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a release of the source: version, changelog, checks, pack. Nothing is pushed, and tagged only on request."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import bootstrap  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.errors import InputError  # noqa: E402
from curvrefl.curvrefl_addon.output import folder_to_publish, write_whole  # noqa: E402
from curvrefl.curvrefl_addon.supervised import ended_softly  # noqa: E402

MANIFEST = "blender_manifest.toml"
CHANGELOG = "CHANGELOG.md"
UNRELEASED = "## [Unreleased]"
_NUMBER = r"(?:0|[1-9]\d{0,5})"
_VERSION = re.compile(rf"{_NUMBER}\.{_NUMBER}\.{_NUMBER}")
_MANIFEST_LINE = re.compile(r'^version = "([^"]*)"$', re.MULTILINE)


def release(version: str, output: Path, tag: bool = False, images: bool = False) -> Path:
    """Set the version, close the changelog's section, check, pack into `output`; with `tag` commit and tag.

    With `images` the pictures of the documents are made anew. Returns the pack. Raises InputError, with nothing
    changed, for a version that cannot be released and for a source with changes of its own or that fails its checks.
    """
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in (MANIFEST, CHANGELOG)}
    _require_version(version, texts)
    _require_clean(version)
    if tag:
        _require_identity()
    texts = {MANIFEST: with_version(texts[MANIFEST], version), CHANGELOG: closed(texts[CHANGELOG], version)}
    with _changed(texts), folder_to_publish(output) as folder:
        package = _checked_and_packed(folder)
        if images:
            import make_images

            make_images.make(list(make_images.IMAGES))
        if tag:
            _git("commit", "--quiet", "--all", "--message", f"Version {version}")
            _git("tag", f"v{version}")
    return output / package


def with_version(manifest: str, version: str) -> str:
    """The manifest's text with this version."""
    return _MANIFEST_LINE.sub(f'version = "{version}"', manifest, count=1)


def closed(changelog: str, version: str) -> str:
    """The changelog's text, its Unreleased changes under the version and today's date. Raises InputError for none."""
    before, _, after = changelog.partition(UNRELEASED)
    changes = re.split(r"^## ", after, maxsplit=1, flags=re.MULTILINE)[0]
    if not re.search(r"^\* |^- ", changes, re.MULTILINE):
        raise InputError(f"{CHANGELOG} lists no unreleased change: write what is new under {UNRELEASED} first.")
    return f"{before}{UNRELEASED}\n\n## [{version}] - {date.today().isoformat()}{after}"


def _require_version(version: str, texts: dict[str, str]) -> None:
    if not _VERSION.fullmatch(version):
        raise InputError(f'"{version}" is not a version like 0.2.0.')
    found = _MANIFEST_LINE.search(texts[MANIFEST])
    if found is None:
        raise InputError(f"{MANIFEST} has no line with a version.")
    if f"## [{version}]" in texts[CHANGELOG]:
        raise InputError(f"Version {version} has been released already, {CHANGELOG} says: choose a higher one.")
    if _numbers(version) < _numbers(found[1]):
        raise InputError(f"Version {version} is lower than {found[1]}, which {MANIFEST} has: choose a higher one.")


def _numbers(version: str) -> list[int]:
    return [int(number) for number in version.split(".")]


def _require_clean(version: str) -> None:
    try:
        changes = _git("status", "--porcelain")
        tags = _git("tag", "--list", f"v{version}")
    except (OSError, subprocess.CalledProcessError) as error:
        raise InputError("A release needs a git repository, and git: make it in a clone of the source.") from error
    if changes:
        raise InputError("The source has changes that are not committed: commit them, or put them away, first.")
    if tags:
        raise InputError(f"There is a tag v{version} already: choose a higher version.")


def _require_identity() -> None:
    try:
        _git("var", "GIT_COMMITTER_IDENT")
    except subprocess.CalledProcessError as error:
        raise InputError("git does not know who commits: set user.name and user.email first.") from error


def _git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


@contextmanager
def _changed(texts: dict[str, str]) -> Iterator[None]:
    """The files with these texts, which they lose again where something fails."""
    before = {name: (ROOT / name).read_text(encoding="utf-8") for name in texts}
    with ended_softly():
        handler = signal.signal(signal.SIGTERM, signal.default_int_handler)
        try:
            for name, text in texts.items():
                write_whole(ROOT / name, text)
            yield
        except BaseException:
            for name, text in before.items():
                write_whole(ROOT / name, text)
            raise
        finally:
            signal.signal(signal.SIGTERM, handler)


def _checked_and_packed(folder: Path) -> str:
    """Check the source and pack it, validated, into `folder`. Raises InputError where a check fails."""
    import build_extension
    from checks import source

    run: Callable[[], int] = source.run
    if run() != 0:
        raise InputError("The source fails its checks, see above: mend it, then release.")
    return build_extension.build(folder).name
