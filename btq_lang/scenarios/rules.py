"""A scenario as substitution rules of the engine, whose TestNodes then do what is given instead of the program's nodes.

One invariant: a rule is for one node, by its path, and what rules cannot say is refused.
Source of the format: BehaviorTree.CPP, `loadSubstitutionRuleFromJSON` and `TestNode` of 4.10.0.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from itertools import groupby
from typing import Any, Final

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import at_least
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.plan import Plan
from btq_lang.simulator.blackboard import BOOL
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.leaves import tick_custom
from btq_lang.simulator.loading import load
from btq_lang.simulator.nodes import FAILURE, RUNNING, STATUS_NAMES, SUCCESS, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.skills import GivenSkill, Skills, Write, is_value
from btq_lang.util.record import Record


class NoRules(Exception):
    """There are no rules that say what a scenario says; the message says why."""


class SubstitutionRules(Record):
    """Rules for `BehaviorTreeFactory::loadSubstitutionRuleFromJSON`.

    Attributes:
        text: JSON.
        entries: what the program has to write on the root blackboard before the first tick: `key = value`.
        without: the conditions without a rule, because nothing says what they answer, by their paths.
    """

    text: str
    entries: tuple[str, ...]
    without: tuple[str, ...]


def substitution_rules(mission: ScenarioMission, plan: Plan) -> SubstitutionRules:
    """The rules that say what is given in a scenario.

    Raises:
        NoRules: the engine's version, or its rules at all, cannot say it.
    """
    version = mission.dialect.version
    if not at_least(version, "4.7"):
        raise NoRules(f"{version} reads rules of a file from memory that it has freed; use --target 4.8")
    if plan.changes:
        raise NoRules("rules cannot say what a `when` changes")
    try:
        skills = Skills(plan.givens, mission.conditions)
        machine = load(mission.documents, mission.name, mission.dialect, skills, _ignore, None, mission.actions)
    except (EngineError, NotModelled) as error:
        raise NoRules(f"the tree cannot be loaded: {error}") from None
    maker = _Maker(mission, plan)
    configs = {node.uid: maker.config(node) for node in machine.nodes if node.rules.flow is tick_custom}
    rules: dict[str, dict[str, Any]] = {}
    for node in machine.nodes:
        if (config := configs.get(node.uid)) is None:
            continue
        for other in machine.nodes:
            if node.path in (other.path, other.name, other.id) and configs.get(other.uid) != config:
                raise NoRules(f"a rule for `{node.path}` is one for several nodes; give them names of their own")
        rules[node.path] = config
    document = {"TestNodeConfigs": rules, "SubstitutionRules": {path: path for path in rules}}
    entries = [f"{each.key} = {_literal(each.value)}" for each in plan.entries if each.key]
    without = tuple(node.path for node in machine.nodes if node.uid in configs and configs[node.uid] is None)
    return SubstitutionRules(json.dumps(document, indent=2) + "\n", (*entries, *maker.counters), without)


class _Maker:
    """Makes what TestNodes do.

    Attributes:
        counters: the entries that count activations, with their first values.
    """

    def __init__(self, mission: ScenarioMission, plan: Plan) -> None:
        self._mission: Final = mission
        self._has_scripts: Final = at_least(mission.dialect.version, "4.10")
        self._givens: Final = sorted(enumerate(plan.givens), key=lambda numbered: -numbered[1].rank)
        self.counters: Final[dict[str, None]] = {}

    def config(self, node: SimulatedNode) -> dict[str, Any] | None:
        """What a TestNode does in place of a node; None: nothing says what it answers."""
        givens = [(number, given) for number, given in self._givens if _concerns(given, node)]
        if node.id in self._mission.conditions:
            for number, given in givens:
                if given.answers:
                    return self._result(node, number, [(SUCCESS if each else FAILURE, 1) for each in given.answers])
            return None
        acting = [(number, given) for number, given in givens if given.activations]
        number, results = _values(node, acting, "result", SUCCESS)
        if any(len(given.activations) > 1 and other != number for other, given in acting):
            raise NoRules(f"more than one given says what {node.path} does from one activation to the next")
        config = self._result(node, number, results)
        for field, default in (("takes", 0), ("writes", ())):
            _, values = _values(node, acting, field, default)
            if len(values) > 1:
                raise NoRules(f"`{field}` of {node.path} differs from one activation to the next")
            if field == "takes" and values[0][0]:
                config["async_delay"] = values[0][0]
            elif field == "writes" and values[0][0] and results != [(RUNNING, 1)]:
                config["post_script"] = "; ".join(_script(node, write) for write in values[0][0])
        return config

    def _result(self, node: SimulatedNode, number: int, results: Sequence[tuple[int, int]]) -> dict[str, Any]:
        """Its result, or the script by which the engine finds it from one activation to the next."""
        runs = [(status, sum(times for _, times in run)) for status, run in groupby(results, key=lambda each: each[0])]
        if len(runs) == 1:
            return {"return_status": STATUS_NAMES[runs[0][0]]}
        if not self._has_scripts:
            raise NoRules(
                f"the results of {node.path} differ, which takes a `return_status_script`, new in 4.10; "
                f"the rules are for {self._mission.dialect.version}"
            )
        if node.id in self._mission.conditions and self._is_asked_again(node.uid):
            raise NoRules(f"{node.path} is asked at every tick, and the engine ticks more often than the model")
        counter = f"btq_{number + 1}"
        self.counters[f"{counter} = 0.0"] = None
        return {"return_status_script": f"@{counter} += 1; {_chosen(f'@{counter}', runs)}"}

    def _is_asked_again(self, uid: int) -> bool:
        """Whether a node above it asks it again while another one runs."""
        nodes = self._mission.tree.nodes
        kinds = [BUILTINS.get(nodes[above].kind) for above in self._mission.tree.above(uid)]
        return any(kind is None or kind.reactive for kind in kinds)


def _concerns(given: GivenSkill, node: SimulatedNode) -> bool:
    """Whether it is about all activations of a node."""
    if node.uid not in given.uids:
        return False
    for port, _ in given.values:
        if key_of(node.ports.get(port, ""), port) is not None:
            raise NoRules(f"what is given of {node.path} depends on the entry at its port `{port}`")
    return all(is_value(node.ports.get(port), wanted) for port, wanted in given.values)


def _values(
    node: SimulatedNode, givens: Sequence[tuple[int, GivenSkill]], field: str, default: object
) -> tuple[int, list[tuple[Any, int]]]:
    """An aspect of successive activations, each with how often, and the number of what is given that says so."""
    for index, (number, given) in enumerate(givens):
        values = [(getattr(each, field), each.times or 1) for each in given.activations]
        if all(value is None for value, _ in values):
            continue
        if any(value is None for value, _ in values):
            _, others = _values(node, givens[index + 1 :], field, default)
            if len(others) > 1:
                raise NoRules(f"more than one given says what {node.path} does from one activation to the next")
            values = [(others[0][0] if value is None else value, times) for value, times in values]
        return number, values if len({value for value, _ in values}) > 1 else [(values[0][0], 1)]
    return -1, [(default, 1)]


def _chosen(counter: str, runs: Sequence[tuple[int, int]]) -> str:
    """The expression of a script that chooses a status by the number of the activation, from 1."""
    last = STATUS_NAMES[runs[-1][0]]
    number = sum(times for _, times in runs[:-1])
    for status, times in reversed(runs[:-1]):
        last = f"({counter} <= {number}) ? {STATUS_NAMES[status]} : ({last})"
        number -= times
    return last


def _script(node: SimulatedNode, write: Write) -> str:
    key = key_of(node.ports.get(write.key, ""), write.key) or write.key
    if not _NAME.fullmatch(key):
        raise NoRules(f"a script cannot name the entry `{key}`")
    return f"{key} := {_literal(bool(write.value) if write.type == BOOL else write.value)}"


def _literal(value: object) -> str:
    """A value as scripts write it."""
    if isinstance(value, str):
        if "'" in value:
            raise NoRules(f"a script cannot have the text `{value}`")
        return f"'{value}'"
    return str(value).lower() if isinstance(value, bool) else f"{value}"


def _ignore(*_: object) -> None: ...


_NAME: Final = re.compile(r"@?[A-Za-z_]\w*")
