"""The digest of a mission, by which kept verdicts know whether it is still the one that they are of."""

from __future__ import annotations

import re

from check_asserts import workspace_of

from btq_lang.catalog import units
from btq_lang.evidence.outline import _WORDS, outline
from btq_lang.requirements import model
from btq_lang.requirements.resolve import requirements

MISSION = """
signal battery : % from {battery} counter fresh within 2 s initially 100 %
signal mode : text
signal near : bool
signal speed : m/s
context Tired: battery < 20 % or not near and mode == "eco" and near == true
context Fast: max(speed) > -1 m/s + 2 * speed and node Pick and Tired
BehaviorTree Main
    Sequence
        Pick (goal=3)
        Place
"""


def digest(text: str) -> str:
    return outline(requirements(workspace_of({"main.btq": text}), "main.btq"))


def test_the_digest_is_the_one_that_is_on_the_disk() -> None:
    """A fixed string: with another one, all verdicts that users keep are those of another mission."""
    assert digest(MISSION) == "68cd00a7f1225c62"


def test_the_digest_is_of_trees_signals_and_contexts_alone() -> None:
    layout = (
        MISSION.replace("context Fast: max", "# faster\ncontext Fast:  max")
        + "QualityReq rq : safety\n    Pick succeeds\n"
    )
    assert digest(layout) == digest(MISSION)
    for old, new in (("goal=3", "goal=4"), ("fresh within 2 s", "fresh within 3 s"), ("2 * speed", "3 * speed")):
        assert digest(MISSION.replace(old, new)) != digest(MISSION), new


def test_every_class_in_signals_and_contexts_has_its_word() -> None:
    """The classes are those that the annotations of a signal and of a condition name, and the annotations of these."""
    names, waiting = set[str](), ["ResolvedSignal", "Condition"]
    while waiting:
        name = waiting.pop()
        if name not in names:
            names.add(name)
            value = getattr(model, name, None)
            annotations = value.__annotations__ if hasattr(value, "__match_args__") else {"": value}
            parts = [str(annotation) for field, annotation in annotations.items() if field != "place"]
            waiting += re.findall(r"\b[A-Z]\w+", " ".join(parts))
    classes = {name: getattr(model, name, getattr(units, name, None)) for name in names}
    records = {name: each for name, each in classes.items() if hasattr(each, "__match_args__")}
    assert [name for name, each in records.items() if each not in _WORDS] == []
    assert len(set(_WORDS.values())) == len(_WORDS)
