"""Trees that nodes of Nav2 name for the goals that they send, values that a node never reads or looks for, and outputs
that nothing reads.

Sources: the tables of `catalog/nav2`; for the trees of goals, `Factory.goals`.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.literals import check_literal, is_pointer
from btq_lang.catalog.nav2 import TREE_OF_GOAL, ports_of
from btq_lang.catalog.versions import is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.entries import blackboards
from btq_lang.checks.entries import mentions as mentions_in
from btq_lang.checks.nav2_nodes import of_distribution, of_nav2
from btq_lang.checks.pointers import passed_on, pointed_at
from btq_lang.checks.view import View, declared_ports, port_names, ports_beside
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Pair, Word, port_named
from btq_lang.util.record import replace
from btq_lang.util.spelling import distance
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def default_instead(view: View) -> Iterator[Diagnostic]:
    """A value that a node replaces by its default: an entry that it reads before anything can have written it, and a
    number that its code refuses though the port's type does not."""
    distribution = view.ask(lookups.distribution)
    if distribution is None:
        return
    from btq_lang.catalog.nav2.creation import is_read_once  # only for Nav2

    for resolved, name, tree in of_nav2(view, distribution, view.seen.given):
        ports = port_names(view, resolved)
        for pair in resolved.node.attributes:
            port, value = pair.key.text, pair.value
            key = pointed_at(port, value.text) if value is not None else None
            if value is None:
                continue
            if key is not None and is_read_once(distribution, name, port, ports):
                if not view.ask(_is_set_before, tree, key):
                    what = f"is read only when the tree is created, when nothing has written `{key}`"
                    yield _default(view, resolved, pair, value, what)
            elif _is_refused(view, resolved, pair, value):
                yield _default(
                    view, resolved, pair, value, f"must not be negative: the node cannot read `{value.text}`"
                )


def error_code_not_collected(view: View) -> Iterator[Diagnostic]:
    """An error code in an entry that no node reads and that the result of a goal does not have."""
    distribution = view.ask(lookups.distribution)
    if distribution is None:
        return
    from btq_lang.catalog.nav2.navigator import COLLECTED, COLLECTING, OF_BRINGUP  # only for Nav2

    usual = OF_BRINGUP if view.factory is None or not view.factory.entries else ()
    for resolved, _, tree in of_nav2(view, distribution, view.seen.given):
        for pair in resolved.node.attributes:
            if pair.key.text not in COLLECTED or pair.value is None:
                continue
            name = pointed_at(pair.key.text, pair.value.text)
            if name is None or name in usual or view.ask(_is_read, tree, name):
                continue
            if any(distance(name, entry, 1) < 2 for entry, _ in view.ask(lookups.outside_entries)):
                continue  # it is misspelt, which is reported
            message = f"nothing reads `{name}`, and the result of a goal does not have it"
            note = f"bt_navigator puts into the result what its parameter `{COLLECTING[distribution[0]]}` names"
            yield Diagnostic("error-code-not-collected", pair.value.span, message, notes=(note,))


def foreign_error_code(view: View) -> Iterator[Diagnostic]:
    """A condition that looks for the error codes of other actions than those that write its entry."""
    distribution = view.ask(lookups.distribution)
    if distribution is None:
        return
    from btq_lang.catalog.nav2.navigator import HELPED  # only for Nav2

    for resolved, node, tree in of_nav2(view, distribution, view.seen.given):
        value = resolved.node.attribute("error_code") if node in HELPED else None
        name = pointed_at("error_code", value.text) if value is not None else None
        if value is None or name is None:
            continue
        actions = _actions_with_codes_in(view, distribution, tree, name)
        if actions and not actions.intersection(HELPED[node]):
            written_by, looked_for = (
                " and ".join(f"`{action}`" for action in names) for names in (sorted(actions), HELPED[node])
            )
            message = (
                f"{resolved.shown_kind} never succeeds: it looks for codes of {looked_for}, "
                f"and `{name}` has those of {written_by}"
            )
            notes = [f"`{other}` looks for these" for other, helped in HELPED.items() if actions.intersection(helped)]
            yield Diagnostic("foreign-error-code", value.span, message, notes=tuple(notes))


