"""That a safe fix changes nothing of a mission but what its finding is about.

    python tests/safe_fixes.py --cases 5000 --seed 1

What is held, of every safe fix of every finding by itself:

* Where the mission can be built before, its XML after the fix has the same elements in the same places, and each is
  equal but for the words that the fix replaces; the model that a build adds for the node that the message names may go.
* Where it cannot be built before, every node that is not on a line of the finding or of the fix is read as before, with
  the same attributes and as deep in its tree, and no such node is between these lines.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator
from typing import NamedTuple, TypeAlias

from check_asserts import MAIN, apply, workspace_of
from damage import case
from lxml import etree

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic, Fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.parser import parse
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import Node, Tree
from btq_lang.util.text import LineIndex, Span
from btq_lang.workspace.workspace import Workspace

Element: TypeAlias = tuple[str, str, dict[str, str]]  # where it is, its tag, its attributes
Elements: TypeAlias = list[Element]


class Change(NamedTuple):
    """What a safe fix changes although its finding is not about that."""

    text: str
    finding: Diagnostic
    fix: Fix
    what: str


def unwanted(text: str, path: str = MAIN) -> Iterator[Change]:
    """What the safe fixes of a mission, or of XML, change beyond their findings."""
    workspace = workspace_of({path: text})
    found = check(workspace, path)
    built = None if _has_errors(found) else _xml(workspace, path)
    for finding in found:
        for fix in finding.fixes:
            if fix.safe and (what := _beyond(text, path, built, finding, fix)):
                yield Change(text, finding, fix, what)


def count(text: str) -> int:
    """The number of a mission's safe fixes."""
    return sum(fix.safe for finding in check(workspace_of({MAIN: text}), MAIN) for fix in finding.fixes)


def _beyond(text: str, path: str, built: Elements | None, finding: Diagnostic, fix: Fix) -> str:
    fixed = apply({path: text}, path, fix)[path]
    if built is not None:
        now = _xml(workspace_of({path: fixed}), path)
        return _difference(built, now, finding, text, fix) if now is not None else "it cannot be built any more"
    lines = _lines(text, finding.span).union(*(_lines(text, change.place.span) for change in fix.changes))
    between = {line for line, _ in _read(text)} & set(range(min(lines), max(lines) + 1)) - lines
    if between:
        return f"it writes at other nodes, on the lines {between}"
    lost = _elsewhere(text, lines, fixed)
    return f"others are read in another way: {lost}" if lost else ""


def _difference(before: Elements, now: Elements, finding: Diagnostic, text: str, fix: Fix) -> str:
    """Where two documents differ, apart from what the fix replaces and the model of a node that the finding names."""
    before, now = ([each for each in one if not _is_model_of(each, finding.message)] for one in (before, now))
    if [place.count("/") for place, _, _ in before] != [place.count("/") for place, _, _ in now]:
        return "elements came or went"
    replaced = [text[change.place.span.start : change.place.span.end] for change in fix.changes]
    texts = (*replaced, *(change.text for change in fix.changes))
    words = {*texts, *(each.rpartition(".")[2] for each in texts)}  # of a quality, XML has the last name
    for one, other in zip(before, now, strict=True):
        if one != other and _without(words, one) != _without(words, other):
            return f"{one} became {other}"
    return ""


def _is_model_of(element: Element, message: str) -> bool:
    return element[0].startswith("/root/TreeNodesModel") and f"`{element[2].get('ID')}`" in message


def _without(words: set[str], element: Element) -> str:
    """An element without some words, wherever they are in it."""
    whole = str(element)
    for word in sorted(words, key=len, reverse=True):
        whole = whole.replace(word.strip(" \t\"'"), "") if word.strip(" \t\"'") else whole
    return whole


def _elsewhere(text: str, lines: set[int], fixed: str) -> list[str]:
    """What is read in another way on lines other than these."""
    gone = text.count("\n") - fixed.count("\n")
    now = _read(fixed)
    apart = [(line, shape) for line, shape in _read(text) if line not in lines]
    return [shape for line, shape in apart if (line if line < max(lines) else line - gone, shape) not in now]


def _read(text: str) -> list[tuple[int, str]]:
    """The nodes of a mission, each with its line, what is written at it, and how deep it is."""
    index = LineIndex(text)
    found: list[tuple[int, str]] = []
    for entry in parse(text).entries:
        if not isinstance(entry.item, Tree):
            continue
        stack = [(node, 1) for node in entry.item.children if isinstance(node, Node)]
        while stack:
            node, depth = stack.pop()
            attributes = [(pair.key.text, pair.value.text if pair.value else None) for pair in node.attributes]
            line = index.position(entry.start + node.start).line
            found.append((line, f"{depth} {node.called} {attributes}"))
            stack += [(child, depth + 1) for child in node.nodes]
    return found


def _lines(text: str, span: Span) -> set[int]:
    index = LineIndex(text)
    return set(range(index.position(span.start).line, index.position(span.end).line + 1))


def _xml(workspace: Workspace, path: str) -> Elements | None:
    """The elements of the XML that is built, or of XML itself; None if it cannot be built or is not well-formed."""
    xml = workspace.files[path].source
    if not workspace.files[path].is_foreign:
        exported = export(workspace, path)
        if exported.problems:
            return None
        xml = write(exported.document)
    try:
        root = etree.fromstring(xml.encode())
    except etree.XMLSyntaxError:
        return None
    return [_element(each) for each in root.iter(etree.Element)]


def _element(element: etree._Element) -> Element:
    """`<Action ID="Go"/>` is `<Go/>`, except in a model."""
    place = "".join(f"/{above.tag}" for above in reversed([*element.iterancestors()]))
    attributes = {str(key): str(value) for key, value in element.attrib.items()}
    if element.tag in CATEGORIES and not place.endswith("/TreeNodesModel") and "ID" in attributes:
        return place, attributes.pop("ID"), attributes
    return place, str(element.tag), attributes


def _has_errors(found: Iterable[Diagnostic]) -> bool:
    return any(each.effective_severity is Severity.ERROR for each in found)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    fixes, failed = 0, 0
    for number in range(options.cases):
        text = case(options.seed, number).text
        fixes += count(text)
        for change in unwanted(text):
            failed += 1
            at = LineIndex(text).position(change.finding.span.start).line + 1
            print(f"---- case {number}, line {at}: {change.finding.message}; {change.fix.title}; {change.what}")
            print(text, flush=True)
    print(f"{options.cases} missions, {fixes} safe fixes, {failed} of which change something else")
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
