"""How fast btq's parser is, on three inputs: beside every installed peer, or beside another commit of btq.

One invariant: only figures of one run are compared.  Every parser has a process of its own (worker.py), and the
processes take turns.  `--against e6dc97b` measures that commit, the one before the parser was rebuilt.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Sequence
from pathlib import Path

import drawn_missions
import inputs
import peers
import rates
import report
from forms import Form, checkout_of, forms
from turns import ROOT


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print; the exit code says nothing about speed."""
    options = _options(arguments)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        own = forms(ROOT, folder, options.compiled)
        three = list(inputs.three(folder, options.seed))
        if options.against:
            with checkout_of(options.against, folder) as other:
                both = [*own, Form(f"{options.against} interpreted", other)]
                measured = rates.measure(both, three, options.rounds)
            results: list[peers.Result] = []
            missing: dict[str, str] = {}
            goals = rates.compare(measured, options.against)
        else:
            measured = rates.measure(own, three, options.rounds)
            sizes = [peers.SMALL, peers.MIDDLE] + ([] if options.quick else [peers.LARGE])
            files = peers.write_missions(folder, sizes)
            results, missing = peers.measure(peers.tools(own), files, options.rounds, options.only)
            goals = rates.compare(measured) + peers.compare(results)
    if options.json:
        data = {"seed": options.seed, "inputs": rates.as_data(measured)}
        print(json.dumps(report.as_data(data | {"tools": peers.as_data(results), "missing": missing}, goals), indent=2))
    else:
        lines = [report.machine(), "", *rates.as_text(measured, options.against), ""]
        lines += [*peers.as_text(results, missing), ""] if results else []
        print("\n".join([*lines, *report.shown(goals)]))


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--against", default="", metavar="COMMIT", help="compare with a commit and not with peers")
    parser.add_argument("--compiled", action="store_true", help="also compiled, which takes some minutes")
    parser.add_argument("--rounds", type=int, default=11, help="parses of each tool at each size (default 11)")
    parser.add_argument("--quick", action="store_true", help="leave the 100 000 nodes out")
    parser.add_argument("--only", default="", metavar="TEXT", help="beside btq, only peers with TEXT in their name")
    today = drawn_missions.seed_of_the_day()
    parser.add_argument("--seed", type=int, default=today, help="of the drawn missions; default: the date as a number")
    parser.add_argument("--json", action="store_true", help="print JSON with every single time")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main()
