# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a farm does with a job bundle, by the packages `openjd-model`, `openjd-sessions` and `deadline`; with the Python
of `farm_tools` alone. Prints JSON, an object a line.

session.py plan BUNDLE PARAMETERS                     the steps, with their tasks
session.py task BUNDLE PARAMETERS STEP TASK RULES     runs one task in a session; what it tells, and its output
session.py submission BUNDLE                          what `deadline bundle submit` would send, without sending it
"""

from __future__ import annotations

import json
import logging
import sys
import threading
from pathlib import Path
from typing import Any

from openjd.model import (  # type: ignore[import-not-found]
    ParameterValue,
    ParameterValueType,
    StepParameterSpaceIterator,
    create_job,
    decode_job_template,
    preprocess_job_parameters,
)
from openjd.sessions import (  # type: ignore[import-not-found]
    LOG,
    ActionState,
    ActionStatus,
    PathMappingRule,
    Session,
)

EXTENSIONS = ["TASK_CHUNKING"]


def job_of(bundle: Path, values: dict[str, str]) -> tuple[Any, Any]:
    """The job, and its parameters."""
    import yaml  # type: ignore[import-untyped]

    content = yaml.safe_load((bundle / "template.yaml").read_text(encoding="utf-8"))
    template = decode_job_template(template=content, supported_extensions=EXTENSIONS)
    parameters = preprocess_job_parameters(
        job_template=template, job_parameter_values=values, job_template_dir=bundle, current_working_dir=Path.cwd()
    )
    return create_job(job_template=template, job_parameter_values=parameters), parameters


def plan(bundle: Path, values: dict[str, str]) -> int:
    job, _ = job_of(bundle, values)
    for step in job.steps:
        tasks = [
            {name: [value.type.value, value.value] for name, value in task.items()}
            for task in StepParameterSpaceIterator(space=step.parameterSpace)
        ]
        say(step=step.name, after=[item.dependsOn for item in step.dependencies or []], tasks=tasks)
    return 0


def run_task(
    bundle: Path, values: dict[str, str], name: str, task: dict[str, list[str]], rules: list[dict[str, str]]
) -> int:
    job, parameters = job_of(bundle, values)
    (step,) = [step for step in job.steps if step.name == name]
    ended = threading.Event()
    seen: list[ActionStatus] = []

    def told(_session: str, status: ActionStatus) -> None:
        seen.append(status)
        say(progress=status.progress, status=status.status_message, fail=status.fail_message)
        if status.state != ActionState.RUNNING:
            ended.set()

    class Output(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            say(line=record.getMessage())

    LOG.addHandler(Output())
    LOG.setLevel(logging.INFO)
    session = Session(
        session_id="worker",
        job_parameter_values=parameters,
        path_mapping_rules=[PathMappingRule.from_dict(rule) for rule in rules],
        callback=told,
    )
    with session:
        session.run_task(
            step_script=step.script,
            task_parameter_values={
                key: ParameterValue(type=ParameterValueType(kind), value=value) for key, (kind, value) in task.items()
            },
        )
        ended.wait()
    say(code=seen[-1].exit_code)
    return 0 if seen[-1].state == ActionState.SUCCESS else 1


def submission(bundle: Path) -> int:
    from deadline.client.job_bundle import loader, parameters  # type: ignore[import-not-found]
    from deadline.client.job_bundle import submission as sent

    loader.validate_directory_symlink_containment(str(bundle))
    definitions = parameters.read_job_bundle_parameters(str(bundle))
    references = sent.AssetReferences.from_dict(loader.read_yaml_or_json_object(str(bundle), "asset_references", False))
    parameters.apply_job_parameters([], str(bundle), definitions, references)
    of_farm, of_job = sent.split_parameter_args(definitions, str(bundle))
    controls = {item["name"]: parameters.get_ui_control_for_parameter_definition(item) for item in definitions}
    say(assets=references.to_dict()["assetReferences"], farm=of_farm, job=of_job, controls=controls)
    return 0


def say(**content: Any) -> None:
    print(json.dumps(content), flush=True)


def main(verb: str, bundle: str, *given: str) -> int:
    if verb == "submission":
        return submission(Path(bundle))
    values = json.loads(given[0])
    if verb == "plan":
        return plan(Path(bundle), values)
    return run_task(Path(bundle), values, given[1], json.loads(given[2]), json.loads(given[3]))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
