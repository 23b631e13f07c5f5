"""Completion in XML: tags, attributes and values, made of the proposals that complete a mission.

One invariant: what is inserted is spelt as XML has it.  While a tag is typed the XML is not sound, so what is proposed
comes from the XML without it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from btq_lang.btcpp.document import escape
from btq_lang.btcpp.opening import with_source
from btq_lang.btcpp.recognition import defined_in
from btq_lang.btcpp.typed_xml import TypedTag, typed_tag, without
from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, PortKind, lookup
from btq_lang.ide import node_proposals as of_nodes
from btq_lang.ide import proposals as offer
from btq_lang.ide.place import LineNode, open_brace
from btq_lang.ide.ports import ports_of_kind
from btq_lang.ide.proposals import Proposal
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import Entry, unquote
from btq_lang.util.record import replace
from btq_lang.util.text import Span
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


def complete_in_xml(workspace: Workspace, path: str, offset: int) -> tuple[Span, tuple[Proposal, ...]]:
    """What may follow at an offset of a file's XML, and the span there that it replaces."""
    xml = workspace.files[path].source
    tag = typed_tag(xml, offset)
    if tag is None:
        return Span(offset, offset), ()
    if tag.part == "end":
        return tag.word, tuple(_closing(tag, xml))
    workspace, entry = _sound(workspace, path, tag)
    if tag.part == "tag":
        proposals = _tags(workspace, path, tag)
    elif tag.part == "attribute":
        proposals = _attributes(workspace, path, tag)
    else:
        return _in_value(workspace, path, entry, tag, xml, offset)
    has_more = xml[tag.word.end : tag.word.end + 2].lstrip(" ").startswith("=")  # the value is there already
    inserted = (replace(one, insert=one.label, snippet=None) if has_more else one for one in proposals)
    return tag.word, _reachable(workspace, inserted)


def _sound(workspace: Workspace, path: str, tag: TypedTag) -> tuple[Workspace, Entry | None]:
    """The workspace without what is typed at the tag, and the tree around it; as it is if that is not sound either."""
    before = workspace.files[path].source[: tag.span.start]
    ids = defined_in(before[before.rfind("<BehaviorTree") :]) if "BehaviorTree" in tag.parents else ()
    for xml in without(workspace.files[path].source, tag):
        after = with_source(workspace, path, xml)
        file = after.files[path]
        if file.is_foreign and file.is_understood:
            trees = (tree.entry for each in ids for tree in file.definitions(Kind.TREE, each))
            return after, next(trees, None)
    return workspace, None


def _reachable(workspace: Workspace, proposals: Iterable[Proposal]) -> tuple[Proposal, ...]:
    """Each once, without those for which another file would have to be included; other XML is found without that."""
    by_label = {one.label: one for one in proposals if not one.include or one.include in workspace.foreign}
    return tuple(replace(one, include="") for one in by_label.values())


# ---- tags ----


def _closing(tag: TypedTag, xml: str) -> Iterator[Proposal]:
    """The end tag of the innermost open element."""
    if tag.parents:
        end = "" if xml[tag.word.end : tag.word.end + 1] == ">" else ">"
        yield Proposal(tag.parents[-1], "keyword", "", f"{tag.parents[-1]}{end}")


def _tags(workspace: Workspace, path: str, tag: TypedTag) -> Iterator[Proposal]:
    above = tag.parents[-1] if tag.parents else ""
    if above in _CHILDREN:
        for name, doc in _CHILDREN[above].items():
            given = " ".join(f'{key}="${{{index}}}"' for index, key in enumerate(_ATTRIBUTES.get(name, ())[:1], 1))
            yield Proposal(name, "keyword", doc, name, f"{name} {given}" if given else name)
    elif tag.parents[-2:-1] == ("TreeNodesModel",):
        for name in ("input_port", "output_port", "inout_port"):
            yield Proposal(name, "keyword", "", name, f'{name} name="${{1:name}}" type="${{2:std::string}}"')
    elif "BehaviorTree" in tag.parents:
        for one in of_nodes.nodes(workspace, path):
            if _is_tag(one.label):
                yield replace(one, insert=one.label, snippet=_with_ports(workspace, path, one.label))


def _is_tag(name: str) -> bool:
    """Whether a node is written so in XML: neither by a symbol nor by a name that only missions have."""
    return _TAG(name) is not None and (name in BUILTINS or lookup(name) is None)


def _with_ports(workspace: Workspace, path: str, name: str) -> str:
    """A tag with the attributes that it needs, as a snippet."""
    if name in CATEGORIES:
        return f'{name} ID="$1"'
    needed = [port for port in ports_of_kind(workspace, path, name, quoted=True) if port.required]
    return " ".join([offer.escaped(name), *(_with_hole(port, index) for index, port in enumerate(needed, 1))])


def _with_hole(port: PortKind, index: int) -> str:
    return f'{offer.escaped(port.name)}="{of_nodes.hole(index, port, in_xml=True)}"'


