"""References: every word of an item that names something, so that an editor can resolve the word under the cursor.

One invariant: mentions depend on the item alone, and their spans count from it, so they are valid as long as the item
exists.  A summary (`symbols`) has the names that checks look up; a mention is made of every word that a user may point
at: ports, blackboard keys, parameters and the names in conditions too.  What it means in its file is for `ide.meaning`.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from functools import lru_cache
from operator import attrgetter
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import PLACEHOLDERS, lookup
from btq_lang.syntax import scenarios
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import BRACED, NAME, NUMBER, QUANTITY, STRING
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.symbols import Summary, Symbol, Target, Use, requirements_at

if TYPE_CHECKING:
    from btq_lang.syntax.script.tree import Variable


class What(Enum):
    """The kind of thing that a word may name, as far as its place determines it."""

    __hash__ = object.__hash__  # `Enum` computes it in Python

    TREE = "tree"
    NODE = "node"  # a kind: a built-in, a model, or a custom node
    REQUIREMENT = "requirement"
    SIGNAL = "signal"
    CONTEXT = "context"
    QUALITY = "quality"
    HAZARD = "hazard"
    PARAMETER = "parameter"
    VALUE = "value"  # in a condition: a context, a signal, a parameter, else a node
    PLACE = "place"  # in a path: a tree, a node or an instance name
    PORT = "port"
    ATTRIBUTE = "attribute"  # `_skipIf`, `name`
    KEY = "blackboard entry"
    INSTANCE = "instance name"
    TAG = "tag"
    INCLUDE = "file"
    QUANTITY = "quantity"
    UNIT = "unit"
    EDITION = "edition"
    RULE = "rule"


Owner: TypeAlias = "syntax.Requirement | syntax.Model | syntax.Tree | str | None"


class Mention(Record):
    """A word that names something.

    Attributes:
        name: what is named; for a quality all its names, joined by `.`.
        span: the name, counted from the item; of a key without its braces and `@`.
        word: that contains it, to see whether it is quoted.
        defines: whether the name is defined here, and not used.
        node: the node that has it, or that it replaces.
        owner: the requirement of a parameter, or the one that refines or mitigates what is named, the model of a port
            or of its own name, the tree of a key; in a scenario the name of the node of a port, or of the tree of a
            key; else None.
        pair: the attribute with a port or a key.
        writes: whether it is a key that a script assigns.
        root: whether it is a key of the root blackboard: `{@key}`.
        updates: whether it is a key that a script assigns and reads for that, as in `tries += 1`.
    """

    what: What
    name: str
    span: Span
    word: syntax.Word
    defines: bool = False
    node: syntax.Node | None = None
    owner: Owner = None
    pair: syntax.Pair | None = None
    writes: bool = False
    root: bool = False
    updates: bool = False


def mentions(item: syntax.Item) -> tuple[Mention, ...]:
    """All words of an item that name something, in the order of the text."""
    listener = ReferenceListener()
    report(item, listener)
    return tuple(sorted(listener.mentions, key=attrgetter("span")))


def summarize(item: syntax.Item) -> Summary:
    """The names that an item defines and refers to."""
    names = _Names(item)
    report(item, names)
    return Summary(tuple(names.symbols), tuple(names.uses)) if names.symbols or names.uses else _NOTHING


def report(item: syntax.Item, to: ReferenceListener) -> None:
    """Report the words of an item that name something, nearly in the order of the text."""
    if isinstance(item, syntax.Tree):
        to.word(What.TREE, item.name, defines=True)
        _ports(item.ports, item, to)
        _clauses(item.clauses, None, to)
        for node in item.walk():
            _node(node, item, to)
    elif isinstance(item, syntax.Model):
        _model(item, to)
    elif isinstance(item, syntax.Models):
        for model in item.models:
            if isinstance(model, syntax.Model):
                _model(model, to)
    elif isinstance(item, syntax.Requirement):
        _requirement(item, None, False, to)
    elif isinstance(item, syntax.Signal):
        to.word(What.SIGNAL, item.name, defines=True)
        to.word(What.UNIT, item.unit)
        if item.source is not None:
            to.value(item.source)
            _keys_of(item.source, None, None, None, to, root=True)
        _quantities(item, to)
    elif isinstance(item, syntax.Context):
        to.word(What.CONTEXT, item.name, defines=True)
        _values(item.condition, None, to)
    elif isinstance(item, syntax.QualityDecl):
        to.word(What.QUALITY, item.name, defines=True)
        _quality(item.parent, None, to)
    elif isinstance(item, syntax.Hazard):
        to.word(What.HAZARD, item.name, defines=True)
    elif isinstance(item, syntax.Scenario):
        to.word(What.TREE, item.tree)
        for name in item.verifies:
            to.word(What.REQUIREMENT, name)
        _scenario(item.steps, item.tree, to)
    elif isinstance(item, syntax.Given):
        _scenario(item, None, to)
    elif isinstance(item, syntax.Qualities):
        to.word(What.EDITION, item.edition)
    elif isinstance(item, syntax.Apply):
        for use in item.uses:
            _reference(use, None, to)
        for selector in (*item.targets, *item.exceptions):
            to.word(What.PLACE, selector.every)
            to.word(What.TAG, selector.tag)
            _path(selector.path, to)
    elif isinstance(item, syntax.Root):
        to.word(What.TREE, item.name)
        for pair in item.attributes:
            if pair.key.text == "main_tree_to_execute":
                to.word(What.TREE, pair.value)
    elif isinstance(item, syntax.Include):
        to.word(What.INCLUDE, item.path)


class ReferenceListener:
    """Makes a mention of each word of an item that names something.  That would be too slow for some, who receive the
    words themselves.

    Attributes:
        skips_values: whether conditions and the attributes of nodes are left out, and of a node all names but one.
    """

    skips_values = False

    def __init__(self) -> None:
        self.mentions: list[Mention] = []

    def word(
        self,
        what: What,
        word: syntax.Word | None,
        defines: bool = False,
        node: syntax.Node | None = None,
        owner: Owner = None,
        pair: syntax.Pair | None = None,
    ) -> None:
        """A whole word, or None where one is missing; arguments as for a mention."""
        if word is not None:
            self.part(Mention(what, word.text, word.span, word, defines, node, owner, pair))

    def part(self, mention: Mention) -> None:
        """A part of a word."""
        if mention.span.start < mention.span.end:
            self.mentions.append(mention)

    def words(self, what: What, words: tuple[syntax.Word, ...], span: Span, node: syntax.Node | None = None) -> None:
        """Several words that are one name."""
        self.part(Mention(what, ".".join([word.text for word in words]), span, words[-1], False, node))

    def value(self, word: syntax.Word) -> None:
        """The value of an attribute that as a whole names nothing; parts of it may follow, in the order of the text."""


class _Names(ReferenceListener):
    """The symbols and uses of a summary."""

    skips_values = True

    def __init__(self, item: syntax.Item) -> None:
        super().__init__()
        self.symbols: list[Symbol] = []
        self.uses: list[Use] = []
        self._item = item

    def word(
        self,
        what: What,
        word: syntax.Word | None,
        defines: bool = False,
        node: syntax.Node | None = None,
        owner: Owner = None,
        pair: syntax.Pair | None = None,
    ) -> None:
        kind = KIND_OF.get(what)
        if word is None or kind is None:
            return
        if not defines:
            self.uses.append(Use(kind, word.text, word.span, node))
        elif isinstance(target := owner or self._item, Target):
            self.symbols.append(Symbol(kind, word.text, word.span, target))

    def words(self, what: What, words: tuple[syntax.Word, ...], span: Span, node: syntax.Node | None = None) -> None:
        self.uses.append(Use(KIND_OF[what], ".".join([word.text for word in words]), span, node))


def _model(model: syntax.Model, to: ReferenceListener) -> None:
    to.word(What.NODE, model.name, defines=True, owner=model)
    _ports(model.ports, model, to)


def _ports(ports: Iterable[syntax.Port], owner: syntax.Model | syntax.Tree, to: ReferenceListener) -> None:
    """The port of a tree is an entry of its blackboard."""
    for port in ports:
        name = port.id
        what = What.KEY if isinstance(owner, syntax.Tree) else What.PORT
        to.word(what, name, defines=True, owner=owner)
        if port.default is not None:
            _quantities(port.default, to)


# ---- nodes ----


def _node(node: syntax.Node, tree: syntax.Tree, to: ReferenceListener) -> None:
    if to.skips_values:
        run = called(node)
        to.word(What.NODE if run is None else What.TREE, run or node.id, node=node)
    else:
        _words_of(node, tree, to)
    if node.clauses:
        _clauses(node.clauses, node, to)


def _words_of(node: syntax.Node, tree: syntax.Tree, to: ReferenceListener) -> None:
    kind, label = node.kind, node.label
    stands_for: syntax.Word | None = None
    if node.category is None and kind is not None and kind.raw not in _STANDING_FOR_OTHERS:  # nearly all
        to.word(What.NODE, kind, node=node)
    else:
        word, stands_for, run = node.id, placeholder(node), called(node)
        if word is not None and word is not run:
            to.word(What.NODE, word, node=node)
        if stands_for is not None:
            to.word(What.NODE, stands_for, node=node)
        if run is not None:
            to.word(What.TREE, run, node=node)
    if label is not None and stands_for is None:
        to.word(What.INSTANCE, label, defines=True, node=node, owner=tree)
    for pair in node.attributes:
        _pair(pair, node, tree, stands_for, to)


def kinds(node: syntax.Node) -> list[syntax.Word]:
    """The words that determine what a node is: its kind, if that is not a tree, and the skill of a placeholder."""
    tree = called(node)
    return [word for word in (node.id, placeholder(node)) if word is not None and word is not tree]


def called(node: syntax.Node) -> syntax.Word | None:
    """The tree that a node runs."""
    if node.kind is not None and node.kind.raw == "SubTreePlus":
        return node.attribute("ID")
    return node.id if node.category is not None and node.category.raw == "SubTree" else None


def placeholder(node: syntax.Node) -> syntax.Word | None:
    """The skill of a classic placeholder (docs/language.md), if its name can be a node's ID."""
    is_one = node.category is None and node.kind is not None and node.kind.raw in PLACEHOLDERS
    name = node.name
    if not is_one or name is None or node.attribute("code") is not None or legal_name(name.text) != name.text:
        return None
    return name


