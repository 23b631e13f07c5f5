"""Hover: explains what is at the cursor.  Signature help: the ports of the node in whose brackets it is."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from btq_lang.btcpp.side_elements import element_descriptions
from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.language import in_line, phrase_at
from btq_lang.ide import describe, external
from btq_lang.ide.meaning import ReferenceAt, Subject, at, definition, everywhere, id_meant, quality_match, subject
from btq_lang.ide.navigation import writes
from btq_lang.ide.place import item_tokens, place_at
from btq_lang.ide.ports import cpp_link, port_of, ports_of_kind, ports_of_tree, signature
from btq_lang.syntax.tokens import NAME
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.file import File
from btq_lang.workspace.queries import Cancelled
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.ide.verdicts import ProjectVerdicts


class Hover(Record):
    """What to show for a word, in Markdown."""

    span: Span
    markdown: str


def hover(
    workspace: Workspace,
    path: str,
    offset: int,
    side: str | None = None,
    evidence: ProjectVerdicts | None = None,
    is_cancelled: Callable[[], bool] = bool,
) -> Hover | None:
    """The hover at a place: a node with its ports and semantics, a requirement with its text and its nodes, a quality
    with its definition, an entry with its readers and writers, a quantity in SI units, a rule's page, a word of the
    language.

    Args:
        is_cancelled: whether to leave out what takes long and has not been computed yet.
    """
    reference = at(workspace, path, offset)
    if reference is None:
        return _word_of_the_language(workspace.files[path], offset)
    referent = subject(workspace, reference)
    markdown = _explained(workspace, reference, referent) or ""
    verdicts = ""
    if evidence is not None and referent.what is What.REQUIREMENT:
        from btq_lang.ide.verdicts import verdict_table  # few projects have logs

        verdicts = verdict_table(workspace, path, referent, evidence)
    built = _written_by_build(workspace, reference, side) if reference.mention.what in (What.NODE, What.TREE) else ""
    others = ""
    if referent.what is What.NODE and workspace.project.simulation is not None:
        from btq_lang.ide.outlook import what_if  # few projects declare skills

        with suppress(Cancelled):
            others = what_if(workspace, reference, is_cancelled)
    text = "\n\n".join(filter(None, (markdown, verdicts, built, others)))
    return Hover(reference.span, text) if text else None


def _written_by_build(workspace: Workspace, reference: ReferenceAt, side: str | None) -> str:
    """The requirements and qualities of an element of XML by its build."""
    file = workspace.files[reference.path]
    if not file.is_foreign:
        return ""
    tag = file.source.rfind("<", 0, file.on_disk(reference.span).start) + 1
    lines = element_descriptions(workspace, reference.path, side).lines.get(tag, ())
    return "\n".join(("Written by `btq build`:\n", *(f"* {line}" for line in lines))) if lines else ""


def _explained(workspace: Workspace, reference: ReferenceAt, referent: Subject) -> str | None:
    path, mention = reference.path, reference.mention
    node = mention.node
    if (imported := external.external_requirement(workspace, path, referent)) is not None:
        return external.described(workspace, imported)
    if referent.what is What.NODE:
        children = len(node.nodes) if node is not None else None
        return describe.node_kind(workspace, path, mention.name, mention.word.quoted and node is not None, children)
    if referent.what is What.TREE:
        return describe.tree(workspace, path, referent.name)
    if referent.what is What.QUALITY:
        own = definition(workspace, path, referent)
        if own is not None:
            return describe.own_quality(workspace, own)
        match = quality_match(workspace, path, mention.name)
        if match.quality is not None:
            return describe.quality(workspace, path, match.quality, match.explanation)
        names = [one.id for one in match.candidates] or match.near
        suggestions = ", ".join(f"`{name}`" for name in names)
        return f"`{mention.name}`: {match.explanation or 'unknown quality'}" + (
            f"\n\nDid you mean {suggestions}?" if suggestions else ""
        )
    if referent.what is What.REQUIREMENT:
        place = definition(workspace, path, referent)
        return describe.requirement(workspace, path, place) if place else None
    if referent.what is What.HAZARD:
        place = definition(workspace, path, referent)
        return describe.hazard(workspace, place) if place else None
    if referent.what in (What.SIGNAL, What.CONTEXT):
        place = definition(workspace, path, referent)
        return describe.declared(workspace, place) if place else None
    if referent.what is What.KEY:
        return (_port(workspace, reference) if mention.what is What.PORT else None) or _key(workspace, referent)
    if referent.what is What.PORT:
        return _port(workspace, reference)
    if referent.what is What.ATTRIBUTE:
        kind = RESERVED_ATTRIBUTES.get(referent.name)
        return f"`{kind.name}`: {kind.doc}" if kind is not None else None
    if referent.what is What.QUANTITY:
        port = port_of(workspace, path, node, mention.pair.key.text) if node and mention.pair else None
        return describe.quantity(mention.name, port.unit if port is not None else None)
    if referent.what is What.UNIT:
        return describe.unit(mention.name)
    if referent.what is What.RULE:
        return describe.rule(referent.name)
    if referent.what is What.INCLUDE:
        return f"`{referent.name}`" if referent.name in workspace.files else None
    if referent.what in (What.INSTANCE, What.TAG, What.PARAMETER):
        return describe.used(workspace, referent, f"{referent.what.value.capitalize()} **{referent.name}**") or None
    return None


def _word_of_the_language(file: File, offset: int) -> Hover | None:
    if not any(token.kind == NAME and token.start <= offset <= token.end for token in item_tokens(file, offset)):
        return None
    start = file.text.rfind("\n", 0, offset) + 1
    line = file.text[start:].partition("\n")[0]
    phrase = phrase_at(line, offset - start)
    markdown = describe.words(in_line(phrase[1], line)) if phrase is not None else None
    if phrase is None or markdown is None:
        return None
    return Hover(Span(start + phrase[0], start + phrase[0] + len(phrase[1])), markdown)


def _key(workspace: Workspace, referent: Subject) -> str:
    places = [one for one in everywhere(workspace, referent) if not one.mention.defines]
    writing = [one for one in places if writes(workspace, one)]
    return describe.key(workspace, referent, writing, [one for one in places if one not in writing])


def _port(workspace: Workspace, reference: ReferenceAt) -> str | None:
    node = reference.mention.node
    name = reference.mention.name
    if node is None:  # in a scenario
        ports = ports_of_kind(
            workspace, reference.path, id_meant(workspace, reference.path, str(reference.mention.owner))
        )
        return next((describe.port(port) for port in ports if port.name == name), None)
    port = port_of(workspace, reference.path, node, name)
    if port is None:
        return None
    link = cpp_link(workspace, reference.path, node.id.text, port.name) if node.id is not None else ""
    return "\n\n".join(filter(None, (describe.port(port), link)))


class PortLabel(Record):
    """A port: its label is a part of the signature's."""

    label: str
    documentation: str


class Signature(Record):
    """The ports of the node on one line.  active: the one that is being given a value; None: a name that is not a
    port."""

    label: str
    parameters: tuple[PortLabel, ...]
    active: int | None


def signature_help(workspace: Workspace, path: str, offset: int) -> Signature | None:
    """The ports of the node in whose brackets an offset is."""
    place = place_at(workspace, path, offset)
    node = place.node
    if node is None or place.depth == 0:
        return None
    if node.is_subtree:
        ports = ports_of_tree(workspace, path, node.name)
    else:
        ports = ports_of_kind(workspace, path, node.name, node.quoted)
    if not ports:
        return None
    parameters = tuple(PortLabel(signature(port), describe.port(port)) for port in ports)
    label = f"{node.name} ({', '.join(parameter.label for parameter in parameters)})"
    names = [port.name for port in ports]
    missing = [name for name in names if name not in place.given] if place.key is None else [place.key]
    return Signature(label, parameters, names.index(missing[0]) if missing and missing[0] in names else None)
