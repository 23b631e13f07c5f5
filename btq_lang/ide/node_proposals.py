"""The words that completion proposes for nodes, their ports and the values of those."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, NodeKind, PortKind, available, is_by_children
from btq_lang.checks.engines import engines_of
from btq_lang.ide.place import LineNode
from btq_lang.ide.ports import declared_ports, ports_of_kind, ports_of_tree
from btq_lang.ide.proposals import Proposal, defined, escaped, keys, unknown, words
from btq_lang.syntax.tree import Entry, Model, is_name, quote, written
from btq_lang.util.record import replace
from btq_lang.workspace.file import Definition
from btq_lang.workspace.workspace import Workspace


def nodes(workspace: Workspace, path: str) -> Iterator[Proposal]:
    """What a node may be: models, custom nodes in use, built-ins by symbol and name, SubTree."""
    seen: set[str] = set()
    for definition, include in defined(workspace, path, Kind.MODEL):
        item = definition.symbol.target
        if isinstance(item, Model) and item.category.raw != "SubTree":
            seen.add(definition.symbol.name)
            yield _model(workspace, definition, item, include)
    for name in unknown(workspace, workspace.scope(path).paths):
        if name not in seen:
            yield Proposal(name, "node", "custom node", written(name), None, "", name)
    yield from _builtins(workspace.store.ask(engines_of, path)[-1])
    yield Proposal("SubTree", "keyword", "run another tree", "SubTree")
    for category in ("Action", "Condition", "Decorator", "Control"):
        yield Proposal(category, "keyword", "a custom node, with its category", category)


def of_category(workspace: Workspace, path: str, category: str) -> Iterator[Proposal]:
    """The IDs that may follow `SubTree`, `Action` …"""
    if category == "SubTree":
        yield from trees(workspace, path)
        return
    for definition, include in defined(workspace, path, Kind.MODEL):
        item = definition.symbol.target
        if isinstance(item, Model) and item.category.raw == category:
            yield _model(workspace, definition, item, include)
    scope = workspace.scope(path)
    for name in unknown(workspace, scope.paths):
        if scope.find(Kind.MODEL, name) is None:
            yield Proposal(name, "node", "custom node", written(name), None, "", name)


def trees(workspace: Workspace, path: str) -> Iterator[Proposal]:
    for definition, include in defined(workspace, path, Kind.TREE):
        name = definition.symbol.name
        ports = declared_ports(definition.symbol.target)
        if not ports and workspace.scope(definition.path).defines(Kind.MODEL, name):
            ports = ports_of_tree(workspace, definition.path, name)
        head = written(name)
        snippet = _with_ports(head, [port for port in ports if port.required]) if ports else None
        yield Proposal(name, "tree", f"{len(ports)} ports" if ports else "", head, snippet, "", name, include)


def unknown_nodes(workspace: Workspace, path: str) -> Iterator[Proposal]:
    """The custom nodes that no model declares yet."""
    scope = workspace.scope(path)
    for name in unknown(workspace, workspace.files):
        if scope.find(Kind.MODEL, name) is None:
            yield Proposal(name, "node", "used here, not declared", written(name))


def ports_of_line(workspace: Workspace, path: str, node: LineNode) -> tuple[PortKind, ...]:
    """The ports of the node of a line; of a SubTree those of its tree, if it declares any."""
    of_tree = ports_of_tree(workspace, path, node.name) if node.is_subtree else ()
    return of_tree or ports_of_kind(workspace, path, node.name, node.quoted)


def ports(port_kinds: tuple[PortKind, ...], given: tuple[str, ...], node: LineNode) -> Iterator[Proposal]:
    """The ports that have no value yet, those that need one first."""
    for port in sorted((one for one in port_kinds if one.name not in given), key=lambda one: not one.required):
        default = f" = {port.default}" if port.default else ""
        detail = f"{port.direction}{f' : {port.type}' if port.type else ''}{default}"
        snippet = f"{escaped(written(port.name))} = {hole(0, port)}"
        insert = f"{written(port.name)} = "
        documented = f"{node.category or ''} {node.name}".strip() + f"/{port.name}"
        yield Proposal(port.name, "port", detail, insert, snippet, "", documented)


def attributes(given: tuple[str, ...], node: LineNode) -> Iterator[Proposal]:
    """`name`, and the attributes that the engine reads at every node."""
    if "name" not in given:
        yield Proposal("name", "attribute", "instance name", "name = ", 'name = "$0"')
    for kind in RESERVED_ATTRIBUTES.values():
        if kind.group == "tool" or kind.name in given or (kind.name == "_autoremap" and not node.is_subtree):
            continue
        snippet = f'{kind.name} = "$0"' if kind.is_script else f"{kind.name} = ${{0:true}}"
        yield Proposal(kind.name, "attribute", kind.doc, f"{kind.name} = ", snippet)


def attribute_values(key: str) -> Iterator[Proposal]:
    """The values of an attribute that is not a port; entries are not allowed there."""
    if RESERVED_ATTRIBUTES[key].is_script:
        yield from words(('""',), "keyword")
    elif key == "_autoremap":
        yield from words(("true", "false"), "enum")


def port_values(workspace: Workspace, path: str, entry: Entry | None, port: PortKind | None) -> Iterator[Proposal]:
    """The values of a port."""
    if port is not None and port.content == "script":
        yield from words(('""',), "keyword")
        return
    yield Proposal("{=}", "key", "the entry with the name of the port", "{=}")
    for one in keys(workspace, path, entry, False) if entry is not None else ():
        yield replace(one, label=f"{{{one.label}}}", insert=f"{{{one.insert}}}")
    if port is not None and port.default:
        yield Proposal(port.default, "enum", "default", port.default if is_plain(port.default) else quote(port.default))
    if port is not None and port.type == "bool":
        yield from words(("true", "false"), "enum")
    if port is not None and port.type.endswith("NodeStatus"):
        statuses = [word for word in port.doc.replace(",", " ").split() if word in _STATUSES]  # from the engine's table
        yield from words(statuses if port.type.startswith("BT::") and statuses else _STATUSES, "enum")


def in_script(workspace: Workspace, path: str, entry: Entry, before: str) -> tuple[int, tuple[Proposal, ...]]:
    """What may follow in a script of an item after its part before the cursor, and how many characters of that it
    replaces."""
    begun = re.search(r"@?\w*$", before)
    word = begun[0] if begun else ""
    others = () if word.startswith("@") else words(("true", "false"), "keyword")
    return len(word), (*keys(workspace, path, entry, False), *others)


def is_plain(value: str) -> bool:
    """Whether a value needs no quotes."""
    return is_name(value) or value.lstrip("-").replace(".", "", 1).isdecimal()


def is_script(workspace: Workspace, path: str, node: LineNode | None, key: str) -> bool:
    """Whether an attribute holds a script."""
    attribute = RESERVED_ATTRIBUTES.get(key)
    if attribute is not None:
        return attribute.is_script
    port_kinds = ports_of_kind(workspace, path, node.name, node.quoted) if node is not None else ()
    return any(port.name == key and port.content == "script" for port in port_kinds)


def port_unit(workspace: Workspace, path: str, node: LineNode, key: str) -> str | None:
    """The unit of a number in a port."""
    port_kinds = ports_of_kind(workspace, path, node.name, node.quoted)
    return next((port.unit for port in port_kinds if port.name == key), None)


# ---- parts of the above ----


def _model(workspace: Workspace, definition: Definition, item: Model, include: str) -> Proposal:
    name = definition.symbol.name
    needed = [port for port in ports_of_kind(workspace, definition.path, name) if port.required]
    text = item.text.text if item.text else ""
    detail = f"{item.category.raw}{f': {text}' if text else ''}"
    return Proposal(name, "node", detail, written(name), _with_ports(written(name), needed), "", name, include)


@lru_cache(2)  # a project has one version of the engine
def _builtins(target: str) -> tuple[Proposal, ...]:
    kinds = [kind for kind in BUILTINS.values() if available(kind, target)]
    shared = {word: kind for kind in reversed(kinds) for word in kind.aliases if is_by_children(word)}
    own = (one for kind in kinds if shared.keys().isdisjoint(kind.aliases) for one in _builtin(kind))
    return (*own, *(_by_children(word, kind) for word, kind in shared.items()))


def _builtin(kind: NodeKind) -> Iterator[Proposal]:
    """A built-in by its symbol, if it has one, and by its shortest name."""
    needed = [port for port in kind.ports if port.required]
    below = "\n    $0" if kind.category in ("Control", "Decorator") else ""
    for word in dict.fromkeys((*kind.symbols[:1], min((kind.tag, *kind.aliases), key=len), kind.tag)):
        snippet = _with_ports(word, needed) or (escaped(word) if below else None)
        named = f"{kind.tag} {word}" if word in kind.symbols else ""
        yield Proposal(word, "node", kind.doc, word, f"{snippet}{below}" if snippet else None, named, kind.tag)


def _by_children(word: str, smallest: NodeKind) -> Proposal:
    """A word that several kinds share, in their place."""
    snippet = f"{word} {_CASES}" if smallest.flow == "switch" else None
    return Proposal(word, "node", smallest.doc, word, snippet, "", word)


def _with_ports(head: str, needed: Iterable[PortKind]) -> str | None:
    holes = [f"{escaped(written(port.name))} = {hole(index, port)}" for index, port in enumerate(needed, 1)]
    return f"{escaped(head)} ({' '.join(holes)})" if holes else None


def hole(index: int, port: PortKind, in_xml: bool = False) -> str:
    """A snippet's placeholder for a value of the port; in XML it is in quotes already, and has no unit."""
    if port.content == "script":
        return f"${{{index}:true}}" if in_xml else f'"${{{index}:true}}"'
    if port.unit == "ms":
        return f"${{{index}:1000}}" if in_xml else f"${{{index}:1 s}}"
    if port.direction != "input":
        return f"{{${{{index}:{escaped(port.name)}}}\\}}"
    if port.type in _NUMBERS:
        return f"${{{index}:1}}"
    return f"${{{index}:{{=\\}}}}"


SAME_ENTRY = Proposal("=", "key", "the entry with the name of the port", "=")
_STATUSES = ("SUCCESS", "FAILURE", "RUNNING", "SKIPPED")
_NUMBERS = ("int", "unsigned int", "double", "float", "int64_t", "uint64_t")
_CASES = (
    '(variable = {${1:key}\\} case_1 = "${2:first}" case_2 = "${3:second}")\n    ${4:First}\n    ${5:Second}\n'
    "    ${0:Otherwise}"
)
