"""Mentions: every word of an item that names something, so that an editor can ask what stands under the cursor.

One invariant: mentions depend on the item alone, and their spans count from it, so they hold for as long as the item
does.  A summary (`symbols`) has what checks need; this has every word that a person may point at: ports, blackboard
keys, parameters and the names in conditions too.  What a mention means in its file is for `features.meaning` to say.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from enum import Enum

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import PLACEHOLDERS, NodeKind, lookup
from btq_lang.record import Record
from btq_lang.symbols import requirements_at
from btq_lang.syntax import (
    Amount,
    Apply,
    Argument,
    Call,
    Claim,
    Clause,
    Context,
    Every,
    Include,
    Item,
    Model,
    Models,
    Node,
    NodeClause,
    Operand,
    Pair,
    Parameter,
    Path,
    Port,
    Qualities,
    QualityDecl,
    QualityPath,
    ReqRef,
    Requirement,
    Root,
    Satisfices,
    Signal,
    Tags,
    Tree,
    Word,
    walk,
)
from btq_lang.text import Span
from btq_lang.tokens import BRACED, NAME, QUANTITY, STRING


class What(Enum):
    """What a word may name, as far as its place says it."""

    TREE = "tree"
    NODE = "node"  # a kind: a built-in, a model, or a custom node
    REQUIREMENT = "requirement"
    SIGNAL = "signal"
    CONTEXT = "context"
    QUALITY = "quality"
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


class Mention(Record):
    """A word that names something.

    Attributes:
        name: what is named; of a quality all its names, joined by `.`.
        span: the name, counted from the item; of a key without its braces and `@`.
        word: the word it stands in, to see whether it is quoted.
        defines: the name is given here, and not used.
        node: the node it stands at, or in whose place it stands.
        owner: the requirement of a parameter, the model of a port, the tree of a key; else None.
        pair: of a port or a key: the attribute it stands in.
        writes: a key that a script assigns.
        root: a key of the root blackboard: `{@key}`.
        updates: a key that a script assigns and reads for that, as in `tries += 1`.
    """

    what: What
    name: str
    span: Span
    word: Word
    defines: bool = False
    node: Node | None = None
    owner: Requirement | Model | Tree | str | None = None
    pair: Pair | None = None
    writes: bool = False
    root: bool = False
    updates: bool = False


def mentions(item: Item) -> tuple[Mention, ...]:
    """All words of an item that name something, in the order of the text."""
    found = (mention for mention in _of_item(item) if mention.span.start < mention.span.end)
    return tuple(sorted(found, key=lambda mention: mention.span))


def _of_item(item: Item) -> Iterator[Mention]:
    if isinstance(item, Tree):
        yield from _word(What.TREE, item.name, defines=True)
        yield from _ports(item.ports, item)
        yield from _clauses(item.clauses, None)
        for node in item.walk():
            yield from _node(node, item)
    elif isinstance(item, Model):
        yield from _model(item)
    elif isinstance(item, Models):
        for model in item.models:
            if isinstance(model, Model):
                yield from _model(model)
    elif isinstance(item, Requirement):
        yield from _requirement(item, None, attached=False)
    elif isinstance(item, Signal):
        yield from _word(What.SIGNAL, item.name, defines=True)
        yield from _word(What.UNIT, item.unit)
        if item.source is not None:
            yield from _keys_of(item.source, None, None, root=True)
        yield from _quantities(item)
    elif isinstance(item, Context):
        yield from _word(What.CONTEXT, item.name, defines=True)
        yield from _values(item.condition, None)
    elif isinstance(item, QualityDecl):
        yield from _word(What.QUALITY, item.name, defines=True)
        yield from _quality(item.parent, None)
    elif isinstance(item, Qualities):
        yield from _word(What.EDITION, item.edition)
    elif isinstance(item, Apply):
        for use in item.uses:
            yield from _reference(use, None)
        for selector in (*item.targets, *item.exceptions):
            yield from _word(What.PLACE, selector.every)
            yield from _word(What.TAG, selector.tag)
            yield from _path(selector.path)
    elif isinstance(item, Root):
        yield from _word(What.TREE, item.name)
        for pair in item.attributes:
            if pair.key.text == "main_tree_to_execute":
                yield from _word(What.TREE, pair.value)
    elif isinstance(item, Include):
        yield from _word(What.INCLUDE, item.path)


def _model(model: Model) -> Iterator[Mention]:
    yield from _word(What.NODE, model.name, defines=True)
    yield from _ports(model.ports, model)


def _ports(ports: Iterable[Port], owner: Model | Tree) -> Iterator[Mention]:
    """The port of a tree is an entry of its blackboard."""
    for port in ports:
        name = port.name or next((pair.value for pair in port.attributes if pair.key.text == "name"), None)
        what = What.KEY if isinstance(owner, Tree) else What.PORT
        yield from _word(what, name, defines=True, owner=owner)
        if port.default is not None:
            yield from _quantities(port.default)


# ---- nodes ----


def _node(node: Node, tree: Tree) -> Iterator[Mention]:
    kind = None if node.kind is None else lookup(node.kind.text, node.kind.quoted, len(node.nodes))
    for word in kinds(node):
        yield from _word(What.NODE, word, node=node)
    yield from _word(What.TREE, called(node), node=node)
    if node.label is not None and placeholder(node) is None:
        yield from _word(What.INSTANCE, node.label, defines=True, node=node, owner=tree)
    for pair in node.attributes:
        yield from _pair(pair, node, tree, kind)
    yield from _clauses(node.clauses, node)


def kinds(node: Node) -> list[Word]:
    """The words that say what a node is: its kind, if that is no tree, and the skill that a placeholder stands for."""
    tree = called(node)
    return [word for word in (node.id, placeholder(node)) if word is not None and word is not tree]


def called(node: Node) -> Word | None:
    """The tree that a node runs."""
    if node.kind is not None and node.kind.raw == "SubTreePlus":
        return node.attribute("ID")
    return node.id if node.category is not None and node.category.raw == "SubTree" else None


def placeholder(node: Node) -> Word | None:
    """The skill that a classic placeholder stands for (language.md §4), where its name can be a node's ID as it is."""
    is_one = node.category is None and node.kind is not None and node.kind.raw in PLACEHOLDERS
    name = node.name
    if not is_one or name is None or node.attribute("code") is not None or legal_name(name.text) != name.text:
        return None
    return name


