"""Refactorings of a tree: extract or inline a subtree, wrap or unwrap a node, lift a requirement.

One invariant: the behavior of the mission does not change; a refactoring that cannot guarantee it is not offered.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import PLACEHOLDERS, lookup
from btq_lang.checks.engines import engines_of
from btq_lang.checks.lookups import taken_names
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.ide.block import STEP, blanks_before, block_of, deeper, moved, nodes_at, shifts
from btq_lang.ide.meaning import entry_at
from btq_lang.ide.ports import port_of
from btq_lang.requirements.model import Interval as Time
from btq_lang.requirements.resolve import requirements
from btq_lang.syntax.scan import line_end
from btq_lang.syntax.tokens import BRACED, NODE_CLAUSES
from btq_lang.syntax.tree import (
    Between,
    Claim,
    Entry,
    Node,
    QualityPath,
    Requirement,
    SatisficedQuality,
    Satisfices,
    Satisfies,
    Tree,
    is_name,
    quote,
    written,
)
from btq_lang.util.record import Record
from btq_lang.util.text import Edit, Span, apply_edits
from btq_lang.workspace.file import File
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.references import Mention, What
from btq_lang.workspace.workspace import Workspace


class Action(Record):
    """A code action.

    Attributes:
        kind: of LSP: quickfix, refactor.extract, refactor.inline, refactor.rewrite, source.fixAll.btq,
            source.organizeImports.btq.
        edits: by file.
        diagnostic: that it fixes.
        preferred: whether it is the one obvious fix, which an editor may apply without offering a choice.
    """

    title: str
    kind: str
    edits: Mapping[str, tuple[Edit, ...]]
    diagnostic: Diagnostic | None = None
    preferred: bool = False


def refactorings(workspace: Workspace, path: str, offset: int) -> Iterator[Action]:
    """The refactorings of the node, or the requirement, at a place."""
    file = workspace.files[path]
    entry = entry_at(workspace, path, offset)
    if entry is None or file.is_foreign or any(one.rule == "syntax-error" for one in entry.diagnostics):
        return
    yield from _lift(workspace, path, entry, offset)
    line = nodes_at(file, entry, offset)
    if not line:
        return
    node = line[-1]
    if len(line) > 1:
        yield from _extract(workspace, path, entry, node)
    yield from _inline(workspace, path, entry, node)
    if block_of(file, entry, node).begins_its_line:
        yield from _unwrap(file, entry, node)
        yield from _wrap(file, entry, node)


# ---- extract a subtree ----


def _extract(workspace: Workspace, path: str, entry: Entry, node: Node) -> Iterator[Action]:
    if node.category is not None and node.category.raw == "SubTree":
        return
    file = workspace.files[path]
    keys = _keys_in(workspace, path, entry, node)
    if keys is None or _parts_a_time(workspace, path, node):
        return
    name, tree = _free_name(workspace, path, node), entry.item
    assert isinstance(tree, Tree), "only trees have nodes"
    block = block_of(file, entry, node)
    margin = blanks_before(file.text, entry.start + tree.start)
    lines = [f"{margin}BehaviorTree {written(name)}"]
    lines += [f"{margin}{STEP}{ways} {written(key)}" for key, ways in keys.items()]
    lines += [f"{margin}{STEP}{moved(file, block, margin + STEP)}"]
    arguments = " ".join(f"{written(key)} = {{=}}" for key in keys)
    call = f"SubTree {written(name)}{f' ({arguments})' if arguments else ''}"
    end = line_end(file.text, entry.start + tree.block_end)
    edits = (Edit(block.span, call), Edit(Span(end, end), "\n\n" + "\n".join(lines)))
    yield Action(f"Extract into the tree `{name}`", "refactor.extract", {path: edits})


def _keys_in(workspace: Workspace, path: str, entry: Entry, top: Node) -> dict[str, str] | None:
    """The entries of the tree's blackboard that the nodes below one use, each with input, output or inout; None if one
    cannot be passed on under its name."""
    nodes = {id(node) for node in top.walk()}
    directions: dict[str, set[str]] = {}
    for mention in workspace.files[path].mentions_of(entry):
        if mention.what is not What.KEY or mention.root or mention.node is None or id(mention.node) not in nodes:
            continue
        if not is_name(mention.name) or mention.node.attribute("_autoremap") is not None:
            return None
        directions.setdefault(mention.name, set()).add(_way(workspace, path, mention))
    return {key: ways.pop() if len(ways) == 1 else "inout" for key, ways in directions.items()}


def _way(workspace: Workspace, path: str, mention: Mention) -> str:
    if mention.writes:
        return "inout" if mention.updates else "output"
    if mention.node is None or mention.pair is None or mention.pair.key.text.startswith("_"):
        return "input"
    port = port_of(workspace, path, mention.node, mention.pair.key.text)
    if port is not None:
        return port.direction
    return "input" if mention.word.kind != BRACED else "inout"  # a script reads what it does not assign


def _free_name(workspace: Workspace, path: str, node: Node) -> str:
    """The node's name, adapted so that the engine accepts it for a tree; `Extracted` if it has none or a skill has that
    name. It is free in all files of the mission, for a build puts their trees and nodes side by side."""
    own = node.name.text if node.name is not None and not is_placeholder(node) else ""
    base = legal_name(own) if is_name(own) else "Extracted"
    taken = {
        *workspace.store.ask(taken_names, path, "", workspace.store.ask(engines_of, path)[-1]),
        *NODE_CLAUSES,
    }  # a clause after SubTree is not taken for a name
    taken.update(*(names_of_nodes(workspace.files[each]) for each in workspace.linked(path)))
    name, number = base, 2
    while name in taken or lookup(name) is not None:
        name, number = f"{base}{number}", number + 1
    return name


def names_of_nodes(file: File) -> set[str]:
    """The IDs of a file's nodes, of the trees that it runs, and of its placeholders."""
    names = {name for kind, name in file.used_names if kind in (Kind.MODEL, Kind.TREE)}
    if not names.isdisjoint(PLACEHOLDERS):  # else the tree is not requested: it may have been released
        nodes = (node for tree in file.of_type(Tree) for node in tree.walk() if is_placeholder(node))
        names |= {legal_name(node.name.text) for node in nodes if node.name is not None}
    return names