def _pair(
    pair: syntax.Pair, node: syntax.Node, tree: syntax.Tree, stands_for: syntax.Word | None, to: ReferenceListener
) -> None:
    key, value = pair.key.text, pair.value
    if key == "name":
        to.word(What.ATTRIBUTE, pair.key, node=node, pair=pair)
        if stands_for is None:
            to.word(What.INSTANCE, value, defines=True, node=node, owner=tree)
        return
    if key == "ID" or key.startswith("_"):
        to.word(What.ATTRIBUTE, pair.key, node=node, pair=pair)
    else:
        to.word(What.PORT, pair.key, node=node, pair=pair, owner=tree)
    if value is None:
        return
    if value.kind == BRACED or (value.kind == STRING and value.raw[1:2] == "{" and value.text.endswith("}")):
        to.value(value)
        _keys_of(value, node, tree, pair, to)
    elif (content := _content(key, node)) == "script":
        to.value(value)
        _script(value, node, tree, pair, to)
    elif content == "key" and value.kind in (NAME, STRING):
        to.word(What.KEY, value, node=node, owner=tree, pair=pair)
    elif value.kind == QUANTITY:
        to.word(What.QUANTITY, value, node=node, pair=pair)
    elif key != "ID":  # which may name what the node is
        to.value(value)


