"""The options of `btq simulate`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.prediction import FORMATS
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.commands.suggesting_parser import SuggestingParser


class SimulateOptions(Record):
    """The options of `btq simulate`.

    Attributes:
        paths: the mission, or a folder with one.
        tree: the tree that the program creates; None: the main tree.
        measured: logs, or a store, that show what skills do; none: those of the project.
        label: of the runs in a store that count.
        check: exit 1 where a demand will be missed, and stop when all is decided.
        template: print the table of btq.toml for skills of which nothing is known.
        show: a requirement of which a run is drawn that misses it, or that comes closest.
        jobs: the number of processes; 0: as many as there are processors.
    """

    paths: Sequence[str]
    stdin_filename: str | None
    tree: str | None
    runs: int
    seed: int
    measured: Sequence[str]
    label: str | None
    target: str | None
    no_enforce: bool
    check: bool
    template: bool
    show: str | None
    jobs: int
    format: str | None
    output: str | None
    color: str


def add_simulate_options(parser: SuggestingParser, of_project: str) -> None:
    """Add the options to a command, without those that most commands have.

    Args:
        of_project: which logs a project has, in words.
    """
    from btq_lang.catalog.versions import targets  # of the catalog, which not every reader of this module needs

    parser.add("--tree", metavar="ID", help="the tree that the program creates; default: the main tree")
    parser.add("--runs", type=int, default=10_000, metavar="N", help="how many runs; default: 10000")
    parser.add("--seed", type=int, default=1, metavar="N", help="of what is drawn; default: 1")
    parser.add(
        "--from",
        action="append",
        default=[],
        dest="measured",
        metavar="PATH",
        help="a log, a folder of logs, or a store, that shows what skills do; may be repeated; default: " + of_project,
    )
    parser.add("--label", metavar="NAME", help="only runs in the store with this label")
    parser.add("--target", choices=targets(), help="the engine's version; default: the project's newest")
    parser.flag("--no-enforce", "run the tree as btq build --no-enforce writes it")
    parser.flag("--check", "exit 1 where a demand will be missed; stop as soon as all demands are decided")
    parser.flag("--template", "print the lines of btq.toml for the skills of which nothing is said")
    parser.add("--show", metavar="ID", help="draw a run that misses this requirement, or comes closest")
    parser.add("--jobs", type=int, default=0, metavar="N", help="run in N processes; default: by their number")
    parser.add("--format", choices=FORMATS, help="default: as the file of -o ends, else text")
    help_text = "where to write; default: standard output; with --show FILE.btlog: a log, FILE.btq: a scenario"
    parser.add("-o", "--output", metavar="FILE", help=help_text)
