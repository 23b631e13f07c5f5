"""Fixtures for every test."""

from __future__ import annotations

import gc
import os
from collections.abc import Generator
from pathlib import Path

import pytest
from build_command import btq as btq  # a fixture of every folder
from hypothesis import settings
from seeds import SEED, takes_all
from strict_queries import strict_queries as strict_queries  # a fixture of some tests

# Without a deadline: how long one example takes on a busy machine says nothing about the code.  Without a database of
# what failed in earlier runs: what is invented follows from the seed alone.
for name, examples in (("usual", 50), ("thorough", 2_000)):
    settings.register_profile(name, deadline=None, database=None, derandomize=SEED == 0, max_examples=examples)
settings.load_profile("usual")

# On a code host, `btq check` would choose its format by these.
for name in ("GITHUB_ACTIONS", "GITLAB_CI", "CI_PROJECT_DIR"):
    os.environ.pop(name, None)

# As `btq` and its server do: with Python's own thresholds, collecting takes a seventh of the time of tests/checks.
gc.set_threshold(100_000, 50, 10)

# Without their bytecode, processes that tests start would compile all modules each time.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# So that what fails in them is shown as in a test.
pytest.register_assert_rewrite("check_asserts", "syntax_asserts", "feature_asserts")


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of inputs made by other people (corpus, facts, the authors' example): `BTQ_SHARED` or ../shared."""
    folder = Path(os.environ.get("BTQ_SHARED") or Path(__file__).resolve().parents[2] / "shared")
    if not (folder / "facts").is_dir():
        pytest.skip(f"no shared inputs at {folder}: set BTQ_SHARED to the folder that holds facts/, corpus/, original/")
    return folder


# Files that take longest are begun first, so that at the end no core waits for one of them; those with a VS Code not at
# once, for it takes a core by itself.
LONGEST = (
    *("test_vscode", "test_damage", "test_compiled", "test_vscode_typing", "test_server", "test_neovim"),
    *("test_neovim_typing", "test_damaged_logs", "test_server_xml_requests"),
    *("test_preview", "test_style", "test_robustness", "test_checks_robust", "test_documents", "test_checks_kept"),
    *("test_many_mistakes", "test_requirements_kept", "test_cli"),
)


@pytest.hookimpl(tryfirst=True)  # before Hypothesis reads its option
def pytest_configure(config: pytest.Config) -> None:
    """Each worker begins to collect in another folder: in a new clone it compiles some tests and reads the others."""
    if SEED:
        config.option.hypothesis_seed = SEED
    worker = getattr(config, "workerinput", None)
    if worker is not None and config.args == ["tests"]:
        folders = sorted({f"tests/{file.parent.name}" for file in Path(__file__).parent.glob("*/test_*.py")})
        begin = int(worker["workerid"].removeprefix("gw")) * len(folders) // worker["workercount"]
        config.args = [*folders[begin:], *folders[:begin]]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The same order in every worker."""
    longest = {stem: place for place, stem in enumerate(LONGEST)}
    items.sort(key=lambda item: (longest.get(item.path.stem, len(LONGEST)), item.path))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """What failed says how to do it again."""
    report = yield
    if report.failed:
        profile = " --hypothesis-profile=thorough" if takes_all() else ""
        report.sections.append(("the same again", f"BTQ_SEED={SEED} .venv/bin/pytest -m ''{profile} '{item.nodeid}'"))
    return report


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update", action="store_true", help="write the golden files as they come out today")
    parser.addoption("--every-key", action="store_true", help="compare after every key of the editing hour")


@pytest.fixture(scope="session")
def update(request: pytest.FixtureRequest) -> bool:
    """Whether golden files are to be written and not compared."""
    return bool(request.config.getoption("--update"))
