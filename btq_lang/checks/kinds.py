"""The kind of a node: unknown, not the engine's, too new, or used as something it is not."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.foreign_names import ForeignName, branch, foreign_name, is_of_leaves, statement
from btq_lang.catalog.kinds import CHILDREN
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name, model_name_problem
from btq_lang.catalog.nav2 import ports_of
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, KnownWord, NodeKind, available, lookup
from btq_lang.catalog.versions import VERSIONS, at_least, is_before_4, last_of
from btq_lang.checks import calls, cpp_lookups, lookups
from btq_lang.checks.engines import is_for_version_3, is_for_version_4, old_words
from btq_lang.checks.lookups import Declaration
from btq_lang.checks.misplaced_children import TOO_FAR, dedent_fixes, has_bare_label, label_as_child
from btq_lang.checks.missing_ids import missing_id
from btq_lang.checks.view import COUNTS, SECOND, View, has_names, is_first_tree, misspelt_clause, near_names
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.conditions import HEADS
from btq_lang.syntax.tokens import CATEGORIES, NAME
from btq_lang.syntax.tree import Model, Tree, Word, quote, written
from btq_lang.util.record import replace
from btq_lang.util.spelling import did_you_mean, distance, without_digits
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.symbols import Symbol, differences, has_ports_of, interface
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.workspace.custom_nodes import LikelyPort


def unknown_node(view: View) -> Iterator[Diagnostic]:
    """A node of unknown kind, if a palette of models is in scope, or if a known name is so similar that this one must
    be misspelt.  Without a palette, any other name is a custom node that the robot's program registers."""
    for resolved in view.seen.strangers:
        name = resolved.id
        word = resolved.node.category
        if word is not None and (name is None or name.text == ""):
            if not view.is_torn(resolved.node.start, resolved.node.end):
                what, pairs = f"missing ID of this {word.raw}", resolved.node.attributes
                diagnostic = missing_id(view, "unknown-node", word.span, what, word.raw, pairs)
                yield replace(diagnostic, severity=Severity.ERROR)
        elif name is None:
            continue
        elif view.ask(lookups.is_defined, Kind.TREE, name.text):
            if not _is_own_tree(view, name):
                yield _tree_as_node(view, resolved, name)
        elif view.is_pooled(Kind.MODEL, name.text):
            continue  # models that differ: whichever the program means, it is known
        elif (
            name.text in KNOWN_WORDS
            or _quoted_alias(resolved, name) is not None
            or _foreign(view, resolved) is not None
        ):
            continue  # not a node of the engine, which is reported
        elif name.text.casefold() == "include" and (
            resolved.name is not None or resolved.node.attribute("path") is not None
        ):
            place = (
                "directly below <root>: <include path=…/>"
                if view.is_xml
                else "outside of trees, at the start of a line"
            )
            yield Diagnostic("unknown-node", name.span, f"an include goes {place}")
        elif how := _in_other_words(view, resolved, name):
            label = resolved.node.label
            removed = (
                [Span(name.start, label.start)] if label is not None and label.kind == NAME and not view.is_xml else []
            )
            fixes = tuple([replace_fix(f"Remove `{name.raw}`", span, "") for span in removed])
            yield Diagnostic("unknown-node", name.span, f"there is no `{name.text}`: {how}", fixes=fixes)
        elif (category := _category_meant(view, resolved)) is not None:
            fix = replace_fix(f"Replace `{name.text}` with `{category}`", name.span, category)
            message = f"btq reads `{name.text}` as a node here; did you mean `{category}`?"
            yield Diagnostic("unknown-node", name.span, message, fixes=(fix,))
        elif resolved.parent is not None and resolved.parent.is_subtree and name.text in OF_SUBTREE:
            continue  # child_count says what replaced it
        elif not (_is_refused(view, resolved, name) or _is_clause(resolved) or misspelt_clause(resolved.node)):
            yield from _unknown(view, resolved, name)
    yield from _bare_subtrees(view)


