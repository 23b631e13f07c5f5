"""Sessions of editing, key by key, as a language server hears them: what it says after each is taken down.

The last session is the recording of an hour's work; in the others chance hits the keys.
"""

from __future__ import annotations

import json
import random
import re
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import damaged
import drawn
import frozen
from client import Client, Message, spans
from under_test import normalized

SESSIONS = 17
HOUR = SESSIONS - 1  # the recording
EDITS = 150  # of each other session
NAME = re.compile(r"[^\W\d]\w*")
PIECES = (
    *"(){}\"'=:,ä🤖静aex1_-.?#\n\t\u2028",
    *("/*", "*/", "->", "R->", "||", "\r\n", " ", "\n    ", "\n        ", "30 s", "3 %", "takes at most 30 s"),
    *("on violation fail", "satisfies ", "apply "),
    *("SubTree ", "BehaviorTree ", "QualityReq ", "signal ", "context ", "Root ", "Action ", "input ", "include "),
)
PROJECTS = (
    'engine = ["4.6"]\n',
    'engine = ["4.8", "4.10"]\ninclude-paths = ["shared"]\n[rules]\nunknown-node = "error"\n',
    'ignore = ["unused-requirement"]\nqualities = "iso25010-2011"\n',
    "engine = 4\n[rules\n",
)
AT_A_PLACE = (
    *("hover", "completion", "signatureHelp", "definition", "declaration", "typeDefinition", "implementation"),
    *("documentHighlight", "prepareRename", "linkedEditingRange", "prepareCallHierarchy"),
)
OF_A_FILE = ("documentSymbol", "foldingRange", "documentLink", "codeLens", "semanticTokens/full", "diagnostic")
COMMANDS = ("btq.server.xml", "btq.server.picture", "btq.server.overview")
VERSIONLESS = "\0"  # a server tells its version only at first
OPTIONS = {"tabSize": 4, "insertSpaces": True}


