"""Requirements on the way through other tools, where these are installed, as in the scheduled workflow."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.requirements.external import read_external

INSPECTION = Path(__file__).resolve().parents[2] / "examples" / "inspection"

CONF = """\
extensions = ["sphinx_needs"]
project = "Plant"
version = "1"
needs_id_regex = "^[A-Za-z0-9_]+$"
needs_types = [
    {"directive": kind, "title": kind, "prefix": "", "color": "#ffffff", "style": "node"} for kind in ("req", "hazard")
]
needs_build_json = True
"""
INDEX = """\
Plant
=====

.. needimport:: needs.json

.. needimport:: robot.json

.. req:: Doors stay closed
   :id: PLANT_9
   :status: draft

   A closed door
   stays closed.
"""


@pytest.mark.skipif(shutil.which("sphinx-build") is None, reason="sphinx-needs is not on the PATH")
def test_sphinx_needs_reads_what_is_written_and_is_read(tmp_path: Path) -> None:
    shutil.copy(INSPECTION / "needs.json", tmp_path)
    run_btq("trace", str(INSPECTION), "--format", "needs-json", "-o", "robot.json", cwd=tmp_path)
    (tmp_path / "conf.py").write_text(CONF)
    (tmp_path / "index.rst").write_text(INDEX)
    command = ["sphinx-build", "-W", "-q", "-b", "html", ".", "out"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    path = tmp_path / "out" / "needs.json"
    needs = {each.id: each for each in read_external(str(path), path.read_text(encoding="utf-8"))}
    robot = ("keep_away", "slow", "enough_power", "in_time", "blind")
    plant = ("HAZ_1", "HAZ_2", "PLANT_1", "PLANT_2", "PLANT_3", "PLANT_9")
    assert {*needs} == {*robot, *plant}
    assert (needs["PLANT_9"].title, needs["PLANT_9"].status) == ("Doors stay closed", "draft")
    assert needs["PLANT_9"].text == "A closed door\nstays closed."
    written = read_external("robot.json", (tmp_path / "robot.json").read_text(encoding="utf-8"))
    assert [(needs[each.id].title, needs[each.id].text) for each in written] == [
        (each.title, each.text) for each in written
    ]


DOCUMENT = """\
[DOCUMENT]
TITLE: Plant

[REQUIREMENT]
UID: PLANT-1
STATUS: Active
TITLE: Machines keep away
STATEMENT: >>>
A machine keeps 0.4 m away
from any pipe & wall.
<<<

[REQUIREMENT]
UID: PLANT-2
STATEMENT: Machines come back.
"""


@pytest.mark.skipif(shutil.which("strictdoc") is None, reason="strictdoc is not on the PATH: it is 466 MB")
def test_what_strictdoc_exports_is_read(tmp_path: Path) -> None:
    pytest.importorskip("reqif")
    (tmp_path / "plant.sdoc").write_text(DOCUMENT)
    command = ["strictdoc", "export", ".", "--formats", "reqif-sdoc", "--no-parallelization", "--output-dir", "out"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    (path,) = (tmp_path / "out").rglob("*.reqif")
    requirements = read_external(str(path), path.read_text(encoding="utf-8"))
    assert [(each.id, each.title, each.text, each.status) for each in requirements] == [
        ("PLANT-1", "Machines keep away", "A machine keeps 0.4 m away\nfrom any pipe & wall.", "Active"),
        ("PLANT-2", "", "Machines come back.", ""),
    ]
