"""After an edit, requirements, budgets and findings equal those of a new workspace."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path

import missions
import pytest
from kept_checks import Kept
from requirement_problems import problems_of
from seeds import seeds, share_of

from btq_lang.checks import check
from btq_lang.diagnostics.model import Place
from btq_lang.requirements.attach import applied_in
from btq_lang.requirements.budget_parts import Budget
from btq_lang.requirements.budgets import Budgets, Success, tree_budgets
from btq_lang.requirements.durations import Range
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import advance
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

MAIN = """include "skills.btq"
include "requirements.btq"
Root Main
BehaviorTree Main
    -> Steps satisfies budget
        satisfies QualityReq rq5 : time-behaviour
            takes at most 40 s
            on violation fail
        ? tags risky
            Pick (from = {shelf}) satisfies slow(limit = 0.2 m/s), quick
            Retry (num_attempts = 3)
                Place satisfies quick, often
        SubTree Carry (to = "x", name = "Home")
        Timeout (msec = 30 s)
            -> Inner
                Place
                SubTree Help
        MoveBase (name = "Last")
BehaviorTree Help
    satisfices Quality = performance (QualityReq rq6 takes at most 3 s in at least 90 % of activations)
    ? Any
        Inverter
            MoveBase satisfies quick
        Sleep (msec = 2 s)
        Script (code = "done := true")
QualityReq steps : reliability
    every MoveBase takes at most 9 s
    Steps takes at least 1 s
    in at least 99 % of activations
    goal 12 s
QualityReq path : time-behaviour
    Help/MoveBase takes at most 5 s
    from Pick starts to Inner/Place succeeds takes at most 45 s
    sum of Steps/Pick, Steps/Retry/Place takes at most 50 s
apply slow to every MoveBase, every Pick under Steps except Last
apply quick to every node tagged risky, Main/Home
"""
SKILLS = """Action Pick
    input from : string
    output found : string
Action MoveBase
    output speed : double
Action Place
quality gentleness : safety
signal near_people : bool from {near}
BehaviorTree Carry
    input to : string
    ->
        MoveBase (speed = {speed})
        SubTree Deeper satisfies quick
BehaviorTree Deeper
    ->
        Place (at = {@battery_level})
        MoveBase (name = "Turn")
"""
REQUIREMENTS = """signal battery : % from {battery_level} initially 100 %
signal speed : m/s from {speed} fresh within 1 s
signal people : person from {people}
context crowded : people > 3 person or near_people
context slowly : crowded and speed < 0.1 m/s
QualityReq quick : time-behaviour
    takes at most 6 s
    on violation halt
QualityReq slow(limit : m/s = 0.25 m/s) : safety
    keeps speed <= limit
    while crowded
    on violation fail
QualityReq often : reliability
    tries at most 2 per Any
QualityReq budget : time-behaviour "Never longer FailureIf battery < 3 %"
    leaves battery >= 3 %
    succeeds within 60 s
QualityReq classic "FailureIf(takes at most 20 s)"
"""
FILES = {"/p/main.btq": MAIN, "/p/skills.btq": SKILLS, "/p/requirements.btq": REQUIREMENTS}
GUARDS = {
    "/p/main.btq": """include "skills.btq"
include "requirements.btq"
Root Main
BehaviorTree Main
    ->
        Sense (speed = {speed})
        Pick satisfies slow
        SubTree Carry (to = "x")
        || Beside
            SubTree Watch (_autoremap = true)
            Place satisfies slow, still
apply still to every MoveBase
BehaviorTree Watch
    -> Inner
        Sense (speed = {speed})
        Sleep (msec = 3 s)
""",
    "/p/skills.btq": """include "requirements.btq"
Condition Sense
    output speed : double
Action Pick
Action Place
Action MoveBase
BehaviorTree Carry
    input to : string
    R->
        Condition Quiet
        MoveBase satisfies slow
""",
    "/p/requirements.btq": """signal speed : m/s from {speed} initially 0 m/s
signal people : person from {people} initially 0 person
QualityReq slow
    keeps speed <= 1 m/s
    on violation halt
QualityReq still
    leaves speed <= 0.1 m/s
    takes at least 1 s
    on violation fail
