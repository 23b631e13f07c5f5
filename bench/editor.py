"""The editor's end of a language server, and what an author types in it."""

from __future__ import annotations

import json
import os
import random
import re
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from report import ENVIRONMENT

Message = dict[str, Any]


@dataclass(eq=False)
class Series:
    """What one kind of message took, in seconds: by the clock, and of the server's processor time."""

    name: str
    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)


# ---- typing ---------------------------------------------------------------------------------------------------------


@dataclass
class Document:
    """An open file as the editor has it."""

    uri: str
    text: str
    version: int = 1

    @property
    def name(self) -> Message:
        return {"uri": self.uri}

    def position(self, offset: int) -> Message:
        start = self.text.rfind("\n", 0, offset) + 1
        return {"line": self.text.count("\n", 0, offset), "character": offset - start}

    def words(self) -> list[int]:
        """Offsets inside names, of nodes, trees and requirements."""
        return [match.start() + 1 for match in _WORD.finditer(self.text)]


@dataclass(frozen=True)
class Stroke:
    """What one change of the text is: so much gone at an offset, and something else there."""

    offset: int
    gone: int
    text: str


@dataclass(frozen=True)
class Typing:
    """What is typed in a language.

    Attributes:
        after: the lines after which nodes are typed; `blanks` is their indentation.
        node: the line that is typed.
        values: what a digit is typed behind, as `it`.
    """

    after: re.Pattern[str]
    node: str
    values: tuple[re.Pattern[str], ...]


IN_BTQ = Typing(
    re.compile(r"^(?P<blanks>[ \t]{8,})[A-Z]\w+(?: \([^()\n]*\))?(?=\n)", re.MULTILINE),
    "Charge (level = 80)",
    (
        re.compile(r" = (?P<it>[0-9]+)"),
        re.compile(r" at most (?P<it>[0-9]+)"),
        re.compile(r"^BehaviorTree (?P<it>\w+)", re.MULTILINE),
    ),
)
IN_XML = Typing(
    re.compile(r"^(?P<blanks>[ \t]{4,})<[^<>]*/>(?=\n)", re.MULTILINE),
    '<Charge level="80"/>',
    (re.compile(r' [a-z_]+="(?P<it>[0-9]+)"'), re.compile(r'<BehaviorTree ID="(?P<it>\w+)"')),
)


def strokes(document: Document, draw: random.Random, typing: Typing = IN_BTQ) -> Iterator[Stroke]:
    """What an author types in one go: a new node behind another, letter by letter, and a value; sometimes the name of
    a tree, or the bound of a requirement.  In the end all of it is taken back, so that the file stays as large."""
    before = document.text
    line = draw.choice(list(typing.after.finditer(before)))
    typed = f"\n{line['blanks']}{typing.node}"
    for index, letter in enumerate(typed):
        yield Stroke(line.end() + index, 0, letter)
    yield Stroke(line.end(), len(typed), "")
    for pattern in typing.values:
        place = draw.choice([match.span("it") for match in pattern.finditer(before)] or [(0, 0)])
        if place[1]:
            yield Stroke(place[1], 0, "1")
            yield Stroke(place[1], 1, "")


_WORD = re.compile(r"\b[A-Z]\w{3,}")


# ---- the server at the other end ------------------------------------------------------------------------------------


