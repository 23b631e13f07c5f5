"""What the nodes of trees do with blackboard entries, and which names in which trees are one entry.

One invariant: a port without a model may read and write.  This module does not know what the robot's program does with
entries, nor whether a name is right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import chain
from typing import TypeAlias

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_entry_name, is_port_name
from btq_lang.catalog.versions import is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.calls import callers
from btq_lang.checks.engines import is_for_version_4
from btq_lang.checks.pointers import is_on, pointed_at, remaps_all
from btq_lang.checks.scripts import is_script
from btq_lang.checks.strings import in_source
from btq_lang.checks.view import View, port_names, port_of
from btq_lang.syntax.tree import Pair, Signal, Tree, Verbatim, Word
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

# A name in a tree; an empty tree means the root blackboard.
Name: TypeAlias = tuple[str, str]


class EntryMention(Record):
    """A place where a tree names an entry.

    Attributes:
        name: in the tree, with the `@` of the root blackboard.
        span: the name itself.
        reads, writes: what may happen to it there; for a SubTree neither, for that happens in its tree.
        creates: whether it need not exist before.
        in_script: whether it is in a script.
    """

    name: str
    span: Span
    node: ResolvedNode
    reads: bool
    writes: bool
    creates: bool
    in_script: bool


@of_scope
def mentions(store: Store[Workspace], viewpoint: str, path: str, tree: Facts) -> tuple[EntryMention, ...]:
    """Every name of an entry in a tree, in document order."""
    return tuple(_mentions(View(store, viewpoint), path, tree))


@of_scope
def blackboards(store: Store[Workspace], viewpoint: str) -> Blackboards:
    """The entries of the trees in scope."""
    return Blackboards(View(store, viewpoint))


@of_scope
def handling(store: Store[Workspace], viewpoint: str, tree: str) -> Handling:
    """What a tree does with entries."""
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    item = definition[1].item if definition is not None else None
    if definition is None or not isinstance(item, Tree):
        return Handling((), (), frozenset(), (), True, False)
    model = view.ask(lookups.meaning, Kind.MODEL, tree)
    declared = model.ports if model is not None else ()
    nodes = view.seen_in(*definition)
    touches = [
        Touch(mention.name, mention.reads, mention.writes, mention.creates)
        for mention in view.ask(mentions, *definition)
    ]
    return Handling(
        tuple([port.name.text for port in (*item.ports, *declared) if port.name is not None]),
        tuple(touches),
        frozenset(_bare_values(nodes.given)),
        tuple([call for resolved in nodes.all if (call := call_of(view, resolved)) is not None]),
        _has_verbatim(item, nodes.all)
        or bool(store.ask(inputs.entry, *definition).diagnostics)
        or any(map(_names_by_value, nodes.given))
        or any(not is_entry_name(touch.name.removeprefix("@")) for touch in touches),
        any(_is_stranger(view, resolved) for resolved in nodes.all),
    )


def _mentions(view: View, path: str, tree: Facts) -> Iterator[EntryMention]:
    for resolved, pair, value in view.seen_in(path, tree).values():
        if "{" in value.raw and (name := pointed_at(pair.key.text, value.text)) is not None:
            yield EntryMention(name, _inside(value, name), resolved, *_use(view, resolved, pair), False)
        elif is_script(resolved, pair):
            yield from _in_script(view, resolved, value)
        elif resolved.kind is not None and (port := resolved.kind.port(pair.key.text)) and port.content == "key":
            creates = port.direction != "input"
            yield EntryMention(value.text, value.span, resolved, not creates, creates, creates, False)


class Handling(Record):
    """What a tree does with entries, by their names in it.

    Attributes:
        ports: names of its own ports.
        touches: one for each mention.
        named: values of custom nodes that may be names of entries: programs read some values so, mostly those of
            outputs.
        calls: the SubTrees in it.
        is_open: whether something in it may read and write any entry: verbatim XML, what could not be read, a name
            that only another language than the engine's understands, as `{a}_{b}`; or it is not here.
        has_strangers: whether a node in it may: one without a model, or with ports that its model lacks.
    """

    ports: tuple[str, ...]
    touches: tuple[Touch, ...]
    named: frozenset[str]
    calls: tuple[SubTreeCall, ...]
    is_open: bool
    has_strangers: bool


class SubTreeCall(Record):
    """A SubTree, as it passes entries.

    Attributes:
        tree: that it runs.
        given: the entries that it passes, by the names that they have in that tree.
        values: the names of the entries that get a value instead.
        shares: whether that tree gets all other entries under their own names, but for private ones.
        is_one: whether both trees have one blackboard, as in version 3.
    """

    tree: str
    given: Mapping[str, str]
    values: frozenset[str]
    shares: bool
    is_one: bool

    def passed(self, name: str) -> str | None:
        """The entry that has a name in the tree below; None: that tree's own."""
        if self.is_one:
            return name
        if name in self.given or name in self.values:
            return self.given.get(name)
        return name if self.shares and name[:1] not in ("_", "@") else None