def _parts_a_time(workspace: Workspace, path: str, top: Node) -> bool:
    """Whether a build enforces the time between two nodes of which only one is below the extracted node: with the other
    in another tree, no node is left whose duration that is."""
    inside = {id(node) for node in top.walk()}
    return any(
        len({id(node.node) in inside for node in applied.nodes}) > 1
        for each in workspace.linked(path)
        if _has_span(workspace.files[each])
        for applied in requirements(workspace, each).applied
        if isinstance(applied.subject, Time) and applied.requirement.is_enforceable
    )


def _has_span(file: File) -> bool:
    """Whether a requirement in a file limits a time between two events: few do, and others need not be resolved."""
    targets = (same[0][1].target for (kind, _), same in file.names.definitions.items() if kind is Kind.REQUIREMENT)
    clauses = [target.clauses for target in targets if isinstance(target, Requirement)]
    return any(isinstance(one, Claim) and isinstance(one.subject, Between) for each in clauses for one in each)


# ---- inline a subtree ----


def _inline(workspace: Workspace, path: str, entry: Entry, node: Node) -> Iterator[Action]:
    if node.category is None or node.category.raw != "SubTree" or node.id is None or node.clauses or node.name:
        return
    definition = workspace.scope(path).find(Kind.TREE, node.id.text)
    tree = definition.symbol.target if definition is not None else None
    if definition is None or not isinstance(tree, Tree) or tree.clauses or len(tree.children) != 1:
        return
    top = tree.children[0]
    source = workspace.files[definition.path]
    arguments = {pair.key.text: pair.value for pair in node.attributes if pair.key.text != "ID"}
    if not isinstance(top, Node) or source.is_foreign or any(key.startswith("_") for key in arguments):
        return
    if definition.path == path and definition.entry is entry:
        return
    own = {one.name for one in workspace.files[path].mentions_of(entry) if one.what is What.KEY and not one.root}
    defaults = {port.name.text for port in tree.ports if port.name is not None and port.default is not None}
    edits: list[Edit] = []
    for mention in source.mentions_of(definition.entry):
        if mention.what is not What.KEY or mention.root or mention.defines:
            continue
        value = arguments.get(mention.name)
        start = definition.entry.start
        if value is None:
            if mention.name in own or mention.name in defaults:
                return  # another entry of the same name, or one that would have had a value
            continue
        if value.text.startswith("{@") or mention.pair is None:
            return
        passed = mention.name if value.text == "{=}" else value.text.strip("{}").strip()
        is_entry = value.kind == BRACED or (value.text.startswith("{") and value.text.endswith("}"))
        whole = mention.word.kind == BRACED or mention.word.text.startswith("{")
        if not is_entry and not whole:
            return  # a literal inside a script
        if mention.word.raw.strip("{} \"'") == "=" and is_entry:
            edits.append(Edit(mention.word.span.shifted(start), f"{{{passed}}}"))
        elif is_entry:
            edits.append(Edit(mention.span.shifted(start), passed))
        else:
            edits.append(Edit(mention.word.span.shifted(start), value.raw))
    block = block_of(source, definition.entry, top)
    after = File(definition.path, apply_edits(source.text, edits))
    grown = len(after.text) - len(source.text)
    changed = type(block)(Span(block.span.start, block.span.end + grown), block.blanks)
    inlined = moved(after, changed, block_of(workspace.files[path], entry, node).blanks)
    replacement = (Edit(node.span.shifted(entry.start), inlined),)
    yield Action(f"Inline the tree `{definition.symbol.name}`", "refactor.inline", {path: replacement})


