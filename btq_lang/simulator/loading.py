"""From XML to the nodes of a tree that can be ticked, with the entries that the engine creates for them.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from typing import Final

from btq_lang.btcpp.document import Document, Element
from btq_lang.catalog.nav2.creation import is_read_once
from btq_lang.catalog.nodes import BUILTINS, inspects_children, of_version
from btq_lang.catalog.versions import ONE_ASYNC_SEQUENCE
from btq_lang.simulator.blackboard import DOUBLE, STRING, Board
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.kinds import rules_of
from btq_lang.simulator.leaves import tick_custom
from btq_lang.simulator.nav2_models import ports_in
from btq_lang.simulator.nodes import Machine, Program, SimulatedNode
from btq_lang.simulator.ports import key_of, read
from btq_lang.simulator.scripts import text_of
from btq_lang.simulator.version3 import SUBTREE, SUBTREES, inner_board
from btq_lang.simulator.versions import Dialect
from btq_lang.simulator.world import World
from btq_lang.syntax.script.parser import parse_script


def load(
    documents: list[Document],
    main: str,
    dialect: Dialect,
    program: Program,
    changes: Callable[[SimulatedNode, int, int], None],
    board: Board | None = None,
    stateful: Collection[str] = (),
    world: World | None = None,
) -> Machine:
    """The tree `main` of some documents, ready to be ticked.

    Args:
        program: has the custom leaves.
        changes: called with each change of a status, and the status before.
        board: the root blackboard, of the same version, with the entries that the program sets before it creates the
            tree.
        stateful: the stateful actions of the program.
        world: what nodes of Nav2 read beside entries and the time.

    Raises:
        EngineError: the engine refuses the tree.
        NotModelled: the tree has a node that is not known here.
    """
    loader = _Loader(documents, dialect, stateful)
    return Machine(
        loader.tree(main, board or Board(is_old=dialect.is_old), ""), dialect, program, changes, world or World()
    )


class _Loader:
    def __init__(self, documents: list[Document], dialect: Dialect, stateful: Collection[str]) -> None:
        tops = [element for document in documents for element in document.root.elements]
        self._trees: Final = {name: tree for tree in tops if tree.tag == "BehaviorTree" and (name := tree.get("ID"))}
        self._dialect: Final = dialect
        self._stateful: Final = stateful
        self._nav2: Final = ports_in(dialect.nav2) if dialect.nav2 else {}
        self._open: Final[list[str]] = []
        self._last = 0  # uid

    def tree(self, name: str, board: Board, prefix: str) -> SimulatedNode:
        """The root of a tree."""
        tree = self._trees.get(name)
        if tree is None:
            raise EngineError(f"Can't find a tree with name: {name}")
        if name in self._open:
            raise EngineError(
                f"Recursive behavior tree cycle detected: tree '{name}' references itself (directly or indirectly)"
            )
        self._open.append(name)
        roots = list(tree.elements)
        if len(roots) != 1:
            raise EngineError("The node <BehaviorTree> must have exactly 1 child")
        root = roots[0]
        if ONE_ASYNC_SEQUENCE.holds(self._dialect.version):
            _refuse_two_async(root)
        node = self._node(root, board, prefix)
        self._open.pop()
        return node

    def _node(self, element: Element, board: Board, prefix: str) -> SimulatedNode:
        """A node and all below it."""
        self._last += 1
        values = {attribute.name: attribute.value for attribute in element.attributes}
        id_ = element.tag if element.tag not in CATEGORIES else values.get("ID", "")
        is_subtree = element.tag in SUBTREES if self._dialect.is_old else element.tag == SUBTREE
        plain = values.get("ID", "") if is_subtree else id_
        name = values.get("name", plain)
        path = prefix + values.get("name", f"{plain}::{self._last}")
        ports = {port: value for port, value in values.items() if not (port in _NO_PORTS or port.startswith("_"))}
        registered = element.tag if is_subtree else id_
        has_children = any(element.elements)
        rules = rules_of(registered, has_children, self._stateful, self._nav2, self._dialect.is_old)
        node = SimulatedNode(self._last, registered, name, path, ports, board, rules)
        if self._dialect.is_old and not is_subtree:
            _refuse_scripts(values, id_, name)
        for attribute in ("_failureIf", "_successIf", "_skipIf", "_while"):
            if attribute in values:
                node.conditions.append((attribute, parse_script(values[attribute])))
        for attribute in ("_onSuccess", "_onFailure", "_post", "_onHalted"):
            if attribute in values:
                node.scripts[attribute] = parse_script(values[attribute])
        if is_subtree:
            inner = (inner_board if self._dialect.is_old else self._inner_board)(element.tag, values, board)
            node.children.append(self.tree(plain, inner, f"{path}/"))
            return node
        self._declare(node)
        for child in element.elements:
            node.children.append(self._node(child, board, prefix))
        return node

    def _inner_board(self, _: str, values: Mapping[str, str], board: Board) -> Board:
        """The blackboard of a SubTree: remapped ports, and constants as entries of its own."""
        inner = Board(board, values.get("_autoremap", "").lower() in ("1", "true"))
        for port, value in values.items():
            if port in _NO_PORTS or port.startswith("_"):
                continue
            key = key_of(value, port)
            if key is not None:
                inner.remapped[port] = key
            else:
                number = _constant(value) if self._dialect.types_constants else None
                if number is None:
                    inner.define(port, value, "")
                else:
                    inner.define(port, number, "int" if isinstance(number, int) else DOUBLE)
        return inner

    def _declare(self, node: SimulatedNode) -> None:
        """Create the entries of a built-in's ports, and fill in its defaults."""
        kind = BUILTINS.get(node.id)
        ports = self._nav2.get(node.id) if kind is None else kind.ports
        for port in ports or ():
            declared = of_version(port, self._dialect.version)
            written = node.ports.get(port.name)
            if written is None:
                if declared.default is not None:
                    node.ports[port.name] = declared.default
            elif (key := key_of(written, port.name)) is not None:
                node.board.create(key, _TYPES.get(declared.type, declared.type))
                is_simulated = kind is None and node.rules.flow is not tick_custom
                if is_simulated and is_read_once(self._dialect.nav2, node.id, port.name, node.ports):
                    _read_once(node, port.name)
        if ports is None:
            for name, written in node.ports.items():
                if (key := key_of(written, name)) is not None:
                    node.board.create(key)
        for name in ("code", "if"):
            if name in node.ports and kind is not None:
                if key_of(node.ports[name], name) is not None:
                    raise NotModelled(f"the script of {node.path} is an entry")
                node.scripts[name] = parse_script(node.ports[name])


