"""`btq check` with `--show-files`, `--show-settings`, `--quiet` and `--config`."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

MISSION = "BehaviorTree Main\n    Sequnce\n"
PROJECT = """\
engine = "4.6"
ignore = ["old-quality-name"]
exclude = ["old/"]

[rules]
unknown-node = "warning"

[[overrides]]
include = ["vendor/"]
ignore = ["unknown-node"]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("main.btq", "vendor/gripper.btq", "old/main.btq"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(MISSION)
    (tmp_path / "btq.toml").write_text(PROJECT)
    (tmp_path / "ci").mkdir()
    (tmp_path / "ci" / "strict.toml").write_text('exclude = ["vendor/", "old/"]\n[rules]\nunknown-node = "error"\n')
    return tmp_path


def test_show_files(folder: Path) -> None:
    assert run_btq("check", "--show-files", cwd=folder) == (0, "main.btq\nvendor/gripper.btq\n", "")
    assert run_btq("check", "--show-files", "btq.toml", "old/main.btq", cwd=folder)[1] == "btq.toml\nold/main.btq\n"
    assert run_btq("check", "--show-files", "--config", "ci/strict.toml", cwd=folder)[1] == "main.btq\n"
    assert run_btq("check", "--show-files", "ci", cwd=folder) == (2, "", "")


def test_show_settings(folder: Path) -> None:
    code, out, err = run_btq("check", "--show-settings", "main.btq", "vendor/gripper.btq", cwd=folder)
    main, vendor = out.split("\n\n")
    assert (code, err) == (0, "")
    assert main.splitlines() == [
        "# main.btq",
        'engine = "4.6"                           # btq.toml:1',
        'qualities = "iso25010-2023"              # default',
        "include-paths = []                       # default",
        "nodes = []                               # default",
        "external = []                            # default",
        'exclude = ["old/"]                       # btq.toml:3',
        "select = []                              # default",
        'ignore = ["old-quality-name"]            # btq.toml:2',
        'baseline = ""                            # default',
        "evidence = {}                            # default",
        "simulate = {}                            # default",
        "requirements = {}                        # default",
        "factory = []                             # default",
        'rules.unknown-node = "warning"           # btq.toml:6',
    ]
    assert vendor.splitlines()[-1] == 'rules.unknown-node = "off"               # btq.toml:8'


def test_show_settings_of_the_command_line(folder: Path) -> None:
    _, out, _ = run_btq(
        "check",
        "--show-settings",
        "--config",
        "ci/strict.toml",
        "--ignore",
        "unused-tree",
        "--select=no-models",
        cwd=folder,
    )
    assert 'select = ["no-models"]                   # --select\n' in out
    assert 'ignore = ["unused-tree"]                 # --ignore\n' in out
    assert 'rules.unknown-node = "error"             # ci/strict.toml:3\n' in out


def test_show_settings_of_a_pyproject_and_of_nothing(tmp_path: Path) -> None:
    assert (
        'engine = ["4.6", "4.8", "4.10"]          # default\n' in run_btq("check", "--show-settings", cwd=tmp_path)[1]
    )
    (tmp_path / "pyproject.toml").write_text('[project]\n[tool.btq]\nengine = "4.8"\n')
    assert (
        'engine = "4.8"                           # pyproject.toml:3\n'
        in run_btq("check", "--show-settings", cwd=tmp_path)[1]
    )
    (tmp_path / "pyproject.toml").write_text("[tool.btq]\nengin = 4\n")
    told = "btq: pyproject.toml:2:1: unknown key `engin`; did you mean `engine`?\n"
    assert run_btq("check", "--show-settings", cwd=tmp_path) == (2, "", told)


def test_quiet(folder: Path) -> None:
    line = "main.btq:2:5: warning[unknown-node] unknown node `Sequnce`; did you mean `Sequence`?\n"
    assert run_btq("check", "-q", "--output-format", "concise", cwd=folder) == (1, line, "")
    code, out, _ = run_btq("check", "--quiet", cwd=folder)
    assert (code, "Found" in out) == (1, False)
    assert run_btq("check", "-q", "vendor", cwd=folder) == (0, "", "")


def test_config_counts_instead_of_the_nearest_project_file(folder: Path) -> None:
    code, out, _ = run_btq("check", "--output-format", "concise", "--config", "ci/strict.toml", cwd=folder)
    assert (code, out.splitlines()[0].split(" ")[:2]) == (1, ["main.btq:2:5:", "error[unknown-node]"])
    assert run_btq("check", "vendor", cwd=folder)[0] == 0  # only of that command
    code, out, _ = run_btq(
        "check", "--output-format", "concise", "--config", "ci/strict.toml", "vendor/gripper.btq", cwd=folder
    )
    assert (code, out.splitlines()[1]) == (1, "Found 1 error")


@pytest.mark.parametrize("command", ["check", "format", "build", "trace", "diff", "schema xsd", "verify"])
def test_config_that_cannot_be_used_is_refused(command: str, folder: Path) -> None:
    for file, reason in (("lost.toml", ": cannot be read: No such file or directory"), ("main.btq", ":1:14: ")):
        code, out, err = run_btq(*command.split(), "--config", file, cwd=folder)
        assert (code, out) == (2, "")
        assert err.startswith(f"btq {command.split()[0]}: --config {file}{reason}")
