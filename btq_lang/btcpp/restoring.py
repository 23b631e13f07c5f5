"""A mission restored from its XML and its side file, which has what the XML cannot hold.

One invariant: XML as it was built gives the mission as it was, character by character; edited XML gives what it says
now, with the items of the mission that have no element before the trees, and the clauses of nodes that still exist.
What is lost is reported.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain

from btq_lang.btcpp.manual_edits import ManualEdit, manual_edits
from btq_lang.btcpp.reader import read
from btq_lang.btcpp.side_file import FORMAT, VERSIONS
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import xml_tag
from btq_lang.lexer import tokens
from btq_lang.parser import Parsed, parse
from btq_lang.syntax.tokens import BLANK, COMMENT, DEDENT, INDENT, NEWLINE
from btq_lang.syntax.tree import (
    Apply,
    Context,
    Entry,
    Given,
    Hazard,
    Include,
    Models,
    Node,
    NodeClause,
    Qualities,
    QualityDecl,
    Requirement,
    Root,
    Satisfies,
    Scenario,
    Signal,
    Tree,
)
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Edit, LineIndex, Span, apply_edits
from btq_lang.workspace.file import is_xml
from btq_lang.workspace.node_names import is_placeholder, tag_of


class Restored(Record):
    """A mission.

    Attributes:
        text: of the .btq file.
        is_whole: whether it is the mission as it was.
        file: the mission's path relative to the side file; not validated.
        lost: clauses of nodes that no longer exist.
        manual_edits: the manual edits of generated nodes, which are ignored.
        others: if a whole bundle, the paths (relative to the mission) and texts of the files that it includes.  The
            paths come from the side file and may lead anywhere.
    """

    text: str
    is_whole: bool
    file: str
    lost: tuple[LostClauses, ...] = ()
    manual_edits: tuple[ManualEdit, ...] = ()
    others: tuple[tuple[str, str], ...] = ()


class LostClauses(Record):
    """Clauses of one node.

    Attributes:
        text: as they were written.
        file: where, relative to the mission; None: in the mission.
        line: 1-based.
    """

    text: str
    file: str | None
    line: int


def restored(xml: str, imported: str, side: str) -> Restored | None:
    """A mission from the XML that was built from it, edited or not, and its import without the marks of a build; None
    if the side file cannot be read."""
    import hashlib
    import json

    try:
        data = json.loads(side)
        is_supported = data["format"] == FORMAT and data["version"] in VERSIONS
        mission, built = data["mission"]["text"], data["xml"]["sha256"]
        place = data["mission"]["file"]
        others = tuple((each["file"], each["text"]) for each in data.get("sources", ()))
        guards = {
            str(each["node"]): {name: str(sum_) for name, sum_ in dict(each["guards"]).items()}
            for each in data.get("guards", ())
        }
    except (ValueError, LookupError, TypeError, RecursionError):
        return None
    if not is_supported or not all(_is_text(each) for each in (mission, place, *chain(*others))):
        return None
    if hashlib.sha256(xml.encode("utf-8", "replace")).hexdigest() == built:
        return Restored(mission, True, place, others=others)
    sources = ((None, mission), *((file, text) for file, text in others if not is_xml(file, text)))
    merged = _merged(parse(imported), [(file, parse(text)) for file, text in sources], place)
    document = read(xml).document if guards else None
    return merged if document is None else replace(merged, manual_edits=manual_edits(document.root, guards))


def _is_text(value: object) -> bool:
    """Whether it can be written into a file: JSON can contain half a character."""
    return isinstance(value, str) and not any("\ud800" <= char <= "\udfff" for char in value)


def _merged(imported: Parsed, sources: Sequence[tuple[str | None, Parsed]], place: str) -> Restored:
    """The XML as it is now, with what the mission and the files of its bundle said beyond it."""
    edits: list[Edit] = []
    lost: list[LostClauses] = []
    imported_trees = {name: (entry, _parts(entry)) for entry, name in _trees(imported)}
    for file, built in sources:
        items = [_lines(built, entry) for entry in built.entries if isinstance(entry.item, _WITHOUT_ELEMENT)]
        if items:
            offset = _place_of_items(imported)
            edits.append(Edit(Span(offset, offset), "".join(f"{item}\n" for item in items)))
        lines = LineIndex(built.text)
        for entry, name in _trees(built):
            imported_entry, parts = imported_trees.get(name, (entry, {}))
            for key, part in _parts(entry).items():
                if part.clauses:
                    text = _clauses(built, entry, part.clauses)
                    edit = _attaching(imported, imported_entry, parts.get(key), text)
                    edits += [edit] if edit is not None else []
                    if edit is None:
                        line = lines.position(entry.start + part.clauses[0].start).line + 1
                        lost.append(LostClauses(text, file, line))
    return Restored(apply_edits(imported.text, edits), False, place, tuple(lost))


def _trees(parsed: Parsed) -> Iterator[tuple[Entry, str]]:
    for entry in parsed.entries:
        if isinstance(entry.item, Tree):
            yield entry, legal_name(entry.item.name.text) if entry.item.name is not None else ""


def _parts(entry: Entry) -> dict[object, Tree | Node]:
    """A tree, and its nodes by kind, name, and number among the nodes that share those."""
    assert isinstance(entry.item, Tree)
    parts: dict[object, Tree | Node] = {None: entry.item}
    counts = Counter[tuple[str, str]]()
    for node in entry.item.walk():
        called = _called(node)
        counts[called] += 1
        parts[called, counts[called]] = node
    return parts


def _called(node: Node) -> tuple[str, str]:
    """The ID and the name of a node in XML; the ID of a placeholder is the one that its name becomes."""
    name = node.name.text if node.name is not None else ""
    if is_placeholder(node):
        ID = legal_name(name)
        return ID, "" if name == ID else name
    return xml_tag(tag_of(node)), name


def _place_of_items(parsed: Parsed) -> int:
    """The offset after the Root line and the includes, at the start of a line."""
    offset = 0
    for entry in parsed.entries:
        if isinstance(entry.item, Root | Include):
            end = parsed.text.find("\n", entry.start + entry.item.end)
            offset = end + 1 if end >= 0 else len(parsed.text)
        elif isinstance(entry.item, Tree | Models):
            break
    return offset


def _lines(parsed: Parsed, entry: Entry) -> str:
    """An item with its block and its comments, without indentation."""
    start = entry.start + entry.item.start
    end = parsed.text.find("\n", max(start, entry.start + entry.item.end - 1))
    margin = parsed.text[entry.start : start]
    lines = parsed.text[start : end if end >= 0 else len(parsed.text)].rstrip().splitlines()
    return "\n".join(line.removeprefix(margin) for line in lines)


def _clauses(parsed: Parsed, entry: Entry, clauses: tuple[NodeClause, ...]) -> str:
    """Clauses on one line; those that define requirements last, for nothing else can follow them."""
    ordered = sorted(clauses, key=lambda clause: isinstance(clause, Satisfies) and _defines(clause))
    return " ".join(_on_one_line(parsed.text[entry.start + each.start : entry.start + each.end]) for each in ordered)


def _defines(clause: Satisfies) -> bool:
    return any(isinstance(use, Requirement) and not use.is_reference for use in clause.uses)


def _on_one_line(text: str) -> str:
    words = []
    for token in tokens(text):
        if token.kind == COMMENT:
            words.append(f"/* {token.text.lstrip('#/').removeprefix('*').removesuffix('*/').strip()} */ ")
        elif token.kind in (BLANK, NEWLINE, INDENT, DEDENT):
            words.append(" ")
        else:
            words.append(token.text)
    return "".join(words).strip()


def _attaching(parsed: Parsed, entry: Entry, part: Tree | Node | None, text: str) -> Edit | None:
    """The edit that puts clauses after a node, or on a line of their own above the node of a tree; None if there is no
    such node."""
    if isinstance(part, Node):
        end = entry.start + part.end
        return Edit(Span(end, end), f" {text}")
    if part is None or not part.children:
        return None
    first = entry.start + part.children[0].start
    line = parsed.text.rfind("\n", 0, first) + 1
    return Edit(Span(line, line), f"{parsed.text[line:first]}{text}\n")


_WITHOUT_ELEMENT = (Qualities, QualityDecl, Signal, Context, Requirement, Apply, Hazard, Given, Scenario)
