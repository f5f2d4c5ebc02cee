# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds a full Blender that can open a window, or makes one: what the gui tests run in.

In this order:

1. the application that `$BLENDER` names, on a virtual screen (xvfb-run) or, without one, on the display there is;
2. the command that `$CURVREFL_WINDOW_BLENDER` names, which brings its own screen;
3. a Debian unstable root with Blender and a virtual screen, made once in the user's cache folder (about 2 GB; needs
   Linux, root's rights and a Debian mirror). It is entered in a mount namespace of its own, so that nothing stays
   mounted however the run ends.

`python tools/window_blender.py ARGUMENTS..` runs that Blender.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
ENTER = REPOSITORY / "tools" / "enter_root.sh"
VARIABLE = "CURVREFL_WINDOW_BLENDER"
LEAST_VERSION = (5, 2)
SCREEN = ("xvfb-run", "-a", "-s", "-screen 0 1280x800x24")

SUITE = "sid"
FALLBACK_MIRROR = "http://deb.debian.org/debian"
PACKAGES = (
    "blender",
    "libgl1-mesa-dri",
    "libegl1",
    "mesa-vulkan-drivers",
    "xvfb",
    "xauth",
    "imagemagick",
    "python3-numpy",
    # Blender's extensions import these two.
    "python3-cattr",
    "python3-requests",
)
STAMP = "curvrefl-made.txt"
"""In the root, written last: says that it is whole, and from which recipe"""
FREE_BYTES = 4 * 10**9
STEP_SECONDS = 900
"""For each of the downloads; two minutes are usual"""


class NoWindowBlenderError(Exception):
    """There is no Blender that opens a window, and none can be made; the message says why."""


@dataclass(frozen=True)
class WindowBlender:
    """Command lines to which Blender's own arguments are added. They see the repository and the temporary folder."""

    windowed: tuple[str, ...]
    """Opens a window"""
    headless: tuple[str, ...]
    """For `--background` and `--command`: without a screen, where that is known to work"""


def find_or_make() -> WindowBlender:
    """The first that works of what the module names; raises NoWindowBlenderError, with a reason fit for a report."""
    if application := os.environ.get("BLENDER"):
        return _application(application)
    if command := os.environ.get(VARIABLE):
        parts = tuple(shlex.split(command))
        if not parts or shutil.which(parts[0]) is None:
            raise NoWindowBlenderError(f"{VARIABLE} is '{command}', which is not a program")
        return WindowBlender(parts, parts)
    return _debian(_cache_folder())