def _pair(pair: Pair, node: Node, tree: Tree, kind: NodeKind | None) -> Iterator[Mention]:
    key = pair.key.text
    if key == "name":
        yield from _word(What.ATTRIBUTE, pair.key, node=node, pair=pair)
        if placeholder(node) is None:
            yield from _word(What.INSTANCE, pair.value, defines=True, node=node, owner=tree)
        return
    if key == "ID" or key.startswith("_"):
        yield from _word(What.ATTRIBUTE, pair.key, node=node, pair=pair)
    else:
        yield from _word(What.PORT, pair.key, node=node, pair=pair, owner=tree)
    value = pair.value
    if value is None:
        return
    port = kind.port(key) if kind is not None else None
    attribute = RESERVED_ATTRIBUTES.get(key)
    if value.kind == BRACED or (value.kind == STRING and value.text.startswith("{") and value.text.endswith("}")):
        yield from _keys_of(value, node, tree, pair)
    elif (attribute is not None and attribute.is_script) or (port is not None and port.content == "script"):
        yield from _script(value, node, tree, pair)
    elif port is not None and port.content == "key" and value.kind in (NAME, STRING):
        yield from _word(What.KEY, value, node=node, owner=tree, pair=pair)
    elif value.kind == QUANTITY:
        yield from _word(What.QUANTITY, value, node=node, pair=pair)


def _keys_of(
    word: Word, node: Node | None, tree: Tree | None, pair: Pair | None = None, root: bool = False
) -> Iterator[Mention]:
    """`{key}`, `{@key}`, and `{=}`, which is the entry that is called as the port."""
    quotes = 1 if word.kind == STRING else 0
    inside = word.raw[quotes + 1 : -1 - quotes]
    name = inside.strip()
    start = word.start + quotes + 1 + len(inside) - len(inside.lstrip())
    if name == "=" and pair is not None:
        yield Mention(What.KEY, pair.key.text, Span(start, start + 1), word, False, node, tree, pair)
        return
    if name.startswith("@"):
        name, start, root = name[1:], start + 1, True
    yield Mention(What.KEY, name, Span(start, start + len(name)), word, False, node, tree, pair, False, root)


