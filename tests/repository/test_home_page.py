"""The first page of the documentation and the README: their commands print what they show, and draw their picture."""

from __future__ import annotations

import re
import shlex
import shutil
import sys
from pathlib import Path

import pytest

from btq_lang.cli import main

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("docs/README.md", "README.md")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PICTURE = "btq graph deliver.btq --qualities -o deliver.svg"


def blocks(page: str, language: str) -> list[str]:
    return [text for each, text in BLOCK.findall((ROOT / page).read_text(encoding="utf-8")) if each == language]


@pytest.mark.parametrize("page", PAGES)
def test_the_xml_has_the_findings_that_are_shown(
    page: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("deliver.xml").write_text(blocks(page, "xml")[0], encoding="utf-8")
    command, _, shown = blocks(page, "console")[0].partition("\n")
    prompt, program, *arguments = shlex.split(command)
    assert (prompt, program) == ("$", "btq")
    assert main(arguments) == 1
    assert capsys.readouterr().out == shown


@pytest.mark.parametrize("page", PAGES)
def test_the_picture_is_that_of_the_mission(
    page: str, tmp_path: Path, update: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("deliver.btq").write_text(blocks(page, "btq")[0], encoding="utf-8")
    assert f"`{PICTURE}`" in (ROOT / page).read_text(encoding="utf-8")
    assert main(shlex.split(PICTURE)[1:]) == 0
    shown = ROOT / "docs/deliver.svg"
    if update:
        shown.write_bytes(Path("deliver.svg").read_bytes())
    assert Path("deliver.svg").read_bytes() == shown.read_bytes()


@pytest.mark.parametrize("page", PAGES)
def test_the_verdicts_are_those_of_the_example(
    page: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a terminal of 88 columns."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "examples", "examples")
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setattr("btq_lang.commands.verdict_report.terminal_width", lambda: 88)
    command, _, shown = blocks(page, "console")[1].partition("\n")
    assert main(shlex.split(command)[2:]) == 1
    assert capsys.readouterr().out == shown


@pytest.mark.parametrize("page", PAGES)
def test_both_missions_of_the_page_are_in_one_folder(
    page: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both are called `deliver`, and the XML is the reader's own."""
    monkeypatch.chdir(tmp_path)
    (xml, *_), (mission, *_) = blocks(page, "xml"), blocks(page, "btq")
    Path("deliver.xml").write_text(xml, encoding="utf-8")
    Path("deliver.btq").write_text(mission, encoding="utf-8")

    def btq(command: str) -> tuple[int, str, str]:
        code = main(shlex.split(command)[1:])
        return code, *capsys.readouterr()

    check, _, findings = blocks(page, "console")[0].removeprefix("$ ").partition("\n")
    assert btq(check) == (1, findings, "")
    assert btq(PICTURE) == (0, "", "")
    for command in ("btq build", "btq build deliver.btq"):
        code, printed, messages = btq(command)
        assert (code, printed) == (2, "")
        assert "deliver.xml is in the way" in messages
        assert "-o FOLDER" in messages
    assert btq("btq build deliver.btq -o build")[:2] == (0, "wrote build/deliver.xml\nwrote build/deliver.qreq.json\n")
    assert btq(check) == (1, findings, "")
    assert Path("deliver.xml").read_text(encoding="utf-8") == xml