def _application(application: str) -> WindowBlender:
    path = shutil.which(application)
    if path is None:
        raise NoWindowBlenderError(f"BLENDER is '{application}', which is not a program")
    _require_version([path])
    if shutil.which(SCREEN[0]):
        return WindowBlender((*SCREEN, path), (path,))
    has_display = sys.platform in ("darwin", "win32") or {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys()
    if not has_display:
        raise NoWindowBlenderError("there is no display for BLENDER's window, and no xvfb-run to make a virtual one")
    return WindowBlender((path,), (path,))


def _require_version(command: Sequence[str]) -> None:
    result = subprocess.run([*command, "--version"], capture_output=True, text=True)
    match = re.search(r"Blender (\d+)\.(\d+)", result.stdout)
    if match is None:
        raise NoWindowBlenderError(f"{shlex.join(command)} --version does not answer: {_last_line(result)}")
    version = (int(match[1]), int(match[2]))
    if version < LEAST_VERSION:
        raise NoWindowBlenderError(f"{shlex.join(command)} is Blender {match[1]}.{match[2]}, and 5.2 is needed")


def _cache_folder() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "curvrefl"


def _debian(cache: Path) -> WindowBlender:
    """The Debian root in this folder, made where it is not there or not whole."""
    _require_rights()
    try:
        cache.mkdir(parents=True, exist_ok=True)
        root = cache / f"debian-{SUITE}"
        lock = os.open(cache, os.O_RDONLY)
    except OSError as error:
        raise NoWindowBlenderError(f"the cache folder {cache} cannot be used: {error.strerror}") from error
    try:
        # Two starts at once take turns; the kernel lets go of the lock however this process ends.
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not _is_whole(root):
            _make(root)
    finally:
        os.close(lock)
    return WindowBlender(
        (*_entered(root), *SCREEN, "blender"),
        (*_entered(root), "blender"),
    )


def _require_rights() -> None:
    if sys.platform != "linux":
        raise NoWindowBlenderError(f"no Debian root can be made on {sys.platform}: name a Blender in BLENDER")
    if os.geteuid() != 0:
        raise NoWindowBlenderError("a Debian root can be made by root only: name a Blender in BLENDER")
    for tool in ("setpriv", "unshare", "mount", "chroot"):
        if shutil.which(tool) is None:
            raise NoWindowBlenderError(f"a Debian root needs the program {tool}")
    result = subprocess.run([*_namespace(), "true"], capture_output=True, text=True)
    if result.returncode != 0:
        raise NoWindowBlenderError(f"nothing can be mounted here: {_last_line(result)}")


def _namespace() -> tuple[str, ...]:
    """Mounts and processes end with the command, and the command with what called it, also when that is killed."""
    return (
        "setpriv",
        "--pdeathsig",
        "KILL",
        "unshare",
        "--mount",
        "--propagation",
        "private",
        "--pid",
        "--fork",
        "--kill-child",
    )


def _entered(root: Path) -> tuple[str, ...]:
    """Start of a command line that runs in the root and sees the repository and the temporary folder."""
    folders = {str(Path(tempfile.gettempdir()).resolve()), "/tmp", str(REPOSITORY)}
    return (*_namespace(), str(ENTER), str(root), *sorted(folders), "--")


def _recipe() -> str:
    return hashlib.sha256(" ".join((SUITE, *PACKAGES)).encode()).hexdigest()


def _is_whole(root: Path) -> bool:
    stamp = root / STAMP
    return stamp.is_file() and stamp.read_text(encoding="utf-8") == _recipe()


def _make(root: Path) -> None:
    """Make the root beside its place and move it there when it is whole."""
    part = root.with_name(f"{root.name}.part")
    for old in (part, root):
        _remove(old)
    free = shutil.disk_usage(root.parent).free
    if free < FREE_BYTES:
        raise NoWindowBlenderError(f"a Debian root needs {FREE_BYTES / 1e9:.0f} GB: {root.parent} has {free / 1e9:.1f}")
    _require_debootstrap()
    mirror, settings = _mirror(), _proxy_settings()
    _say("curvrefl: making a Debian root with Blender for the gui tests, once (about 2 GB, a few minutes) ...")
    start = time.monotonic()
    try:
        environment = {**os.environ, **_proxy_variables(settings)}
        bootstrap = (*_namespace(), "debootstrap", "--variant=minbase", SUITE, str(part), mirror)
        _step("debootstrap", bootstrap, environment)
        lines = [*settings, "# A mirror may be a frozen copy.", 'Acquire::Check-Valid-Until "false";', ""]
        (part / "etc/apt/apt.conf.d/99curvrefl").write_text("\n".join(lines), encoding="utf-8")
        # Where Blender looks for disks
        (part / "etc/mtab").symlink_to("/proc/self/mounts")
        clean = {"DEBIAN_FRONTEND": "noninteractive", "PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"}
        inside = (*_namespace(), str(ENTER), str(part), "--")
        _step("apt-get update", (*inside, "apt-get", "update"), clean)
        install = ("apt-get", "install", "-y", "--no-install-recommends", *PACKAGES)
        _step("apt-get install", (*inside, *install), clean)
        _step("apt-get clean", (*inside, "apt-get", "clean"), clean)
        _require_version([*inside, "blender"])
        (part / STAMP).write_text(_recipe(), encoding="utf-8")
        part.rename(root)
    except BaseException:
        _remove(part)
        raise
    _say(f"curvrefl: {root} made in {time.monotonic() - start:.0f} s")


def _remove(folder: Path) -> None:
    """Delete a root; never what is mounted in it."""
    if not folder.exists():
        return
    mounted = [line.split()[1] for line in Path("/proc/self/mounts").read_text(encoding="utf-8").splitlines()]
    inside = [place for place in mounted if place == str(folder) or place.startswith(f"{folder}/")]
    if inside:
        raise NoWindowBlenderError(f"{inside[0]} is mounted, so that {folder} cannot be made anew: unmount it")
    # As in the namespaces of others.
    subprocess.run(["rm", "-rf", "--one-file-system", str(folder)], check=True)


def _require_debootstrap() -> None:
    if shutil.which("debootstrap"):
        return
    reason = "a Debian root needs debootstrap"
    if shutil.which("apt-get") is None:
        raise NoWindowBlenderError(reason)
    _say("curvrefl: installing debootstrap ...")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    install = ("apt-get", "install", "-y", "--no-install-recommends", "debootstrap")
    try:
        _step(reason, install, environment)
    except NoWindowBlenderError:
        # (a machine on which no list of packages was fetched yet)
        _step(reason, ("apt-get", "update"), environment)
        _step(reason, install, environment)


def _step(name: str, command: Sequence[str], environment: Mapping[str, str]) -> None:
    """Run a command to its end; NoWindowBlenderError with the last thing it said where it fails."""
    try:
        result = subprocess.run(
            command,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=STEP_SECONDS,
        )
    except subprocess.TimeoutExpired as error:
        raise NoWindowBlenderError(f"{name}: not done after {STEP_SECONDS} s") from error
    if result.returncode != 0:
        raise NoWindowBlenderError(f"{name}: {_last_line(result)}")


def _last_line(result: subprocess.CompletedProcess[str]) -> str:
    lines = [line for line in ((result.stdout or "") + (result.stderr or "")).splitlines() if line.strip()]
    return lines[-1].strip() if lines else f"exit code {result.returncode}"


def _mirror() -> str:
    """The Debian mirror that this system's apt uses, where it is a Debian; else Debian's own."""
    try:
        system = Path("/etc/os-release").read_text(encoding="utf-8")
    except FileNotFoundError:
        return FALLBACK_MIRROR
    if not re.search(r'^ID="?debian"?$', system, re.MULTILINE):
        return FALLBACK_MIRROR
    folder = Path("/etc/apt")
    for path in [*sorted(folder.glob("sources.list.d/*.sources")), *sorted(folder.glob("**/*.list"))]:
        if found := mirror_in(path.read_text(encoding="utf-8", errors="replace")):
            return found
    return FALLBACK_MIRROR


def mirror_in(text: str) -> str | None:
    """Address of the first Debian archive in an apt source file of either format; not of security updates."""
    for line in text.splitlines():
        if match := re.match(r"\s*(?:URIs:|deb\s+(?:\[[^]]*\]\s*)?)\s*(https?://\S+)", line):
            address = match[1].rstrip("/")
            if address.endswith("/debian"):
                return address
    return None


def _proxy_settings() -> list[str]:
    """Lines of this system's apt configuration that name proxies."""
    if shutil.which("apt-config") is None:
        return []
    result = subprocess.run(["apt-config", "dump"], capture_output=True, text=True)
    return [line for line in result.stdout.splitlines() if re.match(r"Acquire::https?::Proxy[: ]", line)]


def _proxy_variables(settings: Sequence[str]) -> dict[str, str]:
    """The same for debootstrap, which reads the environment."""
    found = {}
    for line in settings:
        if match := re.match(r'Acquire::(https?)::Proxy "(\S+)";', line):
            found[f"{match[1]}_proxy"] = match[2]
    return found


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def main(arguments: Sequence[str]) -> int:
    """Run the Blender found with these arguments; exit code 2 where there is none."""
    try:
        blender = find_or_make()
    except NoWindowBlenderError as error:
        _say(f"curvrefl: no Blender window: {error}.")
        return 2
    is_headless = not {"--background", "-b", "--command", "-c", "--version"}.isdisjoint(arguments)
    return subprocess.run([*(blender.headless if is_headless else blender.windowed), *arguments]).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