def tree_of_goal(view: View) -> Iterator[Diagnostic]:
    """A tree that bt_navigator does not find, or skips or refuses."""
    goals = view.factory.goals if view.factory is not None else ()
    for resolved, pair, value in view.seen.values() if goals else ():
        if (
            pair.key.text == TREE_OF_GOAL
            and resolved.id is not None
            and TREE_OF_GOAL in (ports_of(resolved.id.text) or ())
        ):
            yield from (replace(diagnostic, span=value.span) for name, diagnostic in goals if name == value.text)


def _actions_with_codes_in(view: View, distribution: str, tree: str, name: str) -> set[str]:
    """The actions whose error codes an entry has; empty if anything else may write it, or a node of another tree."""
    boards = view.ask(blackboards)
    mentions = [
        mention for mention in view.ask(mentions_in, view.path, view.facts) if boards.is_one(tree, mention.name, name)
    ]
    writers = [mention.node for mention in mentions if mention.writes]
    # Before the next goal bt_navigator sets those that it collects to 0.
    resets = [entry for entry, way in view.ask(lookups.outside_entries) if way != "input" and entry == name]
    writes = sum(touch.writes for touch in boards.uses_of(tree, name))
    if boards.is_given(tree, name) or writes > len(writers) + len(resets):
        return set()
    ids = [
        of_distribution(view, resolved, distribution)
        for resolved in writers
        if resolved.node.attribute("error_code_id")
    ]
    return {id_ for id_ in ids if id_ is not None} if len(ids) == len(writers) and None not in ids else set()


def _is_read(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether anything reads an entry, or the tree is given it."""
    boards = store.ask(blackboards, viewpoint)
    return boards.is_given(tree, name) or any(touch.reads for touch in boards.uses_of(tree, name))


def _default(view: View, resolved: ResolvedNode, pair: Pair, value: Word, what: str) -> Diagnostic:
    declared = port_named(ports_beside(view, resolved), pair.key.text)
    default = declared.default.text if declared is not None and declared.default is not None else ""
    goes_on = f"the node goes on with its default, {default}" if default else "the node goes on without a value"
    return Diagnostic(
        "default-instead", value.span, f"`{pair.key.text}` of {resolved.shown_kind} {what}", notes=(goes_on,)
    )


def _is_refused(view: View, resolved: ResolvedNode, pair: Pair, value: Word) -> bool:
    """Whether the code of a node refuses a literal that the type of its port accepts."""
    port = resolved.behavior.port(pair.key.text) if resolved.behavior is not None else None
    target = view.target
    if port is None or port.literal is None or is_pointer(value.text) or is_before_4(target):
        return False  # version 3 takes -1 for a large number
    return (
        check_literal(port.type, value.text, target) is None
        and check_literal(port.literal, value.text, target) is not None
    )


@on_circle(False)
def _is_set_before(store: Store[Workspace], viewpoint: str, tree: str, key: str) -> bool:
    """Whether an entry of a tree has a value when the tree is created: by a literal that a SubTree gives it, or that is
    a default of the tree's port, or by the program."""
    from btq_lang.catalog.nav2.creation import SET_BEFORE  # only for Nav2
    from btq_lang.requirements.nodes import callers  # only if there are such inputs

    if key.removeprefix("@") in SET_BEFORE:
        return True
    port = port_named(declared_ports(View(store, viewpoint), tree), key)
    if port is not None and port.default is not None and not is_pointer(port.default.text):
        return True
    for node in callers(store, viewpoint, tree):
        passed = passed_on(node, key)
        if passed == "":
            return True
        if passed is not None and node.tree is not None and store.ask(_is_set_before, viewpoint, node.tree, passed):
            return True
    return False
