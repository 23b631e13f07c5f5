"""What the tests of editor features assert: `tests/README.md` has the notation on one page.

A fixture is files in a string, with `$0` where the cursor is and `<def>…</def>` round what is expected.  Only these
functions call a feature; each knows which markers it reads and refuses a fixture that has others, or lacks its own.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from check_asserts import split_files

from btq_lang.features.navigation import find_references, goto_definition, highlights
from btq_lang.features.rename import Refusal, prepare_rename, rename
from btq_lang.project import Project
from btq_lang.text import Span, apply_edits
from btq_lang.workspace import Workspace

_TAG = re.compile(r"\$0|</?([a-z]+)>")

Place = tuple[str, int, int]


class Fixture:
    """The files of a fixture without its markers, and where the markers were."""

    def __init__(self, text: str, *allowed: str, cursor: bool = True, project: Project | None = None) -> None:
        self.marks: dict[str, list[Place]] = {mark: [] for mark in allowed}
        self.cursor: tuple[str, int] | None = None
        self.files: dict[str, str] = {}
        for path, content in split_files(text).items():
            self.files[path] = self._read(path, content)
        assert (self.cursor is not None) == cursor, "a cursor `$0` is needed" if cursor else "no cursor is read here"
        self.workspace = Workspace.of(self.files, project)

    def _read(self, path: str, content: str) -> str:
        opened: list[tuple[str, int]] = []
        pieces: list[str] = []
        at = size = 0
        for tag in _TAG.finditer(content):
            pieces.append(content[at : tag.start()])
            size += len(pieces[-1])
            at = tag.end()
            if tag[0] == "$0":
                assert self.cursor is None, "two cursors"
                self.cursor = path, size
            elif tag[0].startswith("</"):
                name, start = opened.pop()
                assert name == tag[1], f"<{name}> is closed by {tag[0]}"
                self.marks[name].append((path, start, size))
            else:
                assert tag[1] in self.marks, f"{tag[0]} says nothing here"
                opened.append((tag[1], size))
        assert not opened, f"{opened} not closed"
        pieces.append(content[at:])
        return "".join(pieces)

    @property
    def at(self) -> tuple[Workspace, str, int]:
        """What a feature is called with."""
        assert self.cursor is not None
        return self.workspace, *self.cursor

    def expect(self, mark: str, found: Iterable[tuple[str, Span]]) -> None:
        """The places found are exactly those marked, shown with what stands there if not."""
        assert self.show(sorted((path, *span) for path, span in found)) == self.show(sorted(self.marks[mark]))

    def show(self, places: Iterable[Place]) -> list[str]:
        return [f"{path}:{start} {self.files[path][start:end]!r}" for path, start, end in places]


def check_goto(text: str) -> None:
    """`<def>` is where the definition of what stands at the cursor is; without one there is none."""
    fixture = Fixture(text, "def")
    targets = goto_definition(*fixture.at)
    for target in targets:
        assert target.span.start <= target.name.start <= target.name.end <= max(target.span.end, target.name.end)
        assert target.origin.start <= fixture.at[2] <= target.origin.end
    fixture.expect("def", ((target.path, target.name) for target in targets))


def check_references(text: str) -> None:
    """`<def>` and `<ref>` are all places that name what stands at the cursor; the answer is the same from each."""
    fixture = Fixture(text, "def", "ref")
    everywhere = fixture.marks["def"] + fixture.marks["ref"]
    for path, start, end in [*everywhere, (*fixture.at[1:], fixture.at[2])]:
        for offset in (start, end):
            found = find_references(fixture.workspace, path, offset)
            assert fixture.show(sorted((where, *span) for where, span in found)) == fixture.show(sorted(everywhere))
    fixture.expect("ref", find_references(*fixture.at, include_definition=False))


def check_highlights(text: str) -> None:
    """`<write>` and `<read>` are what is highlighted with the cursor where it is."""
    fixture = Fixture(text, "write", "read")
    found = highlights(*fixture.at)
    path = fixture.at[1]
    fixture.expect("write", ((path, each.span) for each in found if each.writes))
    fixture.expect("read", ((path, each.span) for each in found if not each.writes))


def check_rename(text: str, name: str, after: str) -> None:
    """Renaming what stands at the cursor makes this of the files; and renaming it back, what they were."""
    fixture = Fixture(text)
    result = rename(*fixture.at, name)
    assert not isinstance(result, Refusal), result.reason
    files = dict(fixture.files)
    for path, edits in result.edits.items():
        assert list(edits) == sorted(edits, key=lambda edit: edit.span)
        files[path] = apply_edits(files[path], edits)
    assert files == split_files(after)


def check_no_rename(text: str, reason: str, name: str | None = None) -> None:
    """What stands at the cursor is not renamed, and this is said about it; without a name it is said at once."""
    fixture = Fixture(text)
    ready = prepare_rename(*fixture.at)
    if name is None:
        assert isinstance(ready, Refusal)
        assert ready.reason == reason
        name = "other"
    else:
        assert not isinstance(ready, Refusal), ready.reason
    result = rename(*fixture.at, name)
    assert isinstance(result, Refusal)
    assert result.reason == reason


def answers(feature: Callable[[Workspace, str, int], object], text: str) -> None:
    """A feature answers at every offset of a text, without an exception."""
    workspace = Workspace.of({"main.btq": text})
    for offset in range(len(text) + 1):
        feature(workspace, "main.btq", offset)
