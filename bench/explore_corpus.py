"""How many trees of a folder `btq explore` closes: `python bench/explore_corpus.py FOLDER… [--states N] [--seconds S]`.

Each main tree of each XML file is searched once with the standard questions.  Prints those that are not closed, and on
the last lines the counts, the processor time and the most memory.
"""

from __future__ import annotations

import resource
import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import process_time

from btq_lang.exploration.missions import ExploredMission, NotExplored, explorable
from btq_lang.exploration.search import SearchBudget
from btq_lang.exploration.surveys import surveyed
from btq_lang.projects.files import Files


def explored(paths: Sequence[Path], budget: SearchBudget) -> Iterator[tuple[str, str]]:
    """Each file that has a main tree, with what came of it in a word."""
    for path in paths:
        for group in Files().groups([str(path)], None)[0]:
            for mission in explorable(group.workspace, group.given):
                began = process_time()
                try:
                    survey = surveyed(ExploredMission(group.workspace, mission), budget)
                except NotExplored:
                    yield path.name, "not loaded"
                    continue
                word = "closed" if survey.is_closed else "unknown" if survey.unknown else "cut off"
                if word != "closed":
                    print(f"{path.name}: {word}, {survey.states} states, {process_time() - began:.1f} s", flush=True)
                yield path.name, word


def main(arguments: Sequence[str]) -> None:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--states", type=int, default=100_000)
    parser.add_argument("--seconds", type=float)
    options = parser.parse_args(arguments)
    paths = sorted(path for folder in options.folders for path in folder.rglob("*.xml"))
    words = Counter(word for _, word in explored(paths, SearchBudget(options.states, options.seconds)))
    loaded = sum(words.values()) - words["not loaded"]
    share = f", {words['closed'] / loaded:.1%} of the {loaded} that load" if loaded else ""
    print(", ".join(f"{number} {word}" for word, number in sorted(words.items())) + share)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{process_time():.0f} s of processor time, at most {memory:.0f} MB")


if __name__ == "__main__":
    main(sys.argv[1:])
