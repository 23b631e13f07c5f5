"""Random runs by the number, judged twice: `python tests/evidence/literal_hunt.py --cases 10000 --seed 1`.

What `btq_lang.evidence` and the literal judge differ in is printed, with the mission and the seed.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

if __name__ == "__main__":  # as pytest has it for tests
    sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

import literal
from literal import ClauseResult, Literal
from literal_log import as_amount
from literal_verbs import OPEN
from random_runs import Case, case

from btq_lang.catalog.units import to_si
from btq_lang.evidence.evaluate import MissionEvaluation
from btq_lang.evidence.model import LogSession
from btq_lang.evidence.odds import lower_limit, upper_limit
from btq_lang.evidence.verdicts import ClauseVerdict
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import (
    Age,
    Compare,
    DurationSum,
    Interval,
    NodeTarget,
    Quantity,
    ResolvedClaim,
    ResolvedEachEvent,
    ResolvedRequirement,
    parts_in,
)

NOT_JUDGED = ("the clause applies to no node", "it has a mistake; run btq check")
WORST_FIRST = ("violated", "unknown", "undecided", "satisfied", "never exercised")


class Hunt:
    """Cases that were judged twice.

    Attributes:
        compared: how many clauses have which verdict.
        differences: what the two differ in, a text each.
    """

    def __init__(self) -> None:
        self.compared: Counter[str] = Counter()
        self.differences: list[str] = []

    def judge(self, seed: int) -> None:
        """Judge the case of a seed twice."""
        self.judge_case(case(seed), seed)

    def judge_case(self, made: Case, seed: int) -> None:
        """Judge a case twice; `seed`: to name it by."""
        evaluation = MissionEvaluation(made.mission)
        read = 0
        for rows in made.sessions:
            read += evaluation.read(LogSession(made.joined.tree, iter(rows)), made.joined, made.series, read + 1, "log")
        literal = literal_of(made)
        found = made.mission.requirements
        for requirement in evaluation.result().requirements:
            if requirement.verdict == "open":
                continue
            held = [each for each in found.applied if each.requirement.name == requirement.id]
            clauses = [(each, claim) for each in held for claim in each.requirement.claims]
            streamed = [each for each in requirement.clauses if each.why not in NOT_JUDGED]
            assert len(clauses) == len(streamed), f"seed {seed}: {requirement}"
            verdicts = ["unknown"] if len(streamed) < len(requirement.clauses) else []
            for (applied, claim), verdict in zip(clauses, streamed, strict=True):
                assert verdict.text.startswith(claim.text)
                verdicts.append(self.compare(made, seed, literal, applied, claim, verdict))
            worst = next(each for each in WORST_FIRST if each in verdicts)
            if worst != requirement.verdict:
                self.differences.append(
                    f"seed {seed}: {requirement.id} {worst}, not {requirement.verdict}\n{made.text}"
                )

    def compare(
        self, made: Case, seed: int, literal: Literal, applied: Applied, claim: ResolvedClaim, streamed: ClauseVerdict
    ) -> str:
        """Compare a clause; its literal verdict."""
        judged = literal.clause(applied, claim)
        what = {Interval: "from … to", DurationSum: "sum of"}.get(type(applied.subject), claim.verb)
        what = "from … until" if applied.requirement.span is not None else what
        self.compared[f"{what}: {judged.verdict}"] += 1
        has_path = streamed.unit != "runs" and not isinstance(
            applied.subject, Interval | DurationSum | ResolvedEachEvent
        )
        expected, got = expected_of(made, applied.requirement, judged, has_path), got_of(streamed, has_path)
        if expected != got:
            of_node = [f"{each}" for each in literal.activations if each.uid in {one.uid for one in judged.judged}]
            self.differences.append(
                "\n".join(
                    [
                        f"seed {seed}: {applied.requirement.name} {streamed.text} at {streamed.path}",
                        f"  literal:        {expected}",
                        f"  btq_lang:       {got}",
                        *(f"  {each}" for each in judged.judged),
                        *(f"  {each}" for each in of_node),
                        made.text,
                    ]
                )
            )
        return judged.verdict


def literal_of(made: Case) -> Literal:
    """The literal judge of a case."""
    signals = made.mission.requirements.signals
    samples = {
        name: [
            (time, value if (unit := signals[name].unit) is None else to_si(as_amount(value), unit))
            for time, value in values
        ]
        for name, values in made.samples.items()
    }

    def instances(target: NodeTarget) -> list[int]:
        return [uid for _, uid in made.joined.instances(target) if uid is not None]

    ages: dict[str, set[int]] = {}
    requirements = made.mission.requirements
    applied = tuple(
        (part.requirement, part.subject, *(each.value for each in part.arguments)) for part in requirements.applied
    )
    for compare in parts_in((applied, (*requirements.contexts.values(),))):
        numbers = compare.operands if isinstance(compare, Compare) else ()
        for age in numbers:
            if isinstance(age, Age):
                times = [round(each.si * 1e6) for each in parts_in(numbers) if isinstance(each, Quantity)]
                ages.setdefault(age.signal.name, set()).update(times)
    of_tree, known = (made.joined.tree, made.subtrees, made.delays), (samples, signals, instances, made.guards, ages)
    return Literal([literal.Session(*of_tree, rows, *known) for rows in made.sessions])


def expected_of(
    made: Case, requirement: ResolvedRequirement, judged: ClauseResult, has_path: bool
) -> dict[str, object]:
    """What a clause came to, by the literal judge.

    Args:
        has_path: each violation is one of a node.
    """
    yes, no, maybe = (sum(each is truth for each in judged.experiments) for truth in (True, False, None))
    confidence = requirement.confidence or 0.95
    limits = (lower_limit(yes, yes + no, confidence), upper_limit(yes, yes + no, confidence)) if yes + no else None
    nodes = made.joined.tree.nodes
    wrong = [each for each in judged.judged if each.verdict is False]
    broken = [(each.run + 1, nodes[each.uid].path if has_path else "") for each in wrong]
    if requirement.odds is not None and requirement.odds.experiments == "runs":
        broken = [*dict.fromkeys(broken)]  # the first one of each run
    return {
        "verdict": judged.verdict,
        "counted": yes + no,
        "violated": no,
        "unknown": maybe,
        "cut off": sum(each.verdict is OPEN for each in judged.judged),
        "violations": sorted(broken),
        "interval": limits if requirement.odds is not None and not maybe else None,
    }


def got_of(clause: ClauseVerdict, has_path: bool) -> dict[str, object]:
    """The same by `btq_lang.evidence`."""
    return {
        "verdict": clause.verdict,
        "counted": clause.counted,
        "violated": clause.violated,
        "unknown": clause.unknown,
        "cut off": clause.cut_off,
        "violations": sorted((each.run, each.path if has_path else "") for each in clause.violations),
        "interval": clause.interval if clause.counted and not clause.unknown else None,
    }


def main() -> None:
    """Judge many cases, and say what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1, help="of the first case; the next ones follow it")
    parser.add_argument("--shown", type=int, default=3, help="how many differences are printed")
    options = parser.parse_args()
    hunt = Hunt()
    for seed in range(options.seed, options.seed + options.cases):
        hunt.judge(seed)
    for difference in hunt.differences[: options.shown]:
        print(difference)
    print("\n".join(f"{number:8} {what}" for what, number in sorted(hunt.compared.items())))
    print(f"{options.cases} cases, {hunt.compared.total()} clauses compared, {len(hunt.differences)} differ")
    sys.exit(bool(hunt.differences))


if __name__ == "__main__":
    main()
