"""An editor that speaks to a language server over its standard input and output, and knows nothing of btq."""

from __future__ import annotations

import json
import re
import signal
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

Message = dict[str, Any]
MOST_SECONDS = 120  # for an answer
LINE_END = re.compile(r"\r\n|\r|\n")
CAPABILITIES: Message = {"textDocument": {"publishDiagnostics": {"relatedInformation": True}}}


class Client:
    """An editor with a folder; what it says of files is said by their names in it.

    Attributes:
        texts: of open files.
    """

    def __init__(self, command: Sequence[str], root: Path) -> None:
        self.root = root
        self.texts: dict[str, str] = {}
        self._versions: dict[str, int] = {}
        self._version = 0  # never the same twice, so that what is told late is told of no other text
        self._count = 0
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._handler = signal.signal(signal.SIGALRM, lambda *_: self._process.kill())
        self.ask("initialize", capabilities=CAPABILITIES, rootUri=root.as_uri(), processId=None)
        self._send(method="initialized", params={})

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, self._handler)
        self._process.kill()
        self._process.communicate()

    # ---- messages ----

    def _send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self._process.stdin is not None
        self._process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self._process.stdin.flush()

    def _receive(self) -> Message:
        """The next message; requests of the server are answered with nothing."""
        assert self._process.stdout is not None
        signal.alarm(MOST_SECONDS)
        while True:
            length = 0
            while (line := self._process.stdout.readline()) not in (b"\r\n", b""):
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            if not length:
                raise EOFError("the server has ended")
            message: Message = json.loads(self._process.stdout.read(length))
            if "id" not in message or "method" not in message:
                return message
            self._send(id=message["id"], result=None)

    def ask(self, method: str, **params: Any) -> Any:
        """The result of a request, or its error."""
        self._count += 1
        self._send(id=self._count, method=method, params=params)
        while (message := self._receive()).get("id") != self._count:
            pass
        return message.get("result", message.get("error"))

    def _published(self, name: str) -> list[Message]:
        """The diagnostics that the server tells of a file's present version."""
        while True:
            message = self._receive()
            params = message.get("params") or {}
            told = (message.get("method"), params.get("uri"), params.get("version"))
            if told == ("textDocument/publishDiagnostics", self.uri(name), self._versions[name]):
                found: list[Message] = params["diagnostics"]
                return found

    # ---- documents ----

    def uri(self, name: str) -> str:
        return (self.root / name).as_uri()

    def document(self, name: str) -> Message:
        return {"textDocument": {"uri": self.uri(name)}}

    def at(self, name: str, offset: int) -> Message:
        return {**self.document(name), "position": position(self.texts[name], offset)}

    def open(self, name: str, text: str) -> list[Message]:
        """Open a file; what is wrong with it."""
        self.texts[name] = text
        self._version += 1
        self._versions[name] = self._version
        item = {"uri": self.uri(name), "languageId": "btq", "version": self._version, "text": text}
        self._send(method="textDocument/didOpen", params={"textDocument": item})
        return self._published(name)

    def change(self, name: str, start: int, end: int, new: str) -> list[Message]:
        """Change a part of an open file; what is wrong with it."""
        text = self.texts[name]
        span = {"start": position(text, start), "end": position(text, end)}
        change: Message = {"range": span, "text": new}
        changed = text[:start] + new + text[end:]
        if [offset(text, span["start"]), offset(text, span["end"])] != [start, end]:
            change = {"text": changed}  # no position is between \r and \n
        self.texts[name] = changed
        self._version += 1
        self._versions[name] = self._version
        document = {"uri": self.uri(name), "version": self._versions[name]}
        self._send(method="textDocument/didChange", params={"textDocument": document, "contentChanges": [change]})
        return self._published(name)

    def close(self, name: str) -> None:
        del self.texts[name]
        self._send(method="textDocument/didClose", params=self.document(name))

    def watched(self, name: str, kind: int) -> None:
        """Tell that a file on the disk was made (1), changed (2) or deleted (3)."""
        change = {"uri": self.uri(name), "type": kind}
        self._send(method="workspace/didChangeWatchedFiles", params={"changes": [change]})

    def name_of(self, uri: str) -> str:
        return uri.removeprefix(f"{self.root.as_uri()}/")


# ---- positions, in UTF-16 ----


def position(text: str, offset: int) -> Message:
    """The position of an offset."""
    ends = [match.end() for match in LINE_END.finditer(text, 0, offset)]
    if text[offset - 1 : offset + 1] == "\r\n" and ends:  # the line end is not over
        ends.pop()
    start = ends[-1] if ends else 0
    return {"line": len(ends), "character": len(text[start:offset].encode("utf-16-le", "surrogatepass")) // 2}


def offset(text: str, place: Mapping[str, int]) -> int:
    """The offset of a position."""
    starts = [0, *(match.end() for match in LINE_END.finditer(text))]
    start = starts[place["line"]] if place["line"] < len(starts) else len(text)
    end = LINE_END.search(text, start)
    line = text[start : end.start() if end else len(text)].encode("utf-16-le", "surrogatepass")
    return start + len(line[: 2 * place["character"]].decode("utf-16-le", "surrogatepass"))


def spans(text: str, edits: Sequence[Mapping[str, Any]]) -> list[tuple[int, int, str]]:
    """Edits of the protocol as offsets, the last one first."""
    found = [(*(offset(text, each["range"][end]) for end in ("start", "end")), each["newText"]) for each in edits]
    return sorted(((start, end, new) for start, end, new in found), key=lambda each: each[:2], reverse=True)
