"""Whether `btq` and `btq-lsp` do what they did at the frozen commit, in some thousands of cases.

    python tests/freeze                                compare all (some ten minutes), or
    python tests/freeze --group damaged --every 20     a part of it; --shard 1/4 a fourth of the work
    python tests/freeze --python venv/bin/python       what is installed there, compiled or not
    python tests/freeze --case damaged:17              how a case differs from what the frozen commit does
    python tests/freeze --write HEAD                   freeze another commit; with --group only what these do

The cases come from the files of a commit, from ../shared (BTQ_SHARED) and from chance with fixed seeds.  Normalized are
the folder of a case, btq's version, where pages of rules are, the words of an internal error, and the ids of results.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

import frozen
from cases import set_shared
from comparing import compare, groups, needs_shared, read, replay, write
from processes import HERE, Code, Commands, code_of


def main() -> int:
    """Run the command; 0: as it was, 1: not."""
    parser = argparse.ArgumentParser(
        "python tests/freeze", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--group", action="append", choices=groups(), help="these groups alone")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="every N-th case alone")
    parser.add_argument("--shard", default="1/1", metavar="I/N")
    parser.add_argument("--python", help="the interpreter whose installed btq is looked at; default: this checkout")
    parser.add_argument("--case", metavar="GROUP:NUMBER", help="show how a case differs")
    parser.add_argument("--against", metavar="REV", help="with --case: from what; default: the frozen commit")
    parser.add_argument("--write", metavar="REV", help="write the golden files as this commit has them")
    parser.add_argument("--inputs", metavar="REV", help="with --write: where the cases come from; default: as before")
    options = parser.parse_args()
    shared = Path(os.environ.get("BTQ_SHARED") or frozen.ROOT.parent / "shared")
    has_shared = (shared / "facts").is_dir()
    set_shared(shared)
    if options.write:
        if not has_shared:
            parser.error(f"no shared inputs at {shared}: set BTQ_SHARED")
        before = read()
        head = frozen.begin(options.write, options.inputs)
        with code_of(options.write) as code:
            write(code, head, before, options.group or groups())
        return 0
    here = Code(options.python, None) if options.python else HERE
    if options.case:
        name, _, number = options.case.partition(":")
        with code_of(options.against or frozen.behaviour()) as code:
            lines = list(replay(code, here, name, int(number)))
        print("\n".join(lines) if lines else "no difference")
        return int(bool(lines))
    names = options.group or groups()
    left_out = [name for name in names if needs_shared(name) and not has_shared]
    if left_out:
        print(f"left out, for there are no shared inputs at {shared} (BTQ_SHARED): {', '.join(left_out)}")
    at, parts = map(int, options.shard.split("/"))
    differences = 0
    with Commands(here) as commands:
        chosen = [name for name in names if name not in left_out]
        for difference in compare(commands, chosen, options.every, (at - 1, parts)):
            differences += 1
            print(difference, flush=True)
    commit = frozen.behaviour()[:12]
    print(f"{differences} cases differ from {commit}; --case GROUP:NUMBER shows how" if differences else f"as {commit}")
    return int(bool(differences))


if __name__ == "__main__":
    sys.exit(main())
