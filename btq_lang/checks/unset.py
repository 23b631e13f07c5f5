"""Entries that are read, or assigned to, where nothing can have set them.

One invariant: a warning is certain but for what C++ does without a port; where the robot's program or a node without a
model may set an entry, there is a hint at most.  Found here is what is wrong in a tree; what happens to its entries in
other trees is known by flow.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.calls import callers, is_missed
from btq_lang.checks.entries import EntryMention, call_of, handling, mentions
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
from btq_lang.util.spelling import near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def unset_entry(view: View) -> Iterator[Diagnostic]:
    """What is wrong with the entries of a tree: unset-entry, uncreated-entry."""
    name = view.tree_name
    if name is None or not view.defines_here(Kind.TREE, name.text):
        return
    yield from _not_passed(view)
    named = view.ask(mentions, view.path, view.facts)
    found = _found(view, name.text, named, set())
    if not found or not view.ask(inputs.is_complete):
        return
    told = _told(view, named)
    yield from _found(view, name.text, named, told) if told else found


def _found(view: View, tree: str, named: Sequence[EntryMention], but: set[str]) -> list[Diagnostic]:
    """What is wrong with entries, except some."""
    return [*_uncreated(view, tree, named, but), *_unset(view, tree, named, but)]


def _told(view: View, named: Sequence[EntryMention]) -> set[str]:
    """The entries of which another rule tells what is wrong: they are misspelt, or in a script that is."""
    spans: list[Span] = []
    for each in chain(misspelt_entry(view), meant_entry(view)):
        spans += (each.span, *(related.place.span for related in each.related))
    wrong = [each.span for each in script_error(view)]
    spans += [pair.span for _, pair, _ in view.seen.values() if any(map(pair.span.contains, wrong))]
    return {each.name for each in named if any(span.touches(each.span) for span in spans)}


def _uncreated(view: View, tree: str, named: Sequence[EntryMention], but: set[str]) -> Iterator[Diagnostic]:
    """The first assignment to each entry that nothing creates."""
    created = {each.name for each in named if each.creates} | but
    for name, mention in _first([each for each in named if each.in_script and each.writes], created).items():
        use = view.ask(uses, tree, name)
        if use & (EntryUse.CREATED | EntryUse.GIVEN | EntryUse.OPEN):
            continue
        if use & EntryUse.OUTSIDE and next(each for each in named if each.name == name) is not mention:
            continue  # programs set what scripts read first
        of_program = view.ask(lookups.set_in_cpp)
        is_in_cpp = name.removeprefix("@") in of_program.names
        if is_in_cpp and use & EntryUse.OUTSIDE:
            continue
        is_seen = not use & EntryUse.STRANGE and not is_in_cpp and not of_program.has_unseen
        is_certain = is_seen and (not use & EntryUse.OUTSIDE or _is_known_root(view, tree))
        message = f"a script assigns to `{name}`, which nothing creates"
        creating, fixes = _creating(view, mention)
        notes = (f"the engine throws when it runs the script; {creating}",)
        severity = None if is_certain else Severity.HINT
        yield Diagnostic("uncreated-entry", mention.span, message, notes=notes, fixes=fixes, severity=severity)


def _creating(view: View, mention: EntryMention) -> tuple[str, tuple[Fix, ...]]:
    """How an entry is created that a script assigns to, and the fix if that is done with another sign."""
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
            at = script.text.index("=", target.end)
            fix = replace_fix("Write `:=`", in_source(value, Span(at, at + 1)), ":=")
            return f"write `{mention.name} := {assigned}`", (fix,)
    return f"create the entry before: `{mention.name} := …`", ()


def _unset(view: View, tree: str, named: Sequence[EntryMention], but: set[str]) -> Iterator[Diagnostic]:
    """The first reading of each entry that nothing writes."""
    outside: list[EntryMention] = []
    for name, mention in _first([each for each in named if _reads(each)], but).items():
        use = view.ask(uses, tree, name) if name.isidentifier() else EntryUse.OPEN
        if use & (EntryUse.GIVEN | EntryUse.OPEN):
            continue
        if use & EntryUse.WRITTEN:
            if not view.ask(callers, tree) and view.ask(_is_before_all, tree, name):
                outside.append(mention)
            continue
        if not use & EntryUse.READ:
            continue  # trees get it that do not read it
        writers = [seen for seen in view.seen.subtrees if seen.id and view.ask(writes_alone, tree, seen.id.text, name)]
        if writers:
            yield _lost(view, mention, writers, use)
        elif use & EntryUse.OUTSIDE:
            is_usual = mention.in_script and not view.ask(lookups.outside_entries)  # programs set what scripts read
            if not (use & EntryUse.STRANGE or is_usual or view.ask(_is_passed, tree, name)):
                outside.append(mention)
        elif not use & EntryUse.STRANGE and view.ask(_needs, tree, name):
            yield _not_given(view, tree, mention)
    of_program = view.ask(lookups.set_in_cpp).names
    outside = [each for each in outside if each.name not in of_program and view.ask(_needs, tree, each.name)]
    if outside and _is_known_root(view, tree):
        yield from _never_set(view, outside)


def _lost(view: View, mention: EntryMention, writers: Sequence[ResolvedNode], use: EntryUse) -> Diagnostic:
    """An entry that SubTrees write for themselves."""
    name, seen = mention.name, writers[0]
    assert seen.id is not None, "its tree is known"
    message = f"nothing writes `{name}`, which is read here: `{seen.id.text}` writes an entry of its own"
    related = (Related(Place(seen.node.head.span), f"does not pass on `{name}`"),)
    fixes = adding_fix(view, seen.node, f"Pass on `{name}`", f"{written(name)} = {{{name}}}")
    severity = Severity.HINT if use & EntryUse.STRANGE else None
    return Diagnostic("unset-entry", mention.span, message, related, fixes=fixes, severity=severity)


def _not_given(view: View, tree: str, mention: EntryMention) -> Diagnostic:
    """An entry of a tree that is run without it."""
    name = mention.name
    message = f"nothing in `{tree}` writes `{name}`, which is read here, and no SubTree passes it"
    return Diagnostic("unset-entry", mention.span, message, view.ask(_runs_without, tree, name))


def _runs_without(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> tuple[Related, ...]:
    """The first tree that runs one without an entry."""
    view = View(store, viewpoint)
    caller = next((caller for caller, call in calls_of(view, tree) if call.passed(name) is None), None)
    return view.declared_at(Kind.TREE, caller, f"runs `{tree}`") if caller is not None else ()


def _not_passed(view: View) -> Iterator[Diagnostic]:
    """An entry that a SubTree does not pass to its tree, which needs it and gets it from another one."""
    for seen in view.seen.subtrees:
        call = call_of(view, seen)
        if call is None or view.ask(is_missed, call.tree):
            continue
        for name in dict.fromkeys(touch.name for touch in view.ask(handling, call.tree).touches):
            is_passed = call.passed(name) is not None or name in call.values or name[:1] == "@"
            if is_passed or near(name, [*call.given, *call.values]) or not view.ask(_is_expected, call.tree, name):
                continue
            if not view.ask(inputs.is_complete):
                return
            message = f"`{call.tree}` reads `{name}`, which this SubTree does not pass to it, and another one does"
            related = view.ask(_passing, call.tree, name)
            yield Diagnostic("unset-entry", seen.node.head.span, message, related)


def _is_expected(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a tree needs an entry that only those can give it that run it, and one of them does."""
    view = View(store, viewpoint)
    use = view.ask(below, tree).of(name)
    if not name.isidentifier() or use & (EntryUse.WRITTEN | EntryUse.OPEN | EntryUse.STRANGE):
        return False
    if port_named(declared_ports(view, tree), name) is not None or name in view.ask(lookups.set_in_cpp).names:
        return False
    return bool(view.ask(_passing, tree, name)) and view.ask(_needs, tree, name)


