"""What a side file says of the elements of its XML: qualities, and requirements with how the build holds each clause.

One invariant: it counts only for the XML that it was built with, byte for byte, and of that only for nodes whose number
and path are as the build wrote them: another file that the XML includes may have changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from btq_lang.btcpp.instances import instances
from btq_lang.btcpp.marks import described
from btq_lang.btcpp.reader import read
from btq_lang.btcpp.side_file import FORMAT, VERSIONS
from btq_lang.util.record import Record, replace
from btq_lang.workspace.workspace import Workspace


class OfElements(Record):
    """What a side file says.

    Attributes:
        problem: why it says nothing; empty if it does.
        lines: by the offset at which the tag of an element begins, in the form of the descriptions of a build.
    """

    problem: str
    lines: Mapping[int, tuple[str, ...]]


def said_in_xml(workspace: Workspace, path: str, side: str | None) -> OfElements:
    """What the side file of an XML file says of each element, else the lines that the build has described at it."""
    file, found = workspace.files[path], OfElements("", {})
    if not file.is_foreign:
        return found
    if side is not None:
        *included, _ = workspace.registered_with(path)
        files = (workspace.files[each] for each in included)
        found = of_elements(side, file.source, tuple(each.source for each in files if each.is_foreign))
    return replace(found, lines={**dict(described(file.source)), **found.lines})


@lru_cache(maxsize=2)  # a request for each move of the mouse
def of_elements(side: str, xml: str, included: tuple[str, ...]) -> OfElements:
    """What a side file says of the elements of its XML, which includes other XML."""
    import hashlib
    import json

    try:
        data = json.loads(side)
        if data["format"] != FORMAT or data["version"] not in VERSIONS:
            return OfElements("cannot be read by this version of btq", {})
        if data["xml"]["sha256"] != hashlib.sha256(xml.encode("utf-8", "replace")).hexdigest():
            return OfElements("belongs to other XML than this", {})
        lines = dict(_lines_by_number(data))
        paths = {node["uid"]: node["path"] for node in data["nodes"]}
        main = data["main_tree"]
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return OfElements("cannot be read", {})
    documents = [document for text in (xml, *included) if (document := read(text).document) is not None]
    found: dict[int, dict[str, None]] = {}
    own = {id(element) for element in documents[0].root.walk()} if documents else set()
    for each in instances(documents, main):
        if id(each.element) in own and each.uid in lines and paths.get(each.uid) == each.path:
            found.setdefault(each.element.tag_span.start, {}).update(dict.fromkeys(lines[each.uid]))
    return OfElements("", {at: tuple(of_it) for at, of_it in found.items()})


def _lines_by_number(data: Mapping[str, Any]) -> Iterator[tuple[int, list[str]]]:
    """What holds for each node, by its number."""
    found: dict[int, list[str]] = {}
    for concern in data["concerns"]:
        for uid in concern["nodes"]:
            found.setdefault(uid, []).extend(f"satisfices {quality}" for quality in concern["qualities"])
    requirements = {each["id"]: each for each in data["requirements"]}
    for applied in data["applied"]:
        line = _line(requirements[applied["requirement"]], applied)
        for uid in applied.get("nodes", ()):
            found.setdefault(uid, []).append(line)
    yield from found.items()


def _line(requirement: Mapping[str, Any], applied: Mapping[str, Any]) -> str:
    """`rq1 (time-behaviour): Reach it in time; takes at most 30 s (enforced); on violation fail`."""
    given = ", ".join(f"{name} = {value['text']}" for name, value in applied.get("arguments", {}).items())
    name = f"{requirement['id']}({given})" if given else requirement["id"]
    quality = requirement.get("quality", "").rpartition(".")[2]
    said = [requirement["title"]] if "title" in requirement else []
    for each in applied.get("clauses", ()):
        said.append(f"{each['clause']} ({each['held']}{': ' + each['why'] if 'why' in each else ''})")
    said += [f"on violation {requirement['on_violation']}"] if "on_violation" in requirement else []
    head = f"{name} ({quality})" if quality else name
    return " ".join((f"{head}: {'; '.join(said)}" if said else head).split())