def session(number: int, command: list[str]) -> Iterator[str]:
    """What a server says, edit by edit."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder).resolve() / "case"
        files = session_files(number)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8", newline="")
        with Client(command, root) as client:
            person = Person(client, random.Random(f"session {number}"), recorded=number == HOUR)
            steps = person.play(recording()) if number == HOUR else person.edit(sorted(files))
            try:
                for step in steps:
                    yield f"{step}\n{person.said()}"
            except EOFError as ended:
                yield f"{ended}\n"


@cache
def recording() -> str:
    """The keys of an hour."""
    return frozen.text(frozen.named("an_hour.keys"))


def session_files(number: int) -> dict[str, str]:
    """What is in the folder at first."""
    folders = ("examples/hospital", "examples/laboratory", "examples/pick-and-place", "examples/navigation")
    folder = folders[number % 4]
    files = {path[len(folder) + 1 :]: frozen.text(path) for path in frozen.paths(folder) if not path.endswith(".md")}
    if number != HOUR:
        files |= {"drawn.btq": drawn.mission(number), "judged.btq": drawn.judged_mission(number)}
        files |= {"damaged.btq": damaged.damaged_mission(number)[1]}
        files |= {"classic.btq": frozen.text(frozen.named("inspector.qualitybtcpp"))}
    return files


class Person:
    """Somebody at an editor."""

    def __init__(self, client: Client, chance: random.Random, *, recorded: bool) -> None:
        self.client = client
        self.chance = chance
        self.name = ""
        self.cursor = 0
        self.count = 0
        self.recorded = recorded
        self.told: list[Message] = []
        self.undone: list[tuple[dict[str, str], str, int]] = []

    # ---- what is taken down ----

    def said(self) -> str:
        """What the server says now: what it has told, at times of all files, and at times everything."""
        self.count += 1
        found: dict[str, Any] = {"told": self.told}
        if self.name in self.client.texts:
            others = sorted(self.client.texts) if self.count % 10 == 0 else []
            for name in others:
                found[f"diagnostics of {name}"] = self._ask("diagnostic", name)
            if self.count % (20 if self.recorded else 10) == 0:
                names = [match.start() for match in NAME.finditer(self.client.texts[self.name])]
                for cursor in (self.cursor, *(self.chance.choice(names) for _ in names[:2])):
                    found[f"at {cursor}"] = self._everything(cursor)
        text = json.dumps(found, indent=1, ensure_ascii=False, sort_keys=True)
        text = re.sub(r'\n *"resultId": "[^"]*",?', "", text)
        return normalized(text, str(self.client.root), VERSIONLESS) + "\n"

    def _ask(self, what: str, name: str, **params: Any) -> Any:
        return self.client.ask(f"textDocument/{what}", **self.client.document(name), **params)

    def _everything(self, cursor: int) -> dict[str, Any]:
        """What an editor can ask about a place and its file."""
        client, name = self.client, self.name
        at = client.at(name, cursor)
        span = {"range": {"start": at["position"], "end": at["position"]}}
        whole = {
            "range": {"start": {"line": 0, "character": 0}, "end": client.at(name, len(client.texts[name]))["position"]}
        }
        found = {what: client.ask(f"textDocument/{what}", **at) for what in AT_A_PLACE}
        found |= {what: self._ask(what, name) for what in OF_A_FILE}
        found["references"] = client.ask("textDocument/references", **at, context={"includeDeclaration": True})
        found["rename"] = client.ask("textDocument/rename", **at, newName="renamed")
        found["selectionRange"] = self._ask("selectionRange", name, positions=[at["position"]])
        found["formatting"] = self._ask("formatting", name, options=OPTIONS)
        found["onTypeFormatting"] = client.ask("textDocument/onTypeFormatting", **at, ch="\n", options=OPTIONS)
        found["inlayHint"] = self._ask("inlayHint", name, **whole)
        found["semanticTokens/range"] = self._ask("semanticTokens/range", name, **whole)
        for title, part in (("here", span), ("anywhere", whole)):
            found[f"codeAction {title}"] = self._ask("codeAction", name, **part, context={"diagnostics": self.told})
        for item in found["prepareCallHierarchy"] or ():
            for way in ("incomingCalls", "outgoingCalls"):
                found[f"{way} {item.get('name')}"] = client.ask(f"callHierarchy/{way}", item=item)
        offered = found["completion"]
        items = offered.get("items", []) if isinstance(offered, dict) else []
        found["resolved"] = [client.ask("completionItem/resolve", **item) for item in items[:3]]
        found["symbols"] = client.ask("workspace/symbol", query=client.texts[name][cursor:][:1])
        for command in COMMANDS:
            given = {"command": command, "arguments": [{"uri": client.uri(name)}]}
            found[command] = client.ask("workspace/executeCommand", **given)
        found["path"] = client.ask("workspace/executeCommand", command="btq.server.nodePath", arguments=[at])
        return found

    # ---- what both do ----

    def change(self, start: int, end: int, new: str) -> None:
        self.apply({self.name: [(start, end, new)]})

    def apply(self, changes: dict[str, list[tuple[int, int, str]]]) -> None:
        """Edits of open files, in each the last one first; the cursor stays where it is in the text."""
        client = self.client
        for name in changes:
            if name not in client.texts:
                path = client.root / name
                client.open(name, path.read_text("utf-8") if path.exists() else "")
        self.undone.append(({name: client.texts[name] for name in changes}, self.name, self.cursor))
        for name, edits in changes.items():
            for start, end, new in edits:
                told = client.change(name, start, end, new)
                if name == self.name:
                    self.told = told
                    if start <= self.cursor:
                        self.cursor += len(new) - (min(end, self.cursor) - start)

    def apply_edit(self, edit: Message | None) -> None:
        """A WorkspaceEdit."""
        changes = dict((edit or {}).get("changes") or {})
        for change in (edit or {}).get("documentChanges") or ():
            changes[change["textDocument"]["uri"]] = change["edits"]
        names = {self.client.name_of(uri): edits for uri, edits in changes.items()}
        for name in names:
            if name not in self.client.texts:
                self.client.open(name, (self.client.root / name).read_text("utf-8"))
        self.apply({name: spans(self.client.texts[name], edits) for name, edits in names.items()})

    def undo(self) -> None:
        texts, self.name, self.cursor = self.undone.pop()
        for name, text in texts.items():
            if name in self.client.texts:
                told = self.client.change(name, 0, len(self.client.texts[name]), text)
                self.told = told if name == self.name else self.told

    def open(self, name: str) -> None:
        self.name, self.cursor = name, 0
        if name not in self.client.texts:
            path = self.client.root / name
            self.told = self.client.open(name, path.read_bytes().decode("utf-8") if path.exists() else "")

    def save(self) -> None:
        path = self.client.root / self.name
        kind = 2 if path.exists() else 1
        path.write_text(self.client.texts[self.name], encoding="utf-8", newline="")
        self.client.watched(self.name, kind)

    def close(self) -> None:
        self.client.close(self.name)
        self.name, self.cursor = next(iter(self.client.texts), ""), 0

    def format(self) -> None:
        edits = self._ask("formatting", self.name, options=OPTIONS) or []
        self.apply({self.name: spans(self.client.texts[self.name], edits)})

    def rename(self, name: str) -> None:
        self._apply_if_edit(
            self.client.ask("textDocument/rename", **self.client.at(self.name, self.cursor), newName=name)
        )

    def _apply_if_edit(self, answer: Any) -> None:
        if isinstance(answer, dict) and "message" not in answer:
            self.apply_edit(answer)

    def actions(self, start: int, end: int) -> list[Message]:
        ends = [self.client.at(self.name, offset)["position"] for offset in (start, end)]
        span = dict(zip(("start", "end"), ends, strict=True))
        found = self._ask("codeAction", self.name, range=span, context={"diagnostics": []})
        return [each for each in found or () if each.get("edit")]

    # ---- the recording ----

    def play(self, keys: str) -> Iterator[str]:
        """Every key of a recording, whose language its head explains."""
        for line in keys.splitlines():
            word, _, rest = line.partition(" ")
            if line and word != "#":
                yield from (line for _ in self._key(word, rest.replace("\\n", "\n").replace("\\t", "\t")))

    def _key(self, word: str, rest: str) -> Iterator[None]:
        text = self.client.texts.get(self.name, "")
        if word == "type":
            for character in rest:
                self.change(self.cursor, self.cursor, character)
                yield
            return
        if word in ("back", "undo"):
            for _ in range(int(rest)):
                if word == "back":
                    self.change(self.cursor - 1, self.cursor, "")
                else:
                    self.undo()
                yield
            return
        if word in ("at", "before"):
            self.cursor = text.find(rest) + (len(rest) if word == "at" else 0)
        elif word == "end":
            self.cursor = len(text.rstrip())
        elif word == "enter":
            self.change(self.cursor, self.cursor, "\n")
            yield
            at = self.client.at(self.name, self.cursor)
            edits = self.client.ask("textDocument/onTypeFormatting", **at, ch="\n", options=OPTIONS)
            if not edits:
                return
            self.apply({self.name: spans(self.client.texts[self.name], edits)})
        elif word == "take":
            count, _, new = rest.partition(" ")
            self.change(self.cursor, self.cursor + int(count), new)
        elif word == "accept":
            found = self.client.ask("textDocument/completion", **self.client.at(self.name, self.cursor))
            for item in found["items"]:
                if item["label"] == rest:
                    self.apply({self.name: spans(text, [item["textEdit"]])})
                    break
        elif word == "fix":
            for action in self.actions(self.cursor, self.cursor):
                if action["title"].startswith(rest):
                    self.apply_edit(action["edit"])
                    break
        elif word in ("open", "rename"):
            getattr(self, word)(rest)
        else:
            getattr(self, word)()
        yield

    # ---- chance ----

    def edit(self, names: list[str]) -> Iterator[str]:
        """Edits by chance, each with a word on what it was."""
        missions = [name for name in names if name.endswith((".btq", ".qualitybtcpp"))]
        for name in missions:
            self.open(name)
            yield f"open {name}"
        kinds: list[Callable[[], str]] = [
            *[self._type] * 6,
            *[self._delete] * 3,
            *[self._paste] * 2,
            *[self._exchange] * 2,
            *(self._move_line, self._undo, self._undo, self._fix, self._fix, self._rename, self._format),
            *(self._project, self._disk),
        ]
        for _ in range(EDITS):
            if self.chance.random() < 0.3:
                self.name = self.chance.choice(missions)
            if not self.client.texts[self.name].strip() or len(self.client.texts[self.name]) > 12_000:
                self.change(
                    0, len(self.client.texts[self.name]), damaged.damaged_mission(self.chance.randrange(5_000))[0]
                )
            self.cursor = self.chance.randint(0, len(self.client.texts[self.name]))
            yield f"{self.chance.choice(kinds)()} in {self.name}"

    def _type(self) -> str:
        piece = self.chance.choice(PIECES)
        self.change(self.cursor, self.cursor, piece)
        return f"type {piece!r}"

    def _delete(self) -> str:
        count = self.chance.choice((1, 1, 1, 2, 5, 30))
        self.change(self.cursor, min(self.cursor + count, len(self.client.texts[self.name])), "")
        return f"delete {count}"

    def _paste(self) -> str:
        _, text = damaged.damaged_mission(self.chance.randrange(5_000))
        lines = text.splitlines(keepends=True)
        at = self.chance.randint(0, len(lines))
        start = self.client.texts[self.name].rfind("\n", 0, self.cursor) + 1
        self.change(start, start, "".join(lines[at : at + self.chance.choice((1, 2, 6))]))
        return "paste"

    def _exchange(self) -> str:
        """A name becomes another one of the same file."""
        found = list(NAME.finditer(self.client.texts[self.name])) or [re.match("", "")]
        one, other = self.chance.choice(found), self.chance.choice(found)
        assert one is not None
        assert other is not None
        self.change(one.start(), one.end(), other[0])
        return f"{one[0]} becomes {other[0]}"

    def _move_line(self) -> str:
        text = self.client.texts[self.name]
        start = text.rfind("\n", 0, self.cursor) + 1
        if self.chance.random() < 0.5:
            self.change(start, start, "    ")
            return "indent"
        end = text.find("\n", start) + 1 or len(text)
        self.change(start, end, text[start:end] * 2)
        return "double"

    def _undo(self) -> str:
        count = min(self.chance.choice((1, 1, 3)), len(self.undone))
        for _ in range(count):
            self.undo()
        self.cursor = min(self.cursor, len(self.client.texts[self.name]))
        return f"undo {count}"

    def _fix(self) -> str:
        found = self.actions(0, len(self.client.texts[self.name]))
        if not found:
            return "no fix"
        action = self.chance.choice(found)
        self.apply_edit(action["edit"])
        return f"fix {action['title']}"

    def _rename(self) -> str:
        found = list(NAME.finditer(self.client.texts[self.name]))
        if found:
            self.cursor = self.chance.choice(found).start()
            self.rename(self.chance.choice(("renamed", "two words", "Retry", "x")))
        return "rename"

    def _format(self) -> str:
        self.format()
        return "format"

    def _project(self) -> str:
        """The project file, as it is on the disk."""
        path = self.client.root / "btq.toml"
        kind = 2 if path.exists() else 1
        if kind == 2 and self.chance.random() < 0.3:
            path.unlink()
            kind = 3
        else:
            path.write_text(self.chance.choice(PROJECTS), encoding="utf-8")
        self.client.watched("btq.toml", kind)
        return f"btq.toml {kind}"

    def _disk(self) -> str:
        """A file that nobody has open: made, changed, deleted."""
        path = self.client.root / "closed.btq"
        kind = 2 if path.exists() else 1
        if kind == 2 and self.chance.random() < 0.3:
            path.unlink()
            kind = 3
        else:
            _, text = damaged.damaged_mission(self.chance.randrange(5_000))
            path.write_text(text, encoding="utf-8", newline="")
        self.client.watched("closed.btq", kind)
        return f"closed.btq {kind}"
