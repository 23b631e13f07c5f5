"""The numbers of a mission on both sides, as a store has them.

One invariant: only means and counts of each run, group of runs or robot are loaded.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final

from btq_lang.evidence.compare import questions
from btq_lang.evidence.compare.chance import Shuffles
from btq_lang.evidence.compare.failures import FailedRuns, failed_runs
from btq_lang.evidence.compare.measures import Measure, ShuffledUnit, Values
from btq_lang.evidence.compare.model import Key, Over, is_time
from btq_lang.evidence.compare.rates import compared_rates
from btq_lang.evidence.compare.requirements import Edited
from btq_lang.evidence.store.queries import Ask, Row
from btq_lang.evidence.store.tables import quoted
from btq_lang.util.grouping import grouped


class Numbers:
    """The numbers that are compared of a mission.

    Attributes:
        over, group: as in `Comparison`.
        measures: what both sides have, in a stratum that both have.
        leaves: the nodes among them that have none inside.
        failures: what failed in some of the runs.
        rates: failure rates that are demanded; `periods`: the time, in seconds, for which each is.
        units: of both sides, in their order.
        shuffles: of these.
    """

    def __init__(
        self, ask: Ask, by: str, sides: tuple[str, str], mission: str, runs: tuple[Row, Row], edited: Sequence[Edited]
    ) -> None:
        """
        Args:
            runs: of each side, the answer to `questions.RUNS`.
        """
        self.sides: Final = sides
        first, second = (set(row["robots"]) for row in runs)
        self.over: Final[Over] = _over(first, second)
        self.group: Final = 1 if self.over == "robots" else -(-min(row["runs"] for row in runs) // _MOST_UNITS)
        stratum = "robot" if self.over == "runs of each robot" else "''"
        by_run = questions.BY_RUN.format(by=by, stratum=stratum, size=self.group)
        self._ask: Final = ask
        self._words: Final = {
            "by": by,
            "sides": ", ".join(map(quoted, sides)),
            "mission": quoted(mission),
            "stratum": stratum,
            "unit": "robot" if self.over == "robots" else by_run,
            "robots": "robot" if first & second else "''",
            "clause": questions.clause_of(edited),
        }
        units = {_key(row): row for row in self._asked(questions.UNITS)}
        self._symbols: Final = {key: row["unit"] or "1" for key, row in units.items()}
        self.periods: Final = {key: row["seconds"] for key, row in units.items() if row["seconds"]}
        rows = grouped((_key(row), row) for row in self._asked(questions.MEASURES))
        measures = {key: _measure(of_key) for key, of_key in rows.items()}
        self.measures: Final = {key: measure for key, measure in measures.items() if self._is_in_both(measure)}
        self.leaves: Final = {key for key in self.measures if any(row["leaf"] for row in rows[key])}
        places = {unit for measure in self.measures.values() for unit in measure}
        self.units: Final = sorted(places, key=lambda unit: (unit.side != sides[0], unit.stratum, unit.number))
        first_units, second_units = ([unit.stratum for unit in self.units if unit.side == side] for side in sides)
        self.shuffles: Final = Shuffles(first_units, second_units)
        self.failures: Final[Sequence[FailedRuns]] = failed_runs(self._asked(questions.FAILURES), sides)
        self.rates: Final = compared_rates(self._asked(questions.RATES), sides)

    def symbol(self, key: Key) -> str:
        """The unit in which a measure is shown."""
        return self._symbols.get(key, "s") if key.requirement else "s"

    def is_duration(self, key: Key) -> bool:
        return is_time(self.symbol(key))

    def one_sided(self) -> tuple[int, int]:
        """How many nodes were active on each side and not on the other."""
        numbers = {row["side"]: row["number"] for row in self._asked(questions.ONE_SIDED)}
        return numbers.get(self.sides[0], 0), numbers.get(self.sides[1], 0)

    def inside(self, keys: Sequence[Key]) -> dict[Key, Collection[Key]]:
        """For some nodes and clauses, the others around them: those that were active whenever they were."""
        rows = self._asked(questions.INSIDE, keys=questions.numbered(keys), sample=questions.SAMPLE)
        around = grouped((keys[row["around"]], keys[row["within"]]) for row in rows)
        return {key: {*around.get(key, ())} for key in keys}

    def failed_together(self, keys: Sequence[Key]) -> Sequence[Row]:
        """In how many runs the same ones of some nodes and clauses failed, by their places."""
        return self._asked(questions.FAILED_TOGETHER, keys=questions.numbered(keys))

    def _is_in_both(self, measure: Measure) -> bool:
        sides = grouped((unit.stratum, unit.side) for unit in measure)
        return any(len({*sides_of_stratum}) > 1 for sides_of_stratum in sides.values())

    def _asked(self, question: str, **words: object) -> Sequence[Row]:
        return self._ask(question.format(**self._words, **words))


def _over(first: set[str], second: set[str]) -> Over:
    """What is shuffled, for the robots of the two sides."""
    if max(len(first), len(second)) == 1:
        return "runs"
    return "runs of each robot" if first <= second or second <= first else "robots"


def _measure(rows: Sequence[Row]) -> Measure:
    return {
        ShuffledUnit(row["side"], row["stratum"], row["unit"]): Values(
            row["number"], row["mean"], row["rank"], row["end_us"]
        )
        for row in rows
    }


def _key(row: Row) -> Key:
    return Key(row["requirement"], row["clause"], row["node"])


_MOST_UNITS: Final = 256  # of the smaller side: more show hardly more, and each shuffle takes as much longer
