"""The command line for argparse: the commands and their options, without importing the commands."""

from __future__ import annotations

import os
from argparse import ArgumentTypeError, RawDescriptionHelpFormatter
from collections.abc import Callable
from functools import cache
from typing import Final, TypeAlias

from btq_lang.commands.simulate_options import add_simulate_options
from btq_lang.commands.suggesting_parser import SuggestingParser
from btq_lang.commands.testing_options import add_scenario_options
from btq_lang.commands.verify_options import VerifyOptions, add_verify_options
from btq_lang.evidence.compare import FORMATS as COMPARISON_FORMATS
from btq_lang.exploration import FORMATS as EXPLORE_FORMATS
from btq_lang.graph import DIRECTIONS
from btq_lang.graph import FORMATS as GRAPH_FORMATS
from btq_lang.projects.options import CheckOptions, add_server_options
from btq_lang.render import FORMATS
from btq_lang.trace import FORMATS as TRACE_FORMATS
from btq_lang.util.record import as_dict
from btq_lang.util.version import __version__

SEVERITIES = ("error", "warning", "info", "hint")


@cache
def build_parser() -> SuggestingParser:
    """The parser of the command line, from which shell completion and documentation are generated, too.

    Its result has the command's name as `command` and the command's own parser as `parser`.
    """
    parser = SuggestingParser(
        prog="btq",
        description="Quality-aware behavior trees for BehaviorTree.CPP: check, build and understand .btq files.",
        epilog="exit codes: 0 clean, 1 findings, 2 usage or I/O\n\nstart here: btq init my-robot && btq check my-robot",
        formatter_class=RawDescriptionHelpFormatter,
    )
    parser.add("-V", "--version", action="version", version=f"btq {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for name, help, epilog, add_options in _COMMANDS:
        command = commands.add_parser(
            name,
            help=help,
            description=help[0].upper() + help[1:] + ".",
            formatter_class=RawDescriptionHelpFormatter,
            epilog=epilog,
        )
        command.set_defaults(command=name, parser=command)
        add_options(command)
    return parser


_Adder: TypeAlias = "Callable[[SuggestingParser], None]"
_COMMANDS: Final[list[tuple[str, str, str | None, _Adder]]] = []  # name, help, epilog, and what adds the options


def _command(name: str, help: str, epilog: str | None = None) -> Callable[[_Adder], _Adder]:
    """Register a command with the function that adds its options; the order is that of the help."""

    def register(add_options: _Adder) -> _Adder:
        _COMMANDS.append((name, help, epilog, add_options))
        return add_options

    return register


def _add_paths(parser: SuggestingParser) -> None:
    parser.add(
        "paths", nargs="*", default=["."], metavar="PATH", help="files and folders, `-` for standard input; default: ."
    )
    parser.add("--stdin-filename", metavar="FILE", help="the file name of standard input, for resolving its includes")


@_command(
    "check",
    "find mistakes in missions before the robot does",
    "exit codes: 0 clean, or only infos and hints; 1 errors or warnings, or (--diff) changes to make;\n"
    "2 usage or I/O\n\n"
    "examples:\n  btq check                          the project in this folder\n"
    "  btq check --fix mission.btq        and apply the safe fixes\n"
    "  btq check --statistics             which rules have most findings\n",
)
def _add_check(parser: SuggestingParser) -> None:
    _add_paths(parser)
    parser.add(
        "--output-format", choices=FORMATS, help="default: full; on GitHub github, on GitLab with --output-file gitlab"
    )
    parser.add("-o", "--output-file", metavar="FILE", help="where to write; default: standard output")
    parser.flag("--statistics", "only the number of findings of each rule")
    parser.flag("--exit-zero", "exit 0 also with errors and warnings")
    parser.add("--select", action="append", metavar="RULES", help="only these rules, separated by commas")
    parser.add("--ignore", action="append", metavar="RULES", help="all rules except these, separated by commas")
    parser.add("--severity", choices=SEVERITIES, help="report this severity and worse; default: hint")
    from btq_lang.catalog.nav2 import PACKAGED  # of the catalog, which not every reader of this module needs
    from btq_lang.catalog.versions import targets

    parser.add(
        "--target",
        choices=(*targets(), *PACKAGED),
        metavar="TARGET",
        help="also what this version of the engine (4.6 … 4.10), or this distribution of Nav2 (nav2-iron … "
        "nav2-lyrical), changes for trees of an earlier one",
    )
    parser.add(
        "--nav2-params",
        action="append",
        metavar="FILE",
        help="also a parameter file of Nav2, and the trees as it loads them; a FILE.yaml among the paths is one too",
    )
    parser.flag("--fix", "apply the safe fixes")
    parser.flag("--diff", "write nothing, show what --fix would change; exit 1 if there is anything")
    parser.add(
        "--since",
        metavar="REV",
        help="only files that changed since a git revision, and those that depend on such a file",
    )
    parser.add(
        "--baseline", metavar="FILE", help="do not report the findings in this file; default: `baseline` of btq.toml"
    )
    parser.flag("--update-baseline", "write the findings of today into the baseline")
    parser.add(
        "--add-ignore",
        nargs="?",
        const="",
        metavar="REASON",
        help="write a comment that silences them for all findings; with `=`, it says why",
    )
    parser.flag("--watch", "check again whenever a file changes")
    parser.flag("--show-files", "check nothing, print the files that would be checked")
    parser.flag(
        "--show-settings", "check nothing, print the settings that hold for the paths, and where each comes from"
    )
    parser.add("-q", "--quiet", action="store_true", help="print findings alone, without a summary")
    parser.add("--jobs", type=int, metavar="N", help="number of processes; default: chosen by btq")
    _add_config(parser)
    _add_color(parser)
    _set_defaults(parser, CheckOptions())


@_command(
    "format",
    "normalize indentation, spaces and the order of clauses",
    "exit codes: 0 formatted; 1 files with syntax errors, left unchanged, or changes to make\n"
    "(--check, --diff); 2 usage or I/O\n\n"
    "examples:\n  btq format                   the project in this folder\n"
    "  btq format --check           in CI: is everything formatted?\n"
    "  btq format - < mission.btq   to standard output\n",
)
def _add_format(parser: SuggestingParser) -> None:
    _add_paths(parser)
    parser.flag("--check", "write nothing; exit 1 if a file would change")
    parser.flag("--diff", "write nothing, show the changes; exit 1 if there are any")
    _add_config(parser)
    _add_color(parser)


@_command(
    "build",
    "write missions as XML that BehaviorTree.CPP loads",
    "exit codes: 0 written, 1 errors in the missions or (--check) files out of date, 2 usage or I/O\n\n"
    "examples:\n  btq build mission.btq              mission.xml, and one file for each included one\n"
    "  btq build missions -o install      below another folder\n"
    "  btq build --check                  in CI: does the XML match the missions?\n",
)
def _add_build(parser: SuggestingParser) -> None:
    from btq_lang.catalog.versions import targets  # of the catalog, which not every reader of this module needs

    _add_paths(parser)
    _add_folder(parser, "FOLDER", "where to write; default: beside the missions")
    parser.flag("--bundle", "each mission in one file with all that it needs")
    parser.add("--target", choices=targets(), help="the engine's version; default: the project's newest")
    parser.flag("--no-enforce", "the plain tree, without the nodes that enforce requirements")
    parser.flag("--verbatim", "exactly the content of the file: no repairs and no additions")
    parser.flag("--check", "write nothing; exit 1 if a file is not up to date")
    parser.flag("--force", "overwrite XML that btq did not write")
    parser.flag("--verbose", "show for every clause whether and how it is enforced")
    parser.flag("--watch", "build again whenever a file changes")
    _add_config(parser)
    _add_color(parser)


def _add_folder(parser: SuggestingParser, metavar: str, help: str) -> None:
    def folder(path: str) -> str:
        if path == "-":
            raise ArgumentTypeError("expected a folder; input from `-` goes to standard output")
        if path.endswith((".btq", ".xml")) and not os.path.isdir(path):
            raise ArgumentTypeError("expected a folder; each file keeps its name there")
        return path

    parser.add("-o", "--output", type=folder, metavar=metavar, help=help)


@_command(
    "import",
    "convert BehaviorTree.CPP XML, and the trees in logs, to .btq files",
    "exit codes: 0 imported; 1 XML that cannot be read; 2 usage or I/O\n\n"
    "examples:\n  btq import mission.xml          writes mission.btq beside it\n"
    "  btq import trees/*.xml -o btq   and into a folder\n"
    "  btq import - < mission.xml      to standard output\n"
    "  btq import run.btlog            the tree that ran\n",
)
def _add_import(parser: SuggestingParser) -> None:
    parser.add("files", nargs="+", metavar="FILE", help="XML files and logs, `-` for XML on standard input")
    _add_folder(parser, "DIR", "the folder to write into; default: that of each file")
    parser.flag("--keep-v3", "keep the syntax of files for version 3 of the engine")
    parser.flag("--xml", "of logs: write the tree as XML")
    parser.flag("--force", "overwrite existing files")
    _add_config(parser)
    _add_color(parser)


@_command(
    "trace",
    "show which requirements hold for which nodes, how they are enforced, and what is missing",
    "exit codes: 0 written; 1 written, but of missions with errors; 2 usage or I/O\n\n"
    "examples:\n  btq trace                               the project in this folder\n"
    "  btq trace --format html -o trace.html   a page with the trees\n"
    "  btq trace --format markdown             for a pull request\n"
    "  btq trace --evidence verdicts.json      with the verdicts that btq verify wrote\n",
)
def _add_trace(parser: SuggestingParser) -> None:
    _add_paths(parser)
    _add_evidence(parser, _OF_PROJECT)
    parser.flag("--bundle", "what is enforced in builds with --bundle")
    parser.add("--priority", action="append", default=[], metavar="NAME", help="only requirements of this priority")
    parser.add(
        "--quality", action="append", default=[], metavar="NAME", help="only those for this quality or its parts"
    )
    parser.add(
        "--state",
        action="append",
        default=[],
        metavar="STATE",
        help="only those that are enforced, violated, suspect, …",
    )
    parser.add("--format", choices=TRACE_FORMATS, help="default: by the suffix of the -o file, else table")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    _add_config(parser)
    _add_color(parser)


@_command(
    "test",
    "run the scenarios of missions without a robot: what happens when …",
    "exit codes: 0 all as expected; 1 a scenario failed, or is unknown; 2 usage, I/O, a mistake in a scenario,\n"
    "no scenario, or no engine\n\n"
    "examples:\n  btq test                           all scenarios below this folder\n"
    "  btq test tests/deliver.btq --show  and how each run went\n"
    "  btq test -k station                those with `station` in their titles\n"
    "  btq test --coverage --mutants      what they do not test\n"
    "  btq test --engine                  in an installed BehaviorTree.CPP, too\n"
    "  btq test --format junit -o scenarios.xml\n",
)
def _add_test(parser: SuggestingParser) -> None:
    _add_paths(parser)
    add_scenario_options(parser)
    _add_config(parser)
    _add_color(parser)


@_command(
    "verify",
    "judge what robots did, by their logs, against what the mission demands",
    "exit codes: 0 nothing violated; 1 a requirement violated (--strict: or not satisfied);\n"
    "2 usage, I/O, or nothing to read\n\n"
    "examples:\n  btq verify logs/*.btlog                            the mission is found by its nodes\n"
    "  btq verify run.db3 --mission mission.btq           or named\n"
    "  btq verify bag/ --mission nav.btq                  a ROS 2 bag with /behavior_tree_log of Nav2\n"
    "  btq verify run.db3 --signals battery.csv           with samples of signals\n"
    "  btq verify logs/ --format junit -o verdicts.xml    for CI\n"
    "  btq verify bag/ --events violations.mcap           for Foxglove and rqt_console\n"
    "  btq verify logs/ --store evidence --label v1.4     kept beside earlier runs\n"
    "  btq verify --store evidence --by label             the verdicts of all that is kept\n"
    "  btq verify --live tcp://127.0.0.1:1667             a running robot, until Ctrl+C\n",
)
def _add_verify(parser: SuggestingParser) -> None:
    add_verify_options(parser)
    _add_config(parser)
    _add_color(parser)
    _set_defaults(parser, VerifyOptions())


@_command(
    "compare",
    "compare what robots did with two versions, by the verdicts in a store, or by logs",
    "exit codes: 0 nothing got worse; 1 something slower, less reliable or newly violated that chance\n"
    "does not explain; 2 usage, I/O, or nothing to compare\n\n"
    "examples:\n  btq compare evidence v1.3 v1.4                two labels of a store\n"
    "  btq compare evidence --by robot r7 r8         two robots\n"
    "  btq compare logs/v1.3 logs/v1.4               two folders of logs, without a store\n"
    "  btq compare evidence v1.3 v1.4 -o report.md   for a pull request\n",
)
def _add_compare(parser: SuggestingParser) -> None:
    # Two names alone are `store` and `before`: if `store` were the optional one, `STORE --by robot A B` would fail.
    parser.usage = (
        "btq compare [-h] [STORE] A B [--by {label,robot}] [--label LABEL] [--at-least PERCENT]\n"
        "                   [--format FORMAT] [-o FILE]"
    )
    parser.add("store", metavar="STORE", help=_STORE)
    parser.add("before", metavar="A", help="the label that is compared with, the robot, or a folder of logs")
    parser.add("after", metavar="B", nargs="?", help="the label, robot or folder that may have changed")
    parser.add("--by", choices=("label", "robot"), default="label", help="what A and B are; default: label")
    parser.add("--label", metavar="LABEL", help="with --by robot: only the runs of this label")
    parser.add(
        "--at-least",
        default="5 %",
        metavar="PERCENT",
        help="what a difference must be to be called a change; default: 5 %%",
    )
    parser.add("--format", choices=COMPARISON_FORMATS, help="default: as the file of -o ends, else table")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    _add_config(parser)


@_command(
    "report",
    "show what a store has as one page: what got worse, requirements by version and robot, trends",
    "exit codes: 0 nothing got worse between the last two labels, as btq compare says; 1 something did;\n"
    "2 usage, I/O, or nothing to show\n\n"
    "examples:\n  btq report evidence -o report.html                by version and robot\n"
    "  btq report evidence --by label -o report.html     without the robots\n"
    "  btq report evidence --sides v1.3 v1.5 -o report.html\n",
)
def _add_report(parser: SuggestingParser) -> None:
    parser.add("store", nargs="?", metavar="STORE", help=_STORE)
    parser.add(
        "--by",
        action="append",
        default=[],
        choices=("label", "robot"),
        help="what has columns or rows of its own; may be repeated; default: both",
    )
    parser.add("--sides", nargs=2, metavar=("A", "B"), help="the labels to compare; default: the two that began last")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    _add_config(parser)


@_command(
    "graph",
    "draw a mission's trees",
    "exit codes: 0 drawn, 2 usage or I/O\n\n"
    "examples:\n  btq graph mission.btq --qualities -o mission.svg   for documents\n"
    "  btq graph mission.btq --format mermaid             for pull requests\n"
    "  btq graph mission.btq --evidence logs/ -o now.svg  with what logs show of each requirement\n",
)
def _add_graph(parser: SuggestingParser) -> None:
    parser.add("paths", nargs=1, metavar="FILE", help="the mission, `-` for standard input")
    parser.add("--stdin-filename", metavar="FILE", help="the file name of standard input, for resolving its includes")
    parser.add("--format", choices=GRAPH_FORMATS, help="default: by the suffix of the -o file, else svg")
    parser.flag("--qualities", "show qualities and requirements beside their nodes")
    _add_evidence(parser, "none")
    parser.add("--direction", choices=DIRECTIONS, default="down", help="the position of the children; default: down")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    _add_config(parser)
    _add_color(parser)


@_command(
    "explore",
    "find out what can happen in a mission when its leaves do anything",
    "exit codes: 0 what is asked with --can can happen, and what is asked with --never cannot; without questions: no\n"
    "findings; 1 otherwise; 2 usage or I/O\n\n"
    "examples:\n  btq explore mission.btq --can 'Grasp starts before DetectCup succeeds'\n"
    "  btq explore mission.btq --never 'mission fails'\n"
    "  btq explore mission.btq --never 'Grasp halts' -o case.btq\n"
    "  btq explore mission.btq -o answers.html   a page with the runs\n"
    "  btq explore                        what never runs, never ends, is read unset\n",
)
def _add_explore(parser: SuggestingParser) -> None:
    _add_paths(parser)
    parser.add("--can", action="append", default=[], metavar="QUESTION", help="whether this can happen")
    parser.add("--never", action="append", default=[], metavar="QUESTION", help="whether this cannot happen")
    parser.add("--tree", metavar="ID", help="the tree that the program creates; default: the main tree")
    parser.add("--states", type=int, default=100_000, metavar="N", help="how many states to search; default: 100000")
    parser.add("--seconds", type=float, metavar="S", help="how much processor time to use; default: any")
    parser.flag("--strict", "exit 1 where a search was cut off")
    parser.flag("--show", "draw the runs that were found")
    parser.add("--format", choices=EXPLORE_FORMATS, help="default: as the file of -o ends, else text")
    help_text = (
        "where to write; default: standard output; FILE.btq: the runs as scenarios; FILE.btlog: the run as a log"
    )
    parser.add("-o", "--output", metavar="FILE", help=help_text)
    _add_config(parser)


@_command(
    "simulate",
    "predict whether a mission will do what it must: runs in which skills do what was declared or measured",
    "exit codes: 0 predicted; 1 (--check) a demand will be missed; 2 usage, I/O, or a condition that nobody answers\n\n"
    "examples:\n  btq simulate mission.btq                       skills as [simulate.skills] of btq.toml says\n"
    "  btq simulate mission.btq --from runs.btlog     and as logs show\n"
    "  btq simulate mission.btq --template            what is still to be said, for btq.toml\n"
    "  btq simulate mission.btq --show in_time -o run.btlog\n"
    "  btq simulate --check                           in CI\n",
)
def _add_simulate(parser: SuggestingParser) -> None:
    _add_paths(parser)
    add_simulate_options(parser, _OF_PROJECT)
    _add_config(parser)
    _add_color(parser)


@_command(
    "preview",
    "show a mission's trees in a browser, redrawn whenever a file is saved",
    "exit codes: 0 ended by Ctrl+C, 2 usage or I/O\n\n"
    "examples:\n  btq preview mission.btq --open\n"
    "  btq preview mission.btq --on-click 'emacsclient -n +{line}:{column} {file}'\n",
)
def _add_preview(parser: SuggestingParser) -> None:
    parser.add("file", metavar="FILE", help="the mission")
    parser.add("--port", type=int, default=0, metavar="N", help="the port, on this machine only; default: a free one")
    parser.flag("--open", "show it in the browser")
    _add_evidence(parser, _OF_PROJECT)
    parser.add(
        "--on-click",
        metavar="COMMAND",
        help="the command to run on a click on a node, with {file}, {line} and {column}; no shell",
    )
    parser.flag(
        "--follow",
        'for an editor: read {"line": N} and {"text": "…"} from standard input, an object a line, until it closes',
    )
    _add_config(parser)


@_command(
    "diff",
    "show what changed between two missions",
    "exit codes: 0 the same, 1 different, 2 usage or I/O\n\n"
    "examples:\n  btq diff old.btq new.btq                   two missions, XML or btq\n"
    "  btq diff --git HEAD                        what has changed since the last commit\n"
    "  btq diff --git main...HEAD --format markdown mission.btq\n"
    "  ssh robot cat mission.xml | btq diff - mission.btq\n",
)
def _add_diff(parser: SuggestingParser) -> None:
    parser.add(
        "paths",
        nargs="*",
        metavar="PATH",
        help="two files or folders, `-` for standard input; with --git any number, default: .",
    )
    parser.add("--stdin-filename", metavar="FILE", help="the file name of standard input, for resolving its includes")
    parser.add("--git", metavar="REV", help="compare revisions: REV with the working tree, REV..REV, or REV...REV")
    parser.add("--format", choices=("text", "markdown", "json"), default="text", help="default: text")
    _add_config(parser)
    _add_color(parser)


@_command(
    "approve",
    "write who has approved a requirement, and the fingerprint of what it means",
    "exit codes: 0 written, or approved already; 1 a requirement that cannot be approved; 2 usage or I/O\n\n"
    "examples:\n  btq approve slow --by Kim\n"
    "  btq approve slow rq7 --by Kim --in missions/\n",
)
def _add_approve(parser: SuggestingParser) -> None:
    parser.add("ids", nargs="+", metavar="ID", help="the IDs of requirements")
    parser.add("--by", required=True, metavar="NAME", help="who has approved them")
    parser.add(
        "--in", action="append", dest="paths", metavar="PATH", help="files and folders that define them; default: ."
    )
    parser.add("--date", metavar="DATE", help="when, as 2026-11-29; default: today")
    _add_config(parser)


@_command(
    "explain",
    "explain a rule, a node, a quality or a word of the language",
    "examples:\n  btq explain unknown-port\n  btq explain '->'\n  btq explain time-behaviour\n"
    "  btq explain on violation\n",
)
def _add_explain(parser: SuggestingParser) -> None:
    parser.add("subject", nargs="*", metavar="RULE|NODE|QUALITY|WORD", help="default: list the rules")
    _add_color(parser)


@_command(
    "nodes",
    "write the nodes that C++ sources register, with their ports, as models or as a page",
    "exit codes: 0 written; 1 written, with remarks on the sources; 2 usage, I/O, no btq-lang[cpp]\n\n"
    "examples:\n  btq nodes src -o nodes.btq                models to include in missions\n"
    "  btq nodes src --format xml -o nodes.xml   a palette for Groot\n"
    "  btq nodes src include -o nodes.html       a page for people\n",
)
def _add_nodes(parser: SuggestingParser) -> None:
    parser.add("paths", nargs="+", metavar="SRC", help="C++ files and folders")
    parser.add("--format", choices=("btq", "xml", "html"), help="default: by the suffix of the -o file, else btq")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")


@_command(
    "schema",
    "write the schema by which other editors check XML or btq.toml",
    "exit codes: 0 written; 1 written, but of files that cannot be read whole; 2 usage or I/O\n\n"
    "examples:\n  btq schema xsd -o btq.xsd                an XSD with the nodes of the project in this folder\n"
    "  btq schema xsd missions --target 4.6     for an older engine\n"
    "  btq schema project -o btq.schema.json    a JSON schema of btq.toml\n"
    "  btq schema simulate                      a JSON schema of btq simulate --format json\n",
)
def _add_schema(parser: SuggestingParser) -> None:
    from btq_lang.catalog.versions import targets  # as above

    parser.add(
        "format",
        choices=("xsd", "project", "simulate"),
        help="an XSD of the nodes, or a JSON schema: of btq.toml, or of what btq simulate writes",
    )
    parser.add("paths", nargs="*", metavar="PATH", help="of xsd: files and folders with nodes; default: .")
    parser.add("--target", choices=targets(), help="the engine's version; default: the project's newest")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    _add_config(parser)


@_command(
    "init",
    "create a project without findings",
    "exit codes: 0 created; 2 usage or I/O, or the project exists already\n\n"
    "examples:\n  btq init my-robot && btq check my-robot\n"
    "  btq init --from-xml        a project file for the XML in this folder\n",
)
def _add_init(parser: SuggestingParser) -> None:
    parser.add("folder", nargs="?", default=".", metavar="FOLDER", help="default: .")
    parser.flag("--from-xml", "only a project file, for the XML that is there")
    parser.flag("--convert", "with --from-xml: and write .btq files beside the XML")


@_command(
    "completion",
    "print the completion script of a shell",
    'examples:\n  eval "$(btq completion bash)"\n  btq completion fish > ~/.config/fish/completions/btq.fish\n',
)
def _add_completion(parser: SuggestingParser) -> None:
    from btq_lang.commands.shell import SHELLS

    parser.add("shell", choices=SHELLS)


@_command("lsp", "serve an editor: the language server, also called btq-lsp")
def _add_lsp(parser: SuggestingParser) -> None:
    add_server_options(parser)


def _add_evidence(parser: SuggestingParser, default: str) -> None:
    parser.add(
        "--evidence",
        action="append",
        default=[],
        metavar="PATH",
        help="with each requirement its verdict, last value and history: by logs, of a store, or of a file of"
        f" btq verify --format json; may be repeated; default: {default}",
    )


def _set_defaults(parser: SuggestingParser, options: CheckOptions | VerifyOptions) -> None:
    """Take the defaults of a record for a command's options; argparse appends to lists."""
    values = as_dict(options)
    for action in parser._actions:  # argparse has no public access to them
        if action.option_strings and action.dest in values:
            value = values[action.dest]
            action.default = [*value] if isinstance(value, tuple) else value


def _add_config(parser: SuggestingParser) -> None:
    parser.add(
        "--config",
        metavar="FILE",
        help="the project file of all paths, instead of the nearest btq.toml; paths in it are relative to this folder",
    )


def _add_color(parser: SuggestingParser) -> None:
    parser.add("--color", choices=("auto", "always", "never"), default="auto", help="default: auto")


_OF_PROJECT: Final = "those of `logs`, else of `store`, in [evidence] of btq.toml"
_STORE: Final = "the folder that btq verify --store writes; default: `store` in [evidence] of btq.toml"