def not_an_engine_node(view: View) -> Iterator[Diagnostic]:
    """A word of the published language or of an older engine that no current engine registers."""
    for resolved in view.nodes:
        name = resolved.id
        if name is None or resolved.is_defined or resolved.is_subtree:
            continue
        text = name.text
        if resolved.kind is not None and resolved.kind.tag == text:
            continue
        message = f"`{text}` is not built into BehaviorTree.CPP {VERSIONS[0]}–{VERSIONS[-1]}"
        known_word = KNOWN_WORDS.get(text)
        if _is_of(view, text):
            continue
        if known_word is not None and (not name.quoted or known_word.tag == name.text):
            fixes = _of_today(view, resolved, name, known_word)
            notes = (
                known_word.why,
                *_as_precondition(view, resolved),
                *(way_in(view) if known_word.word in _TRANSLATED else ()),
            )
            yield Diagnostic("not-an-engine-node", name.span, message, notes=notes, fixes=fixes)
        elif (meant := _quoted_alias(resolved, name)) is not None and not _is_refused(view, resolved, name):
            yield _aliased(view, resolved, name, message, meant)
        elif ":" in text:
            continue  # `bt:Sequence`, which forbidden_name reports
        elif (foreign := _foreign(view, resolved)) is not None:
            message += did_you_mean((foreign.tag,))
            as_child, fixes = label_as_child(view, resolved, foreign.tag)
            notes = (
                *((foreign.note,) if foreign.note else ()),
                *_as_child_condition(view, resolved, foreign.tag),
                *as_child,
            )
            if not as_child:
                fixes = (_as_built_in(view, resolved, name, foreign),)
            yield Diagnostic("not-an-engine-node", name.span, message, notes=notes, fixes=fixes)


def newer_engine_node(view: View) -> Iterator[Diagnostic]:
    """A built-in that one of the versions lacks that the file is for."""
    for tagged in view.seen.by_tag.values():
        missing = [] if tagged[0].kind is None else _missing(tagged[0].kind.tag, view.engines)
        for resolved in tagged if missing else ():
            if resolved.kind is None or resolved.id is None or _is_of(view, resolved.id.text):
                continue
            known_word = KNOWN_WORDS.get(resolved.id.text)
            if (
                known_word is not None
                and known_word.until is not None
                and all(at_least(last_of(known_word.until), v) for v in missing)
            ):
                continue  # they have it by this name
            since = "4" if is_before_4(missing[0]) else resolved.kind.since
            pin = f'if you run {view.target}, set `engine = "{view.target}"` in btq.toml'
            message = f"`{resolved.kind.tag}` requires BehaviorTree.CPP {since}; {missing[0]} does not have it"
            severity = None if view.is_pinned else Severity.WARNING
            notes = () if view.is_pinned else (pin,)
            yield Diagnostic("newer-engine-node", resolved.id.span, message, notes=notes, severity=severity)


@lru_cache(1_000)  # every tree of every file calls it
def _missing(tag: str, engines: tuple[str, ...]) -> list[str]:
    return [version for version in engines if not available(BUILTINS[tag], version)]


def no_models(view: View) -> Iterator[Diagnostic]:
    """A mission of many nodes with ports and without any model: an include may be missing, which no other rule
    reports."""
    if view.is_xml or not view.ask(is_first_tree, view.facts) or view.ask(has_names, Kind.MODEL):
        return
    names = view.ask(_nodes_with_ports) if view.ask(inputs.is_complete) and view.is_read else ()
    nodes = view.nodes
    if nodes and len(names) >= _MANY:
        shown = ", ".join(f"`{name}`" for name in names[:3])
        message = f"no models in scope, so btq cannot check the ports of {len(names)} nodes: {shown} …"
        notes = ("declare the nodes (`Action …` with its ports), or include the file that declares them",)
        yield Diagnostic("no-models", nodes[0].node.head.span, message, notes=notes)


