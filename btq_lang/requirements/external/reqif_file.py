"""Requirements in the Requirements Interchange Format (OMG, ReqIF 1.2): its SPEC-OBJECTs.

Their fields are attributes with names that tools agree on.  A first pass of expat finds the lines, and refuses what a
reader that builds a tree must not get: declarations of entities, and deep nesting.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import Any, Final
from xml.parsers import expat

from btq_lang.requirements.external.fields import ImportProblem, id_among, requirement
from btq_lang.workspace.external_requirements import ExternalRequirement


def read_requirements(path: str, text: str) -> list[ExternalRequirement]:
    """The objects that have an id of people, or all by their identifiers, if none has one.

    Raises:
        ImportProblem: the text is not ReqIF, or the package `reqif` is not installed.
    """
    lines = _lines(text)
    objects = [*_objects(text)]
    fields = [values for _, values in objects]
    has_ids = any(id_among(values) is not None for values in fields)
    requirements: list[ExternalRequirement] = []
    for identifier, values in objects:
        id_name = id_among(values)
        id_ = values.pop(id_name) if id_name is not None else "" if has_ids else identifier
        if id_:
            requirements.append(requirement(id_, values, path, lines.get(identifier, 1)))
    return requirements


def _lines(text: str) -> dict[str, int]:
    """The line of each SPEC-OBJECT, by its identifier."""
    parser = expat.ParserCreate()
    lines: dict[str, int] = {}
    depth = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > _DEEPEST:
            raise ImportProblem(f"more than {_DEEPEST} nested elements", parser.CurrentLineNumber)
        if name.rpartition(":")[2] == "SPEC-OBJECT":
            lines[attributes.get("IDENTIFIER", "")] = parser.CurrentLineNumber

    def end(_: str) -> None:
        nonlocal depth
        depth -= 1

    def declare(*_: object) -> None:
        raise ImportProblem("a document type, which may declare entities, is not read", parser.CurrentLineNumber)

    parser.StartElementHandler, parser.EndElementHandler, parser.StartDoctypeDeclHandler = start, end, declare
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise ImportProblem(f"not XML: {expat.ErrorString(error.code)}", error.lineno, error.offset + 1) from error
    return lines


def _objects(text: str) -> Iterator[tuple[str, dict[str, str]]]:
    """The objects of a text: the identifier of each, and the values of its attributes by their names in lower case."""
    package = _package()
    start = text.find("?>") + 2 if text.startswith("<?xml") else 0  # the text is decoded, whatever its encoding was
    try:
        bundle = package.ReqIFParser.parse_from_string(text[start:].lstrip())
    except Exception as error:  # it reads by KeyError, AttributeError and assertions too
        raise ImportProblem(f"not ReqIF that the package reqif reads: {_reason(error)}", 1) from error
    content = bundle.core_content.req_if_content if bundle.core_content is not None else None
    types, data_types = bundle.lookup.spec_types_lookup, bundle.lookup.data_types_lookup
    choices = {
        choice.identifier: choice
        for data_type in data_types.values()
        for choice in getattr(data_type, "values", None) or ()
    }
    names = {
        attribute.identifier: attribute.long_name or attribute.identifier
        for of_type in types.values()
        for attribute in getattr(of_type, "attribute_definitions", None) or ()
    }
    for spec_object in (content.spec_objects if content is not None else None) or ():
        values = {"long-name": spec_object.long_name or "", "desc": spec_object.description or ""}
        for attribute in spec_object.attributes:
            values[names.get(attribute.definition_ref, "").lower()] = _value(attribute, choices)
        yield spec_object.identifier, values


def _package() -> ModuleType:
    try:
        import reqif.parser
    except ImportError as error:
        raise ImportProblem("needs the package reqif to be read: pip install 'btq-lang[reqif]'", 1) from error
    module: ModuleType = reqif.parser
    return module


def _reason(error: Exception) -> str:
    return " ".join(str(error).split())[:_LONGEST_REASON] or type(error).__name__


def _value(attribute: Any, choices: dict[str, Any]) -> str:
    if isinstance(attribute.value, list):
        chosen = [choices.get(each) for each in attribute.value]
        return ", ".join(choice.long_name or choice.identifier for choice in chosen if choice is not None)
    if attribute.value_stripped_xhtml is None:
        return str(attribute.value).replace("\\n", "\n")  # so StrictDoc writes line ends
    paragraphs = "".join(_pieces(attribute.xml_node.find("THE-VALUE"))).split("\n")
    return "\n".join(line for paragraph in paragraphs if (line := " ".join(paragraph.split())))


def _pieces(element: Any) -> Iterator[str]:
    """The text of an XHTML element; blocks end with a line end."""
    yield " ".join((element.text or "").splitlines()) if isinstance(element.tag, str) else ""
    for child in element:
        yield from _pieces(child)
        is_block = isinstance(child.tag, str) and child.tag.rpartition("}")[2].rpartition(":")[2] in _BLOCKS
        yield "\n" if is_block else ""
        yield " ".join((child.tail or "").splitlines())


_DEEPEST: Final = 100
_LONGEST_REASON: Final = 200  # characters; some errors have a part of the file in them
_BLOCKS: Final = frozenset(
    ("p", "div", "li", "br", "tr", "td", "th", "h1", "h2", "h3", "h4", "h5", "h6", "ul", "ol", "table")
)