def _content(key: str, node: syntax.Node) -> str | None:
    """The content of the value of an attribute: of a port of a built-in node, or of an attribute that every node may
    have."""
    attribute = RESERVED_ATTRIBUTES.get(key)
    if attribute is not None:
        return "script" if attribute.is_script else None
    kind = None if node.kind is None else lookup(node.kind.text, node.kind.quoted, len(node.nodes))
    port = kind.port(key) if kind is not None else None
    return None if port is None else port.content


def _keys_of(
    word: syntax.Word,
    node: syntax.Node | None,
    tree: syntax.Tree | None,
    pair: syntax.Pair | None,
    to: ReferenceListener,
    root: bool = False,
) -> None:
    """`{key}`, `{@key}`, and `{=}`, which is the entry named as the port."""
    quotes = 1 if word.kind == STRING else 0
    inside = word.raw[quotes + 1 : -1 - quotes]
    name = inside.strip()
    start = word.start + quotes + 1 + len(inside) - len(inside.lstrip())
    if name == "=" and pair is not None:
        to.part(Mention(What.KEY, pair.key.text, Span(start, start + 1), word, False, node, tree, pair))
        return
    if name.startswith("@"):
        name, start, root = name[1:], start + 1, True
    to.part(Mention(What.KEY, name, Span(start, start + len(name)), word, False, node, tree, pair, False, root))


