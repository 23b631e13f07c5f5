"""Trees that language models wrote for five tasks: right, wrong or refused, as the real engine says."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

from generated_trees import results, suite_of

from btq_lang.scenarios.mutants import mutants
from btq_lang.scenarios.outcomes import NodeOutcomes


def test_what_the_engine_says_of_every_tree(shared: Path) -> None:
    folder = shared / "corpus" / "generated"
    verdicts: Counter[str] = Counter()
    different = []
    with open(folder / "TRUTH.tsv", encoding="utf-8") as rows:
        for row in csv.DictReader(rows, delimiter="\t"):
            last = results((folder / row["file"]).read_text(encoding="utf-8"), row["task"])[-1]
            verdict = {"passed": "right", "failed": "wrong"}.get(last.outcome, last.outcome)
            # Nor does the engine know which of several trees to create.
            verdict = "refused" if last.ended == "is refused" or not last.tree else verdict
            wanted = row["task_verdict"] or "refused"
            first_wrong = row["first_wrong_scenario"].partition(" ")[0]
            if verdict != wanted or (verdict == "wrong" and last.title != first_wrong):
                different.append((row["file"], verdict, last.title, last.why, row["first_wrong_scenario"]))
            verdicts[verdict] += 1
    assert different == []
    assert verdicts == {"refused": 226, "right": 120, "wrong": 46}


def test_which_changes_of_the_right_trees_their_scenarios_notice(shared: Path) -> None:
    folder = shared / "corpus" / "generated"
    noticed: Counter[bool] = Counter()
    with open(folder / "TRUTH.tsv", encoding="utf-8") as rows:
        right = [row for row in csv.DictReader(rows, delimiter="\t") if row["task_verdict"] == "right"]
    for row in right:
        suite = suite_of((folder / row["file"]).read_text(encoding="utf-8"), row["task"])
        ran = [suite.ran(place, False) for place, _ in suite.places("case.btq")]
        places = [place for place, _ in suite.places("case.btq")]
        mission = ran[0].mission
        assert mission is not None
        outcomes = NodeOutcomes(mission)
        for each in ran:
            assert each.run is not None
            assert [
                (place, word) for place, word in outcomes.met(each.run) if word not in outcomes.possible[place]
            ] == []
        for named in mutants(mission, outcomes):
            noticed[any(suite.ran(place, False, named.mutant).result.outcome != "passed" for place in places)] += 1
    assert noticed == {True: 946, False: 12}
