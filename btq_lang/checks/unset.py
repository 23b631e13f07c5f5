"""Entries that are read, or assigned to, where nothing can have set them.

One invariant: a warning is certain, except for what C++ does without a port.  If the robot's program or a node without
a model may set an entry, there is a hint at most.  This module looks at one tree; flow.py says what happens to its
entries in other trees.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain

from btq_lang.catalog.kinds import PortKind
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import cpp_lookups, lookups
from btq_lang.checks.calls import callers, has_gaps, is_missed
from btq_lang.checks.entries import EntryMention, call_of, handling
from btq_lang.checks.entries import mentions as mentions_in
from btq_lang.checks.flow import EntryUse, below, calls_of, of_program, uses, writes_alone
from btq_lang.checks.meant_entries import meant_entry
from btq_lang.checks.misspelt import misspelt_entry
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.scripts import script_error
from btq_lang.checks.strings import in_source
from btq_lang.checks.view import View, declared_ports, port_of
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import port_named, written
from btq_lang.util.grouping import grouped
from btq_lang.util.spelling import near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def unset_entry(view: View) -> Iterator[Diagnostic]:
    """The problems with the entries of a tree: unset-entry, uncreated-entry."""
    name = view.tree_name
    if name is None or not view.defines_here(Kind.TREE, name.text):
        return
    yield from _not_passed(view)
    mentions = view.ask(mentions_in, view.path, view.facts)
    diagnostics = _diagnostics(view, name.text, mentions, set())
    if not diagnostics or not view.ask(inputs.is_complete):
        return
    reported = _reported_otherwise(view, mentions)
    yield from _diagnostics(view, name.text, mentions, reported) if reported else diagnostics


def _diagnostics(view: View, tree: str, mentions: Sequence[EntryMention], excluded: set[str]) -> list[Diagnostic]:
    return [*_uncreated(view, tree, mentions, excluded), *_unset(view, tree, mentions, excluded)]


def _reported_otherwise(view: View, mentions: Sequence[EntryMention]) -> set[str]:
    """The entries that another rule reports: they are misspelt, or in a script with an error."""
    spans: list[Span] = []
    for diagnostic in chain(misspelt_entry(view), meant_entry(view)):
        spans += (diagnostic.span, *(related.place.span for related in diagnostic.related))
    wrong = [problem.span for problem in script_error(view)]
    spans += [pair.span for _, pair, _ in view.seen.values() if any(map(pair.span.contains, wrong))]
    return {mention.name for mention in mentions if any(span.touches(mention.span) for span in spans)}


def _uncreated(view: View, tree: str, mentions: Sequence[EntryMention], excluded: set[str]) -> Iterator[Diagnostic]:
    """The first assignment to each entry that nothing creates."""
    by_name = grouped((mention.name, mention) for mention in mentions)
    later = {
        name
        for name, of_name in by_name.items()
        if _are_created_late(of_name) and view.ask(_is_of_tree_alone, tree, name)
    }
    created = ({mention.name for mention in mentions if mention.creates} - later) | excluded
    writing = [mention for mention in mentions if mention.in_script and mention.writes]
    for name, mention in _first_mentions(writing, created).items():
        use = view.ask(uses, tree, name)
        is_created = name not in later and use & EntryUse.CREATED
        if is_created or use & (EntryUse.GIVEN | EntryUse.OPEN):
            continue
        if use & EntryUse.OUTSIDE and by_name[name][0] is not mention:
            continue  # programs set what scripts read first
        set_in_cpp = view.ask(cpp_lookups.set_in_cpp)
        is_in_cpp = name.removeprefix("@") in set_in_cpp.names
        if is_in_cpp and use & EntryUse.OUTSIDE:
            continue
        is_seen = not use & EntryUse.STRANGE and not is_in_cpp and not set_in_cpp.has_unseen
        is_certain = is_seen and (not use & EntryUse.OUTSIDE or _is_known_root(view, tree))
        message = f"a script assigns to `{name}`, which nothing creates{' before' * (name in later)}"
        creating, fixes = _creating(view, mention)
        notes = (f"the engine throws when it runs the script; {creating}",)
        severity = None if is_certain else Severity.HINT
        yield Diagnostic("uncreated-entry", mention.span, message, notes=notes, fixes=fixes, severity=severity)


def _are_created_late(mentions: Sequence[EntryMention]) -> bool:
    """Whether a script assigns to an entry before the scripts that create it run, and no port does when the engine
    creates the tree; given all mentions of the entry in a tree."""
    first, creating = mentions[0], [mention for mention in mentions if mention.creates]
    return (
        bool(creating)
        and first.writes
        and first.name.isidentifier()
        and all(mention.in_script for mention in mentions)
        and all(_runs_first(first.node, mention.node) for mention in creating)
    )


def _creating(view: View, mention: EntryMention) -> tuple[str, tuple[Fix, ...]]:
    """The note on how to create the entry that a script assigns to, and the fix if another sign does it."""
    from btq_lang.syntax.script.tree import Assign  # few scripts assign to what nothing creates

    pairs = [pair for pair in mention.node.node.attributes if pair.span.contains(mention.span)]
    for value in [pair.value for pair in pairs if pair.value is not None]:
        script = view.script(value.text)
        for statement in script.statements:
            if not isinstance(statement, Assign) or statement.operator != "=":
                continue
            target, assigned = statement.target, script.text[statement.value.start : statement.value.end]
            if in_source(value, Span(target.start, target.end)) != mention.span:
                continue
            offset = script.text.index("=", target.end)
            fix = replace_fix("Write `:=`", in_source(value, Span(offset, offset + 1)), ":=")
            return f"write `{mention.name} := {assigned}`", (fix,)
    return f"create the entry before: `{mention.name} := …`", ()


def _unset(view: View, tree: str, mentions: Sequence[EntryMention], excluded: set[str]) -> Iterator[Diagnostic]:
    """The first reading of each entry that nothing writes."""
    outside: list[EntryMention] = []
    for name, mention in _first_mentions([mention for mention in mentions if _reads(mention)], excluded).items():
        use = view.ask(uses, tree, name) if name.isidentifier() else EntryUse.OPEN
        if use & (EntryUse.GIVEN | EntryUse.OPEN):
            continue
        if use & EntryUse.WRITTEN:
            if not view.ask(callers, tree) and view.ask(_is_before_all, tree, name):
                outside.append(mention)
            elif not use & (EntryUse.OUTSIDE | EntryUse.STRANGE) and _is_too_early(view, tree, mention):
                yield _too_early(mention, mentions)
            continue
        if not use & EntryUse.READ:
            continue  # trees get it that do not read it
        writers = [
            resolved
            for resolved in view.seen.subtrees
            if resolved.id and view.ask(writes_alone, tree, resolved.id.text, name)
        ]
        if writers:
            yield _lost(view, mention, writers, use)
        elif use & EntryUse.OUTSIDE:
            is_usual = mention.in_script and not view.ask(lookups.is_of_navigator)  # programs set what scripts read
            if not (use & EntryUse.STRANGE or is_usual or view.ask(_is_passed, tree, name)):
                outside.append(mention)
        elif not use & EntryUse.STRANGE and (need := view.ask(_need, tree, name)):
            yield _not_given(view, tree, mention, need)
    set_in_cpp = view.ask(cpp_lookups.set_in_cpp).names
    outside = [
        mention for mention in outside if mention.name not in set_in_cpp and view.ask(_needs, tree, mention.name)
    ]
    if outside and _is_known_root(view, tree):
        yield from _never_set(view, outside)


def _lost(view: View, mention: EntryMention, writers: Sequence[ResolvedNode], use: EntryUse) -> Diagnostic:
    """An entry that SubTrees write for themselves."""
    name, resolved = mention.name, writers[0]
    assert resolved.id is not None, "its tree is known"
    message = f"nothing writes `{name}`, which is read here: `{resolved.id.text}` writes an entry of its own"
    related = (Related(Place(resolved.node.head.span), f"does not pass on `{name}`"),)
    fixes = adding_fix(view, resolved.node, f"Pass on `{name}`", f"{written(name)} = {{{name}}}")
    severity = Severity.HINT if use & EntryUse.STRANGE else None
    return Diagnostic("unset-entry", mention.span, message, related, fixes=fixes, severity=severity)


def _is_too_early(view: View, tree: str, mention: EntryMention) -> bool:
    """Whether a node surely reads an entry of its tree alone before the tree writes it."""
    name = mention.name
    if mention.in_script or not _is_needed(view, mention) or not view.ask(_is_before_all, tree, name):
        return False
    of_tree = [each for each in view.ask(mentions_in, view.path, view.facts) if each.name == name]
    return all(_runs_first(mention.node, each.node) for each in of_tree if each.writes)


def _too_early(mention: EntryMention, named: Sequence[EntryMention]) -> Diagnostic:
    """An entry that is written only after it is read."""
    message = f"nothing writes `{mention.name}` before it is read here"
    writer = next(each for each in named if each.name == mention.name and each.writes)
    related = (Related(Place(writer.node.node.head.span), "writes it, but runs later"),)
    return Diagnostic("unset-entry", mention.span, message, related)


def _not_given(view: View, tree: str, mention: EntryMention, need: str) -> Diagnostic:
    """An entry of a tree that is run without it; need: as `_need` says."""
    name = mention.name
    message = f"nothing in `{tree}` writes `{name}`, which is read here, and no SubTree passes it"
    related = view.ask(_runs_without, tree, name)
    return Diagnostic("unset-entry", mention.span, message, related, severity=_SEVERITIES[need])


def _runs_without(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> tuple[Related, ...]:
    """The first SubTree that runs a tree without an entry, with what to write there."""
    view = View(store, viewpoint)
    for caller in view.ask(callers, tree):
        for resolved in view.nodes_of(caller).subtrees:
            call = call_of(view, resolved)
            if call is not None and call.tree == tree and call.passed(name) is None:
                value = f'{name}="{{…}}"' if view.is_xml else f"{written(name)} = {{…}}"
                return (Related(resolved.place, f"write `{value}` at this SubTree"),)
    return ()


def _not_passed(view: View) -> Iterator[Diagnostic]:
    """An entry that a SubTree does not pass to its tree, which needs it and gets it from another one."""
    for resolved in view.seen.subtrees:
        call = call_of(view, resolved)
        if call is None or view.ask(is_missed, call.tree):
            continue
        for name in dict.fromkeys(touch.name for touch in view.ask(handling, call.tree).touches):
            is_passed = call.passed(name) is not None or name in call.values or name[:1] == "@"
            if is_passed or near(name, [*call.given, *call.values]):
                continue
            if not (need := view.ask(_expected, call.tree, name)):
                continue
            if not view.ask(inputs.is_complete):
                return
            message = f"`{call.tree}` reads `{name}`, which this SubTree does not pass to it, and another one does"
            related = view.ask(_passing, call.tree, name)
            severity = _SEVERITIES[need]
            yield Diagnostic("unset-entry", resolved.node.head.span, message, related, severity=severity)


def _expected(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> str:
    """As `_need`, for an entry that only the trees that run this one can give it, if one of them does."""
    view = View(store, viewpoint)
    use = view.ask(below, tree).use_of(name)
    if not name.isidentifier() or use & (EntryUse.WRITTEN | EntryUse.OPEN | EntryUse.STRANGE):
        return ""
    if port_named(declared_ports(view, tree), name) is not None or name in view.ask(cpp_lookups.set_in_cpp).names:
        return ""
    return view.ask(_need, tree, name) if view.ask(_passing, tree, name) else ""


def _passing(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> tuple[Related, ...]:
    """The first tree that gives an entry to one that it runs."""
    view = View(store, viewpoint)
    calls = calls_of(view, tree)
    caller = next(
        (
            caller
            for caller, call in calls
            if name in call.given or name in call.values or (call.shares and view.ask(_has_entry, caller, name))
        ),
        None,
    )
    return view.declared_at(Kind.TREE, caller, f"passes `{name}` to `{tree}`") if caller is not None else ()


def _has_entry(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether an entry is a port of a tree, or a node of it writes it."""
    handled = store.ask(handling, viewpoint, tree)
    return name in handled.ports or any(touch.name == name and touch.writes for touch in handled.touches)


