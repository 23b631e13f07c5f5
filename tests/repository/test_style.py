"""Types and style are tests like any other."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# CI never comes back to a cache that it has written, which takes a tenth of the time.
MYPY = ("mypy", "--cache-dir", os.devnull) if "BTQ_CI" in os.environ else ("mypy",)
# Some tests call what only POSIX has, so pyproject.toml names Linux; another system checks btq_lang alone, for itself.
TYPES = MYPY if sys.platform == "linux" else (*MYPY, "--platform", sys.platform, "btq_lang")


@pytest.mark.parametrize("command", [TYPES, ("ruff", "check", "."), ("ruff", "format", "--check", ".")], ids=" ".join)
def test_nothing_to_complain_of(command: tuple[str, ...]) -> None:
    run = subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


QUERIES = """
from btq_lang.workspace.queries import Store, input_of

@input_of(lambda letter: "text")
def count(text: str, letter: str) -> int:
    return text.count(letter)

def length(store: Store[str], times: int) -> int:
    return store.ask(count, "a") * times

store = Store("banana")
store.ask(length, 2)
store.ask(length, "2")
store.ask(length)
store.ask(count, 1)
"""


def test_wrong_arguments_of_a_query_are_errors_of_types(tmp_path: Path) -> None:
    asked = tmp_path / "asked.py"
    asked.write_text(QUERIES, encoding="utf-8")
    command = [sys.executable, "-m", *MYPY, "--strict", "--follow-imports=silent", "--config-file=", str(asked)]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert [line.split(": ", 1)[1] for line in run.stdout.splitlines()[:-1]] == [
        'error: Argument 2 to "ask" of "Store" has incompatible type "str"; expected "int"  [arg-type]',
        'error: Missing positional argument "times" in call to "ask" of "Store"  [call-arg]',
        'error: Argument 2 to "ask" of "Store" has incompatible type "int"; expected "str"  [arg-type]',
    ]
