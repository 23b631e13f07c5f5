"""The language server as an editor runs it: a process, spoken to over its standard input and output."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

WRONG = "BehaviorTree Main\n    ->\n        Sequnce\n            Dock\n"
RIGHT = WRONG.replace("Sequnce", "Sequence")


class Editor:
    """An editor with one server: requests are answered in order, notifications are kept until asked for."""

    def __init__(self, root: Path, encodings: tuple[str, ...] = ()) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "btq_lang.server", "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self.root = root
        self.count = 0
        general = {"general": {"positionEncodings": list(encodings)}} if encodings else {}
        self.capabilities = self.request("initialize", capabilities=general, rootUri=root.as_uri(), processId=None)
        self.notify("initialized")

    def send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin is not None
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.process.stdin.flush()

    def receive(self) -> dict[str, Any]:
        assert self.process.stdout is not None
        length = 0
        while (line := self.process.stdout.readline()) not in (b"\r\n", b""):
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        message: dict[str, Any] = json.loads(self.process.stdout.read(length))
        return message

    def notify(self, method: str, **params: Any) -> None:
        self.send(method=method, params=params)

    def request(self, method: str, **params: Any) -> Any:
        self.count += 1
        self.send(id=self.count, method=method, params=params)
        while (message := self.receive()).get("id") != self.count or "method" in message:
            pass
        assert "error" not in message, message
        return message["result"]

    def uri(self, name: str) -> str:
        return (self.root / name).as_uri()

    def open(self, name: str, text: str) -> None:
        document = {"uri": self.uri(name), "languageId": "btq", "version": 1, "text": text}
        self.notify("textDocument/didOpen", textDocument=document)

    def change(self, name: str, text: str, version: int = 2) -> None:
        document = {"uri": self.uri(name), "version": version}
        self.notify("textDocument/didChange", textDocument=document, contentChanges=[{"text": text}])

    def diagnostics(self, name: str) -> list[tuple[str, int, int, int]]:
        """What is published next for a file: rule, line, first and last column."""
        while True:
            message = self.receive()
            if message.get("method") == "textDocument/publishDiagnostics" and message["params"]["uri"] == self.uri(
                name
            ):
                return [
                    (
                        each["code"],
                        each["range"]["start"]["line"],
                        each["range"]["start"]["character"],
                        each["range"]["end"]["character"],
                    )
                    for each in message["params"]["diagnostics"]
                ]

    def close(self) -> None:
        self.request("shutdown")
        self.notify("exit")
        with self.process:
            assert self.process.wait(20) == 0


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    editor = Editor(tmp_path)
    yield editor
    editor.close()


def test_diagnostics_come_and_go_as_one_types(editor: Editor) -> None:
    editor.open("main.btq", WRONG)
    assert editor.diagnostics("main.btq") == [("unknown-node", 2, 8, 15)]
    editor.change("main.btq", RIGHT)
    assert editor.diagnostics("main.btq") == []
    editor.change("main.btq", "", version=3)
    assert editor.diagnostics("main.btq") == []


def test_an_edit_in_one_file_reaches_the_file_that_includes_it(editor: Editor) -> None:
    editor.open("skills.btq", "Action Dock\n")
    assert editor.diagnostics("skills.btq") == []
    editor.open("main.btq", 'include "skills.btq"\nBehaviorTree Main\n    Dock (x = 1)\n')
    assert editor.diagnostics("main.btq") == [("unknown-port", 2, 10, 11)]
    editor.change("skills.btq", "Action Dock\n    input x : int = 0\n")
    assert editor.diagnostics("main.btq") == []


def test_closing_a_file_clears_it(editor: Editor) -> None:
    editor.open("main.btq", WRONG)
    assert editor.diagnostics("main.btq") != []
    editor.notify("textDocument/didClose", textDocument={"uri": editor.uri("main.btq")})
    assert editor.diagnostics("main.btq") == []


def test_formatting(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n  Dock\n")
    options = {"tabSize": 4, "insertSpaces": True}
    edits = editor.request("textDocument/formatting", textDocument={"uri": editor.uri("main.btq")}, options=options)
    assert [(edit["range"]["start"], edit["newText"]) for edit in edits] == [({"line": 1, "character": 2}, "  ")]


@pytest.mark.parametrize(("encoding", "column"), [("utf-8", 17), ("utf-16", 15), ("utf-32", 14)])
def test_columns_are_counted_as_agreed(tmp_path: Path, encoding: str, column: int) -> None:
    editor = Editor(tmp_path, (encoding,))
    assert editor.capabilities["capabilities"]["positionEncoding"] == encoding
    editor.open("main.btq", 'BehaviorTree Main\n    Dock "🤖" (_skipif = x)\n')
    found = editor.diagnostics("main.btq")
    assert (found[0][0], found[0][2]) == ("unknown-attribute", column)
    editor.close()