class Touch(Record):
    """What may happen to an entry in one place, as in `EntryMention`."""

    name: str
    reads: bool
    writes: bool
    creates: bool


class Blackboards:
    """The entries of the trees in scope.

    Attributes:
        root_names: how often each name of the root blackboard is mentioned.
    """

    def __init__(self, view: View) -> None:
        self._same: dict[Name, Name] = {}
        self._uses: dict[Name, list[Touch]] = {}
        self._ports: set[Name] = set()
        self._signals = view.ask(signal_entries)
        self.root_names: dict[str, int] = {}
        for name, direction in view.ask(lookups.outside_entries):
            touch = Touch(name, direction != "output", direction != "input", direction != "input")
            self._uses.setdefault(("", name), []).append(touch)
        trees = {tree: view.ask(handling, tree) for tree in view.ask(inputs.names, Kind.TREE)}
        self._roots = frozenset([tree for tree in trees if not view.ask(callers, tree)])
        for tree, handled in trees.items():
            self._add(tree, handled, trees)

    def uses_of(self, tree: str, name: str) -> list[Touch]:
        """All uses of an entry, wherever it is passed."""
        return self._merged.get(self._representative(self.place(tree, name)), [])

    def is_port(self, tree: str, name: str) -> bool:
        """Whether the entry is a port of the tree."""
        return self.place(tree, name) in self._ports

    def is_given(self, tree: str, name: str) -> bool:
        """Whether the entry comes from outside: it is a port, or a signal is read from it."""
        place = self.place(tree, name)
        return place in self._ports or place in self._signals

    def is_one(self, tree: str, name: str, other: str) -> bool:
        """Whether two names of a tree are one entry."""
        return self._representative(self.place(tree, name)) == self._representative(self.place(tree, other))

    def place(self, tree: str, name: str) -> Name:
        """The blackboard of an entry: the tree's own or that of the root."""
        if name[:1] == "@":
            return "", name[1:]
        return ("", name) if self.is_root(tree) else (tree, name)

    def is_root(self, tree: str) -> bool:
        """Whether the tree's own blackboard is that of the root."""
        return tree in self._roots

    @cached_property
    def _merged(self) -> dict[Name, list[Touch]]:
        merged: dict[Name, list[Touch]] = {}
        for key, uses in self._uses.items():
            merged.setdefault(self._representative(key), []).extend(uses)
        return merged

    def _add(self, tree: str, handled: Handling, trees: Mapping[str, Handling]) -> None:
        self._ports.update(self.place(tree, port) for port in handled.ports)
        for touch in handled.touches:
            place = self.place(tree, touch.name)
            self._uses.setdefault(place, []).append(touch)
            if not place[0]:
                self.root_names[place[1]] = self.root_names.get(place[1], 0) + 1
        for call in handled.calls:
            for port, name in call.given.items():
                self._join(self.place(tree, name), (call.tree, port))
            for name in [touch.name for touch in trees[call.tree].touches] if call.tree in trees else ():
                if name not in call.given and call.passed(name) == name:
                    self._join(self.place(tree, name), (call.tree, name))

    def _join(self, one: Name, other: Name) -> None:
        first, second = self._representative(one), self._representative(other)
        if first != second:
            self._same[second] = first

    def _representative(self, name: Name) -> Name:
        while (above := self._same.get(name)) is not None:
            name = above
        return name


