"""A project file that is broken concerns the files that it governs, and no others."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows
from in_process import run_btq

from btq_lang.lsp.session import Session

BROKEN = "engine = 4.10\n[[broken\n"
FACTORY = '[[factory]]\nname = "gone"\nload = ["nowhere/*.xml"]\n'
XML = '<root BTCPP_format="4">\n<BehaviorTree ID="{}">{}</BehaviorTree>\n</root>\n'
MISSION = f"{MAIN}QualityReq rq : safety\n    Move takes at most 1 s\n"


@pytest.fixture(params=[BROKEN, FACTORY, "zebra = 1\n"], ids=["syntax", "factory", "key"])
def folder(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """A repository with files, and a broken project in one of its folders."""
    (tmp_path / ".git").mkdir()
    (tmp_path / "lib" / "sub").mkdir(parents=True)
    (tmp_path / "a.xml").write_text(XML.format("Main", '<SubTree ID="Dock"/>'))
    (tmp_path / "dock.xml").write_text(XML.format("Dock", "<AlwaysSuccess/>"))
    (tmp_path / "m.btq").write_text(MISSION)
    (tmp_path / "lib" / "btq.toml").write_text(request.param)
    (tmp_path / "lib" / "lib.xml").write_text(XML.format("Lib", "<AlwaysSuccess/>"))
    (tmp_path / "lib" / "sub" / "m.btq").write_text(MISSION)
    return tmp_path


@pytest.mark.parametrize(
    "command", ["check a.xml", "check m.btq", "check - --stdin-filename a.xml", "build m.btq", "trace m.btq"]
)
def test_a_command_for_other_files(folder: Path, command: str) -> None:
    code, _, err = run_btq(*command.split(), cwd=folder, stdin=(folder / "a.xml").read_text())
    assert (code, "btq.toml" in err) == (0, False)


def test_more_commands_for_other_files(folder: Path) -> None:
    assert run_btq("graph", "m.btq", cwd=folder)[::2] == (0, "")
    assert run_btq("import", "a.xml", cwd=folder)[2] == "1 file imported\nNext: btq check a.btq\n"
    assert run_btq("diff", "a.xml", "dock.xml", cwd=folder)[2] == ""
    assert run_btq("check", "../a.xml", cwd=folder / "lib")[0] == 0


def test_what_it_governs_hears_of_it(folder: Path) -> None:
    for path in ("lib/lib.xml", "lib", "."):
        code, _, err = run_btq("check", path, cwd=folder)
        assert (code, err.startswith("btq: lib/btq.toml")) == (2, True)
    assert run_btq("build", "lib/sub/m.btq", cwd=folder)[0] == 2


def test_an_editor_shows_it_in_the_project_file_alone(folder: Path) -> None:
    session = Session()
    session.folders = (str(folder),)
    session.edit(str(folder / "a.xml"), (folder / "a.xml").read_text())
    assert session.diagnostics(str(folder / "a.xml")) == ()
    assert [*session.projects] == [str(folder / "lib" / "btq.toml")]


def test_logs_are_judged_by_the_missions_that_are_whole(folder: Path) -> None:
    log = btlog(MAIN_XML, rows("1R 2R 5 2S 3R 9 3S 1S"))
    (folder / "run.btlog").write_bytes(log)
    code, out, err = run_btq("verify", "run.btlog", "--format", "json", cwd=folder)
    assert (code, "btq.toml" in err) == (0, False)
    assert [each["file"] for each in json.loads(out)["missions"]] == ["m.btq"]
    assert "btq.toml" in run_btq("verify", "run.btlog", "--mission", "lib/sub/m.btq", cwd=folder)[2]
