"""What BehaviorTree.CPP refuses in an XML file when it loads it, written down once more, apart from the exporter.

One invariant: `violations` knows XML and the engine's rules and nothing of missions.  The tables of ports and literals
are the catalog's, which other tests hold against what the engines print of themselves.

Source: VerifyXML and its neighbours in src/xml_parsing.cpp of 4.6.2, 4.8.4 and 4.10.0.
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from btq_lang.catalog.literals import check_literal
from btq_lang.catalog.nodes import BUILTINS, available, of_version

EXPLICIT = ("Action", "Condition", "Control", "Decorator")
FORBIDDEN = frozenset(" \t\n\r<>&\"'/\\:*?|.")
RESERVED = frozenset(
    (
        *("name", "ID", "_autoremap", "_failureIf", "_successIf", "_skipIf", "_while"),
        *("_onHalted", "_onFailure", "_onSuccess", "_post"),
    )
)


def violations(xml: str, version: str) -> list[str]:
    """What the engine of a version would refuse in a file without includes; nothing where it loads."""
    root = etree.fromstring(xml.encode("utf-8"))
    return list(_of_root(root, _number(version)))


def _of_root(root: etree._Element, version: float) -> Iterator[str]:
    if root.tag != "root":
        yield f"the document element is {root.tag}"
    if root.get("BTCPP_format") != "4":
        yield "no BTCPP_format"
    children = list(root.iterchildren(etree.Element))
    if [child.tag for child in children].count("TreeNodesModel") > 1:
        yield "two TreeNodesModel"
    models = {(model.tag, model.get("ID")): model for each in root.iterchildren("TreeNodesModel") for model in each}
    categories = {name: tag for tag, name in models if isinstance(tag, str)}
    for (tag, _), model in models.items():
        if tag == "SubTree":
            yield from _of_subtree_model(model, version)
    trees = [child for child in children if child.tag == "BehaviorTree"]
    names = [tree.get("ID") for tree in trees]
    if None in names and len(children) > 1:
        yield "a tree without ID beside something else"
    if len(set(names)) < len(names):
        yield "two trees of one name"
    main = root.get("main_tree_to_execute")
    if main is not None and main not in names:
        yield f"no main tree {main!r}"
    for tree in trees:
        yield from _of_name("tree", tree.get("ID") or "_", version)
        if tree.get("ID") in BUILTINS or categories.get(tree.get("ID")) in EXPLICIT:
            yield f"tree {tree.get('ID')!r} is called like a node"
        if len(list(tree.iterchildren(etree.Element))) != 1:
            yield "a tree without exactly one child"
        subtrees = list(tree.iter("SubTree"))
        given = [each.get("name") for each in subtrees if each.get("name") is not None]
        if version >= 4.08 and (len(set(given)) < len(given) or "" in given):
            yield f"names of SubTrees: {given}"
        for each in subtrees:
            if each.get("ID") not in names:
                yield f"no tree {each.get('ID')!r}"
        for node in tree.iterdescendants(etree.Element):
            yield from _of_node(node, version, categories)


def _of_node(node: etree._Element, version: float, categories: dict[str | None, str]) -> Iterator[str]:
    parent = node.getparent()
    name = node.get("ID") if node.tag in EXPLICIT else node.tag
    if node.tag in EXPLICIT:
        if not name:
            yield f"<{node.tag}> without ID"
        if parent is not None and parent.tag == "ReactiveSequence" and version >= 4.07:
            yield f"explicit <{node.tag}> in a ReactiveSequence"
    elif node.tag != "SubTree":
        yield from _of_name("node", node.tag, version)
        if node.get("ID") is not None:
            yield f"<{node.tag}> has an ID"
    else:
        yield from _of_name("SubTree", node.get("ID") or "", version)
    if any(ord(character) < 32 and character not in "\t\n\r" for character in node.get("name") or ""):
        yield "a control character in a name"
    kind = BUILTINS.get(name or "")
    if kind is not None and not available(kind, _text(version)):
        yield f"{name} is newer"
    category = kind.category if kind is not None else categories.get(name, node.tag)
    count = len(list(node.iterchildren(etree.Element)))
    if category in ("Action", "Condition", "SubTree") and count:
        yield f"{name} has children"
    if category == "Decorator" and count != 1:
        yield f"{name} has {count} children"
    if category == "Control" and not count:
        yield f"{name} has no children"
    if category not in (*EXPLICIT, "SubTree"):
        yield f"nobody knows {name}"
    if kind is not None and node.tag != "SubTree":
        yield from _of_ports(node, version)


def _of_ports(node: etree._Element, version: float) -> Iterator[str]:
    kind = BUILTINS[node.get("ID") if node.tag in EXPLICIT else node.tag]
    for key, value in node.attrib.items():
        if key in RESERVED or not (key[0].isascii() and key[0].isalpha()) or FORBIDDEN.intersection(key):
            continue
        port = kind.port(key)
        if port is None:
            yield f"{kind.tag} has no port {key}"
        elif port.content == "value":
            problem = check_literal(port.literal or of_version(port, _text(version)).type, value, _text(version))
            if problem is not None and problem.kind == "refused":
                yield f"{kind.tag}.{key}: {value!r}, expected {problem.expected}"


def _of_name(what: str, name: str, version: float) -> Iterator[str]:
    if version < 4.08:
        return
    if not name or name in ("Root", "root") or FORBIDDEN.intersection(name) or any(ord(each) < 32 for each in name):
        yield f"{what} name {name!r}"


def _of_subtree_model(model: etree._Element, version: float) -> Iterator[str]:
    yield from _of_name("model", model.get("ID") or "", version)
    for port in model.iterchildren("input_port", "output_port", "inout_port"):
        name = port.get("name") or ""
        if name in RESERVED or name[:1].isdigit():
            yield f"port name {name!r}"
        yield from _of_name("port", name, version)


def _number(version: str) -> float:
    major, minor = version.split(".")
    return int(major) + int(minor) / 100


def _text(version: float) -> str:
    return f"{int(version)}.{round(version % 1 * 100)}"