class Server:
    """A server and the editor's end of it: the editor takes whatever the server offers, and answers what it asks."""

    def __init__(self, command: tuple[str, ...], root: Path) -> None:
        # Not in a checkout: there `python -c` would import that, and not the package that is installed.
        self.process = subprocess.Popen(
            command, cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=ENVIRONMENT
        )
        assert self.process.stdin is not None, "it is a pipe"
        assert self.process.stdout is not None, "as above"
        self._to, self._from = self.process.stdin, self.process.stdout
        self._count = 0
        self._kept: list[Message] = []
        capabilities = {
            "window": {"workDoneProgress": True},
            "textDocument": {
                "completion": {"completionItem": {"snippetSupport": True}},
                "semanticTokens": {
                    "requests": {"full": {"delta": True}},
                    "tokenTypes": [],
                    "tokenModifiers": [],
                    "formats": ["relative"],
                },
            },
        }
        answer = self.request("initialize", capabilities=capabilities, rootUri=root.as_uri(), processId=None)
        sync = answer["capabilities"].get("textDocumentSync", 1)
        self.takes_parts = (sync["change"] if isinstance(sync, dict) else sync) == 2
        self.notify("initialized")

    def open(self, path: Path) -> Document:
        document = Document(path.as_uri(), path.read_text(encoding="utf-8"))
        item = {"uri": document.uri, "languageId": path.suffix[1:], "version": 1, "text": document.text}
        self.notify("textDocument/didOpen", textDocument=item)
        return document

    def change(self, document: Document, stroke: Stroke) -> None:
        """Type, and wait for the diagnostics of what is typed."""
        self.type(document, stroke)
        self.wait_for(is_of(document))

    def type(self, document: Document, stroke: Stroke) -> None:
        """Change a document, here and there."""
        end = stroke.offset + stroke.gone
        change: Message = {"text": stroke.text}
        if self.takes_parts:
            change["range"] = {"start": document.position(stroke.offset), "end": document.position(end)}
        document.text = document.text[: stroke.offset] + stroke.text + document.text[end:]
        document.version += 1
        if not self.takes_parts:
            change["text"] = document.text
        name = {"uri": document.uri, "version": document.version}
        self.notify("textDocument/didChange", textDocument=name, contentChanges=[change])

    def request(self, method: str, **params: Any) -> Any:
        self._count += 1
        self._send(id=self._count, method=method, params=params)
        while (message := self._receive()).get("id") != self._count:
            self._kept.append(message)
        if "error" in message:
            raise SystemExit(f"{method} is refused: {message['error']}")
        return message["result"]

    def notify(self, method: str, **params: Any) -> None:
        self._send(method=method, params=params)

    def wait_for(self, is_wanted: Callable[[Message], bool]) -> Message:
        for index, message in enumerate(self._kept):
            if is_wanted(message):
                del self._kept[: index + 1]
                return message
        self._kept.clear()
        while not is_wanted(message := self._receive()):
            pass
        return message

    @contextmanager
    def measuring(self, series: Series) -> Iterator[None]:
        cpu, wall = self.processor_time(), time.perf_counter()
        yield
        series.wall.append(time.perf_counter() - wall)
        series.cpu.append(self.processor_time() - cpu)

    def processor_time(self) -> float:
        """Seconds of processor that the process has had, to the nanosecond, of all its threads (Linux)."""
        tasks = Path(f"/proc/{self.process.pid}/task").iterdir()
        return sum(int((task / "schedstat").read_text().split()[0]) for task in tasks) / 1e9

    def memory(self) -> float:
        """The megabytes that the process has resident (Linux)."""
        pages = int(Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    def end(self) -> None:
        self.request("shutdown")
        self.notify("exit")
        self.process.wait(timeout=30)
        self._to.close()
        self._from.close()

    def _send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self._to.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self._to.flush()

    def _receive(self) -> Message:
        """The next message that is not a request of the server's; those are answered."""
        while True:
            length = 0
            while (line := self._from.readline()) not in (b"\r\n", b""):
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            if not length:
                raise SystemExit("the server has gone")
            message: Message = json.loads(self._from.read(length))
            if "id" not in message or "method" not in message:
                return message
            self._send(id=message["id"], result=None)


_DIAGNOSTICS = "textDocument/publishDiagnostics"


def is_about(path: Path) -> Callable[[Message], bool]:
    """Whether a message tells the diagnostics of a file."""
    uri = path.as_uri()
    return lambda message: message.get("method") == _DIAGNOSTICS and message["params"]["uri"] == uri


def is_of(document: Document) -> Callable[[Message], bool]:
    """Whether a message tells the diagnostics of a document as it is now."""
    now = document.uri, document.version
    return lambda message: (
        message.get("method") == _DIAGNOSTICS and (message["params"]["uri"], message["params"].get("version")) == now
    )


def is_progress(message: Message) -> bool:
    return message.get("method") == "$/progress"


def is_end_of_progress(message: Message) -> bool:
    return is_progress(message) and message["params"]["value"]["kind"] == "end"
