"""An include that cannot be read hides nothing that is wrong with other files, whether lxml is installed or not."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from in_process import run_btq
from lsp_editor import Editor
from xml_judges import judged_by

MAIN = 'include "part.xml"\nBehaviorTree Main\n    Rety\n        Pick\n'
OTHER = '<root BTCPP_format="4"><BehaviorTree ID="Other"><Timeot><Pick/></Timeot></BehaviorTree></root>'
OF_OTHERS = [
    "main.btq:3:5: warning[unknown-node] unknown node `Rety`; did you mean `Retry`?",
    "other.xml:1:50: warning[unknown-node] unknown node `Timeot`; did you mean `Timeout`?",
]
MISSING = "main.btq:1:9: error[missing-include] cannot find the file `part.xml`"
DEEP = f'<root BTCPP_format="4">{"<a>" * 600}{"</a>" * 600}</root>'


def write(text: str | bytes) -> Callable[[Path], object]:
    return lambda path: path.write_bytes(text.encode() if isinstance(text, str) else text)


PARTS: dict[str, tuple[Callable[[Path], object], list[str], str]] = {
    "missing": (lambda path: None, [MISSING], ""),
    "torn": (
        write('<root BTCPP_format="4">'),
        ["main.btq:1:9: error[include-with-errors] `part.xml` has 1 error: <root> is never closed"],
        "",
    ),
    "foreign": (
        write("<a/>"),
        ["main.btq:1:9: error[include-with-errors] `part.xml` has 1 error: the document element is <a>, not <root>"],
        "",
    ),
    "empty": (write(""), ["main.btq:1:9: error[include-with-errors] `part.xml` has 1 error: this file is empty"], ""),
    "deep": (
        write(DEEP),
        [
            "main.btq:1:9: error[include-with-errors] `part.xml` has 1 error: "
            "more than 498 nested elements, which BehaviorTree.CPP refuses"
        ],
        "",
    ),
    "binary": (write(b"<root\0/>"), [MISSING], "btq: part.xml: this is not a text file\n"),
    "folder": (Path.mkdir, [MISSING], ""),
    "dead link": (lambda path: path.symlink_to("nowhere.xml"), [MISSING], ""),
    "pipe": (os.mkfifo, [MISSING], "") if hasattr(os, "mkfifo") else (lambda path: None, [MISSING], ""),
}


@pytest.fixture(params=["lxml", "expat"])
def judge(request: pytest.FixtureRequest) -> Iterator[None]:
    with judged_by(request.param):
        yield


@pytest.fixture(params=PARTS)
def part(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """What is wrong with the include of a mission."""
    PARTS[request.param][0](tmp_path / "part.xml")
    (tmp_path / "main.btq").write_text(MAIN, encoding="utf-8")
    (tmp_path / "other.xml").write_text(OTHER, encoding="utf-8")
    kind: str = request.param
    return kind


@pytest.mark.usefixtures("judge")
def test_other_findings_are_reported(part: str, tmp_path: Path) -> None:
    _, findings, messages = PARTS[part]
    code, report, said = run_btq("check", "--output-format", "concise", "main.btq", "other.xml", cwd=tmp_path)
    assert (code, said) == (2 if messages else 1, messages)
    assert report.splitlines()[:-1] == [*findings, *OF_OTHERS]


def test_the_server_reports_them_too(part: str, tmp_path: Path) -> None:
    editor = Editor(tmp_path)
    editor.open("main.btq", MAIN)
    assert [each[:2] for each in editor.diagnostics("main.btq")] == [
        (PARTS[part][1][0].split("[")[1].split("]")[0], 0),
        ("unknown-node", 2),
    ]
    editor.open("other.xml", OTHER)
    assert [each[:2] for each in editor.diagnostics("other.xml")] == [("unknown-node", 0)]
    editor.close()