# ---- attributes ----


def _attributes(workspace: Workspace, path: str, tag: TypedTag) -> Iterator[Proposal]:
    """Those that a tag does not have yet, each with its quotes."""
    given = tuple(key for key, _ in tag.attributes)
    keys = [key for key in _ATTRIBUTES.get(tag.name, ()) if key not in given]
    yield from (Proposal(key, "attribute", "", f'{key}=""', f'{key}="$0"') for key in keys)
    if "BehaviorTree" not in tag.parents:
        return
    node = _node(tag)
    ports = of_nodes.ports_of_line(workspace, path, node)
    by_name = {port.name: port for port in ports}
    for one in (*of_nodes.ports(ports, given, node), *of_nodes.attributes(given, node)):
        port = by_name.get(one.label)
        snippet = _with_hole(port, 0) if port is not None else f'{one.label}="$0"'
        yield replace(one, insert=f'{one.label}=""', snippet=snippet)


def _node(tag: TypedTag) -> LineNode:
    if tag.name not in CATEGORIES:
        return LineNode(tag.name, True, None)
    return LineNode(dict(tag.attributes).get("ID", "")[1:-1], True, tag.name)


# ---- values ----


def _in_value(
    workspace: Workspace, path: str, entry: Entry | None, tag: TypedTag, xml: str, offset: int
) -> tuple[Span, tuple[Proposal, ...]]:
    node, begun = _node(tag), open_brace(xml[tag.word.start :], offset - tag.word.start)
    is_of_node = "BehaviorTree" in tag.parents and tag.key not in ("ID", "name")
    is_script = is_of_node and of_nodes.is_script(workspace, path, node, tag.key)
    if is_of_node and begun is not None and not is_script:
        keys = list(offer.keys(workspace, path, entry, begun.is_root)) if entry is not None else []
        same = () if begun.is_root else (of_nodes.SAME_ENTRY,)
        proposals = tuple(replace(one, insert=f"{one.insert}{begun.closing}") for one in (*same, *keys))
        return begun.span.shifted(tag.word.start), proposals
    if is_script:
        before = xml[tag.word.start : offset]
        typed, proposals = of_nodes.in_script(workspace, path, entry, before) if entry is not None else (0, ())
        return Span(offset - typed, offset), proposals
    proposals = tuple(_values(workspace, path, entry, tag, node))
    plain = (unquote(one.insert) if one.insert[:1] in ('"', "'") else one.insert for one in proposals)
    spelt = (replace(one, insert=escape(text), snippet=None) for one, text in zip(proposals, plain, strict=True))
    return tag.word, _reachable(workspace, spelt)


def _values(workspace: Workspace, path: str, entry: Entry | None, tag: TypedTag, node: LineNode) -> Iterator[Proposal]:
    above = tag.parents[-1] if tag.parents else ""
    place = tag.name, tag.key
    if place == ("root", "main_tree_to_execute"):
        yield from of_nodes.trees(workspace, path)
    elif place == ("root", "BTCPP_format"):
        yield from offer.words(("4",), "enum")
    elif place == ("include", "path"):
        yield from offer.includes(workspace, path, quoted=False)
    elif place == ("BehaviorTree", "ID"):
        yield from offer.undeclared(workspace, path, Kind.TREE, What.TREE)
    elif above == "TreeNodesModel" and tag.key == "ID":
        yield from of_nodes.unknown_nodes(workspace, path)
    elif tag.parents[-2:-1] == ("TreeNodesModel",):
        yield from offer.types() if tag.key == "type" else ()
    elif tag.name in CATEGORIES and tag.key == "ID":
        yield from of_nodes.of_category(workspace, path, tag.name)
    elif tag.key in RESERVED_ATTRIBUTES:
        yield from of_nodes.attribute_values(tag.key)
    elif "BehaviorTree" in tag.parents and tag.key not in ("ID", "name"):
        ports = (port for port in of_nodes.ports_of_line(workspace, path, node) if port.name == tag.key)
        yield from of_nodes.port_values(workspace, path, entry, next(ports, None))


_TAG = re.compile(r"[A-Za-z_][\w.-]*").fullmatch
_CHILDREN = {
    "": {"root": "the document of the engine"},
    "root": {
        "BehaviorTree": "a tree",
        "include": "the trees of another file",
        "TreeNodesModel": "the ports of custom nodes",
    },
    "TreeNodesModel": dict.fromkeys(sorted(CATEGORIES), "the ports of a node"),
}
_ATTRIBUTES = {
    "root": ("BTCPP_format", "main_tree_to_execute"),
    "BehaviorTree": ("ID",),
    "include": ("path", "ros_pkg"),
    **dict.fromkeys(("input_port", "output_port", "inout_port"), ("name", "type", "default")),
    **dict.fromkeys(sorted(CATEGORIES), ("ID",)),
}
