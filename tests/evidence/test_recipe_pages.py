"""The recipes of the documentation: a bag of Nav2, and a pull request whose simulation violates a requirement."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from evidence_logs import MAIN, MAIN_XML, Verify, btlog, logged, rows

from btq_lang.cli import main

ROOT = Path(__file__).parents[2]


def blocks(page: str) -> list[tuple[str, str]]:
    """The blocks of a page, each with its language."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


def test_a_bag_of_nav2(shared: Path, verify: Verify) -> None:
    pytest.importorskip("rosbags")
    from evidence_bags import names_of, tree_log, write_bag

    shutil.copy(shared / "logs" / "nav.xml", verify.folder / "navigate.xml")
    xml, start, transitions = logged(shared / "logs" / "nav.btlog")
    write_bag(verify.folder / "bag", tree_log(transitions, names_of(xml), start))
    found = blocks("nav2.md")
    (mission,) = (text for language, text in found if language == "text")
    (verify.folder / "nav.btq").write_text(mission, encoding="utf-8")
    imports, verifies = (text.partition("\n") for language, text in found if language == "console")
    assert imports[0] == "$ btq import navigate.xml"
    assert main(shlex.split(imports[0])[2:]) == 0
    assert main(["check", "nav.btq"]) == 0
    assert verifies[0].startswith("$ btq verify ")
    assert verify.text(*shlex.split(verifies[0])[3:]) == verifies[2]
    assert verify.code == 0


@pytest.mark.skipif(os.name == "nt", reason="the steps are for a POSIX shell")
@pytest.mark.parametrize(("bound", "code"), [("20 ms", 0), ("10 ms", 1)])
def test_a_pull_request_whose_simulation_violates_a_requirement_fails(bound: str, code: int, tmp_path: Path) -> None:
    workflow = next(text for language, text in blocks("ci.md") if language == "yaml" and "btq verify" in text)
    steps = yaml.safe_load(workflow)["jobs"]["simulation"]["steps"]
    (step,) = (each for each in steps if "btq verify" in each.get("run", ""))
    (tmp_path / "missions").mkdir()
    (tmp_path / "logs").mkdir()
    demand = f"QualityReq swift : reliability\n    Move takes at most {bound}\n"
    (tmp_path / "missions" / "mission.btq").write_text(f"{demand}{MAIN}", encoding="utf-8")
    (tmp_path / "logs" / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 15 2S 3S 1S")))
    program = tmp_path / "btq"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m btq_lang "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    summary = tmp_path / "summary.md"
    environment = {**os.environ, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
    run = subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],
        cwd=tmp_path,
        env={**environment, "GITHUB_STEP_SUMMARY": str(summary)},
        capture_output=True,
        text=True,
    )
    assert (run.returncode, run.stderr) == (code, "")
    written = (tmp_path / "verdicts.md").read_text(encoding="utf-8")
    assert written.startswith(f"### mission: 1 {'violated' if code else 'satisfied'}\n")