""",
}
CLASSIC = {"/p/main.btq": missions.mission(60, 2, "classic")}
SHORT = {"/p/main.btq": missions.mission(90, 3, "short")}
EXAMPLE = {"/p/main.btq": (Path(__file__).parents[1] / "every_form.btq").read_text(encoding="utf-8")}
WORDS = (
    *("MoveBase", "Pick", "Place", "Steps", "Carry", "Help", "Deeper", "Main", "Any", "Home", "quick", "slow", "rq5"),
    *(
        "speed",
        "battery",
        "people",
        "crowded",
        "slowly",
        "limit",
        "every",
        "satisfies",
        "takes",
        "6",
        "40 s",
        "0.2 m/s",
    ),
    *("Sense", "Watch", "R->", "->", "||", "halt", "(speed = {speed})", "{speed}", "still"),
    *("x", "1", "9 s", "-1", "Retry", "Sleep", "Fallback", "SubTree Help", "at least", "fail", "risky", "apply"),
)
LINES = (
    *("signal battery : % from {battery_level}", "signal extra : s from {speed}", "context crowded : people > 1"),
    *("QualityReq quick : safety\n    takes at most 2 s", "apply quick to every Place", "apply slow to Help/MoveBase"),
    *("BehaviorTree Deeper\n    Place satisfies quick", "BehaviorTree New\n    SubTree Main", "Action Place"),
    *("    QualityReq", '"', "    Sleep (msec = 3 s) satisfies quick", "context a : b", "context b : a", "# a remark"),
    *("QualityReq many\n    every Place takes at most 1 s", "Condition MoveBase", "        SubTree Carry"),
)


EDITED = {"includes": FILES, "guards": GUARDS, "classic": CLASSIC, "short": SHORT, "every form": EXAMPLE}


@pytest.mark.parametrize(("seed", "name"), list(product(share_of(seeds(2), 2), EDITED)))
def test_what_is_kept_is_what_would_be_found(seed: int, name: str) -> None:
    files = EDITED[name]
    chance = random.Random(seed)
    workspace = Workspace.of(files)
    answers = {path: Kept() for path in files}
    for step in range(40):
        path = chance.choice(sorted(files))
        text = edited(workspace.files[path].text, chance) if chance.random() > 0.15 else files[path]
        workspace = after_edit(workspace, path, text)
        texts = {each: file.text for each, file in workspace.files.items()}
        fresh = Workspace.of(texts)
        for each in chance.sample(sorted(files), len(files)):
            now = list(said(workspace, requirements(workspace, each)))
            assert now == list(said(fresh, requirements(fresh, each))), (step, each, texts)
            assert answers[each].check(workspace, each).diagnostics == check(fresh, each), (step, each, texts)


def edited(text: str, chance: random.Random) -> str:
    """A text after a random edit: a letter, a word or a line written, moved or removed."""
    lines = text.split("\n")
    at = chance.randrange(len(lines))
    kind = chance.randrange(10)
    if kind < 4:  # another word in the place of one
        words = lines[at].split(" ")
        words[chance.randrange(len(words))] = chance.choice(WORDS)
        lines[at] = " ".join(words)
    elif kind < 6:  # a letter
        column = chance.randrange(len(lines[at]) + 1)
        lines[at] = lines[at][:column] + chance.choice('ax1 (){}"#') + lines[at][column + chance.randrange(2) :]
    elif kind == 6:
        lines.insert(at, chance.choice(LINES))
    elif kind == 7:
        del lines[at : at + chance.choice((1, 1, 1, 4))]
    else:  # a block stands in another place
        tops = [number for number, line in enumerate(lines) if line[:1].strip()] or [0]
        start = chance.choice(tops)
        end = next((number for number in tops if number > start), len(lines))
        moved = lines[start:end]
        del lines[start:end]
        at = chance.choice([number for number, line in enumerate(lines) if line[:1].strip()] or [0])
        lines[at:at] = moved
    return "\n".join(lines)


def said(workspace: Workspace, found: Requirements) -> Iterator[object]:
    """All results for requirements and budgets, with places in the texts."""

    def at(place: Place) -> tuple[str | None, int]:
        assert place.path is not None, "these places have a path"
        return place.path, workspace.files[place.path].start_of(place.anchor) + place.span.start

    def named(node: ResolvedNode | None) -> object:
        return (node.shown, node.tree, at(node.place)) if node is not None else None

    yield [node.names for node in found.nodes.all]
    yield [named(node) for node in found.nodes.all]
    yield named(found.mission)
    yield [(each.name, each.unit, each.initially, at(each.place)) for each in found.signals.values()]
    yield [(name, condition is not None) for name, condition in found.contexts.items()]
    for each in found.all.values():
        yield each.name, at(each.place), each.quality, each.title, each.classic, each.action, each.odds is not None
        yield [(claim.text, at(claim.place)) for claim in each.claims], [scope.text for scope in each.scopes]
    for applied in found.applied:
        claims = [(claim.text, claim.limit is not None) for claim in applied.requirement.claims]
        arguments = [(each.name, each.value.text) for each in applied.arguments]
        yield applied.requirement.name, claims, arguments, [*map(named, applied.nodes)], at(applied.place), applied.how
    yield [(trace.requirement, named(trace.node)) for trace in found.traces]
    yield [(at(each.place), each.diagnostic.rule, each.diagnostic.message) for each in problems_of(found)]
    yield [[at(related.place) for related in each.diagnostic.related] for each in problems_of(found)]
    budgets = Budgets(found.store, found.viewpoint)
    for node in found.nodes.all:
        yield shown(budgets.of(node), named), shown(budgets.composed(node), named), likely(budgets.success(node), named)


def shown(budget: Budget, named: Callable[[ResolvedNode], object]) -> object:
    def one(each: Range | None) -> object:
        return each and (each.low, each.high, [(named(term.node), term.times, term.seconds) for term in each.terms])

    ranges = [one(each) for each in (budget.success, budget.failure, budget.skip)]
    return ranges, budget.waits, budget.probability, budget.endless


def likely(found: Success | None, named: Callable[[ResolvedNode], object]) -> object:
    return found and (found.seconds, found.probability, [(named(node), share) for node, share in found.parts])


def test_an_edit_in_one_tree_leaves_the_others() -> None:
    workspace = Workspace.of(FILES)
    before, trees = requirements(workspace, "/p/main.btq"), held(workspace.store)
    text = MAIN.replace("Sleep (msec = 2 s)", "Sleep (msec = 3 s)")
    workspace = after_edit(workspace, "/p/main.btq", text)
    after, trees_after = requirements(workspace, "/p/main.btq"), held(workspace.store)
    assert [name for name, applied in trees_after.items() if applied is trees[name]] == ["Carry", "Deeper"]
    # These name nodes of the tree `Help`, or are defined in it; what `every` means is no part of `steps`.
    assert {name for name, each in after.all.items() if each is not before.all[name]} == {"path", "often", "rq6"}


def after_edit(before: Workspace, path: str, text: str) -> Workspace:
    """The workspace after an edit, with the cached answers of the one before it."""
    after = before.with_file(path, text)
    advance(before, after)
    return after


def held(store: Store[Workspace]) -> dict[str, object]:
    """What applies to nodes of each tree in scope of the main file."""
    return in_trees(store, applied_in, "/p/main.btq")


def in_trees(store: Store[Workspace], query: Callable[..., object], viewpoint: str) -> dict[str, object]:
    """The result of a query for each tree in scope, by the tree's name."""
    trees = store.ask(inputs.trees, viewpoint)
    return {facts.summary.symbols[0].name: store.ask(query, viewpoint, path, facts) for path, facts in trees}


