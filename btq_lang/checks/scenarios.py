"""Scenarios: names that nothing has, values that do not fit, and steps that their nodes cannot do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.chain import is_external, may_be_external
from btq_lang.checks.known_ports import known_ports
from btq_lang.checks.view import View, near_names
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax import scenarios as syntax
from btq_lang.syntax.tokens import BRACED
from btq_lang.syntax.tree import Amount, Claim, Pair, Path, Word, shape, written
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.requirements.entries import ScenarioReader


def unknown_requirement(view: View) -> Iterator[Diagnostic]:
    """A requirement that a scenario verifies or expects a verdict of, and that is defined nowhere."""
    for use in view.uses(Kind.REQUIREMENT) if isinstance(view.item, syntax.Scenario) else ():
        if view.ask(lookups.is_defined, Kind.REQUIREMENT, use.name):
            continue
        if is_external(view, use.name) or may_be_external(view, use.name):
            continue
        if not view.ask(inputs.is_complete):
            return
        likely = view.ask(near_names, Kind.REQUIREMENT, use.name)
        fixes = tuple(replace_fix(f"Replace `{use.name}` with `{name}`", use.span, written(name)) for name in likely)
        message = f"unknown requirement `{use.name}`{did_you_mean(likely)}"
        yield Diagnostic("unknown-requirement", use.span, message, fixes=fixes)


def expects_nothing(view: View) -> Iterator[Diagnostic]:
    """A scenario without a line that says what is expected."""
    scenario = view.item
    if not isinstance(scenario, syntax.Scenario) or any(isinstance(step, syntax.Expect) for step in scenario.steps):
        return
    if view.entry.diagnostics:
        return  # its expectation may be on a line that could not be read
    span = scenario.title.span if scenario.title is not None else Span(scenario.start, scenario.start)
    note = "add what must be true of the run, such as `expect mission succeeds`"
    yield Diagnostic("expects-nothing", span, "this scenario expects nothing", notes=(note,))


def undecidable_expectation(view: View) -> Iterator[Diagnostic]:
    """A requirement that a scenario expects to be satisfied, though that needs more runs than the one that it is."""
    from btq_lang.requirements.definitions import requirement  # few files have scenarios
    from btq_lang.requirements.one_run import never_satisfied_by_one, shown_by_one

    for step in view.item.steps if isinstance(view.item, syntax.Scenario) else ():
        expected = step.expectation if isinstance(step, syntax.Expect) else None
        if not isinstance(expected, syntax.ExpectedVerdict) or [word.raw for word in expected.words] not in _SATISFIED:
            continue
        resolved, _ = view.ask(requirement, expected.name.text)
        if resolved is not None and (what := never_satisfied_by_one(resolved)):
            message = f"a scenario is one run, which cannot decide {what}"
            notes = tuple(f"`expect {text}` is what one run can show" for text in shown_by_one(resolved))
            yield Diagnostic("undecidable-expectation", expected.name.span, message, notes=notes)


def duplicate_title(view: View) -> Iterator[Diagnostic]:
    """A scenario with the title of an earlier one of its file."""
    title = view.item.title if isinstance(view.item, syntax.Scenario) else None
    if title is None:
        return
    first = view.ask(_titles)[title.text]
    if first is not view.facts and isinstance(first.item, syntax.Scenario) and first.item.title is not None:
        related = (Related(Place(first.item.title.span, view.path, first.item), "the first one"),)
        message = f"duplicate title of a scenario: `{title.text}`"
        notes = ("editors and `btq test -k` know scenarios by their titles",)
        yield Diagnostic("duplicate-definition", title.span, message, related, notes, severity=Severity.WARNING)


def ambiguous_given(view: View) -> Iterator[Diagnostic]:
    """Two givens of which neither is more specific, and that say something else of one node."""
    if isinstance(view.item, syntax.Given):
        yield from view.ask(_ties_of_file).get(id(view.facts), ())
    elif isinstance(view.item, syntax.Scenario):
        steps = [(view.facts, step) for step in view.item.steps if isinstance(step, syntax.Given)]
        for _, diagnostic in _ties(view, steps):
            yield diagnostic


def wrong_step(view: View) -> Iterator[Diagnostic]:
    """All else that is wrong with the steps: unknown nodes, ports, signals, values that do not fit, and what the nodes
    cannot do."""
    from btq_lang.requirements.entries import ScenarioReader  # few files have scenarios

    reader = ScenarioReader(view.store, view.path, view.path, view.facts)
    steps = view.item.steps if isinstance(view.item, syntax.Scenario) else (view.item,)
    diagnostics = [diagnostic for step in steps for diagnostic in _in_step(view, reader, step)]
    yield from [problem.diagnostic for problem in reader.problems]
    yield from diagnostics


def _in_step(view: View, reader: ScenarioReader, step: object) -> Iterator[Diagnostic]:
    if isinstance(step, syntax.Given):
        yield from _of_effect(view, reader, step.fact)
    elif isinstance(step, syntax.When):
        yield from _of_trigger(view, reader, step.trigger)
        yield from _of_effect(view, reader, step.effect)
    elif isinstance(step, syntax.Expect):
        yield from _of_expectation(view, reader, step.expectation)


def _of_trigger(view: View, reader: ScenarioReader, trigger: object) -> Iterator[Diagnostic]:
    from btq_lang.requirements.terms import DURATION  # as above

    if isinstance(trigger, syntax.Elapsed):
        reader.quantity(trigger.duration, DURATION)
    elif isinstance(trigger, syntax.EventTrigger):
        if trigger.event.path is not None:
            yield from _unknown_ports(view, _of_path(view, reader, trigger.event.path), trigger.pairs)
    elif trigger is not None:
        reader.condition(trigger)  # type: ignore[arg-type]  # the last kind of trigger


def _of_effect(view: View, reader: ScenarioReader, effect: object) -> Iterator[Diagnostic]:
    from btq_lang.requirements.terms import DURATION  # as above

    if isinstance(effect, syntax.Assignment):
        yield from _of_assignment(view, reader, effect)
    elif isinstance(effect, syntax.NodesDo):
        targets = _nodes_of(view, reader, effect.nodes)
        yield from _unknown_ports(view, targets, effect.nodes.pairs)
        yield from _impossible(targets, effect)
        for behavior in effect.behaviors:
            for aspect in behavior.aspects:
                reader.quantity(aspect.duration, DURATION)


def _of_assignment(view: View, reader: ScenarioReader, assignment: syntax.Assignment) -> Iterator[Diagnostic]:
    """A value of a signal; that of an entry may be anything."""
    from btq_lang.requirements.model import ResolvedParameter  # as above

    target, value = assignment.target, assignment.value
    if target.kind == BRACED:
        return
    signal = reader.signal(target.text)
    if signal is not None and value is not None and value.kind != BRACED:
        reader.argument(ResolvedParameter(signal.name, signal.sort, signal.unit, None), Amount(value))
    elif signal is None and reader.is_context(target.text):
        message = f"`{target.text}` is a context: what is given are the signals that it compares"
        yield Diagnostic("unknown-signal", target.span, message)
    elif signal is None and (targets := reader.find((target.text,))):
        message = f"`{target.text}` is a node, not a signal"
        fixes: tuple[Fix, ...] = ()
        if value is not None and value.raw in ("true", "false") and targets[0].node.category == "Condition":
            fixes = (write_fix(f" answers {value.raw}", Span(target.end, value.end)),)
        yield Diagnostic("unknown-signal", target.span, message, fixes=fixes)
    elif signal is None:
        reader.unknown(target, ("signals",))


def _of_expectation(view: View, reader: ScenarioReader, expectation: object) -> Iterator[Diagnostic]:
    from btq_lang.requirements.clauses import claim_of  # as above

    if isinstance(expectation, Claim):
        claim_of(reader, expectation)
    elif isinstance(expectation, syntax.Finally):
        reader.condition(expectation.condition)
    elif isinstance(expectation, syntax.ExpectedRuns):
        targets = _nodes_of(view, reader, expectation.nodes)
        yield from _unknown_ports(view, targets, expectation.nodes.pairs)
        if expectation.port is not None:
            yield from _unknown_ports(view, targets, (Pair(expectation.port, None),))
        else:
            yield from _which_port(view, targets, expectation)


# ---- nodes ----


def _nodes_of(view: View, reader: ScenarioReader, pattern: syntax.NodePattern) -> tuple[ResolvedNode, ...]:
    """The nodes that a pattern matches, whatever values their ports have; none is reported."""
    if pattern.path is not None:
        return _of_path(view, reader, pattern.path)
    if pattern.every is None:
        return ()
    targets = _every(view, pattern.every.text)
    if not targets:
        reader.report_unknown_kind(pattern.every)
    return targets


def _of_path(view: View, reader: ScenarioReader, path: Path) -> tuple[ResolvedNode, ...]:
    targets = _matching(view, path)
    if not targets:
        reader.target(path)
    return targets


def _every(view: View, name: str) -> tuple[ResolvedNode, ...]:
    from btq_lang.requirements import nodes  # few files have scenarios

    return view.ask(nodes.every, name)


def _matching(view: View, path: Path) -> tuple[ResolvedNode, ...]:
    from btq_lang.requirements import nodes  # as above

    return tuple([target.node for target in view.ask(nodes.find, tuple(name.text for name in path.names))])


def _unknown_ports(view: View, targets: Sequence[ResolvedNode], pairs: Iterable[Pair]) -> Iterator[Diagnostic]:
    """Ports that none of some nodes has, if the ports of all of them are known."""
    names: set[str] = set()
    for target in targets:
        ports = known_ports(view, target)
        if target.is_subtree or ports is None:
            return
        names |= {*ports.names, *(pair.key.text for pair in target.node.attributes)}
    for pair in pairs if targets else ():
        if pair.key.text not in names:
            likely = near(pair.key.text, names, limit=1)
            title = f"Replace `{pair.key.text}` with"
            fixes = tuple(replace_fix(f"{title} `{name}`", pair.key.span, written(name)) for name in likely)
            message = f"{targets[0].shown_kind} has no port `{pair.key.text}`{did_you_mean(likely)}"
            shown = ", ".join(f"`{name}`" for name in sorted(names) if name not in ("name", "ID"))
            notes = (f"it has {shown}" if shown else "it has no ports",)
            yield Diagnostic("unknown-port", pair.key.span, message, notes=notes, fixes=fixes)


def _which_port(view: View, targets: Sequence[ResolvedNode], expectation: syntax.ExpectedRuns) -> Iterator[Diagnostic]:
    """`runs` without a port, of nodes with several inputs, or with none."""
    for target in targets:
        ports = known_ports(view, target)
        if ports is None or target.is_subtree:
            continue
        inputs_of = [port.name for port in ports.all if port.direction != "output" and port.name not in ("name", "ID")]
        if len(inputs_of) == 1:
            continue
        message = f"{target.shown_kind} has no input port, so it runs no values"
        fixes: tuple[Fix, ...] = ()
        if inputs_of:
            shown = ", ".join(f"`{name}`" for name in inputs_of)
            message = f"{target.shown_kind} has several input ports ({shown}); name one before `runs`"
            place = Span(expectation.nodes.end, expectation.nodes.end)
            if not expectation.nodes.pairs:
                fixes = tuple(replace_fix(f"Name `{name}`", place, f" ({written(name)})") for name in inputs_of[:5])
        span = Span(expectation.nodes.start, expectation.nodes.end)
        yield Diagnostic("impossible-step", span, message, fixes=fixes)
        return


def _impossible(targets: Sequence[ResolvedNode], given: syntax.NodesDo) -> Iterator[Diagnostic]:
    """Behaviors that none of some nodes can have: a condition answers, all other nodes do not, and nodes of the engine
    do what the engine does."""
    from btq_lang.catalog.nav2.nodes import ASKING  # few files have scenarios

    if not targets:
        return
    span = Span(given.nodes.start, given.nodes.end)
    if all(target.kind is not None or target.is_subtree for target in targets):
        what = "runs a tree" if targets[0].is_subtree else "is a node of the engine"
        message = f"{targets[0].shown_kind} {what}, so its behavior follows from the tree"
        yield Diagnostic("impossible-step", span, message, notes=("say what the nodes of your robot below it do",))
        return
    categories = {target.category for target in targets if target.kind is None}
    is_asked = any(target.id is not None and target.id.text in ASKING for target in targets)
    shown = targets[0].shown_kind
    for behavior in given.behaviors:
        for aspect in behavior.aspects:
            word = aspect.word.raw
            if word == "answers" and categories <= {"Action", "Control", "Decorator"} and not is_asked:
                message = f"{shown} is not a condition: it succeeds or fails, and answers nothing"
                only = aspect.answers[0].raw if len(aspect.answers) == 1 else ""
                meant = {"true": "succeeds", "false": "fails"}.get(only)
            elif word in _OF_ACTIONS and categories == {"Condition"}:
                message = f"{shown} is a condition: it `answers` true or false at once"
                meant = {"succeeds": "answers true", "fails": "answers false"}.get(word)
            else:
                continue
            place = Span(aspect.start, aspect.end)
            fixes = (write_fix(meant, place),) if meant is not None else ()
            yield Diagnostic("impossible-step", place, message, fixes=fixes)


# ---- givens that contradict each other ----


class _Stated(Record):
    """What a given says of nodes; values: of their ports."""

    given: syntax.Given
    item: object
    nodes: frozenset[int]
    values: dict[str, str]
    aspects: dict[str, object]


def _titles(store: Store[Workspace], viewpoint: str) -> dict[str, Facts]:
    """The first scenario of the file with each title."""
    titles: dict[str, Facts] = {}
    for facts in View(store, viewpoint).ask(lookups.items):
        if isinstance(facts.item, syntax.Scenario) and facts.item.title is not None:
            titles.setdefault(facts.item.title.text, facts)
    return titles


def _ties_of_file(store: Store[Workspace], viewpoint: str) -> dict[int, list[Diagnostic]]:
    """The ties among the givens for all scenarios of the file, by the `id` of the facts of the later one."""
    view = View(store, viewpoint)
    givens = [(facts, facts.item) for facts in view.ask(lookups.items) if isinstance(facts.item, syntax.Given)]
    by_item: dict[int, list[Diagnostic]] = {}
    for facts, diagnostic in _ties(view, givens):
        by_item.setdefault(id(facts), []).append(diagnostic)
    return by_item


def _ties(view: View, givens: Sequence[tuple[Facts, syntax.Given]]) -> Iterator[tuple[Facts, Diagnostic]]:
    earlier: dict[tuple[bool, bool, int], list[_Stated]] = {}  # by how specific they are, and by the node
    values: dict[str, tuple[Facts, syntax.Given, syntax.Assignment]] = {}  # by the signal or entry
    for facts, given in givens:
        if isinstance(given.fact, syntax.Assignment) and given.fact.value is not None:
            name = _entry_of(view, facts, given.fact.target)
            first_facts, first, assigned = values.setdefault(name, (facts, given, given.fact))
            if assigned.value is not None and assigned.value.text != given.fact.value.text:
                related = (Related(Place(Span(first.start, first.end), view.path, first_facts.item), "the other one"),)
                message = f"two givens say the value of `{given.fact.target.text}`, and neither is more specific"
                note = "what changes during the run goes after `when`, as in `when 30 s have passed: battery = 20 %`"
                yield facts, Diagnostic("ambiguous-given", Span(given.start, given.end), message, related, (note,))
        stated = _stated(view, facts, given)
        if stated is None or not isinstance(given.fact, syntax.NodesDo):
            continue
        pattern = given.fact.nodes
        others = [earlier.setdefault((pattern.every is None, bool(pattern.pairs), node), []) for node in stated.nodes]
        clashes = (_clash(stated, other) for each in others for other in each)
        rival = next((clash for clash in clashes if clash is not None), None)
        for each in others:
            if len(each) < _MOST_COMPARED:
                each.append(stated)
        if rival is not None:
            other, aspect = rival
            span = Span(other.given.start, other.given.end)
            related = (Related(Place(span, view.path, other.item), "the other one"),)
            message = f"two givens say the {aspect} of one node, and neither is more specific"
            note = "values of ports are more specific than a path, a path than `every`, and a scenario than the file"
            place = Span(given.start, given.end)
            yield facts, Diagnostic("ambiguous-given", place, message, related, (note,))


def _entry_of(view: View, facts: Facts, target: Word) -> str:
    """The entry that a value is given to, or the signal that has none."""
    from btq_lang.requirements.entries import ScenarioReader, key_of  # few files have scenarios

    if target.kind == BRACED:
        return f"{{{key_of(target)}}}"
    signal = ScenarioReader(view.store, view.path, view.path, facts).signal(target.text)
    return f"{{{signal.entry}}}" if signal is not None and signal.key else target.text


def _stated(view: View, facts: Facts, given: syntax.Given) -> _Stated | None:
    fact = given.fact
    if not isinstance(fact, syntax.NodesDo):
        return None
    if fact.nodes.path is not None:
        matching = _matching(view, fact.nodes.path)
    else:
        matching = _every(view, fact.nodes.every.text) if fact.nodes.every is not None else ()
    values = {pair.key.text: pair.value.text for pair in fact.nodes.pairs if pair.value is not None}
    aspects: dict[str, object] = {}
    for behavior in fact.behaviors:
        for aspect in behavior.aspects:
            aspects.setdefault(_ASPECTS[aspect.word.raw], shape(fact.behaviors))
        if behavior.writes:
            aspects["writes"] = shape(fact.behaviors)
    return _Stated(given, facts.item, frozenset(map(id, matching)), values, aspects)


def _clash(stated: _Stated, other: _Stated) -> tuple[_Stated, str] | None:
    """The other one, if it says something else of the same activations, and of what."""
    if any(other.values.get(port, value) != value for port, value in stated.values.items()):
        return None
    for aspect, content in stated.aspects.items():
        if aspect in other.aspects and other.aspects[aspect] != content:
            return other, aspect
    return None


_SATISFIED: Final[tuple[list[str], ...]] = ([], ["satisfied"])
_OF_ACTIONS: Final = ("succeeds", "fails", "does", "takes", "after")
_ASPECTS: Final = {
    **dict.fromkeys(("succeeds", "fails", "skips", "does"), "result"),
    **dict.fromkeys(("takes", "after"), "duration"),
    "answers": "answers",
}
_MOST_COMPARED: Final = 100  # givens of one node
