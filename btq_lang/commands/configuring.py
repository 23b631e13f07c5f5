"""`--config FILE`: one project file for all files of a command, instead of the nearest one above each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.workspace.loader import absolute, find_project, read, use_project_file


def configured(run: Callable[[Any, CommandOutput], int], config: str) -> Callable[[Any, CommandOutput], int]:
    """The function that runs a command with a project file."""

    def run_configured(options: Any, messages: CommandOutput) -> int:
        refuse(_problem(config))
        with _using(absolute(config)):
            return run(options, messages)

    return run_configured


@contextmanager
def _using(config: str) -> Iterator[None]:
    use_project_file(config)
    try:
        yield
    finally:
        use_project_file(None)


def _problem(config: str) -> str | None:
    text, problem = read(absolute(config))
    if text is None:
        return f"--config {config}: {problem.message if problem else 'cannot be read'}"
    with _using(absolute(config)):
        problems = find_project(".").problems
    return f"--config {problems[0]}" if problems else None
