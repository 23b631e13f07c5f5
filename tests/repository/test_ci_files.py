"""What other people's CI runs of ours: the commands in the hooks and in the action do what they say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
# `shell: bash` as GitHub runs it, but for the file that it writes the step to.
BASH = ("bash", "--noprofile", "--norc", "-eo", "pipefail", "-c")
CLEAN = "BehaviorTree Main\n    Dock\n"
WRONG = "BehaviorTree Main\n    ->\n        Sequnce\n            Dock\n"


def read(name: str) -> Any:
    return yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))


@pytest.fixture
def programs(tmp_path: Path) -> dict[str, str]:
    """An environment in which `btq` is this checkout's."""
    folder = tmp_path / "programs"
    folder.mkdir()
    program = folder / "btq"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m btq_lang "$@"\n')
    program.chmod(0o755)
    return {**os.environ, "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
@pytest.mark.parametrize(
    ("hook", "text", "code"),
    [
        ("btq-check", CLEAN, 0),
        ("btq-check", WRONG, 1),
        ("btq-format", WRONG.replace("  ", " "), 0),
        ("btq-build", CLEAN, 1),  # there is no XML
    ],
)
def test_a_hook_runs(hook: str, text: str, code: int, tmp_path: Path, programs: dict[str, str]) -> None:
    (tmp_path / "main.btq").write_text(text)
    (entry,) = (each for each in read(".pre-commit-hooks.yaml") if each["id"] == hook)
    given = ["main.btq"] if entry.get("pass_filenames", True) else []
    run = subprocess.run([*entry["entry"].split(), *given], cwd=tmp_path, env=programs, capture_output=True)
    assert run.returncode == code, run.stdout + run.stderr


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
def test_the_hook_and_the_action_check_projects_of_xml(tmp_path: Path, programs: dict[str, str]) -> None:
    (tmp_path / "trees").mkdir()
    for name, child in (("main", '<SubTree ID="Dock"/>'), ("dock", '<Timeout mesc="3"><Go/></Timeout>')):
        tree = f'<BehaviorTree ID="{name.capitalize()}">{child}</BehaviorTree>'
        (tmp_path / "trees" / f"{name}.xml").write_text(f'<root BTCPP_format="4">\n{tree}\n</root>\n')
    (tmp_path / "package.xml").write_text("<package/>\n")
    (entry,) = (each for each in read(".pre-commit-hooks.yaml") if each["id"] == "btq-check")
    run = subprocess.run(entry["entry"].split(), cwd=tmp_path, env=programs, capture_output=True, text=True)
    assert (run.returncode, run.stdout.splitlines()[-1]) == (1, "Found 1 error")
    (step,) = (each for each in read("action.yml")["runs"]["steps"] if each.get("name") == "Check")
    inputs = {"BTQ_PATHS": ".", "BTQ_SEVERITY": "warning"}
    run = subprocess.run([*BASH, step["run"]], cwd=tmp_path, env={**programs, **inputs}, capture_output=True, text=True)
    assert run.returncode == 1
    (line,) = run.stdout.splitlines()
    assert line.startswith("::error file=trees/dock.xml,line=2,")


@pytest.mark.parametrize("hook", ["btq-check", "btq-build"])
def test_a_hook_looks_at_all_missions_whatever_is_committed(hook: str) -> None:
    """A model, a project file, or a mission that is taken away breaks others; XML may be edited by hand."""
    (entry,) = (each for each in read(".pre-commit-hooks.yaml") if each["id"] == hook)
    assert (entry["pass_filenames"], entry["always_run"], "files" in entry) == (False, True, False)


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
@pytest.mark.parametrize(
    ("step", "code", "said"),
    [
        ("Check", 1, "::warning file=main.btq,line=3,"),
        ("Format", 0, ""),
        ("Build", 1, "main.xml"),
    ],
)
def test_a_step_of_the_action_runs(step: str, code: int, said: str, tmp_path: Path, programs: dict[str, str]) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    action = read("action.yml")
    (body,) = (each for each in action["runs"]["steps"] if each.get("name") == step)
    defaults = {f"${{{{ inputs.{name} }}}}": given["default"] for name, given in action["inputs"].items()}
    values = {name: defaults[value] for name, value in body["env"].items()}
    run = subprocess.run([*BASH, body["run"]], cwd=tmp_path, env={**programs, **values}, capture_output=True, text=True)
    assert run.returncode == code, run.stdout + run.stderr
    assert said in run.stdout + run.stderr


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
@pytest.mark.parametrize("step", ["Check", "Format"])
def test_the_action_is_content_with_this_repository(step: str, programs: dict[str, str]) -> None:
    """The job of our own workflow."""
    action = read("action.yml")
    (ours,) = (
        each["with"] for each in read(".github/workflows/ci.yml")["jobs"]["action"]["steps"] if each.get("uses") == "./"
    )
    assert ours["format"] == "true"
    (body,) = (each for each in action["runs"]["steps"] if each.get("name") == step)
    given = {name: ours.get(name, about["default"]) for name, about in action["inputs"].items()}
    inputs = {f"${{{{ inputs.{name} }}}}": value for name, value in given.items()}
    values = {name: inputs[value] for name, value in body["env"].items()}
    run = subprocess.run([*BASH, body["run"]], cwd=ROOT, env={**programs, **values}, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
def test_the_action_writes_what_changed(tmp_path: Path, programs: dict[str, str]) -> None:
    def git(*words: str) -> None:
        person = ("-c", "user.name=x", "-c", "user.email=x@example.org", "-c", "commit.gpgsign=false")
        subprocess.run(["git", *person, *words], cwd=tmp_path, check=True, capture_output=True)

    git("init", "-q", "-b", "main")
    for text in (CLEAN, CLEAN.replace("Dock", "Charge")):
        (tmp_path / "main.btq").write_text(text)
        git("add", "main.btq")
        git("commit", "-q", "-m", "x")
    (body,) = (each for each in read("action.yml")["runs"]["steps"] if each.get("id") == "diff")
    files = {name: str(tmp_path / name) for name in ("GITHUB_STEP_SUMMARY", "GITHUB_OUTPUT")}
    values = {**files, "RUNNER_TEMP": str(tmp_path), "BTQ_PATHS": ".", "BTQ_DIFF_FROM": "HEAD~1"}
    run = subprocess.run([*BASH, body["run"]], cwd=tmp_path, env={**programs, **values}, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    said = (tmp_path / "btq-diff.md").read_text(encoding="utf-8")
    assert "Charge" in said
    assert (tmp_path / "GITHUB_STEP_SUMMARY").read_text(encoding="utf-8") == said
    assert (tmp_path / "GITHUB_OUTPUT").read_text() == f"file={tmp_path}/btq-diff.md\n"


def test_workflows_are_secure() -> None:
    """Actions pinned by hash, no credentials that stay behind, no more permissions than needed."""
    zizmor = Path(sys.executable).with_name("zizmor" + (".exe" if os.name == "nt" else ""))
    options = ("--offline", "--quiet", "--no-progress", "--format", "plain")
    run = subprocess.run([zizmor, *options, ".github", "action.yml"], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


def test_a_release_is_of_its_tag_and_for_three_systems() -> None:
    jobs = read(".github/workflows/release.yml")["jobs"]
    (tag,) = (step for step in jobs["build"]["steps"] if step.get("name") == "The tag is the version")
    run = [*BASH, tag["run"]]
    given = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    assert subprocess.run(run, cwd=ROOT, env={**given, "GITHUB_REF_NAME": "v9.9"}).returncode == 1
    assert jobs["compiled"]["strategy"]["matrix"]["system"] == ["ubuntu-latest", "macos-latest", "windows-latest"]
    assert jobs["publish"]["needs"] == ["build", "compiled"]


@pytest.mark.parametrize("name", ["docs", "marketplace"])
def test_a_maintainer_starts_what_follows_a_release(name: str) -> None:
    assert read(f".github/workflows/{name}.yml")[True].keys() == {"workflow_dispatch"}


def test_the_citation_names_the_article() -> None:
    citation = read("CITATION.cff")
    (article,) = citation["references"]
    assert [author["family-names"] for author in article["authors"]] == ["Ghzouli", "Wohlrab", "Horkoff"]
    assert (citation["license"], article["conference"]["name"], article["year"]) == ("MIT", "REFSQ 2025", 2025)


def test_every_job_tests_the_versions_that_are_promised() -> None:
    matrix = read(".github/workflows/ci.yml")["jobs"]["python"]["strategy"]["matrix"]
    assert matrix["python"] == ["3.10", "3.11", "3.12", "3.13", "3.14"]
    assert matrix["system"] == ["ubuntu-latest", "macos-latest", "windows-latest"]


def test_every_job_runs_the_command_of_the_readme() -> None:
    """Which `.ci/run` does to the letter."""
    jobs = read(".github/workflows/ci.yml")["jobs"]
    steps = {name: [step["run"] for step in job["steps"] if "run" in step] for name, job in jobs.items()}
    install = 'python -m pip install ".[test]"'
    assert steps == {"python": [install, "python -m pytest -n auto -rs"], "editors": [".ci/run"], "action": []}
    assert "PYTEST_ADDOPTS" not in (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")


def test_each_night_all_tests_run_with_another_seed() -> None:
    workflow = read(".github/workflows/scheduled.yml")
    assert workflow[True].keys() == {"schedule", "workflow_dispatch"}  # YAML 1.1 reads `on` as a boolean
    assert workflow["permissions"] == {"contents": "read"}
    assert workflow["env"] == {"BTQ_SEED": "${{ inputs.seed || github.run_number }}"}
    tests, issue = (workflow["jobs"][name] for name in ("tests", "issue"))
    tools, step = (step for step in tests["steps"] if "run" in step)
    assert "sphinx-build /opt/tools/bin/strictdoc" in tools["run"]  # which trace/test_other_tools.py skips without
    assert step == {"run": ".ci/run", "env": {"PYTEST_ADDOPTS": '--timeout 3600 -m "scheduled or not scheduled"'}}
    assert (issue["needs"], issue["if"], issue["permissions"]) == ("tests", "failure()", {"issues": "write"})


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
def test_the_issue_names_the_seed_and_what_does_it_again(tmp_path: Path) -> None:
    program = tmp_path / "gh"
    program.write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n')
    program.chmod(0o755)
    (step,) = read(".github/workflows/scheduled.yml")["jobs"]["issue"]["steps"]
    values = {
        "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}",
        "BTQ_SEED": "17",
        "GITHUB_REPOSITORY": "some/btq",
        "GITHUB_RUN_ID": "4",
        "GITHUB_SERVER_URL": "https://host",
        "GITHUB_SHA": "abc",
    }
    run = subprocess.run([*BASH, step["run"]], env=values, capture_output=True, text=True)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.splitlines() == [
        *("issue", "create", "--repo", "some/btq", "--title", "Tests fail with seed 17", "--body"),
        "[The run](https://host/some/btq/actions/runs/4) names the tests that failed at abc. "
        "The same inputs again: `BTQ_SEED=17 .venv/bin/pytest -n auto -m 'scheduled or not scheduled'`",
    ]
