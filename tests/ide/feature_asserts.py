"""What the tests of editor features assert: `tests/README.md` has the notation on one page.

A fixture is files in a string, with `$0` where the cursor is and `<def>…</def>` round what is expected.  Only these
functions call a feature; each knows which markers it reads and refuses a fixture that has others, or lacks its own.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from textwrap import dedent

from check_asserts import COMMENT_WITH_MARKERS, split_files, workspace_of

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.ide.actions import code_actions
from btq_lang.ide.colours import colours, difference, encoded_within
from btq_lang.ide.completion import Completion, complete
from btq_lang.ide.describe import documentation, include_edits
from btq_lang.ide.hints import code_lenses, inlay_hints
from btq_lang.ide.hover import hover, signature_help
from btq_lang.ide.legend import MODIFIERS, TYPES
from btq_lang.ide.moves import moved_files
from btq_lang.ide.navigation import (
    called,
    callers,
    find_references,
    goto_definition,
    goto_implementation,
    goto_type,
    highlights,
    node_path,
    prepare_calls,
)
from btq_lang.ide.on_type import linked_ranges, on_type
from btq_lang.ide.outline import Outline, document_symbols, workspace_symbols
from btq_lang.ide.proposals import Proposal
from btq_lang.ide.readiness import getting_ready
from btq_lang.ide.refactor import Action
from btq_lang.ide.rename import RenameRefusal, prepare_rename, rename
from btq_lang.ide.structure import document_links, folding_ranges, selection_range
from btq_lang.lexer import tokens as tokens_of
from btq_lang.parser import parse
from btq_lang.projects.opening import open_workspace
from btq_lang.syntax.tokens import BLANK, CLOSE, DEDENT, ERROR, INDENT, NEWLINE, OPEN, Token
from btq_lang.util.text import Edit, Encoding, LineIndex, Position, Span, apply_edits
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

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
        """The places found are exactly those marked, shown with the text there if not."""
        assert self.show(sorted((path, *span) for path, span in found)) == self.show(sorted(self.marks[mark]))

    def show(self, places: Iterable[Place]) -> list[str]:
        return [f"{path}:{start} {self.files[path][start:end]!r}" for path, start, end in places]


def check_goto(text: str) -> None:
    """`<def>` is where the definition of the word at the cursor is; without one there is none."""
    fixture = Fixture(text, "def")
    targets = goto_definition(*fixture.at)
    for target in targets:
        assert target.span.start <= target.name.start <= target.name.end <= max(target.span.end, target.name.end)
        assert target.origin.start <= fixture.at[2] <= target.origin.end
    fixture.expect("def", ((target.path, target.name) for target in targets))


def check_implementation(text: str) -> None:
    """`<def>` are the heads of the nodes that satisfy the requirement at the cursor."""
    fixture = Fixture(text, "def")
    fixture.expect("def", ((target.path, target.name) for target in goto_implementation(*fixture.at)))


def check_type(text: str) -> None:
    """`<def>` is what declares the type of the thing at the cursor; without one nothing does."""
    fixture = Fixture(text, "def")
    fixture.expect("def", ((target.path, target.name) for target in goto_type(*fixture.at)))


def check_references(text: str) -> None:
    """`<def>` and `<ref>` are all references to what the word at the cursor means; the result is the same from each."""
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
    """Renaming the word at the cursor changes the files to this; and renaming it back restores them."""
    fixture = Fixture(text)
    result = rename(*fixture.at, name)
    assert not isinstance(result, RenameRefusal), result.reason
    files = dict(fixture.files)
    for path, edits in result.edits.items():
        assert list(edits) == sorted(edits, key=lambda edit: edit.span)
        files[path] = apply_edits(files[path], edits)
    assert files == split_files(after)


def check_no_rename(text: str, reason: str, name: str | None = None) -> None:
    """The word at the cursor cannot be renamed, for this reason; without a name it is reported at once."""
    fixture = Fixture(text)
    ready = prepare_rename(*fixture.at)
    if name is None:
        assert isinstance(ready, RenameRefusal)
        assert ready.reason == reason
        name = "other"
    else:
        assert not isinstance(ready, RenameRefusal), ready.reason
    result = rename(*fixture.at, name)
    assert isinstance(result, RenameRefusal)
    assert result.reason == reason


def check_outline(text: str, *lines: str) -> None:
    """The outline of the first file: `kind name | detail`, indented as it is nested."""
    fixture = Fixture(text, cursor=False)
    path = next(iter(fixture.files))

    def show(outlines: Iterable[Outline], level: int, inside: Span) -> Iterable[str]:
        for one in outlines:
            assert inside.start <= one.span.start <= one.name_span.start
            assert one.name_span.end <= one.span.end <= inside.end
            yield f"{'  ' * level}{one.kind} {one.name}{f' | {one.detail}' if one.detail else ''}"
            yield from show(one.children, level + 1, one.span)

    outline = document_symbols(fixture.workspace, path)
    assert list(show(outline, 0, Span(0, len(fixture.files[path])))) == list(lines)


def check_search(text: str, query: str, *found: str) -> None:
    """Searching the project for a name finds these: `kind name (container)`, best first."""
    fixture = Fixture(text, cursor=False)
    matches = workspace_symbols(fixture.workspace, query)
    for match in matches:
        assert match.name in fixture.files[match.path][match.span.start : match.span.end]
    assert [f"{match.kind} {match.name} ({match.container})" for match in matches] == list(found)


def check_folds(text: str) -> None:
    """`<block>`, `<brackets>`, `<comment>` and `<includes>` are all that folds."""
    kinds = ("block", "brackets", "comment", "includes")
    fixture = Fixture(text, *kinds, cursor=False)
    folds = folding_ranges(fixture.workspace, "main.btq")
    for kind in kinds:
        fixture.expect(kind, (("main.btq", fold.span) for fold in folds if fold.kind == kind))


def check_selection(text: str, *steps: str) -> None:
    """What a selection at the cursor grows to, step by step."""
    fixture = Fixture(text)
    spans = selection_range(*fixture.at)
    content = fixture.files[fixture.at[1]]
    for inner, outer in pairwise(spans):
        assert outer.start <= inner.start <= inner.end <= outer.end
        assert inner != outer
    assert [content[slice(*span)] for span in spans] == [*steps, content]


def check_links(text: str, *targets: str | None) -> None:
    """`<link>` are the links of the first file, and these their targets."""
    fixture = Fixture(text, "link", cursor=False)
    path = next(iter(fixture.files))
    links = document_links(fixture.workspace, path)
    fixture.expect("link", ((path, link.span) for link in links))
    assert [link.target for link in links] == list(targets)


def check_tokens(text: str, *expected: str) -> None:
    """The coloured words of the first file: `type.modifier word`; in every encoding they are the same, and a part of
    the file has those of its lines."""
    fixture = Fixture(text, cursor=False)
    workspace, path = fixture.workspace, next(iter(fixture.files))
    content = fixture.files[path]
    lines = LineIndex(content)
    for encoding in ("utf-8", "utf-16", "code-points"):
        made = colours(workspace, path, encoding)
        assert made.data == json.loads(made.as_json)
        tokens = list(decoded(made.data, lines, encoding))
        assert [f"{look} {content[slice(*span)]}" for span, look in tokens] == list(expected)
        assert all(one.end <= other.start for (one, _), (other, _) in pairwise(tokens))
        for span, _ in tokens:
            line = lines.position(span.start).line
            part = [*decoded(encoded_within(workspace, path, span, encoding), lines, encoding)]
            assert part == [one for one in tokens if lines.position(one[0].start).line == line]


def decoded(data: list[int], lines: LineIndex, encoding: Encoding) -> Iterator[tuple[Span, str]]:
    """The place of each semantic token, and `type.modifier`."""
    line = column = 0
    for down, right, length, type_, bits in zip(*[iter(data)] * 5, strict=True):
        line, column = line + down, right if down else column + right
        start, end = (lines.offset(Position(line, at), encoding) for at in (column, column + length))
        assert start < end
        assert lines.position(end, encoding) == (line, column + length)
        modifiers = [name for bit, name in enumerate(MODIFIERS) if bits & 1 << bit]
        yield Span(start, end), ".".join((TYPES[type_], *modifiers))


def check_delta(before: list[int], after: list[int], expected: tuple[int, int, list[int]] | None) -> None:
    """This change turns the first list of integers into the second."""
    made = difference(before, after)
    if made is not None:
        assert [*before[: made.start], *made.data, *before[made.start + made.delete_count :]] == after
    assert (None if made is None else (made.start, made.delete_count, made.data)) == expected


def check_hover(text: str, markdown: str | None) -> None:
    """What is shown at the cursor; `<hover>` is the word that it is about."""
    fixture = Fixture(text, "hover")
    found = hover(*fixture.at)
    fixture.expect("hover", ((fixture.at[1], found.span) for found in (found,) if found is not None))
    assert (found.markdown if found else None) == (dedent(markdown).strip() if markdown else None)


def check_signature(text: str, label: str | None) -> None:
    """The signature at the cursor, its active parameter in `«…»`."""
    found = signature_help(*Fixture(text).at)
    if found is None:
        assert label is None
        return
    shown = found.label
    for parameter in found.parameters:
        assert parameter.label in shown
    if found.active is not None:
        active = found.parameters[found.active].label
        shown = shown.replace(active, f"«{active}»")
    assert shown == label


def check_completion(text: str, *labels: str) -> None:
    """All that is proposed at the cursor, in this order."""
    assert [one.label for one in _complete(Fixture(text)).proposals] == list(labels)


def check_list(text: str, *labels: str, trigger: str = "", absent: Iterable[str] = ()) -> None:
    """The list that opens by itself at the cursor begins with these; without any, none opens.

    Args:
        trigger: the character that was typed last, where an editor asks because of it.
    """
    found = [one.label for one in complete(*Fixture(text).at, asked=False, trigger=trigger).proposals]
    assert found[: len(labels)] == list(labels)
    assert labels or not found
    assert not set(found) & set(absent)


def check_left(text: str, *labels: str) -> None:
    """What an editor leaves of the list that was asked for before the word at the cursor was typed, best first."""
    fixture = Fixture(text)
    workspace, path, offset = fixture.at
    content = fixture.files[path]
    start = complete(workspace, path, offset).span.start
    before = workspace.with_file(path, content[:start] + content[offset:])
    typed = content[start:offset].lower()
    found = complete(before, path, start).proposals
    words = [(one.label, (one.filter or one.label).lower()) for one in found]
    assert [label for label, word in words if word.startswith(typed)] == list(labels)


def check_offers(text: str, *labels: str, absent: Iterable[str] = ()) -> None:
    """These are proposed at the cursor, in this order, perhaps among others; those that are absent are not."""
    found = [one.label for one in _complete(Fixture(text)).proposals]
    assert [label for label in found if label in labels] == list(labels)
    assert not set(found) & set(absent)


def check_filter(text: str, label: str, filtered: str) -> None:
    """What an editor compares the typed letters with, for a proposal at the cursor."""
    assert [one.filter for one in _complete(Fixture(text)).proposals if one.label == label] == [filtered]


def check_accept(text: str, label: str, after: str, *, plain: str | None = None) -> None:
    """Accepting a proposal makes this of the file, with `$1` for the places to fill in; `plain`: where an editor has
    no such places."""
    fixture = Fixture(text)
    found = _complete(fixture)
    _, path, _ = fixture.at
    content = fixture.files[path]
    one = next(one for one in found.proposals if one.label == label)

    def accepted(inserted: str) -> str:
        return content[: found.span.start] + inserted + content[found.span.end :]

    assert accepted(one.snippet or one.insert) == after
    if plain is not None:
        assert accepted(one.insert) == plain


def check_documentation(text: str, label: str, markdown: str) -> None:
    """What is shown beside a proposal."""
    fixture = Fixture(text)
    one = next(one for one in _complete(fixture).proposals if one.label == label)
    assert _documented(fixture, one) == dedent(markdown).strip()


def check_include(text: str, label: str, line: str) -> None:
    """Accepting a proposal also puts this line in, where it stands before everything else."""
    fixture = Fixture(text)
    workspace, path, _ = fixture.at
    one = next(one for one in _complete(fixture).proposals if one.label == label)
    made = apply_edits(fixture.files[path], include_edits(workspace, path, one.include))
    assert made == line + fixture.files[path]


def _complete(fixture: Fixture) -> Completion:
    found = complete(*fixture.at)
    offset = fixture.at[2]
    assert found.span.start <= offset <= found.span.end
    assert len({one.label for one in found.proposals}) == len(found.proposals)
    for one in found.proposals:
        assert one.insert
        assert one.name == "" or _documented(fixture, one)
    return found


def _documented(fixture: Fixture, one: Proposal) -> str | None:
    return documentation(fixture.workspace, fixture.at[1], one.kind, one.name)


def check_action(text: str, title: str, after: str) -> None:
    """What can be done at the cursor has this title, and makes this of the files; the syntax is as right as it was."""
    fixture = Fixture(text)
    action = next((one for one in _actions(fixture) if one.title == title), None)
    assert action is not None, [one.title for one in _actions(fixture)]
    files = dict(fixture.files)
    for path, edits in action.edits.items():
        files[path] = apply_edits(files[path], edits)
    assert files == split_files(after)
    for path, content in files.items():
        assert len(parse(content).diagnostics) <= len(parse(fixture.files[path]).diagnostics)


def check_actions(text: str, *titles: str, only: tuple[str, ...] = ()) -> None:
    """All that can be done at the cursor, of some kinds."""
    assert [one.title for one in _actions(Fixture(text), only)] == list(titles)


def check_preferred(text: str, *titles: str) -> None:
    """Those of all that can be done at the cursor that an editor may apply without asking which."""
    assert [one.title for one in _actions(Fixture(text)) if one.preferred] == list(titles)


def check_no_action(text: str, title: str) -> None:
    """Nothing whose title begins so is offered."""
    assert not [one.title for one in _actions(Fixture(text)) if one.title.startswith(title)]


def check_all_actions(example: Path, title: str, *severities: Severity) -> list[str]:
    """Whatever begins so and is offered on any line of an example: with it no file has more findings of these
    severities than before.

    Returns:
        the titles, in the order of the text.
    """
    workspace = open_workspace(str(example.parent))
    path = str(example)
    text = workspace.files[path].text
    before = _findings(workspace, severities)
    offered: dict[tuple[str, tuple[Edit, ...]], None] = {}
    for line in re.finditer(r"\S.*", text):
        for offset in line.span():
            found = code_actions(workspace, path, Span(offset, offset), ("refactor",), ())
            offered.update(((one.title, one.edits[path]), None) for one in found if one.title.startswith(title))
    for named, edits in offered:
        after = _findings(workspace.with_file(path, apply_edits(text, edits)), severities)
        assert after <= before, (named, after - before)
    return [named for named, _ in offered]


def _findings(workspace: Workspace, severities: tuple[Severity, ...]) -> Counter[str]:
    found = (one for path in workspace.files for one in check(workspace, path))
    return Counter(one.rule for one in found if one.effective_severity in severities)


def check_silences(text: str) -> None:
    """Each silencing that is offered in some files, their markers left out, removes what it is for from what a check
    finds, and adds nothing to it."""
    files = split_files("\n".join(COMMENT_WITH_MARKERS.sub("", line).rstrip() for line in text.split("\n")))
    workspace = workspace_of(files)
    for path, content in files.items():
        found = check(workspace, path)
        before = Counter((one.rule, one.message) for one in found)
        for action in code_actions(workspace, path, Span(0, len(content)), ("quickfix",), found):
            if action.diagnostic is None or not action.title.startswith("Silence"):
                continue
            silenced = workspace_of({**files, path: apply_edits(content, action.edits[path])})
            left = Counter((one.rule, one.message) for one in check(silenced, path))
            assert left < before, action.title
            assert (
                left[action.diagnostic.rule, action.diagnostic.message]
                < before[action.diagnostic.rule, action.diagnostic.message]
            ), action.title


def _actions(fixture: Fixture, only: tuple[str, ...] = ()) -> tuple[Action, ...]:
    workspace, path, offset = fixture.at
    return code_actions(workspace, path, Span(offset, offset), only)


def check_calls(text: str, name: str | None, callers_: Iterable[str] = (), called_: Iterable[str] = ()) -> None:
    """The tree at the cursor, the trees that run it and those that it runs: `name ×how often`."""
    fixture = Fixture(text)
    tree = prepare_calls(*fixture.at)
    assert (tree.name if tree else None) == name
    if tree is not None:
        for feature, expected in ((callers, callers_), (called, called_)):
            found = feature(fixture.workspace, tree)
            assert [f"{call.tree.name} ×{len(call.places)}" for call in found] == list(expected)
            for call in found:
                names = (tree.name, call.tree.name)
                assert all(fixture.files[call.path][slice(*place)].strip('"') in names for place in call.places)


def check_hints(text: str) -> None:
    """`<hint>: quality</hint>` are the inlay hints of the first file: what they say is not part of it."""
    shown = Fixture(re.sub("<hint>.*?</hint>", "", text), cursor=False)
    path = next(iter(shown.files))
    content = shown.files[path]
    hints = inlay_hints(shown.workspace, path, Span(0, len(content)))
    for hint in reversed(hints):
        content = f"{content[: hint.offset]}<hint>{hint.label}</hint>{content[hint.offset :]}"
    assert content == split_files(text)[path]
    for hint in hints:
        assert hint in inlay_hints(shown.workspace, path, Span(hint.offset, hint.offset))


def check_lenses(text: str, *lenses: str) -> None:
    """The code lenses of the first file: `name: title`."""
    fixture = Fixture(text, cursor=False)
    path = next(iter(fixture.files))
    found = code_lenses(fixture.workspace, path)
    assert [f"{fixture.files[path][slice(*lens.span)]}: {lens.title}" for lens in found] == list(lenses)


def check_typed(text: str, after: str) -> None:
    """The character before the cursor was typed: this is made of the text."""
    fixture = Fixture(text)
    workspace, path, offset = fixture.at
    content = fixture.files[path]
    typed = "\n" if not content[:offset].rsplit("\n", 1)[-1].strip() else content[offset - 1]
    assert apply_edits(content, on_type(workspace, path, offset, typed)) == after


def check_linked(text: str) -> None:
    """`<name>` are the names that are written together with the one at the cursor."""
    fixture = Fixture(text, "name")
    fixture.expect("name", ((fixture.at[1], span) for span in linked_ranges(*fixture.at)))


def check_node_path(text: str, path: str | None) -> None:
    """The path of the node at the cursor."""
    assert node_path(*Fixture(text).at) == path


def check_moved(text: str, moves: Mapping[str, str], after: str) -> None:
    """When files are moved their includes are adapted so."""
    fixture = Fixture(text, cursor=False)
    edits = moved_files(fixture.workspace, moves)
    files = {path: apply_edits(content, edits.get(path, ())) for path, content in fixture.files.items()}
    assert files == split_files(after)


def answer_everything(
    text: str, offset: int, workspace: Workspace | None = None, problems: Sequence[Diagnostic] | None = None
) -> None:
    """Every feature answers, and what it answers lies in the text: `main.btq` of a workspace, or of a new one.

    Args:
        problems: what is wrong with it, if somebody knows already.
    """
    workspace = workspace or Workspace.of({"main.btq": text})
    at = workspace, "main.btq", offset
    whole = Span(0, len(text))
    for target in goto_definition(*at):
        assert _lies_in(target.name, whole)
    for target in (*goto_implementation(*at), *goto_type(*at)):
        assert _lies_in(target.span, whole)
        assert _lies_in(target.name, whole)
    for _, span in find_references(*at):
        assert _lies_in(span, whole)
    highlights(*at)
    renamed = rename(*at, "another")
    if not isinstance(renamed, RenameRefusal):
        for edits in renamed.edits.values():
            apply_edits(text, edits)
    found = hover(*at)
    assert found is None or _lies_in(found.span, whole)
    signature_help(*at)
    node_path(*at)
    for _ in getting_ready(workspace, "main.btq"):
        pass
    completed = complete(*at)
    file = workspace.files["main.btq"]
    for entry in file.parsed.entries:
        for mention in file.mentions_of(entry):
            assert (entry, mention) in file.mentioned(mention.name)
    assert completed.span.start <= offset <= completed.span.end <= len(text)
    for one in completed.proposals[:3]:
        documentation(workspace, "main.btq", one.kind, one.name)
    assert selection_range(*at)[-1] == whole
    for fold in folding_ranges(workspace, "main.btq"):
        assert _lies_in(fold.span, whole)
    for link in document_links(workspace, "main.btq"):
        assert _lies_in(link.span, whole)
    for outline in document_symbols(workspace, "main.btq"):
        assert _lies_in(outline.span, whole)
    starts = [0, *(entry.start for entry in file.parsed.entries), len(text)]
    parts = [text[start:end] for start, end in pairwise(starts)]  # each is coloured by itself
    words = [word for part in parts for word in words_of(tokens_of(part))]
    assert words == words_of(file.parsed.tokens)
    lines = LineIndex(text)
    tokens = list(decoded(colours(workspace, "main.btq", "utf-16").data, lines, "utf-16"))
    assert all(one.end <= other.start for (one, _), (other, _) in pairwise(tokens))
    part = list(decoded(encoded_within(workspace, "main.btq", Span(offset, offset), "utf-16"), lines, "utf-16"))
    line = lines.position(offset).line
    assert part == [one for one in tokens if lines.position(one[0].start).line == line]
    for action in code_actions(workspace, "main.btq", Span(offset, offset), diagnostics=problems):
        for changed in action.edits.values():
            apply_edits(text, changed)
    tree = prepare_calls(*at)
    if tree is not None:
        callers(workspace, tree)
        called(workspace, tree)
    inlay_hints(workspace, "main.btq", whole)
    code_lenses(workspace, "main.btq")
    for typed in ("\n", ")"):
        apply_edits(text, on_type(*at, typed))
    assert all(_lies_in(span, whole) for span in linked_ranges(*at))


def words_of(tokens: Iterable[Token]) -> list[tuple[int, str]]:
    """Those of some tokens that may have a colour."""
    silent = (BLANK, OPEN, CLOSE, ERROR, NEWLINE, INDENT, DEDENT)
    return [(token.kind, token.text) for token in tokens if token.kind not in silent]


def _lies_in(span: Span, whole: Span) -> bool:
    return whole.start <= span.start <= span.end <= whole.end
