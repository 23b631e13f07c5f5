"""An editor of the tests: it talks to a server as editors do, and waits for messages, never for time."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from forked_server import Forked, serve

SERVER = (sys.executable, "-m", "btq_lang.server", "--stdio")

Message = dict[str, Any]


def part(start: tuple[int, int], end: tuple[int, int], text: str) -> Message:
    """A change of what stands between two positions."""
    places = [dict(zip(("line", "character"), place, strict=True)) for place in (start, end)]
    return {"range": {"start": places[0], "end": places[1]}, "text": text}


class Editor:
    """An editor with one server: requests are answered in order, notifications are kept until asked for.

    Args:
        command: what starts the server as an editor does; without one it is forked, which takes a tenth of the time.
        program: what a forked one runs, if not the server as it comes.

    Attributes:
        settings: what it answers when the server asks for the section `btq`.
        asked: the requests that the server has made.
    """

    def __init__(
        self,
        root: Path,
        *,
        command: tuple[str, ...] | None = None,
        program: str | None = None,
        capabilities: Message | None = None,
        **more: Any,
    ) -> None:
        self.process: subprocess.Popen[bytes] | Forked = _started(command) if command else Forked(program or serve())
        self.root = root
        self.count = 0
        self.kept: list[Message] = []
        self.asked: list[Message] = []
        self.settings: Message = {}
        self.versions: dict[str, int] = {}
        given = {"capabilities": capabilities or {}, "rootUri": root.as_uri(), "processId": None, **more}
        self.initialized: Message = self.request("initialize", **given)
        self.capabilities: Message = self.initialized["capabilities"]
        self.notify("initialized")

    # ---- messages ----

    def send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin is not None
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.process.stdin.flush()

    def receive(self) -> Message:
        """The next message that is not a request of the server's; those are answered."""
        while True:
            message = self._read()
            if "id" in message and "method" in message:
                self.asked.append(message)
                self.send(id=message["id"], result=self._answer(message))
            else:
                return message

    def _answer(self, asked: Message) -> Any:
        if asked["method"] == "workspace/configuration":
            return [self.settings for _ in asked["params"]["items"]]
        return {"success": True} if asked["method"] == "window/showDocument" else None

    def _read(self) -> Message:
        assert self.process.stdout is not None
        length = 0
        while (line := self.process.stdout.readline()) not in (b"\r\n", b""):
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        assert length, "the server has gone"
        message: Message = json.loads(self.process.stdout.read(length))
        return message

    def notify(self, method: str, **params: Any) -> None:
        self.send(method=method, params=params)

    def ask(self, method: str, **params: Any) -> Message:
        """A request's whole answer, result or error."""
        self.count += 1
        self.send(id=self.count, method=method, params=params)
        while (message := self.receive()).get("id") != self.count:
            self.kept.append(message)
        return message

    def request(self, method: str, **params: Any) -> Any:
        message = self.ask(method, **params)
        assert "error" not in message, message
        return message["result"]

    def wait_for(self, is_wanted: Callable[[Message], bool]) -> Message:
        """The first notification, of those kept and those still to come, that is wanted."""
        for index, message in enumerate(self.kept):
            if is_wanted(message):
                del self.kept[: index + 1]
                return message
        self.kept.clear()
        while not is_wanted(message := self.receive()):
            pass
        return message

    # ---- what an editor does ----

    def uri(self, name: str) -> str:
        return (self.root / name).as_uri()

    def document(self, name: str) -> Message:
        return {"textDocument": {"uri": self.uri(name)}}

    def open(self, name: str, text: str) -> None:
        self.versions[name] = 1
        document = {"uri": self.uri(name), "languageId": "btq", "version": 1, "text": text}
        self.notify("textDocument/didOpen", textDocument=document)

    def change(self, name: str, *changes: str | Message) -> None:
        """Changes one after another: each the whole text, or a part of it that is said anew."""
        self.versions[name] += 1
        document = {"uri": self.uri(name), "version": self.versions[name]}
        said = [{"text": change} if isinstance(change, str) else change for change in changes]
        self.notify("textDocument/didChange", textDocument=document, contentChanges=said)

    def shut(self, name: str) -> None:
        self.notify("textDocument/didClose", **self.document(name))

    def write(self, name: str, text: str) -> None:
        """Change a file on the disk, and tell so."""
        path = self.root / name
        kind = 2 if path.exists() else 1
        path.write_text(text, encoding="utf-8")
        self.notify("workspace/didChangeWatchedFiles", changes=[{"uri": self.uri(name), "type": kind}])

    def at(self, name: str, line: int, character: int) -> Message:
        return {**self.document(name), "position": {"line": line, "character": character}}

    def published(self, name: str) -> Message:
        """What is published next for a file."""
        uri = self.uri(name)

        def is_it(message: Message) -> bool:
            return message.get("method") == "textDocument/publishDiagnostics" and message["params"]["uri"] == uri

        published: Message = self.wait_for(is_it)["params"]
        return published

    def published_for(self, *names: str) -> list[Message]:
        """What is published next for each of some files, in any order."""
        messages: dict[str, Message] = {}
        uris = [self.uri(name) for name in names]

        def is_last(message: Message) -> bool:
            if message.get("method") == "textDocument/publishDiagnostics":
                messages.setdefault(message["params"]["uri"], message["params"])
            return messages.keys() >= {*uris}

        self.wait_for(is_last)
        return [messages[uri] for uri in uris]

    def diagnostics(self, name: str) -> list[tuple[str, int, int, int]]:
        """As `published`: rule, line, first and last column."""
        return [
            (
                each["code"],
                each["range"]["start"]["line"],
                each["range"]["start"]["character"],
                each["range"]["end"]["character"],
            )
            for each in self.published(name)["diagnostics"]
        ]

    def close(self) -> str:
        """End the server as an editor does; what it has written to standard error."""
        self.request("shutdown")
        self.notify("exit")
        _, log = self.process.communicate(timeout=20)
        assert self.process.returncode == 0, log.decode()
        return log.decode()


def _started(command: tuple[str, ...]) -> subprocess.Popen[bytes]:
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