def _script(word: syntax.Word, node: syntax.Node, tree: syntax.Tree, pair: syntax.Pair, to: ReferenceListener) -> None:
    """The entries that a script reads and writes; not of one with escapes, whose offsets differ."""
    text = word.text
    if len(text) != len(word.raw) - (2 if word.quoted else 0):
        return
    offset = word.start + (1 if word.quoted else 0)
    for variable in _variables(text):
        root = variable.name.startswith("@")
        name = variable.name[1:] if root else variable.name
        end = offset + variable.span.end
        span, writes = Span(end - len(name), end), variable.writes
        updates = writes and variable.reads
        to.part(Mention(What.KEY, name, span, word, False, node, tree, pair, writes, root, updates))


@lru_cache(1_000)  # many nodes have the same one
def _variables(text: str) -> tuple[Variable, ...]:
    from btq_lang.syntax.script.parser import parse_script  # most files have no script, and it is large
    from btq_lang.syntax.script.tree import variables

    return variables(parse_script(text))


def _clauses(clauses: Iterable[syntax.NodeClause], node: syntax.Node | None, to: ReferenceListener) -> None:
    for clause in clauses:
        if isinstance(clause, syntax.Tags):
            for name in clause.names:
                to.word(What.TAG, name, defines=True, node=node)
            continue
        if isinstance(clause, syntax.Satisfices):
            for quality in clause.qualities:
                _quality(quality.path, node, to)
        for requirement in requirements_at((clause,)):
            if isinstance(requirement, syntax.ReqRef):
                _reference(requirement, node, to)
            else:
                _requirement(requirement, node, True, to)


# ---- requirements ----


def _reference(reference: syntax.ReqRef, node: syntax.Node | None, to: ReferenceListener) -> None:
    to.word(What.REQUIREMENT, reference.name, node=node)
    for argument in reference.arguments:
        to.word(What.PARAMETER, argument.name, owner=reference.name.text)
        _values(argument.value, None, to)


def _requirement(
    requirement: syntax.Requirement, node: syntax.Node | None, attached: bool, to: ReferenceListener
) -> None:
    refers = attached and requirement.is_reference
    to.word(What.REQUIREMENT, requirement.name, defines=not refers, node=node, owner=requirement)
    for quality in requirement.qualities:
        _quality(quality, node, to)
    if requirement.text is not None:
        to.value(requirement.text)
    for parameter in requirement.parameters:
        to.word(What.PARAMETER, parameter.name, defines=True, owner=requirement)
        to.word(What.UNIT, parameter.unit)
        _values(parameter.default, requirement, to)
    for clause in requirement.clauses:
        if isinstance(clause, syntax.Refines | syntax.Mitigates):
            what = What.REQUIREMENT if isinstance(clause, syntax.Refines) else What.HAZARD
            for name in clause.names:
                to.word(what, name, owner=requirement)
        else:
            _values(clause, requirement, to)


def _quality(path: syntax.QualityPath | None, node: syntax.Node | None, to: ReferenceListener) -> None:
    if path is not None:
        to.words(What.QUALITY, path.names, path.span, node)