def _nodes_with_ports(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """The custom nodes of the file that have ports."""
    view = View(store, viewpoint)
    by_tree = (view.ask(_nodes_with_ports_in, tree) for tree in view.ask(lookups.trees))
    return tuple(dict.fromkeys(name for names in by_tree for name in names))


def _nodes_with_ports_in(store: Store[Workspace], viewpoint: str, tree: Facts) -> tuple[str, ...]:
    nodes = View(store, viewpoint).seen_in(viewpoint, tree).all
    return tuple(dict.fromkeys(resolved.node.head.text for resolved in nodes if _gives_ports(resolved)))


def _gives_ports(resolved: ResolvedNode) -> bool:
    if resolved.kind is not None or resolved.is_subtree or resolved.id is None or resolved.is_placeholder:
        return False
    return any(is_port_name(pair.key.text) for pair in resolved.node.attributes)


def category_mismatch(view: View) -> Iterator[Diagnostic]:
    """`Condition MoveBase` where MoveBase is an action."""
    for resolved in view.seen.categorized:
        category = declared_category(resolved)
        written_as = resolved.node.category
        if written_as is None or category is None or category == written_as.raw:
            continue
        declarer = "the engine defines" if resolved.kind is not None else "its model declares"
        least, most = CHILDREN[category]
        fits = least <= len(resolved.node.children) and (most is None or len(resolved.node.children) <= most)
        safe = category != "SubTree" and (fits or resolved.kind is not None)
        fix = replace_fix(f"Replace it with `{category}`", written_as.span, category, safe=safe)
        message = f"{resolved.shown_kind} is written as {written_as.raw}, but {declarer} it as {category}"
        related = model_related(view, resolved, "the model")
        yield Diagnostic("category-mismatch", written_as.span, message, related=related, fixes=(fix,))


def clause_as_node(view: View) -> Iterator[Diagnostic]:
    """`keeps` in the block of a node is a node of that name."""
    nodes = view.seen
    for resolved, pair, value in nodes.values():
        word = pair.key.raw
        if word in ("satisfices", "satisfies") and not view.is_xml:
            message = f"btq reads `{word} =` as a port of {resolved.shown_kind} here"
            note = f"write `{word}` without `=`: `{word} {value.raw}`"
            fix = replace_fix("Remove `=`", Span(pair.key.end, value.start), " ")
            yield Diagnostic("clause-as-node", pair.key.span, message, notes=(note,), fixes=(fix,))
    for resolved in nodes.strangers:  # no built-in has such a name
        name = resolved.node.kind
        meant = misspelt_clause(resolved.node)
        if name is None or not (meant or _is_clause(resolved)):
            continue
        if view.is_torn(name.start, name.start):
            continue  # the parser has reported it already
        if meant:
            message = f"btq reads `{name.text}` as a node here; did you mean `{meant}`?"
            fix = replace_fix(f"Replace `{name.text}` with `{meant}`", name.span, meant)
            yield Diagnostic("clause-as-node", name.span, message, fixes=(fix,))
            continue
        message = f"btq reads `{name.text}` as a node here, although it starts a requirement clause"
        notes = ("indent the clause below its requirement, `satisfies QualityReq …` on a line of its own",)
        fix = replace_fix(f'Write "{name.text}" for a node of that name', name.span, quote(name.text))
        yield Diagnostic("clause-as-node", name.span, message, notes=notes, fixes=(fix,))


def duplicate_definition(view: View) -> Iterator[Diagnostic]:
    """A second signal, context, quality or hazard of one name, or a second model with another interface."""
    for first, second in view.clashes(*_DEFINED_ONCE):
        if not _is_same_model(first.symbol, second.symbol):
            both = Related(first.place, COUNTS), Related(second.place, SECOND)
            yield _second(second.symbol, view.head, both, "this file includes a second definition of")
    for symbol, other, counts in view.repeated(*_DEFINED_ONCE):
        if (
            _is_same_model(other.symbol, symbol)
            or _is_of_node(view, other, symbol)
            or view.store.ask(cpp_lookups.is_cpp, other.path)
        ):
            continue
        only_one = f"Nav2 registers a node `{symbol.name}`, and a program can register only one"
        differing = ", ".join(differences(other.symbol, symbol))
        unlike = (f"they differ in {differing}",) if differing else ()
        notes = (*unlike, *((only_one,) if other.is_of_nav2 else ()))
        related = (Related(other.place, COUNTS if counts else SECOND),)
        yield _second(symbol, symbol.span, related, "duplicate definition of", notes)


def declared_category(resolved: ResolvedNode) -> str | None:
    """A node's category by the engine or a model; what is written at the node does not matter."""
    if resolved.is_subtree:
        return None
    if resolved.kind is not None:
        return resolved.kind.category
    return resolved.of_model


def model_related(view: View, resolved: ResolvedNode, message: str) -> tuple[Related, ...]:
    """The place of a node's model, if it has one."""
    return (
        view.declared_at(Kind.MODEL, resolved.id.text, message)
        if resolved.is_defined and resolved.id is not None
        else ()
    )


def likely_category(resolved: ResolvedNode) -> str:
    """The category of a custom node, as written or else as its number of children suggests."""
    if resolved.stated_category is not None:
        return resolved.stated_category
    return ("Action", "Decorator", "Control")[min(len(resolved.node.children), 2)]


def way_in(view: View) -> tuple[str, ...]:
    """How to turn XML for version 3 into a file for version 4."""
    if not view.is_xml or not view.ask(is_for_version_3):
        return ()
    return ("`btq import` converts the file to .btq in the syntax of version 4",)


def _is_of(view: View, word: str) -> bool:
    """Whether the engine that the file is for still has an older engine's word, or the file is for an older one."""
    known_word = KNOWN_WORDS.get(word)
    if known_word is None or known_word.until is None:
        return False
    return at_least(last_of(known_word.until), view.target) or (
        is_before_4(view.target) and known_word.tag in view.ask(old_words)
    )


def _of_today(view: View, resolved: ResolvedNode, name: Word, known_word: KnownWord) -> tuple[Fix, ...]:
    """The fix that replaces an older engine's node by its successor."""
    if known_word.replacement is not None:
        # Without quotes the old word is read as the new one already, so only this diagnostic changes.
        title = f"Replace it with `{known_word.replacement}`"
        safe = not name.quoted and not _missing(known_word.replacement, view.engines)
        return (replace_fix(title, name.span, known_word.replacement, safe=safe),)
    if known_word.category == "SubTree" and resolved.node.category is None:
        return (replace_fix("Replace it with `SubTree`", name.span, "SubTree"),)
    return ()


def _as_precondition(view: View, resolved: ResolvedNode) -> tuple[str, ...]:
    """The note with the Precondition that does the same as a BlackboardCheck of version 3."""
    values = {pair.key.text: pair.value.text for pair in resolved.node.attributes if pair.value is not None}
    if not values.keys() >= {"value_A", "value_B"}:
        return ()
    is_text = resolved.id is not None and resolved.id.text.endswith("String")
    sides = [values[key] for key in ("value_A", "value_B")]
    left, right = (side[1:-1] if is_pointer(side) else f"'{side}'" if is_text else side for side in sides)
    script, otherwise = f"{left} == {right}", values.get("return_on_mismatch", "FAILURE")
    shown = f'Precondition (if = "{script}", else = "{otherwise}")'
    if view.is_xml:
        shown = f'<Precondition if="{script}" else="{otherwise}">'
    return (f"write `{shown}`",)


def _as_child_condition(view: View, resolved: ResolvedNode, tag: str) -> tuple[str, ...]:
    """The note with the ScriptCondition for the condition that an `If` or a `While` has as an attribute."""
    conditions = [pair.value for pair in resolved.node.attributes if pair.key.text.casefold() in _CONDITIONS]
    if BUILTINS[tag].flow != "choice" or not conditions or conditions[0] is None:
        return ()
    script = conditions[0].text.strip("{}")
    shown = f'<ScriptCondition code="{script}"/>' if view.is_xml else f'ScriptCondition (code = "{script}")'
    return (f"write `{shown}` as its first child",)


def _foreign(view: View, resolved: ResolvedNode) -> ForeignName | None:
    """What a node means to other engines, if it has children, or a label that may be meant as one, and nothing
    declares it."""
    name = resolved.id
    if name is None or resolved.node.category is not None or resolved.of_model is not None:
        return None
    if not (resolved.node.children or (has_bare_label(view, resolved.node) and not is_of_leaves(name.text))):
        return None
    foreign = foreign_name(name.text)
    if foreign is None or view.ask(lookups.is_defined, Kind.TREE, name.text) or view.is_pooled(Kind.MODEL, name.text):
        return None
    return foreign if view.ask(inputs.is_complete) and not view.project.hides_nodes else None


def _as_built_in(view: View, resolved: ResolvedNode, name: Word, foreign: ForeignName) -> Fix:
    """The fix that writes the built-in, in XML without what it requires: that needs an attribute more."""
    end = (resolved.node.label or name).end
    if foreign.attributes and not (resolved.node.attributes or view.is_xml):
        changes = (FixEdit(Place(name.span), foreign.tag), FixEdit(Place(Span(end, end)), f" ({foreign.attributes})"))
        return Fix(f"Replace it with `{foreign.tag} ({foreign.attributes})`", changes)
    return replace_fix(f"Replace `{name.text}` with `{foreign.tag}`", name.span, foreign.tag)


def _quoted_alias(resolved: ResolvedNode, name: Word) -> NodeKind | None:
    """The built-in that a word would mean without its quotes: `"Retry"` is not a tag of the engine."""
    return lookup(name.text) if name.quoted and resolved.kind is None else None


def _aliased(view: View, resolved: ResolvedNode, name: Word, message: str, meant: NodeKind) -> Diagnostic:
    """`<Retry>` in XML, and `"Retry"` in quotes: a word of this language that the engine does not know as a tag."""
    if not view.is_xml:
        note = f"a quoted kind is the XML tag, and the engine's tag is {meant.tag}"
        fix = replace_fix("Remove the quotes", name.span, name.text)
        return Diagnostic("not-an-engine-node", name.span, message, notes=(note,), fixes=(fix,))
    tag = meant.tag
    if meant.flow == "for-each" and not any(meant.port(pair.key.text) for pair in resolved.node.attributes):
        tag = next(kind.tag for kind in BUILTINS.values() if kind.flow == "repeat")  # `Loop` in other engines
    fix = replace_fix(f"Replace `{name.text}` with `{tag}`", name.span, tag)
    return Diagnostic("not-an-engine-node", name.span, f"{message}{did_you_mean((tag,))}", fixes=(fix,))


def _unknown(view: View, resolved: ResolvedNode, name: Word) -> Iterator[Diagnostic]:
    is_complete = view.ask(inputs.is_complete) and not view.project.hides_nodes
    are_in_cpp = is_complete and view.ask(cpp_lookups.registers_all)
    has_palette = are_in_cpp or (is_complete and view.ask(lookups.has_palette))
    if not has_palette and resolved.node.category is not None:
        return  # written as a declaration: `Action Foo` declares such a node
    likely = view.ask(near_names, Kind.MODEL, name.text)
    is_parent = False  # and nothing else is wrong with its name
    if not has_palette:
        likely = tuple(meant for meant in likely if _is_slip(name.text, meant))
        is_parent = not (is_complete and view.ask(lookups.most_have_models))
        if not likely and is_parent and not (is_complete and _has_own_children(view, resolved, name)):
            return
    begun = () if likely else _begun(view, resolved, name.text)
    likely = likely or begun
    if not likely and not view.is_first_use(resolved.node, name.text):
        return  # one model is missing, however many nodes would need it
    fixes = tuple(replace_fix(f"Replace `{name.text}` with `{meant}`", name.span, written(meant)) for meant in likely)
    notes: tuple[str, ...] = ()
    if not likely:
        category, ports, _ = view.ask(lookups.custom_node, name.text)
        fixes = (_declared(view, resolved, f"{category} {written(name.text)}", ports),)
        shortest = f"a line `{category} {written(name.text)}`"
        if view.is_xml:
            shortest = f'`<{category} ID="{name.text}"/>` in <TreeNodesModel>'
        others = "the other nodes of this file" if has_palette else "most nodes of this file"
        why = "it has children and is not built in" if is_parent else f"{others} have models"
        why = "no C++ of the factory registers it" if are_in_cpp else why
        notes = (f"{why}; to declare {'it' if is_parent else 'this one'}, write {shortest}",)
        if moved := dedent_fixes(view, resolved, resolved.node.children):
            notes, fixes = (*notes, TOO_FAR), fixes + moved
    severity = None if (likely and not begun) or has_palette else Severity.HINT
    if has_palette and view.factory is not None and view.factory.nodes:
        severity = Severity.ERROR  # the program registers what `nodes` names, and refuses to load any other
    message = f"unknown node `{name.text}`{did_you_mean(likely)}"
    yield Diagnostic("unknown-node", name.span, message, notes=notes, fixes=fixes, severity=severity)


def _begun(view: View, resolved: ResolvedNode, name: str) -> tuple[str, ...]:
    """The one node of Nav2 with children whose name begins with the words of another name: PipelineSequence for
    `Pipeline`."""
    distribution = view.ask(lookups.distribution)
    if distribution is None or not resolved.node.children:
        return ()
    longer = [other for other in view.ask(inputs.names, Kind.MODEL) if other.startswith(name) and other != name]
    models = [(other, view.ask(lookups.meaning, Kind.MODEL, other)) for other in longer if other[len(name)].isupper()]
    parents = [
        other
        for other, model in models
        if model is not None and isinstance(model.target, Model) and model.target.category.raw in _WITH_CHILDREN
    ]
    return tuple(parents) if len(parents) == 1 else ()


def _has_own_children(view: View, resolved: ResolvedNode, name: Word) -> bool:
    """Whether a node must be one of the program's own that has children: no known library has it."""
    if ports_of(name.text) is not None or view.entry.diagnostics:
        return False
    return bool(resolved.node.nodes) and not any(misspelt_clause(child) for child in resolved.node.nodes)


def _declared(view: View, resolved: ResolvedNode, model: str, ports: tuple[LikelyPort, ...]) -> Fix:
    """The fix that declares a node's model before an item, with the ports that its uses show."""
    margin = view.text[: view.item.start]
    below = view.text[: resolved.node.start + 1].splitlines()[1:]
    inside = next((line[: len(line) - len(line.lstrip())] for line in below if line.strip()), "")
    inside = inside if inside.startswith(margin) and inside != margin else f"{margin}    "
    lines = [f"{margin}{model}\n"]
    for port in ports:
        type_ = f" : {port.type}" if port.type else ""
        lines.append(f"{inside}{port.direction} {written(port.name)}{type_}\n")
    title = f"Declare it{' with its ports' if ports else ''}: `{model}`"
    return Fix(title, (FixEdit(Place(Span(0, 0)), "".join(lines)),))


def _category_meant(view: View, resolved: ResolvedNode) -> str | None:
    """`action Lower`, `Acton Lower`: the category that a word means, not written as one."""
    kind = resolved.node.kind
    if kind is None or kind.quoted or resolved.node.category is not None or resolved.node.label is None:
        return None
    meant = kind.raw.capitalize()
    if meant in CATEGORIES:
        return meant if meant != kind.raw else None
    if resolved.node.attributes or view.is_xml:  # a node with a label
        return None
    return next((word for word in sorted(CATEGORIES) if distance(kind.raw.lower(), word.lower(), 1) == 1), None)


def _is_slip(word: str, meant: str) -> bool:
    """Whether it must be a misspelling: `LoopPoint` is as good a name as LoopInt, `Pack` as Pick, and `Switch7` as
    Switch6."""
    is_builtin = lookup(meant) is not None
    word, meant = word.casefold(), meant.casefold()
    if without_digits(word) == without_digits(meant):
        return word == meant
    short_and_replaced = len(word) == len(meant) < 6 and sorted(word) != sorted(meant)
    most = 2 if len(word) >= 12 and is_builtin else 1
    return distance(word, meant) <= most and not short_and_replaced


def _tree_as_node(view: View, resolved: ResolvedNode, name: Word) -> Diagnostic:
    """`PickPlace` or `Action PickPlace` where PickPlace is a tree."""
    category = resolved.node.category
    span, text = (Span(name.start, name.start), "SubTree ") if category is None else (category.span, "SubTree")
    message = f"`{name.text}` is a tree, not a node"
    fixes = (
        replace_fix(f"Write `SubTree {written(name.text)}`", span, text, safe=_is_plain_call(view, resolved, name)),
    )
    related = view.declared_at(Kind.TREE, name.text, "tree definition")
    related = related or view.declared_at(Kind.MODEL, name.text, "its model")
    return Diagnostic("unknown-node", name.span, message, related=related, fixes=fixes, severity=Severity.ERROR)


def _bare_subtrees(view: View) -> Iterator[Diagnostic]:
    """`PickPlace` where only a model `SubTree PickPlace` declares it: version 3 runs the tree, version 4 refuses the
    node."""
    bare = [resolved for resolved in view.seen.subtrees if resolved.node.category is None]
    if bare and (not view.is_xml or view.ask(is_for_version_4)):
        for resolved in bare:
            if resolved.id is not None and not _is_own_tree(view, resolved.id):
                yield _tree_as_node(view, resolved, resolved.id)


def _is_own_tree(view: View, name: Word) -> bool:
    """Whether it is the name of the tree itself, which then is the mistake."""
    return view.tree_name is not None and view.tree_name.text == name.text


def _in_other_words(view: View, resolved: ResolvedNode, name: Word) -> str:
    """How a tree says what a word of programming languages does; empty if the node may be one of the program."""
    if name.quoted or resolved.node.category:
        return ""
    how = branch(name.text)
    if not how or not view.ask(inputs.is_complete) or view.project.hides_nodes:
        return statement(name.text)
    are_declared = view.ask(lookups.has_palette) or view.ask(lookups.most_have_models)
    return how if resolved.node.children or are_declared else ""


def _is_plain_call(view: View, resolved: ResolvedNode, name: Word) -> bool:
    """Whether a node of a tree's name is nothing but that tree, once `SubTree` is before it: it gives no ports and
    needs none, and no circle of trees begins."""
    node, tree = resolved.node, view.ask(inputs.definition, Kind.TREE, name.text)
    if node.category or node.label or node.attributes or node.clauses or node.children or view.tree_name is None:
        return False
    needs_ports = tree is None or not isinstance(tree[1].item, Tree) or bool(tree[1].item.ports)
    return not needs_ports and not view.ask(calls.runs, name.text, view.tree_name.text)


def _is_refused(view: View, resolved: ResolvedNode, name: Word) -> bool:
    """Whether another rule reports the name itself."""
    return resolved.node.category is None and model_name_problem(name.text, view.target) is not None


def _is_clause(resolved: ResolvedNode) -> bool:
    name = resolved.node.kind
    return (
        name is not None
        and not (name.quoted or resolved.node.category or resolved.node.children)
        and (name.text in VERB_WORDS or name.text in HEADS)
        and name.text != "visits"  # which is a clause only where nodes follow
    )


_DEFINED_ONCE = (Kind.MODEL, Kind.SIGNAL, Kind.CONTEXT, Kind.QUALITY, Kind.HAZARD)


def _second(
    symbol: Symbol, span: Span, related: tuple[Related, ...], what: str, notes: tuple[str, ...] = ()
) -> Diagnostic:
    # The engine never reads the model of a node, so only tools are affected.
    severity = Severity.WARNING if symbol.kind is Kind.MODEL else None
    message = f"{what} the {symbol.kind.value} `{symbol.name}`"
    return Diagnostic("duplicate-definition", span, message, related=related, notes=notes, severity=severity)


def _is_same_model(first: Symbol, second: Symbol) -> bool:
    """Whether two symbols are models that give a node the same interface."""
    one, other = first.target, second.target
    return isinstance(one, Model) and isinstance(other, Model) and interface(one) == interface(other)


def _is_of_node(view: View, other: Declaration, symbol: Symbol) -> bool:
    """Whether a symbol is the model of a node that a file of nodes declares with these ports and maybe more."""
    return has_ports_of(other.symbol, symbol) and other.path in view.ask(lookups.node_paths)


# What version 2 wrote below a SubTree.
OF_SUBTREE: Final = ("remap",)

# A file with so many nodes with ports should declare them.
_MANY: Final = 5
_WITH_CHILDREN: Final = ("Control", "Decorator")

# Words of version 3 that an import translates.
_TRANSLATED: Final = frozenset(("SequenceStar", "RetryUntilSuccesful", "SubTreePlus"))
_CONDITIONS: Final = frozenset(("condition", "cond", "if", "test", "expression", "expr", "when", "code"))
