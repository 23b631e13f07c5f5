"""Trees that language models wrote for five tasks: right, wrong or refused, as the real engine says."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

from generated_trees import results


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
