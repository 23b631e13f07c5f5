"""How tests of the parser write down scenarios: their steps as outlines, beside those of `syntax_asserts`."""

from __future__ import annotations

from syntax_asserts import MISSING, block, show, show_clause, show_condition, show_event, show_item, show_pairs, words
from syntax_asserts import show_path as path

from btq_lang.syntax.scenarios import (
    Aspect,
    Assignment,
    Behavior,
    Elapsed,
    EventTrigger,
    Expect,
    ExpectedOutcome,
    ExpectedRuns,
    ExpectedVerdict,
    Finally,
    Given,
    HaltMission,
    NeverEnds,
    NodePattern,
    NodesDo,
    Scenario,
    Step,
    When,
)
from btq_lang.syntax.tree import Claim, Condition


@show_item.register
def _(item: Given) -> str:
    return show_step(item)


@show_item.register
def _(item: Scenario) -> str:
    head = words(
        "scenario",
        show(item.title),
        f"of {show(item.tree)}" if item.tree else "",
        f"verifies {', '.join(map(show, item.verifies))}" if item.verifies else "",
    )
    return block(head, *map(show_step, item.steps))


def show_step(step: Step) -> str:
    if isinstance(step, Given):
        return f"given {show_fact(step.fact)}"
    if isinstance(step, When):
        return f"when {show_trigger(step.trigger)}: {show_fact(step.effect)}"
    return f"expect {show_expectation(step)}"


def show_fact(fact: NodesDo | Assignment | HaltMission | None) -> str:
    """Behaviors in square brackets."""
    if isinstance(fact, Assignment):
        return f"{show(fact.target)} = {show(fact.value)}"
    if isinstance(fact, NodesDo):
        return words(show_nodes(fact.nodes), *map(show_behavior, fact.behaviors))
    return "mission halts" if fact is not None else MISSING


def show_nodes(nodes: NodePattern) -> str:
    return words(f"every {show(nodes.every)}" if nodes.every else path(nodes.path), show_pairs(nodes.pairs))


def show_behavior(behavior: Behavior) -> str:
    times = f"x {show(behavior.times)}" if behavior.times else ""
    writes = f"writes {show_pairs(behavior.writes)}" if behavior.writes else ""
    return f"[{words(*map(show_aspect, behavior.aspects), times, writes)}]"


def show_aspect(aspect: Aspect) -> str:
    duration = show(aspect.duration) if aspect.word.raw in ("takes", "after") else ""
    answers = "/".join(map(show, aspect.answers)) or MISSING if aspect.word.raw == "answers" else ""
    return words(show(aspect.word), duration, answers)


def show_trigger(trigger: Elapsed | EventTrigger | Condition | None) -> str:
    if isinstance(trigger, Elapsed):
        return f"after {show(trigger.duration)}"
    if isinstance(trigger, EventTrigger):
        number = f"#{trigger.nth}" if trigger.number else ""
        return words(f"event {show_event(trigger.event)}", show_pairs(trigger.pairs), number)
    return show_condition(trigger)


def show_expectation(step: Expect) -> str:
    expectation = step.expectation
    if isinstance(expectation, Claim):
        return f"claim {show_clause(expectation)}"
    if isinstance(expectation, ExpectedRuns):
        port = f".{show(expectation.port)}" if expectation.port else ""
        return words(f"runs {show_nodes(expectation.nodes)}{port}:", " ".join(map(show, expectation.values)))
    if isinstance(expectation, Finally):
        return f"finally {show_condition(expectation.condition)}"
    if isinstance(expectation, ExpectedVerdict):
        return words("verdict", show(expectation.name), *map(show, expectation.words))
    if isinstance(expectation, ExpectedOutcome):
        return words("ends", show(expectation.word))
    return "no end" if isinstance(expectation, NeverEnds) else MISSING
