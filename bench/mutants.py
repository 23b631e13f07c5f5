"""How many bugs the tests find: a bug is put into a copy of the checkout, and the tests of its room run.

One invariant: what is compared is a rate, found of all, per room and with one seed.  Which places are taken follows
from the source, so a rewritten module has others.  Each kind of bug has the same share of the places, so that a table
of a thousand strings does not outweigh the code beside it.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from mutators import Mutant, mutants, with_bug

ROOT = Path(__file__).resolve().parents[1]

# The modules of a room, and the tests that must find a bug in them, the quickest first; globs.
ROOMS = {
    "parser": (
        "lexer.py parser.py syntax/suggestions.py grammar/*.py",
        "grammar/test_lexer.py grammar/test_parser*.py grammar/test_*.py",
    ),
    "checks": ("checks/*.py", "diagnostics/test_rules.py requirements/test_budgets.py checks/test_*.py"),
    "btcpp": ("btcpp/**/*.py", "commands/test_build.py btcpp/test_*.py"),
}
# They take a minute, and are there to find what crashes or is kept too long, not what is wrong.
IGNORED = ("*robust*.py", "*_kept.py", "*corpus*.py")


def chosen(room: str, seed: int, places: int) -> list[Mutant]:
    """As many bugs of each kind as of any other, while there are some; the first of many are those of few."""
    chance = random.Random(seed)
    of_kind: dict[str, list[Mutant]] = {}
    for path in sorted({path for pattern in ROOMS[room][0].split() for path in (ROOT / "btq_lang").glob(pattern)}):
        for mutant in mutants(path.read_text(encoding="utf-8"), path.relative_to(ROOT).as_posix()):
            of_kind.setdefault(mutant.kind, []).append(mutant)
    piles = [chance.sample(pile, len(pile)) for _, pile in sorted(of_kind.items())]
    return [pile[turn] for turn in range(places) for pile in piles if turn < len(pile)][:places]


def run(room: str, taken: list[Mutant], seconds: float) -> Iterator[tuple[Mutant, str, float]]:
    """Each bug, what became of it (`survived`, `timed out`, or the test that found it), and the seconds that took.

    Args:
        seconds: how long the tests of one bug may take; never less than three times what they take without.

    Raises:
        RuntimeError: the tests fail without any bug, or do not run in the copy.
    """
    with tempfile.TemporaryDirectory(prefix="btq-mutants-") as folder:
        copy = Path(folder) / ROOT.name
        names = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True).split("\0")
        for name in filter(lambda name: (ROOT / name).is_file(), names):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, copy / name)
        environment = {"BTQ_SHARED": str(ROOT.parent / "shared"), **os.environ, "PYTHONPATH": str(copy)}
        probe = [sys.executable, "-c", "import btq_lang; print(btq_lang.__file__)"]
        if not Path(subprocess.check_output(probe, cwd=copy, env=environment, text=True)).is_relative_to(copy):
            raise RuntimeError(f"the btq_lang that is imported is not the one in {copy}")
        found = [sorted((copy / "tests").glob(pattern)) for pattern in ROOMS[room][1].split()]
        if not all(found):
            raise RuntimeError(f"of the tests of {room} some are not where they were: {ROOMS[room][1]}")
        paths = dict.fromkeys(path for some in found for path in some if not any(map(path.match, IGNORED)))
        tests = [str(path.relative_to(copy)) for path in paths]
        began = time.monotonic()
        if (outcome := _test(tests, copy, environment, None)) != "survived":
            raise RuntimeError(f"without any bug the tests of {room} fail: {outcome}")
        limit = max(seconds, 3 * (time.monotonic() - began))
        environment["PYTHONDONTWRITEBYTECODE"] = "1"  # bytecode of two bugs of one second and one size is mixed up
        for mutant in taken:
            began = time.monotonic()
            path = copy / mutant.path
            source, known = path.read_bytes(), path.stat()
            path.write_text(with_bug(source.decode(), mutant.number), encoding="utf-8")
            yield mutant, _test(tests, copy, environment, limit), round(time.monotonic() - began, 1)
            path.write_bytes(source)
            os.utime(path, ns=(known.st_atime_ns, known.st_mtime_ns))  # its bytecode is of this time


def _test(tests: list[str], copy: Path, environment: dict[str, str], limit: float | None) -> str:
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=no", *tests]
    with subprocess.Popen(
        command, cwd=copy, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True
    ) as process:
        try:
            output = process.communicate(timeout=limit)[0].decode(errors="replace")
        except subprocess.TimeoutExpired:
            return "timed out"
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)  # with what the tests have started
    failed = [line for line in output.splitlines() if line.startswith(("FAILED ", "ERROR "))]
    return "survived" if process.returncode == 0 else "".join(failed[:1]) or output[-500:]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--room", choices=list(ROOMS), action="append", help="default: all")
    parser.add_argument("--places", type=int, default=60, help="bugs, divided among the rooms")
    parser.add_argument("--seconds", type=float, default=60, help="how long the tests of one bug may take")
    parser.add_argument("--list", action="store_true", help="print the bugs and run nothing")
    parser.add_argument("--json", action="store_true", help="print JSON, and progress as messages")
    options = parser.parse_args()
    out = sys.stderr if options.json else sys.stdout
    rooms = options.room or list(ROOMS)
    measured: list[dict[str, object]] = []
    for room in rooms:
        taken = chosen(room, options.seed, options.places // len(rooms))
        if options.list:
            print(*taken, sep="\n")
            continue
        outcomes = []
        try:
            for mutant, outcome, seconds in run(room, taken, options.seconds):
                outcomes.append(outcome if outcome in ("survived", "timed out") else "killed")
                by = outcome if outcomes[-1] == "killed" else ""
                measured.append({"room": room, **asdict(mutant), "outcome": outcomes[-1], "by": by, "seconds": seconds})
                print(f"{outcomes[-1]:9} {mutant}", file=out, flush=True)
        except RuntimeError as error:
            parser.exit(2, f"{error}\n")
        counts = ", ".join(f"{outcomes.count(each)} {each}" for each in ("killed", "survived", "timed out"))
        print(f"{room}: {counts}", file=out, flush=True)
    if options.json and not options.list:
        print(json.dumps({"seed": options.seed, "bugs": measured}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