def _never_set(view: View, mentions: Sequence[EntryMention]) -> Iterator[Diagnostic]:
    """The diagnostics for entries of the root blackboard: a warning for each if the entries that the program sets are
    known; else one hint for all."""
    if view.ask(lookups.is_of_navigator):
        for mention in mentions:
            message = f"nothing writes `{mention.name}` before it is read here, and bt_navigator does not set it"
            yield Diagnostic("unset-entry", mention.span, message)
        return
    names = ", ".join(f"`{mention.name}`" for mention in mentions[:_MOST]) + (" …" if len(mentions) > _MOST else "")
    they_are = "it is" if len(mentions) == 1 else "they are"
    message = f"nothing here writes {names} before {they_are} read"
    notes = (
        "ignore this where the robot's program sets the entry"
        if len(mentions) == 1
        else "ignore this for those that the robot's program sets",
        *_not_written(view, mentions),
    )
    related = tuple([Related(Place(mention.span), f"`{mention.name}`") for mention in mentions[1:_MOST]])
    yield Diagnostic("unset-entry", mentions[0].span, message, related, notes, severity=Severity.HINT)


def _not_written(view: View, mentions: Sequence[EntryMention]) -> Iterator[str]:
    """The notes about what in the tree was meant to write the entries: a similar name, or an input."""
    of_tree = view.ask(mentions_in, view.path, view.facts)
    read = {mention.name for mention in of_tree if mention.reads or mention.node.is_subtree}
    written_only = [mention.name for mention in of_tree if mention.writes and mention.name not in read]
    counts = Counter(mention.name for mention in of_tree)
    for mention in mentions:
        if likely := near(mention.name, written_only, 1):
            yield f"did you mean `{likely[0]}`, which a node writes?"
        elif not mention.in_script and mention.node.of_model is not None and counts[mention.name] > 1:
            node = mention.node.node
            port = next(pair.key.text for pair in node.attributes if pair.span.contains(mention.span))
            yield f"if `{node.head.text}` writes `{mention.name}`, its model declares `{port}` as an output"


