"""What a side file records of the elements of its XML: qualities, and requirements with how each clause is enforced.

One invariant: it counts only for the XML that it was built with, byte for byte, and of that only for nodes whose number
and path are as the build wrote them: another file that the XML includes may have changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

from btq_lang.btcpp.instances import instances
from btq_lang.btcpp.marks import described
from btq_lang.btcpp.reader import read
from btq_lang.btcpp.side_file import FORMAT, VERSIONS
from btq_lang.util.record import Record, replace
from btq_lang.workspace.workspace import Workspace


class ElementDescriptions(Record):
    """What a side file records of elements.

    Attributes:
        problem: why it says nothing; empty if it does.
        lines: by the offset at which the tag of an element begins, in the form of the descriptions of a build.
    """

    problem: str
    lines: Mapping[int, tuple[str, ...]]


def element_descriptions(workspace: Workspace, path: str, side: str | None) -> ElementDescriptions:
    """What the side file of an XML file says of each element, else the lines that the build has described at it."""
    file = workspace.files[path]
    descriptions = ElementDescriptions("", {})
    if not file.is_foreign:
        return descriptions
    if side is not None:
        *included, _ = workspace.registered_with(path)
        files = (workspace.files[each] for each in included)
        descriptions = descriptions_from(side, file.source, tuple(each.source for each in files if each.is_foreign))
    return replace(descriptions, lines={**dict(described(file.source)), **descriptions.lines})


@lru_cache(maxsize=2)  # a request for each move of the mouse
def descriptions_from(side: str, xml: str, included: tuple[str, ...]) -> ElementDescriptions:
    """What a side file says of the elements of its XML, which includes other XML."""
    import hashlib
    import json

    try:
        data = json.loads(side)
        if data["format"] != FORMAT or data["version"] not in VERSIONS:
            return ElementDescriptions("cannot be read by this version of btq", {})
        if data["xml"]["sha256"] != hashlib.sha256(xml.encode("utf-8", "replace")).hexdigest():
            return ElementDescriptions("belongs to other XML than this", {})
        lines = dict(_lines_by_number(data))
        paths = {node["uid"]: node["path"] for node in data["nodes"]}
        main = data["main_tree"]
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return ElementDescriptions("cannot be read", {})
    documents = [document for text in (xml, *included) if (document := read(text).document) is not None]
    lines_at: dict[int, dict[str, str]] = {}
    own = {id(element) for element in documents[0].root.walk()} if documents else set()
    for instance in instances(documents, main):
        if id(instance.element) in own and instance.uid in lines and paths.get(instance.uid) == instance.path:
            lines_at.setdefault(instance.element.tag_span.start, {}).update(lines[instance.uid])
    in_xml = dict(described(xml))
    return ElementDescriptions(
        "", {offset: _as_described(texts, in_xml.get(offset, ())) for offset, texts in lines_at.items()}
    )


def _as_described(lines: Mapping[str, str], in_xml: Sequence[str]) -> tuple[str, ...]:
    """The lines of an element in the order in which the build has described it, as far as it has.

    Args:
        lines: each with what it is about.
    """

    def place(line: str) -> int:
        about = lines[line]
        starts = tuple(f"{about}{sign}" for sign in ("(", " (", ":"))
        return next((at for at, one in enumerate(in_xml) if one == about or one.startswith(starts)), len(in_xml))

    return tuple(sorted(lines, key=place))


def _lines_by_number(data: Mapping[str, Any]) -> Iterator[tuple[int, dict[str, str]]]:
    """What holds for each node, by its number: lines, each with the quality or requirement that it is about."""
    lines: dict[int, dict[str, str]] = {}
    for concern in data["concerns"]:
        for uid in concern["nodes"]:
            qualities = (f"satisfices {quality}" for quality in concern["qualities"])
            lines.setdefault(uid, {}).update((line, line) for line in qualities)
    requirements = {each["id"]: each for each in data["requirements"]}
    for applied in data["applied"]:
        line = _line(requirements[applied["requirement"]], applied)
        for uid in applied.get("nodes", ()):
            lines.setdefault(uid, {})[line] = " ".join(applied["requirement"].split())
    yield from lines.items()


def _line(requirement: Mapping[str, Any], applied: Mapping[str, Any]) -> str:
    """`rq1 (time-behaviour): Reach it in time; takes at most 30 s (enforced); on violation fail`."""
    arguments = ", ".join(f"{name} = {value['text']}" for name, value in applied.get("arguments", {}).items())
    name = f"{requirement['id']}({arguments})" if arguments else requirement["id"]
    qualities = [requirement.get("quality", ""), *requirement.get("further_qualities", ())]
    quality = ", ".join(name.rpartition(".")[2] for name in qualities)
    parts = [requirement["title"]] if "title" in requirement else []
    for clause in applied.get("clauses", ()):
        parts.append(f"{clause['clause']} ({clause['held']}{': ' + clause['why'] if 'why' in clause else ''})")
    parts += [f"on violation {requirement['on_violation']}"] if "on_violation" in requirement else []
    head = f"{name} ({quality})" if quality else name
    return " ".join((f"{head}: {'; '.join(parts)}" if parts else head).split())
