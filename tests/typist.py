"""A person at an editor: plays a recording of keys, a session of the server behind them.

The language of recordings is at the head of `recordings/an_hour.keys`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from btq_lang.formatter import format_text
from btq_lang.ide.actions import code_actions
from btq_lang.ide.completion import complete
from btq_lang.ide.on_type import on_type
from btq_lang.ide.rename import RenameRefusal, rename
from btq_lang.lsp.session import Session
from btq_lang.util.text import Edit, Span, apply_edits
from btq_lang.workspace.workspace import Workspace


class Typist:
    """What a person has open, and where the cursor is.

    Attributes:
        texts: of the open files, by path.
        path, cursor: the file in front, and the offset in it.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.session = Session()
        self.session.folders = (str(folder),)
        self.texts: dict[str, str] = {}
        self.path = ""
        self.cursor = 0
        self._told: dict[str, object] = {}
        self._changed: dict[str, None] = {}
        self._undone: list[tuple[dict[str, str], str, int]] = []
        self._tell(self.session.reload())

    def play(self, recording: str) -> Iterator[str]:
        """Every key, as the line of the recording that it is of; what it does is done when it is given."""
        for line in recording.splitlines():
            word, _, rest = line.partition(" ")
            if line and word != "#":
                for _ in getattr(self, f"step_{word}")(rest.replace("\\n", "\n").replace("\\t", "\t")):
                    yield line

    @property
    def told(self) -> dict[str, object]:
        """For each file the diagnostics that an editor would show: only what the session has named is asked again."""
        for path in self._changed:
            self._told[path] = self.session.diagnostics(path)
        self._changed.clear()
        known = set(self.session.paths())
        self._told = {path: found for path, found in self._told.items() if path in known}
        return self._told

    # ---- steps: each yields once for a key ----

    def step_open(self, name: str) -> Iterator[None]:
        self.path = str(self.folder / name)
        self.cursor = 0
        if self.path not in self.texts:
            file = Path(self.path)
            self.texts[self.path] = file.read_text(encoding="utf-8") if file.exists() else ""
            self._tell(self.session.edit(self.path, self.texts[self.path]))
        yield

    def step_close(self, _: str) -> Iterator[None]:
        del self.texts[self.path]
        self._tell((self.path, *self.session.close(self.path)))
        self.path = next(iter(self.texts), "")
        self.cursor = 0
        yield

    def step_save(self, _: str) -> Iterator[None]:
        Path(self.path).write_text(self.texts[self.path], encoding="utf-8")
        self._tell(self.session.reload())
        yield

    def step_at(self, text: str) -> Iterator[None]:
        self.cursor = self.texts[self.path].index(text) + len(text)
        yield

    def step_before(self, text: str) -> Iterator[None]:
        self.cursor = self.texts[self.path].index(text)
        yield

    def step_end(self, _: str) -> Iterator[None]:
        self.cursor = len(self.texts[self.path].rstrip())
        yield

    def step_type(self, text: str) -> Iterator[None]:
        for character in text:
            self._change(self.cursor, self.cursor, character)
            yield

    def step_enter(self, _: str) -> Iterator[None]:
        self._change(self.cursor, self.cursor, "\n")
        yield
        made = on_type(*self._here, "\n")
        if made:
            self._apply({self.path: made})
            yield

    def step_back(self, count: str) -> Iterator[None]:
        for _ in range(int(count)):
            self._change(self.cursor - 1, self.cursor, "")
            yield

    def step_take(self, rest: str) -> Iterator[None]:
        count, _, text = rest.partition(" ")
        self._change(self.cursor, self.cursor + int(count), text)
        yield

    def step_accept(self, label: str) -> Iterator[None]:
        found = complete(*self._here)
        one = next(one for one in found.proposals if one.label == label)
        self._change(*found.span, one.insert)
        yield

    def step_rename(self, name: str) -> Iterator[None]:
        made = rename(*self._here, name)
        assert not isinstance(made, RenameRefusal), made.reason
        self._apply(made.edits)
        yield

    def step_fix(self, title: str) -> Iterator[None]:
        workspace, path, cursor = self._here
        action = next(one for one in code_actions(workspace, path, Span(cursor, cursor)) if one.title.startswith(title))
        self._apply(action.edits)
        yield

    def step_format(self, _: str) -> Iterator[None]:
        self._apply({self.path: format_text(self.texts[self.path]).edits})
        yield

    def step_undo(self, count: str) -> Iterator[None]:
        for _ in range(int(count)):
            texts, self.path, self.cursor = self._undone.pop()
            for path, text in texts.items():
                self.texts[path] = text
                self._tell(self.session.edit(path, text))
            yield

    # ---- what they are made of ----

    @property
    def _here(self) -> tuple[Workspace, str, int]:
        workspace = self.session.workspace_of(self.path)
        assert workspace is not None, "what is open is known"
        return workspace, self.path, self.cursor

    def _change(self, start: int, end: int, text: str) -> None:
        self._apply({self.path: (Edit(Span(start, end), text),)})

    def _apply(self, changes: Mapping[str, tuple[Edit, ...]]) -> None:
        """Edits of files; the cursor stays where it is in the text."""
        workspace = self.session.workspace_of(self.path)
        assert workspace is not None, "what is open is known"
        texts = {path: self.texts.get(path, workspace.files[path].text) for path in changes}
        self._undone.append((texts, self.path, self.cursor))
        for path, edits in changes.items():
            self.texts[path] = apply_edits(texts[path], edits)
            self._tell(self.session.edit(path, self.texts[path]))
        moved = self.cursor
        for edit in changes.get(self.path, ()):
            if edit.span.start <= self.cursor:
                moved += len(edit.text) - (min(edit.span.end, self.cursor) - edit.span.start)
        self.cursor = moved

    def _tell(self, changed: tuple[str, ...]) -> None:
        self._changed.update(dict.fromkeys(changed))
