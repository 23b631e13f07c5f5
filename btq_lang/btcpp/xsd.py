"""The XML of BehaviorTree.CPP 4 as an XSD, for editors of XML: what a project's nodes may have inside and beside them.

One invariant: of nodes, ports and children the schema refuses only what the checks report too.  It is XSD 1.0, the
only version that Red Hat's language server for XML reads, so what depends on an attribute's value is not in it: the
ports of a node in the explicit form are those of all nodes of its category.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from itertools import repeat

from btq_lang.btcpp.document import Attribute, Content, Document, Element, XmlComment, XmlText, escape, write
from btq_lang.btcpp.interfaces import Interface, PortInterface, interfaces, merged_ports, tree_names
from btq_lang.btcpp.spelling import FORBIDDEN
from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.kinds import CATEGORIES, CHILDREN
from btq_lang.catalog.literals import values_of
from btq_lang.catalog.names import is_xml_name
from btq_lang.workspace.workspace import Workspace


def xsd(workspaces: Sequence[Workspace], version: str, unknown: Container[str]) -> str:
    """The schema of XML files with the nodes of some workspaces, without names that the checks call unknown."""
    nodes = interfaces(workspaces, version, unknown)
    remark = f" The nodes of BehaviorTree.CPP {version} and of this project, by btq schema xsd. "
    schema = _x(
        "schema",
        {"xmlns:xs": "http://www.w3.org/2001/XMLSchema"},
        _root(),
        *map(_explicit_form, CATEGORIES, repeat([*nodes.values()])),
        _x("group", {"name": "node"}, _x("choice", {}, *_elements(nodes))),
        _x("attributeGroup", {"name": "node"}, _attribute("name", "the name of this node"), *_scripts(), *_of_tools()),
        _tree_names(tree_names(workspaces)),
        *_types_of_models(),
    )
    return write(Document((XmlComment(remark), schema)))


def _root() -> Element:
    """The document element, and what is in it beside the nodes."""
    include = _type(_attribute("path", "the file to include"), *_others(True))
    identity = _attribute("ID", "the name of the tree")
    tree = _type(_x("group", {"ref": "node"}), identity, *_of_tools(), *_others(True))
    models = _type(_some(*(_x("element", {"name": each, "type": "model"}) for each in CATEGORIES)))
    parts = {"include": include, "BehaviorTree": tree, "TreeNodesModel": models}
    root = _type(
        _some(*(_x("element", {"name": name}, type_) for name, type_ in parts.items())),
        _attribute("BTCPP_format", "the version of the format: 4"),
        _attribute("main_tree_to_execute", "the tree that the robot runs", "tree"),
    )
    return _x("element", {"name": "root"}, root)


def _elements(nodes: Mapping[str, Interface]) -> Iterator[Element]:
    """The elements of nodes: the explicit forms, and those whose name can be a tag."""
    for category in CATEGORIES:
        yield _x("element", {"name": category, "type": category})
    for name, node in nodes.items():
        if is_xml_name(name) and name not in CATEGORIES:
            type_ = _type(
                *_children(node.least, node.most),
                *map(_port, node.ports.values()),
                _x("attributeGroup", {"ref": "node"}),
                *_others(node.is_open),
            )
            yield _x("element", {"name": name}, *_doc(node.doc), type_)


def _explicit_form(category: str, nodes: Iterable[Interface]) -> Element:
    """The type of `<Action ID="…">` or the like, named as the tag."""
    members = [node for node in nodes if category in node.categories]
    if category == "SubTree":
        # The engine reads it before any entry exists.
        ports = [_attribute("_autoremap", RESERVED_ATTRIBUTES["_autoremap"].doc, values=values_of("bool"))]
        identity = _attribute("ID", "the tree to run", "tree", is_required=True)
    else:
        ports = [*map(_port, merged_ports(members).values())]
        identity = _attribute("ID", "the node", values=[node.name for node in members], is_required=True)
    return _x(
        "complexType",
        {"name": category},
        *_children(*CHILDREN[category]),
        identity,
        *ports,
        _x("attributeGroup", {"ref": "node"}),
        *_others(any(node.is_open for node in members)),
    )


def _children(least: int, most: int | None) -> tuple[Element, ...]:
    if most == 0:
        return ()
    return (
        _x("group", {"ref": "node", "minOccurs": str(least), "maxOccurs": "unbounded" if most is None else str(most)}),
    )


def _port(port: PortInterface) -> Element:
    # Any port can be an entry of the blackboard instead.
    return _attribute(port.name, port.doc, values=port.values, or_entry=True, is_required=port.required)


def _scripts() -> list[Element]:
    return [_attribute(kind.name, kind.doc) for kind in RESERVED_ATTRIBUTES.values() if kind.is_script]


def _of_tools() -> list[Element]:
    """The attributes of tools, without those of version 3, which begin with `__`."""
    kinds = [kind for kind in RESERVED_ATTRIBUTES.values() if kind.group == "tool" and not kind.name.startswith("__")]
    return [_attribute(kind.name, kind.doc) for kind in kinds]


def _types_of_models() -> Iterator[Element]:
    """The types of models, and of what is in them."""
    any_attribute = _others(True)
    # Nav2's palette has a bidirectional_port, which neither the engine nor Groot reads.
    directions = ("input", "output", "inout", "bidirectional")
    ports = [_x("element", {"name": f"{direction}_port", "type": "port"}) for direction in directions]
    data = _x("element", {"name": "Metadata"}, _type(*any_attribute))
    fields = _x("element", {"name": "MetadataFields"}, _type(_some(data)))
    text = _x("element", {"name": "description", "type": "xs:string"})
    identity = _attribute("ID", "the name of the node", is_required=True)
    yield _x("complexType", {"name": "model"}, _some(*ports, text, fields), identity, *any_attribute)
    attributes = (
        _attribute("name", "the name of the port", is_required=True),
        _attribute("type", "its type in C++"),
        _attribute("default", "its value where a node gives it none"),
    )
    yield _x("complexType", {"name": "port", "mixed": "true"}, *attributes, *any_attribute)


def _tree_names(trees: Sequence[str]) -> Element:
    """The type of attributes that name a tree: any text, and the known trees to propose."""
    proposed = _x("simpleType", {}, _restriction(trees))
    return _x("simpleType", {"name": "tree"}, _x("union", {"memberTypes": "xs:string"}, *([proposed] if trees else [])))


def _attribute(
    name: str,
    doc: str,
    type_: str = "xs:string",
    values: Iterable[str] = (),
    or_entry: bool = False,
    is_required: bool = False,
) -> Element:
    """An attribute: of a type, or with one of some values, or perhaps with an entry of the blackboard, `{key}`."""
    use = {"use": "required"} if is_required else {}
    if not values:
        return _x("attribute", {"name": name, "type": type_, **use}, *_doc(doc))
    closed = _x("simpleType", {}, _restriction(values))
    if or_entry:
        entry = _x("restriction", {"base": "xs:string"}, _x("pattern", {"value": r"\{[\s\S]+\}"}))
        closed = _x("simpleType", {}, _x("union", {}, closed, _x("simpleType", {}, entry)))
    return _x("attribute", {"name": name, **use}, *_doc(doc), closed)


def _restriction(values: Iterable[str]) -> Element:
    spelt = [value for value in values if not FORBIDDEN.search(value)]
    return _x("restriction", {"base": "xs:string"}, *(_x("enumeration", {"value": value}) for value in spelt))


def _others(is_open: bool) -> tuple[Element, ...]:
    return (_x("anyAttribute", {"processContents": "lax"}),) if is_open else ()


def _some(*parts: Element) -> Element:
    return _x("choice", {"minOccurs": "0", "maxOccurs": "unbounded"}, *parts)


def _type(*parts: Element) -> Element:
    return _x("complexType", {}, *parts)


def _doc(text: str) -> tuple[Element, ...]:
    return (_x("annotation", {}, _x("documentation", {}, XmlText(FORBIDDEN.sub("\ufffd", text)))),) if text else ()


def _x(tag: str, attributes: Mapping[str, str], *parts: Content) -> Element:
    return Element(f"xs:{tag}", (Attribute(name, escape(value)) for name, value in attributes.items()), parts)
