"""The options of `btq test`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.scenarios import FORMATS
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.commands.suggesting_parser import SuggestingParser


class ScenarioOptions(Record):
    """The options of `btq test`.

    Attributes:
        paths: files and folders, or `-` for standard input.
        title: only scenarios whose titles contain this text.
        target: the version of the engine; None: the newest of the project.
        no_enforce: without the nodes that enforce requirements.
        show: draw the runs of all scenarios.
        coverage: say what no scenario has met.
        mutants: say which changes of the tree no scenario notices: of so many; 0: of all; None: no.
        rules: the file for the engine's substitution rules that say what is given; None: the scenario runs.
        engine: the prefix of an installed engine in which they run, too; empty: wherever it is found; None: no.
        jobs: the number of processes; 0: as many as there are processors, if there are many scenarios.
    """

    paths: Sequence[str]
    stdin_filename: str | None
    title: str
    target: str | None
    no_enforce: bool
    show: bool
    coverage: bool
    mutants: int | None
    rules: str | None
    engine: str | None
    jobs: int
    format: str | None
    output: str | None
    watch: bool
    color: str


def add_scenario_options(parser: SuggestingParser) -> None:
    """Add the options to a command, without those that most commands have."""
    from btq_lang.catalog.versions import targets  # of the catalog, which not every reader of this module needs

    parser.add("-k", "--title", default="", metavar="TEXT", help="only scenarios with this text in their titles")
    parser.add("--target", choices=targets(), help="the engine's version; default: the project's newest")
    parser.flag("--no-enforce", "run the tree as btq build --no-enforce writes it")
    parser.flag("--show", "draw the run of each scenario, and not only of those that fail")
    parser.flag("--coverage", "say which outcomes of nodes no scenario has met")
    parser.add(
        "--mutants",
        nargs="?",
        type=int,
        const=0,
        metavar="N",
        help="change the tree in many ways, and say which changes no scenario notices; N: only so many of them",
    )
    parser.add("--rules", metavar="FILE", help="write what a scenario gives as substitution rules of the engine")
    parser.add(
        "--engine",
        nargs="?",
        const="",
        metavar="PREFIX",
        help="run them in an installed BehaviorTree.CPP, too, and judge what it does; PREFIX: where it is installed",
    )
    parser.add("--jobs", type=int, default=0, metavar="N", help="run them in N processes; default: by their number")
    parser.add("--format", choices=FORMATS, help="default: as the file of -o ends, else text")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    parser.flag("--watch", "run again whenever a file changes, until Ctrl+C")
