"""Tests are the same in every run, other ones with another seed, and what failed says how to do it again."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TESTS = """\
import pytest
from hypothesis import given, strategies
from seeds import seeds, share_of

@given(strategies.integers(0, 10**9))
def test_invented(number):
    print("invented", number)

def test_taken():
    print("taken", share_of("abcdefgh", 4), *seeds(3))

@pytest.mark.scheduled
def test_that_takes_long():
    assert False
"""


@pytest.fixture
def run(tmp_path: Path) -> Run:
    (tmp_path / "test_drawn.py").write_text(TESTS, encoding="utf-8")
    return Run(tmp_path)


class Run:
    """pytest with our configuration on some tests of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, seed: str | None, *options: str) -> str:
        """What it prints."""
        command = [sys.executable, "-m", "pytest", "-c", str(ROOT / "pyproject.toml"), f"--rootdir={self.folder}"]
        env = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tests'}"}
        env.pop("BTQ_SEED", None)
        env.pop("PYTEST_ADDOPTS", None)
        env |= {} if seed is None else {"BTQ_SEED": seed}
        done = subprocess.run(
            [*command, "-p", "conftest", "-rP", *options, "test_drawn.py"],
            cwd=self.folder,
            env=env,
            capture_output=True,
            text=True,
        )
        return done.stdout + done.stderr


def test_a_run_is_always_the_same(run: Run) -> None:
    first, again, other, other_again = (drawn(run(seed)) for seed in (None, "0", "3", "3"))
    assert first == again
    assert other == other_again
    assert first[-1] == "taken ['a', 'e'] 0 1 2"
    assert other[-1] == "taken ['d', 'h'] 9 10 11"
    assert len(first) > 40
    assert first[:-1] != other[:-1]


def test_the_thorough_profile_takes_all(run: Run) -> None:
    found = drawn(run("3", "--hypothesis-profile=thorough"))
    assert (found[-1], len(found) > 1_500) == ("taken ['a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'] 9 10 11", True)


def test_what_failed_says_how_to_do_it_again(run: Run) -> None:
    assert "that_takes_long" not in run("3")
    said = run("3", "-m", "scheduled")
    assert "the same again" in said
    assert "\nBTQ_SEED=3 .venv/bin/pytest -m '' 'test_drawn.py::test_that_takes_long'\n" in said


def drawn(output: str) -> list[str]:
    return re.findall(r"^(?:invented|taken) .*", output, re.MULTILINE)