def _reads(mention: EntryMention) -> bool:
    """Whether a mention only reads an entry, or passes it on to a tree that may."""
    return (mention.reads and not mention.writes) or mention.node.is_subtree


@on_circle(False)
def _needs(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a node in a tree, or in the trees that get the entry from it, needs its value."""
    view = View(store, viewpoint)
    mentions = view.ask(_mentions_by_name, tree).get(name, ())
    if any(not mention.node.is_subtree and _is_needed(view, mention) for mention in mentions):
        return True
    return any(view.ask(_needs, *entry) for entry in _given_below(view, tree, name))


@on_circle("")
def _need(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> str:
    """As `_needs`, also of ports with defaults: the engine uses none where the XML names an entry.

    Returns: empty if it is not needed, `_LIKELY` if C++ is not seen to fail without it, else `_CERTAIN`.
    """
    view = View(store, viewpoint)
    if view.ask(_needs, tree, name):
        return _CERTAIN
    mentions = view.ask(_mentions_by_name, tree).get(name, ())
    needs = {_need_with_default(view, mention) for mention in mentions if not mention.node.is_subtree}
    needs.update(view.ask(_need, *entry) for entry in _given_below(view, tree, name))
    return max(needs, key=("", _LIKELY, _CERTAIN).index, default="")


def _need_with_default(view: View, mention: EntryMention) -> str:
    """The need of a custom node whose input has a default, as `_need` says."""
    resolved = mention.node
    if resolved.behavior is not None or resolved.id is None:
        return ""
    needs = {""}
    for port in _ports_of(view, mention):
        if port is not None and port.direction == "input" and port.default:
            without = view.ask(cpp_lookups.without, Kind.MODEL, resolved.id.text)
            is_certain = without is None or dict(without).get(port.name) == "fails"
            needs.add(_CERTAIN if is_certain else _LIKELY)
    return max(needs, key=("", _LIKELY, _CERTAIN).index)


def _given_below(view: View, tree: str, name: str) -> list[tuple[str, str]]:
    """The trees that get an entry from a tree, each with its name there."""
    calls = view.ask(handling, tree).calls
    below = {(call.tree, port) for call in calls for port, passed in call.given.items() if passed == name}
    below |= {(call.tree, name) for call in calls if call.passed(name) == name}
    return sorted(below)


def _mentions_by_name(store: Store[Workspace], viewpoint: str, tree: str) -> dict[str, list[EntryMention]]:
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    mentions = view.ask(mentions_in, *definition) if definition is not None else ()
    return grouped((mention.name, mention) for mention in mentions)


def _is_needed(view: View, mention: EntryMention) -> bool:
    """Whether the node of a mention needs the value of the entry."""
    if mention.in_script or mention.node.kind is not None:
        return True
    return any(port is not None and port.required for port in _ports_of(view, mention))


def _ports_of(view: View, mention: EntryMention) -> list[PortKind | None]:
    """The ports of a custom node that are given the entry of a mention; None for one that nothing declares."""
    pairs = [pair for pair in mention.node.node.attributes if pair.value is not None and is_pointer(pair.value.text)]
    return [
        port_of(view, mention.node, pair.key.text)
        for pair in pairs
        if pair.span.start <= mention.span.start < pair.span.end
    ]


def _first_mentions(mentions: Sequence[EntryMention], excluded: set[str]) -> dict[str, EntryMention]:
    """The first mention of each name."""
    by_name: dict[str, EntryMention] = {}
    for mention in mentions:
        if mention.name not in excluded:
            by_name.setdefault(mention.name, mention)
    return by_name


def _is_before_all(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a tree reads an entry of the root blackboard before it writes it: at an earlier child of one Sequence."""
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    if definition is None or not view.ask(_is_of_tree_alone, tree, name):
        return False
    mentions = [mention for mention in view.ask(mentions_in, *definition) if mention.name == name]
    first, writers = mentions[0], [mention for mention in mentions if mention.writes]
    is_read_first = first.reads and not first.writes and bool(writers)
    return is_read_first and all(_is_earlier(first.node, mention.node) for mention in writers)


def _is_of_tree_alone(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether no other tree gets an entry from a tree or gives it to it, nor the program."""
    view = View(store, viewpoint)
    handled = view.ask(handling, tree)
    if view.ask(of_program, name) & EntryUse.WRITTEN or name in handled.named:
        return False
    if any(call.passed(name) is not None or name in call.given.values() for call in handled.calls):
        return False
    return not any(call.passed(name) is not None or name in call.values for _, call in calls_of(view, tree))


def _is_earlier(resolved: ResolvedNode, other: ResolvedNode) -> bool:
    """Whether one node ends before another begins, whenever both run: no node above them begins again."""
    above = [*other.ancestors()]
    shared = [ancestor for ancestor in resolved.ancestors() if ancestor in above]
    return (
        resolved is not other
        and bool(shared)
        and shared[0].flow == "sequence"
        and all(ancestor.flow in ("sequence", "fallback") for ancestor in shared)
        and resolved not in above
        and other not in resolved.ancestors()
    )


def _runs_first(resolved: ResolvedNode, other: ResolvedNode) -> bool:
    """Whether one node has run whenever another begins: it is below nothing but Sequences, and nothing skips it."""
    if not _is_earlier(resolved, other):
        return False
    above = [*other.ancestors()]
    own = (resolved, *(each for each in resolved.ancestors() if each not in above))
    is_skipped = any(pair.key.text[:1] == "_" for each in own for pair in each.node.attributes)
    return not is_skipped and all(each.flow == "sequence" for each in own[1:])


def _is_known_root(view: View, tree: str) -> bool:
    """Whether a known main tree has the root blackboard and runs a tree: no file out of scope runs that tree and gives
    it entries."""
    mains = view.ask(lookups.main_trees) or ((view.main_tree,) if view.main_tree is not None else ())
    if not mains or view.ask(is_missed, tree):
        return False
    if tree not in mains and not view.ask(callers, tree) and view.ask(has_gaps):
        return False  # the SubTree that names no known tree may mean this one
    is_alone = not view.ask(inputs.is_included) and not any(
        view.ask(lookups.is_run_elsewhere, other) for other in (*mains, tree)
    )
    return view.factory is not None or is_alone


@on_circle(True)
def _is_passed(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a tree above names the entry that it passes down; a mistake is then reported there."""
    for caller, call in calls_of(View(store, viewpoint), tree):
        if name in call.given or store.ask(_is_passed, viewpoint, caller, name):
            return True
        if any(touch.name == name for touch in store.ask(handling, viewpoint, caller).touches):
            return True
    return False


_MOST = 5
_LIKELY, _CERTAIN = "likely", "certain"
_SEVERITIES = {_LIKELY: Severity.HINT, _CERTAIN: None}