# ---- wrap and unwrap a node ----


def _wrap(file: File, entry: Entry, node: Node) -> Iterator[Action]:
    block = block_of(file, entry, node)
    for head, what in _WRAPPERS:
        first, *others = shifts(file, block, block.blanks + STEP)
        opened = Edit(first.span, f"{block.blanks}{head}\n{first.text}")
        yield Action(f"Wrap in {what}", "refactor.rewrite", {file.path: (opened, *others)})


def _unwrap(file: File, entry: Entry, node: Node) -> Iterator[Action]:
    if len(node.children) != 1 or not isinstance(node.children[0], Node) or node.clauses:
        return
    child = block_of(file, entry, node.children[0])
    own = block_of(file, entry, node)
    between = Span(own.span.start, child.span.start)
    if "#" in file.text[slice(*between)] or "/" in file.text[slice(*between)]:
        return  # a comment would be lost
    first, *others = shifts(file, child, own.blanks)
    removed = Edit(Span(own.span.start - len(own.blanks), first.span.end), own.blanks)
    title = f"Unwrap: remove `{node.head.text}`"
    yield Action(title, "refactor.rewrite", {file.path: (removed, *others)})


_WRAPPERS = (
    ("Retry (num_attempts = 3)", "Retry"),
    ("Timeout (msec = 30 s)", "Timeout"),
    ("Inverter", "Inverter"),
    ("ForceSuccess", "ForceSuccess"),
    ("->", "a Sequence"),
    ("?", "a Fallback"),
)


# ---- lift a requirement to the file's level ----


def _lift(workspace: Workspace, path: str, entry: Entry, offset: int) -> Iterator[Action]:
    """A requirement that is defined in place becomes an item of its own, and its place refers to it."""
    tree = entry.item
    if not isinstance(tree, Tree):
        return
    file = workspace.files[path]
    for clause in (*tree.clauses, *(clause for node in tree.walk() for clause in node.clauses)):
        for requirement, quality in _defined_in(clause):
            if requirement.name is None or requirement.is_reference:
                continue
            if not entry.start + requirement.start <= offset <= entry.start + requirement.end:
                continue
            if quality is not None and workspace.scope(path).is_repeated(Kind.REQUIREMENT, requirement.name.text):
                continue  # the item names its quality, which the other places leave to what encloses them
            name = written(requirement.name.text)
            start = entry.start + tree.start
            margin = blanks_before(file.text, start)  # in a Root block, items are indented
            item = _item(file, entry, requirement, quality.path if quality else None, margin)
            insertion = Edit(Span(start, start), f"{item}\n\n{margin}")
            if quality is None:
                reference = Edit(Span(requirement.start, requirement.end).shifted(entry.start), name)
            else:
                opened = file.text.rfind("(", 0, entry.start + requirement.start)
                closed = file.text.find(")", entry.start + requirement.end)
                between = file.text[opened + 1 : entry.start + requirement.start]
                if len(quality.requirements) > 1 or opened < 0 or closed < 0 or between.strip():
                    continue
                reference = Edit(Span(opened, closed + 1), f"satisfies {name}")
            yield Action(
                f"Move `{requirement.name.text}` to the top level of the file",
                "refactor.extract",
                {path: (insertion, reference)},
            )


def _defined_in(clause: object) -> Iterator[tuple[Requirement, SatisficedQuality | None]]:
    if isinstance(clause, Satisfies):
        yield from ((use, None) for use in clause.uses if isinstance(use, Requirement))
    elif isinstance(clause, Satisfices):
        yield from ((one, quality) for quality in clause.qualities for one in quality.requirements)


def _item(file: File, entry: Entry, requirement: Requirement, quality: QualityPath | None, margin: str) -> str:
    """The requirement as an item.  margin: its indentation."""
    assert requirement.name is not None, "what has no name cannot be referred to"
    path = requirement.quality or quality
    shown = f" : {'.'.join(written(name.text) for name in path.names)}" if path is not None else ""
    parameters = ""
    if requirement.parameters:
        first, last = requirement.parameters[0].name.start, file.text.find(")", entry.start + requirement.name.end)
        parameters = f"({file.text[entry.start + first : last]})"
    text = f" {quote(' '.join(requirement.text.text.split()))}" if requirement.text is not None else ""
    lines = [f"QualityReq {written(requirement.name.text)}{parameters}{shown}{text}"]
    blanks = deeper(file.text, margin)
    lines += [f"{blanks}{file.on_one_line(entry, clause)}" for clause in requirement.clauses]
    return "\n".join(lines)