def _values(
    part: syntax.Clause | syntax.Parameter | syntax.Argument | object,
    owner: syntax.Requirement | None,
    to: ReferenceListener,
) -> None:
    """The names and quantities in clauses, conditions and bounds."""
    for piece in () if to.skips_values else syntax.walk(part):
        if isinstance(piece, syntax.Word):  # nearly half of them are
            if piece.kind == QUANTITY:
                to.word(What.QUANTITY, piece)
            elif piece.kind == NUMBER:
                to.value(piece)
        elif isinstance(piece, (syntax.Operand, syntax.Amount)):
            if piece.word.kind == NAME and piece.word.raw not in ("true", "false"):
                to.word(What.VALUE, piece.word, owner=owner)
        elif isinstance(piece, syntax.Call):
            to.word(What.VALUE, piece.signal, owner=owner)
        elif isinstance(piece, syntax.Claim):
            to.word(What.VALUE, piece.resource, owner=owner)
        elif isinstance(piece, syntax.Path):
            _path(piece, to)
        elif isinstance(piece, syntax.Every):
            to.word(What.PLACE, piece.name)


# ---- scenarios ----


def _scenario(part: object, tree: syntax.Word | None, to: ReferenceListener) -> None:
    """The words in the steps of a scenario of a tree, None: the main tree.  Entries are those of the tree that runs."""
    run = tree.text if tree is not None else None
    for piece in syntax.walk(part):
        if isinstance(piece, scenarios.ExpectedVerdict):
            to.word(What.REQUIREMENT, piece.name)
        elif to.skips_values:
            continue
        elif isinstance(piece, scenarios.NodePattern):
            to.word(What.PLACE, piece.every)
            _values_of_ports(piece.pairs, piece.last, run, to)
        elif isinstance(piece, scenarios.EventTrigger) and piece.event.path is not None:
            _values_of_ports(piece.pairs, piece.event.path.names[-1], run, to)
        elif isinstance(piece, syntax.NodeRef):
            _values_of_ports(piece.pairs, piece.path.names[-1], run, to)
        elif isinstance(piece, scenarios.NodesDo):
            for behavior in piece.behaviors:
                _values_of_ports(behavior.writes, piece.nodes.last, run, to)
        elif isinstance(piece, scenarios.Assignment):
            if piece.target.kind == NAME:
                to.word(What.VALUE, piece.target)
            _entry(piece.target, run, to)
            _entry(piece.value, run, to)
        elif isinstance(piece, scenarios.ExpectedRuns):
            last = piece.nodes.last
            to.word(What.PORT, piece.port, owner=last.text if last is not None else None)
            for word in piece.values:
                _entry(word, run, to)
        elif isinstance(piece, syntax.Operand):
            _entry(piece.word, run, to)
    _values(part, None, to)


def _values_of_ports(
    pairs: Iterable[syntax.Pair], node: syntax.Word | None, tree: str | None, to: ReferenceListener
) -> None:
    """Ports of a node by its name, and the entries that are their values."""
    for pair in pairs:
        to.word(What.PORT, pair.key, owner=node.text if node is not None else None)
        _entry(pair.value, tree, to)


def _entry(word: syntax.Word | None, tree: str | None, to: ReferenceListener) -> None:
    """`{key}` or `{@key}` of the tree that a scenario runs."""
    if word is None or word.kind != BRACED:
        return
    inside = word.raw[1:-1]
    name = inside.strip().removeprefix("@")
    start = word.start + 1 + inside.index(name)
    root = tree is None or inside.strip().startswith("@")
    to.part(Mention(What.KEY, name, Span(start, start + len(name)), word, owner=tree, root=root))


def _quantities(part: object, to: ReferenceListener) -> None:
    for piece in () if to.skips_values else syntax.walk(part):
        if isinstance(piece, syntax.Word) and piece.kind == QUANTITY:
            to.word(What.QUANTITY, piece)


def _path(path: syntax.Path | None, to: ReferenceListener) -> None:
    for name in path.names if path is not None else ():
        to.word(What.PLACE, name)


_STANDING_FOR_OTHERS: Final = frozenset((*PLACEHOLDERS, "SubTreePlus"))
KIND_OF: Final = {  # of what is looked up by its name
    What.TREE: Kind.TREE,
    What.NODE: Kind.MODEL,
    What.REQUIREMENT: Kind.REQUIREMENT,
    What.SIGNAL: Kind.SIGNAL,
    What.CONTEXT: Kind.CONTEXT,
    What.QUALITY: Kind.QUALITY,
    What.HAZARD: Kind.HAZARD,
}
_NOTHING: Final = Summary((), ())