def _passing(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> tuple[Related, ...]:
    """The first tree that gives an entry to one that it runs."""
    view = View(store, viewpoint)
    calls = calls_of(view, tree)
    caller = next((caller for caller, call in calls if name in call.given or name in call.values), None)
    return view.declared_at(Kind.TREE, caller, f"passes `{name}` to `{tree}`") if caller is not None else ()


def _never_set(view: View, named: Sequence[EntryMention]) -> Iterator[Diagnostic]:
    """Entries of the root blackboard: a warning each if it is known what the program sets; else a hint for all."""
    if view.ask(lookups.outside_entries):
        for each in named:
            message = f"nothing writes `{each.name}` before it is read here, and bt_navigator does not set it"
            yield Diagnostic("unset-entry", each.span, message)
        return
    names = ", ".join(f"`{each.name}`" for each in named[:_MOST]) + (" …" if len(named) > _MOST else "")
    them = "it is" if len(named) == 1 else "they are"
    message = f"nothing here writes {names} before {them} read"
    notes = (
        "ignore this where the robot's program sets the entry"
        if len(named) == 1
        else "ignore this for those that the robot's program sets",
        *_not_written(view, named),
    )
    related = tuple([Related(Place(each.span), f"`{each.name}`") for each in named[1:_MOST]])
    yield Diagnostic("unset-entry", named[0].span, message, related, notes, severity=Severity.HINT)


def _not_written(view: View, named: Sequence[EntryMention]) -> Iterator[str]:
    """What in the tree was probably meant to write the entries: one with a similar name, or an input."""
    of_tree = view.ask(mentions, view.path, view.facts)
    read = {each.name for each in of_tree if each.reads or each.node.is_subtree}
    written_only = [each.name for each in of_tree if each.writes and each.name not in read]
    for each in named:
        if likely := near(each.name, written_only, 1):
            yield f"did you mean `{likely[0]}`, which a node writes?"
        elif (
            not each.in_script and each.node.of_model is not None and sum(each.name == one.name for one in of_tree) > 1
        ):
            port = next(pair.key.text for pair in each.node.node.attributes if pair.span.contains(each.span))
            yield f"if `{each.node.node.head.text}` writes `{each.name}`, its model declares `{port}` as an output"


def _reads(mention: EntryMention) -> bool:
    """Whether a mention only reads an entry, or passes it on to a tree that may."""
    return (mention.reads and not mention.writes) or mention.node.is_subtree


@on_circle(False)
def _needs(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a node in a tree, or in those that get the entry from it, cannot do without its value."""
    view = View(store, viewpoint)
    found = view.ask(inputs.definition, Kind.TREE, tree)
    named = view.ask(mentions, *found) if found is not None else ()
    if any(each.name == name and not each.node.is_subtree and _is_needed(view, each) for each in named):
        return True
    calls = view.ask(handling, tree).calls
    below = {(call.tree, port) for call in calls for port, passed in call.given.items() if passed == name}
    below |= {(call.tree, name) for call in calls if call.passed(name) == name}
    return any(view.ask(_needs, *each) for each in sorted(below))


def _is_needed(view: View, mention: EntryMention) -> bool:
    """Whether a node cannot do without the value of an entry."""
    if mention.in_script or mention.node.kind is not None:
        return True
    pairs = [pair for pair in mention.node.node.attributes if pair.value is not None and is_pointer(pair.value.text)]
    ports = [
        port_of(view, mention.node, pair.key.text)
        for pair in pairs
        if pair.span.start <= mention.span.start < pair.span.end
    ]
    return any(port is not None and port.required for port in ports)


def _first(named: Sequence[EntryMention], but: set[str]) -> dict[str, EntryMention]:
    """The first mention of each name."""
    found: dict[str, EntryMention] = {}
    for each in named:
        if each.name not in but:
            found.setdefault(each.name, each)
    return found


def _is_before_all(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a tree reads an entry of the root blackboard before it writes it: at an earlier child of one Sequence."""
    view = View(store, viewpoint)
    found = view.ask(inputs.definition, Kind.TREE, tree)
    if found is None or view.ask(of_program, name) & EntryUse.WRITTEN:
        return False
    named = [each for each in view.ask(mentions, *found) if each.name == name]
    own = view.ask(handling, tree)
    if any(call.passed(name) is not None or name in call.given.values() for call in own.calls) or name in own.named:
        return False
    first, others = named[0], [each for each in named if each.writes]
    is_read_first = first.reads and not first.writes and bool(others)
    return is_read_first and all(_is_earlier(first.node, each.node) for each in others)


def _is_earlier(seen: ResolvedNode, other: ResolvedNode) -> bool:
    """Whether one node ends before another begins, whenever both run: no node above them begins again."""
    above = [*_above(other)]
    shared = [each for each in _above(seen) if each in above]
    return (
        seen is not other
        and bool(shared)
        and shared[0].flow == "sequence"
        and all(each.flow in ("sequence", "fallback") for each in shared)
        and seen not in above
        and other not in _above(seen)
    )


def _above(seen: ResolvedNode) -> Iterator[ResolvedNode]:
    while seen.parent is not None:
        seen = seen.parent
        yield seen


def _is_known_root(view: View, tree: str) -> bool:
    """Whether the root blackboard is that of a main tree, which runs a tree: no file that is not in scope runs it and
    gives it entries."""
    mains = view.ask(lookups.main_trees) or ((view.main_tree,) if view.main_tree is not None else ())
    if not mains or view.ask(is_missed, tree):
        return False
    is_alone = not view.ask(inputs.is_included) and not any(
        view.ask(lookups.is_run_elsewhere, each) for each in (*mains, tree)
    )
    return view.factory is not None or is_alone


@on_circle(True)
def _is_passed(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a tree above names the entry that it passes down, and so is where its fault is found."""
    for caller, call in calls_of(View(store, viewpoint), tree):
        if name in call.given or store.ask(_is_passed, viewpoint, caller, name):
            return True
        if any(each.name == name for each in store.ask(handling, viewpoint, caller).touches):
            return True
    return False


_MOST = 5
