# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb that measures the device; see `verbs`."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path

from ..output import checked_folder, folder_to_publish
from ..streams import STDOUT, dropped
from .inputs import start_gpu, warn_of


def benchmark(options: argparse.Namespace) -> int:
    """Solves and rays per second, see `study.benchmark.benchmark`; or with --calibrate what `auto` counts with."""
    output = checked_folder(options.output)
    start_gpu()
    return _calibrate(output) if options.calibrate else _measure(options, output)


def _measure(options: argparse.Namespace, output: Path) -> int:
    from ..study.benchmark.benchmark import Limits, format_benchmark, measure_benchmark

    with dropped(STDOUT) as stdout:
        report = measure_benchmark(
            options.vertices,
            options.triangles,
            Limits(options.bandwidth, options.flops),
            output,
            lambda line: print(line, file=stdout, flush=True),
        )
    print(format_benchmark(report))
    print(f"Numbers: {output / 'benchmark.json'}")
    return 0


def _calibrate(output: Path) -> int:
    """Measure the costs of this device, keep them where the extension is installed, and write them to a file too."""
    from ..renderer.costs.table import SHIPPED, costs_in_use
    from ..renderer.device.context import platform_facts
    from ..renderer.proofs.report import summary
    from ..renderer.proofs.verdict import known_verdict
    from ..viewport import device_run

    with dropped(STDOUT):
        problem = device_run.measure_now()
    measured = device_run.measured_costs()
    if measured is None:
        raise RuntimeError(problem)
    warn_of([problem] if problem else [])
    facts = platform_facts()
    print(f"{facts['renderer']} ({facts['vendor']}), {facts['version']}, {facts['backend']}")
    print(f"{summary(known_verdict())}.")
    print(f"{'microseconds':28}{'here':>12}{'shipped':>12}")
    for name, cost in asdict(costs_in_use()).items():
        print(f"{name:28}{cost:>12.4g}{getattr(SHIPPED, name):>12.4g}")
    with folder_to_publish(output) as folder:
        content = {"device": facts, "costs": asdict(measured), **known_verdict().as_json()}
        (folder / "costs.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    print(f"Costs: {output / 'costs.json'}")
    return 0