def call_of(view: View, resolved: ResolvedNode) -> SubTreeCall | None:
    """How a node passes entries to the tree that it runs; None if it runs none."""
    is_plus = resolved.node.kind is not None and resolved.node.kind.raw == "SubTreePlus"
    tree_name = resolved.node.attribute("ID") if is_plus else resolved.id if resolved.is_subtree else None
    if tree_name is None:
        return None
    is_old = is_before_4(view.target)
    is_new = not view.is_xml or view.ask(is_for_version_4)
    entries: dict[str, str] = {}
    values: list[str] = []
    for pair in resolved.node.attributes:
        port, text = pair.key.text, pair.value.text if pair.value is not None else ""
        if not is_port_name(port, view.target):
            continue
        # In version 3 a SubTree maps names to names; a file that does not say its version may be for that one.
        is_name = text.isidentifier() and not (is_new or is_plus)
        name = pointed_at(port, text) or (text if is_name else None)
        if name is not None:
            entries.setdefault(port, name)
        if name is None or (is_name and not is_old):
            values.append(port)
    is_one = not is_new and is_on(resolved, "__shared_blackboard")
    shares = is_one or remaps_all(resolved) or (is_plus and is_on(resolved, "__autoremap"))
    return SubTreeCall(tree_name.text, entries, frozenset(values), shares, is_one)


def _bare_values(nodes: Iterable[ResolvedNode]) -> Iterator[str]:
    """The values that look like names, of custom nodes and of built-in ones that remove entries."""
    for resolved in nodes:
        for pair in resolved.node.attributes if not resolved.is_subtree else ():
            if not is_port_name(pair.key.text):
                continue
            port = resolved.kind.port(pair.key.text) if resolved.kind is not None else None
            text = pair.value.text.removeprefix("@") if pair.value is not None else ""
            if text.isidentifier() and (resolved.kind is None or (port is not None and port.removes)):
                yield text


def _names_by_value(resolved: ResolvedNode) -> bool:
    """Whether an entry of a built-in node says which other entry it writes."""
    for pair in resolved.node.attributes if resolved.kind is not None else ():
        port = resolved.kind.port(pair.key.text) if resolved.kind is not None else None
        if port is not None and port.content == "key" and pair.value is not None and is_pointer(pair.value.text):
            return True
    return False


def _is_stranger(view: View, resolved: ResolvedNode) -> bool:
    """Whether the ports of a node are unknown: nothing declares it, or it has more than are declared."""
    if resolved.kind is not None or resolved.is_subtree or resolved.is_placeholder:
        return False
    names = port_names(view, resolved)
    keys = [pair.key.text for pair in resolved.node.attributes]
    return resolved.of_model is None or any(is_port_name(name) and name not in names for name in keys)


def _has_verbatim(tree: Tree, resolved_nodes: Iterable[ResolvedNode]) -> bool:
    nodes = chain([tree.children], (resolved.node.children for resolved in resolved_nodes))
    return any(isinstance(child, Verbatim) for children in nodes for child in children)


def signal_entries(store: Store[Workspace], viewpoint: str) -> frozenset[Name]:
    """The entries that signals are read from."""
    view = View(store, viewpoint)
    meanings = [view.ask(lookups.meaning, Kind.SIGNAL, name) for name in view.ask(inputs.names, Kind.SIGNAL)]
    signals = [meaning.target for meaning in meanings if meaning is not None]
    sources = [signal.source for signal in signals if isinstance(signal, Signal) and signal.source is not None]
    return frozenset([("", source.text.strip("{}").removeprefix("@")) for source in sources])


def _use(view: View, resolved: ResolvedNode, pair: Pair) -> tuple[bool, bool, bool]:
    """Whether a port reads, writes and creates the entry that it is given."""
    if resolved.is_subtree:
        unknown = resolved.id is None or not view.ask(lookups.is_defined, Kind.TREE, resolved.id.text)
        return unknown, unknown, unknown
    port = port_of(view, resolved, pair.key.text)
    return port is None or port.direction != "output", port is None or port.direction != "input", True


def _inside(value: Word, name: str) -> Span:
    """The name in `{name}`, in quotes or not; all of `{=}`."""
    offset = value.raw.find(name)
    start = value.start + offset
    return Span(start, start + len(name)) if offset > 0 else value.span


def _in_script(view: View, resolved: ResolvedNode, value: Word) -> Iterator[EntryMention]:
    from btq_lang.syntax.script.tree import variables  # most files have no script, and it is large

    for variable in variables(view.script(value.text)):
        span = in_source(value, variable.span)
        yield EntryMention(variable.name, span, resolved, variable.reads, variable.writes, variable.creates, True)