def _script(word: Word, node: Node, tree: Tree, pair: Pair) -> Iterator[Mention]:
    """The entries that a script reads and writes; one with escapes in it is left alone, for its offsets are others."""
    from btq_lang.script import Assign, Name, parse_script  # most files have no script, and it is large
    from btq_lang.script import children as parts

    text = word.text
    if len(text) != len(word.raw) - (2 if word.quoted else 0):
        return
    offset = word.start + (1 if word.quoted else 0)
    stack = list(parse_script(text).statements)
    written = {id(part.target): part.operator for part in stack if isinstance(part, Assign)}
    while stack:
        part = stack.pop()
        if isinstance(part, Name):
            root = part.name.startswith("@")
            name = part.name[1:] if root else part.name
            span = Span(offset + part.end - len(name), offset + part.end)
            operator = written.get(id(part))
            is_update = operator not in (None, ":=", "=")
            yield Mention(What.KEY, name, span, word, False, node, tree, pair, operator is not None, root, is_update)
        else:
            stack += parts(part)


def _clauses(clauses: Iterable[NodeClause], node: Node | None) -> Iterator[Mention]:
    for clause in clauses:
        if isinstance(clause, Tags):
            for name in clause.names:
                yield from _word(What.TAG, name, defines=True, node=node)
            continue
        if isinstance(clause, Satisfices):
            for quality in clause.qualities:
                yield from _quality(quality.path, node)
        for requirement in requirements_at((clause,)):
            if isinstance(requirement, ReqRef):
                yield from _reference(requirement, node)
            else:
                yield from _requirement(requirement, node, attached=True)


# ---- requirements ----


def _reference(reference: ReqRef, node: Node | None) -> Iterator[Mention]:
    yield from _word(What.REQUIREMENT, reference.name, node=node)
    for argument in reference.arguments:
        yield from _word(What.PARAMETER, argument.name, owner=reference.name.text)
        yield from _values(argument.value, None)


def _requirement(requirement: Requirement, node: Node | None, attached: bool) -> Iterator[Mention]:
    refers = attached and requirement.is_reference
    yield from _word(What.REQUIREMENT, requirement.name, defines=not refers, node=node, owner=requirement)
    yield from _quality(requirement.quality, node)
    for parameter in requirement.parameters:
        yield from _word(What.PARAMETER, parameter.name, defines=True, owner=requirement)
        yield from _word(What.UNIT, parameter.unit)
        yield from _values(parameter.default, requirement)
    for clause in requirement.clauses:
        yield from _values(clause, requirement)


def _quality(path: QualityPath | None, node: Node | None) -> Iterator[Mention]:
    if path is not None:
        name = ".".join(word.text for word in path.names)
        yield Mention(What.QUALITY, name, path.span, path.names[-1], False, node)


def _values(part: Clause | Parameter | Argument | object, owner: Requirement | None) -> Iterator[Mention]:
    """The names and quantities in clauses, conditions and bounds."""
    for found in walk(part):
        if isinstance(found, Operand | Amount):
            if found.word.kind == NAME and found.word.raw not in ("true", "false"):
                yield from _word(What.VALUE, found.word, owner=owner)
        elif isinstance(found, Call):
            yield from _word(What.VALUE, found.signal, owner=owner)
        elif isinstance(found, Claim):
            yield from _word(What.VALUE, found.resource, owner=owner)
        elif isinstance(found, Path):
            yield from _path(found)
        elif isinstance(found, Every):
            yield from _word(What.PLACE, found.name)
        elif isinstance(found, Word) and found.kind == QUANTITY:
            yield from _word(What.QUANTITY, found)


def _quantities(part: object) -> Iterator[Mention]:
    for found in walk(part):
        if isinstance(found, Word) and found.kind == QUANTITY:
            yield from _word(What.QUANTITY, found)


def _path(path: Path | None) -> Iterator[Mention]:
    for name in path.names if path is not None else ():
        yield from _word(What.PLACE, name)


def _word(
    what: What,
    word: Word | None,
    *,
    defines: bool = False,
    node: Node | None = None,
    owner: Requirement | Model | Tree | str | None = None,
    pair: Pair | None = None,
) -> Iterator[Mention]:
    if word is not None:
        yield Mention(what, word.text, word.span, word, defines, node, owner, pair)
