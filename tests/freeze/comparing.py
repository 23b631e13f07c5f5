"""What is held against the golden file: chunks of cases, the rows of the matrix, and sessions of editing."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import cases
import editing
import frozen
import matrix
from processes import Code, Commands
from under_test import digest

CHUNK = 50  # cases that are told on one line of the golden file
SESSIONS = "editing"
MATRIX = "matrix"
LETTERS = 4  # of a digest
Golden = Mapping[tuple[str, int], tuple[str, str]]
HEADING = "# group, first case, what its cases are made of, and four characters for what each does"


class Chunk(NamedTuple):
    """Cases of a group that follow each other, or a session of editing.

    Attributes:
        count: how many cases, or sessions.
    """

    group: str
    first: int
    count: int

    @property
    def numbers(self) -> range:
        """Of its cases."""
        return range(self.first, self.first + self.count)


class Difference(NamedTuple):
    """A case that is not as it was; `what`: more about it."""

    group: str
    number: int
    what: str = ""

    def __str__(self) -> str:
        return f"{self.group}:{self.number}{f' {self.what}' if self.what else ''}"


def groups() -> tuple[str, ...]:
    """The names of all groups."""
    return (*cases.GROUPS, MATRIX, SESSIONS)


def chunks(names: Iterable[str]) -> Iterator[Chunk]:
    """The cases of groups."""
    for name in names:
        size = 1 if name == SESSIONS else CHUNK
        for first in range(0, _count(name), size):
            yield Chunk(name, first, min(size, _count(name) - first))


def needs_shared(name: str) -> bool:
    """Whether the cases of a group are inputs made by others."""
    return name in cases.GROUPS and cases.GROUPS[name].needs_shared


def compare(
    commands: Commands, names: Iterable[str], every: int = 1, shard: tuple[int, int] = (0, 1)
) -> Iterator[Difference]:
    """The cases that are not as the golden file has them.

    Args:
        every: one case in so many is looked at.
        shard: which of how many parts of the work is done.
    """
    golden = read()
    changed: set[str] = set()  # groups of other inputs
    for index, chunk in enumerate(chunks(names)):
        numbers = [number for number in chunk.numbers if number % every == 0]
        if numbers and index % shard[1] == shard[0]:
            inputs, expected = golden.get(chunk[:2], ("", ""))
            if inputs != digest(_inputs(chunk)):
                if chunk.group not in changed:
                    yield Difference(
                        chunk.group, chunk.first, "and others of its group are made of other inputs than before"
                    )
                changed.add(chunk.group)
            else:
                yield from _differences(commands, chunk, numbers, expected)


def write(code: Code, head: str, golden: Golden, names: Iterable[str]) -> None:
    """Write the golden file, and the matrix, as some code has it.

    Args:
        head: the first line.
        golden: the rest of the file as it was.
        names: of the groups that are run; the others are kept where they are made of the same inputs as before.
    """
    inputs_of = {chunk: digest(_inputs(chunk)) for chunk in chunks(groups())}
    names = {*names, *(chunk.group for chunk in inputs_of if golden.get(chunk[:2], ("",))[0] != inputs_of[chunk])}
    lines = []
    transcripts: list[str] = []
    with Commands(code) as commands:
        for chunk, inputs in inputs_of.items():
            found = golden.get(chunk[:2], ("", ""))[1]
            if chunk.group in names:
                print(*chunk[:2], flush=True)
                if chunk.group == MATRIX:
                    transcripts += commands.transcripts([matrix.make(number) for number in chunk.numbers])
                else:
                    found = "".join(_digests(commands, chunk, chunk.numbers))
            lines.append("\t".join((chunk.group, str(chunk.first), inputs, found)))
    if transcripts:
        matrix.TABLE.write_text(matrix.table(transcripts), encoding="utf-8")
    frozen.GOLDEN.write_text("".join(f"{line}\n" for line in (head, HEADING, *lines)), encoding="utf-8")


def replay(one: Code, other: Code, name: str, number: int) -> Iterator[str]:
    """What two codes do in a case, as a unified diff; of a session the first edit that differs."""
    if name == SESSIONS:
        sessions = (editing.session(number, code.command("btq-lsp")) for code in (one, other))
        for index, (before, after) in enumerate(zip(*sessions, strict=True)):
            if before != after:
                yield f"edit {index}"
                yield from _unified(before, after)
                return
        return
    found = []
    for code in (one, other):
        with Commands(code) as commands:
            found += commands.transcripts([_case(name, number)])
    yield from _unified(*found)


def _unified(before: str, after: str) -> Iterator[str]:
    yield from difflib.unified_diff(before.split("\n"), after.split("\n"), "before", "after", lineterm="", n=5)


def _differences(commands: Commands, chunk: Chunk, numbers: list[int], expected: str) -> Iterator[Difference]:
    if chunk.group == MATRIX:
        text = matrix.TABLE.read_text(encoding="utf-8")
        rows, reasons = set(text.splitlines()), matrix.known_reasons(text)
        transcripts = commands.transcripts([matrix.make(number) for number in numbers])
        for number, transcript in zip(numbers, transcripts, strict=True):
            if (row := matrix.row(number, transcript, reasons)) not in rows:
                yield Difference(chunk.group, number, row)
        return
    found = list(_digests(commands, chunk, numbers))
    known = [expected[at : at + LETTERS] for at in range(0, len(expected), LETTERS)]
    if chunk.group == SESSIONS:
        if found != known:
            same = [one == other for one, other in zip(found, known, strict=False)]
            at = same.index(False) if False in same else len(same)
            yield Difference(chunk.group, chunk.first, f"from edit {at} on")
        return
    for number, one in zip(numbers, found, strict=True):
        if one != known[number - chunk.first]:
            yield Difference(chunk.group, number)


def _digests(commands: Commands, chunk: Chunk, numbers: Iterable[int]) -> Iterable[str]:
    if chunk.group == SESSIONS:
        return [digest(said) for said in editing.session(chunk.first, commands.code.command("btq-lsp"))]
    return commands.digests([_case(chunk.group, number) for number in numbers])


def _case(name: str, number: int) -> cases.Case:
    return matrix.make(number) if name == MATRIX else cases.GROUPS[name].make(number)


def _count(name: str) -> int:
    return {MATRIX: matrix.COUNT, SESSIONS: editing.SESSIONS}.get(name) or cases.GROUPS[name].count()


def _inputs(chunk: Chunk) -> str:
    """What the cases of a chunk are made of."""
    inputs: Any
    if chunk.group == SESSIONS:
        inputs = editing.session_files(chunk.first), editing.recording()
    else:
        inputs = [_case(chunk.group, number) for number in chunk.numbers]
    return json.dumps(inputs, sort_keys=True)


def read() -> Golden:
    """What the golden file says: by group and first case: of the inputs, and of what each case does."""
    if not frozen.GOLDEN.exists():
        return {}
    lines = frozen.GOLDEN.read_text(encoding="utf-8").splitlines()[2:]
    parts = (line.split("\t") for line in lines)
    return {(group, int(first)): (inputs, found) for group, first, inputs, found in parts}