def _read_once(node: SimulatedNode, port: str) -> None:
    """Give a port the value that its entry has now."""
    value = read(node, port)
    if value is None:
        raise NotModelled(f"the port {port} of {node.path} is read when the tree is created, and its entry is empty")
    node.ports[port] = text_of(value)


def _refuse_scripts(values: Mapping[str, str], id_: str, name: str) -> None:
    """Refuse conditions and scripts as version 3 does, which takes them for ports."""
    for attribute in values:
        if attribute.startswith("_") and attribute != "_description":
            raise EngineError(
                f'Possible typo? In the XML, you tried to remap port "{attribute}" in node [{id_} / {name}], '
                "but the manifest of this node does not contain a port with this name."
            )


def _refuse_two_async(root: Element) -> None:
    for element in root.walk():
        if inspects_children(element.tag) and sum(map(_is_async_sequence, element.elements)) > 1:
            line = element.source.count("\n", 0, element.start) + 1
            raise EngineError(f"Error at line {line}: -> A {element.tag} cannot have more than one async child.")


def _is_async_sequence(element: Element) -> bool:
    kind = BUILTINS.get(element.tag)
    return kind is not None and kind.flow == "sequence" and kind.pauses and not kind.keeps_place


def _constant(text: str) -> int | float | None:
    """A constant as the number that it is as a whole."""
    if _WHOLE.fullmatch(text):
        return int(text)
    return float(text) if _REAL.fullmatch(text) else None


CATEGORIES: Final = ("Action", "Condition", "Control", "Decorator")
_NO_PORTS: Final = ("ID", "name")
_TYPES: Final = {"BT::Any": "", "BT::AnyTypeAllowed": "", "": "", "std::__cxx11::basic_string": STRING}
_WHOLE: Final = re.compile(r"-?\d+")
_REAL: Final = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