def test_a_budget_is_made_again_where_one_that_it_rests_on_is_another() -> None:
    text = """BehaviorTree Main
    -> Steps
        SubTree Slow
        SubTree Fast
BehaviorTree Slow
    Sleep (msec = 2 s)
BehaviorTree Fast
    Sleep (msec = 1 s)
signal s : m
"""
    workspace = Workspace.of({"/a.btq": text})
    kept = in_trees(workspace.store, tree_budgets, "/a.btq")

    def made_again(edited: str) -> set[str]:
        nonlocal kept, workspace
        workspace = after_edit(workspace, "/a.btq", edited)
        before, kept = kept, in_trees(workspace.store, tree_budgets, "/a.btq")
        return {name for name, one in kept.items() if one is not before[name]}

    assert made_again(text.replace("msec = 1 s", "msec = 1000")) == {"Fast"}
    assert made_again(text.replace("msec = 1 s", "msec = 1500")) == {"Fast", "Main"}
    assert made_again(text.replace("1 s", "1500").replace("SubTree Fast", "SubTree Main")) == {"Main"}


CIRCLE = """BehaviorTree A
    ->
        SubTree B
        SubTree D
BehaviorTree B
    SubTree A
BehaviorTree C
    SubTree A
BehaviorTree D
    Sleep (msec = 1 s)
"""


def test_a_tree_that_contains_itself_has_no_budget_whoever_is_asked_first() -> None:
    workspace = Workspace.of({"/a.btq": CIRCLE})
    for first in ("A", "B", "C", "D"):
        found = requirements(workspace, "/a.btq")
        budgets = Budgets(found.store, "/a.btq")
        tops = {tree.name: tree.root for tree in found.nodes.trees if tree.root is not None}
        budgets.of(tops[first])
        assert [name for name, root in tops.items() if budgets.of(root).is_bounded] == ["D"]


@pytest.mark.parametrize("is_circle", [False, True])
def test_no_chain_of_trees_is_too_long(is_circle: bool) -> None:
    count = sys.getrecursionlimit() + 100  # more than a function may call itself
    chain = "".join(f"BehaviorTree T{at}\n    SubTree T{at + 1} satisfies quick\n" for at in range(count))
    last = f"BehaviorTree T{count}\n    {'SubTree T7' if is_circle else 'Sleep (msec = 2 s)'}\n"
    text = f"Root T0\nQualityReq quick takes at most 1 s\n{chain}{last}"
    workspace, kept = Workspace.of({"/a.btq": text}), Kept()
    found = kept.check(workspace, "/a.btq").diagnostics
    exceeded = [each.message for each in found if each.rule == "budget-exceeded"]
    assert exceeded == ([] if is_circle else [f"`T{count}` takes at least 2 s, so it always violates `1 s`"])
    shorter = workspace.with_file("/a.btq", text.replace("2 s", "1 s").replace("SubTree T7", "Sleep (msec = 1 s)"))
    assert "budget-exceeded" not in {each.rule for each in kept.check(shorter, "/a.btq").diagnostics}
