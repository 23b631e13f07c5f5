"""How the time of a parse grows with texts that are made to be slow: no more than n log n, whatever the text.

One invariant: a shape is a text of any length, so the same is read in two lengths, one after the other, and the least
of several times counts: what a neighbour on the machine adds never makes a shape look better.
"""

from __future__ import annotations

import argparse
import math
import time

from report import Goal, machine, shown

from btq_lang import parse

SHORT, TIMES = 30_000, 8
# Between n log n, 9.6 times, and n squared, 64 times; above the first by what a busy machine adds.
ALLOWED = TIMES * math.log(SHORT * TIMES) / math.log(SHORT) * 1.5

TREE = "BehaviorTree t\n"
# What each begins with, and what is repeated.
SHAPES = {
    "opening brackets": ("", "("),
    "closing brackets": ("", ")"),
    "quotes": ("", '"'),
    "a string without end": (TREE + '  X (a = "', "b\n  "),
    "backslashes in a string": (TREE + '  X (a = "', "\\"),
    "comments without end": ("", "/* "),
    "lines with a comment without end": (TREE, "  /* a\n"),
    "braces": (TREE + "  X (a = ", "{"),
    "one name": (TREE + "  ", "x"),
    "digits": ("context a : b < ", "7"),
    "units that nobody knows": ("QualityReq a takes at most ", "30sek "),
    "words on one line": (TREE + "  ", "a "),
    "a list of tags": (TREE + "  X tags ", "a, "),
    "a list of requirements": (TREE + "  X\n    satisfies ", "QualityReq a, "),
    "a path": ("apply a to ", "a/"),
    "a quality": ("QualityReq a : ", "a."),
    "signs": ("context a : ", "- "),
    "negations": ("context a : ", "not "),
    "brackets in a condition": ("context a : ", "(b or "),
    "values for each situation": ("QualityReq a takes at most ", "1 s if b, "),
    "symbols": (TREE + "  ", "R?->"),
    "attributes on one line": (TREE + "  X (", "a = 1 "),
    "a bracket without end on each line": (TREE, "  X (\n"),
    "brackets over lines": (TREE + "  X (\n", "  a (b\n"),
    "a string without end on each line": (TREE, "  X (a = 'b\n"),
    "columns that no block has": (TREE + "    ->\n", "        X\n      Y\n"),
    "tabs and spaces by turns": (TREE, "  ->\n\tX\n"),
    "clauses after children": (TREE + "  ->\n    X\n", "    satisfies a\n"),
    "trees without a node": ("", TREE),
    "requirements without a name": ("", "QualityReq\n  takes\n"),
    "line ends of all kinds": (TREE, "  a\r\n\r  b\n\n"),
    "ever deeper lines": (TREE, ""),
}


def text(shape: str, length: int) -> str:
    """A text of a shape, of about so many characters."""
    head, unit = SHAPES[shape]
    if not unit:  # as many levels as take so many characters
        return head + "".join(" " * level + "->\n" for level in range(1, int(math.sqrt(2 * length)) - 3))
    return head + unit * ((length - len(head)) // len(unit))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3, help="parses of each length (default 3)")
    rounds = parser.parse_args().rounds
    grown = {}
    for shape in SHAPES:
        short, long = (least(text(shape, length), rounds) for length in (SHORT, SHORT * TIMES))
        grown[shape] = (long / short, short, long)
    print(machine())
    print(f"\n| shape | {SHORT:,} characters | {SHORT * TIMES:,} | times |\n|---|---|---|---|")
    for shape, (times, short, long) in sorted(grown.items(), key=lambda item: -item[1][0]):
        print(f"| {shape} | {1000 * short:.1f} ms | {1000 * long:.1f} ms | {times:.1f} |")
    shape, (worst, _, _) = max(grown.items(), key=lambda item: item[1][0])
    goal = Goal(f"{TIMES} times the length, {shape}: times <= {ALLOWED:.1f}", worst, worst <= ALLOWED)
    print("", *shown([goal]), sep="\n")


def least(given: str, rounds: int) -> float:
    """Processor seconds."""
    seconds = []
    for _ in range(rounds):
        begin = time.process_time()
        parse(given)
        seconds.append(time.process_time() - begin)
    return min(seconds)


if __name__ == "__main__":
    main()
