"""The command line: `btq check`, `format`, `build`, `import`, `trace`, `graph`, `explain`, `init`, `completion`.

Exit codes, everywhere: 0 clean, 1 findings, 2 usage or I/O.  Nothing is decided here: arguments in, the pure parts
called, their answer printed.  A command imports what it needs when it runs, for most runs are one `btq check`.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from btq_lang import __version__

if TYPE_CHECKING:
    from argparse import ArgumentParser

CLEAN, FINDINGS, TROUBLE = 0, 1, 2
_SYMBOLS_LIKE_OPTIONS = ("->",)


def program() -> None:
    """The program `btq`: runs the command and ends the process.

    It ends as it stands: to free every object first, as Python does, takes a tenth of a small check, and the system
    takes all of it back anyway.
    """
    try:
        code = main()
    except Exception as error:  # a mistake of btq's: nothing of it says that there are findings
        code = _internal_error(error)
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            code = TROUBLE
        except ValueError:  # closed, since nobody reads it
            pass
    os._exit(code)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; `arguments` without the program's name, None: those of the process."""
    if sys.stdout is None or sys.stderr is None:  # closed before the start: `btq check >&-`
        from io import BytesIO, TextIOWrapper

        nobody = TextIOWrapper(BytesIO(), encoding="utf-8")
        sys.stdout, sys.stderr = sys.stdout or nobody, sys.stderr or nobody
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given in (["--version"], ["-V"]):
        print(f"btq {__version__}")
        return CLEAN
    if given[:1] == ["check"] and not any(word.startswith("-") for word in given[1:]):
        return _plain_check(given[1:])
    if given[:1] == ["explain"]:  # `->` is a node, not an option
        given[1:] = [f" {word}" if word in _SYMBOLS_LIKE_OPTIONS else word for word in given[1:]]
    parser = build_parser()
    options, unknown = parser.parse_known_args(given)
    try:
        run, command = options.run, options.parser
    except AttributeError:
        parser.print_help()
        return TROUBLE
    if unknown:
        command.error(f"unrecognized arguments: {' '.join(unknown)}")
    return _finish(run, options)


def _plain_check(paths: Sequence[str]) -> int:
    """`btq check PATH …`, the command that editors, hooks and people run all day: no argparse, no needless work."""
    import gc

    gc.disable()  # what imports make stays; looking for garbage in it takes a tenth of the time of a small check
    from btq_lang.commands.check import run
    from btq_lang.commands.options import CheckOptions

    gc.freeze()
    gc.enable()
    return _finish(run, CheckOptions(paths))


def _finish(run: Callable[[Any], int], options: object) -> int:
    try:
        code = run(options)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader of our output has seen enough: `btq check | head`; ruff says 0, too
        sys.stderr.close()
        return CLEAN
    except OSError as error:  # our own output cannot be written: a full disk
        print(f"btq: {error.strerror}", file=sys.stderr)
        return TROUBLE
    return code


def _internal_error(error: Exception) -> int:
    from btq_lang.failures import internal_error

    if os.environ.get("BTQ_TRACEBACK"):
        from traceback import print_exception

        print_exception(error)
    said = internal_error(error, f"in `{' '.join(['btq', *sys.argv[1:]])}`")
    print(f"btq: {said}; BTQ_TRACEBACK=1 shows the traceback", file=sys.stderr)
    return TROUBLE


def build_parser() -> ArgumentParser:
    """The commands and their options; shell completion and the documentation are made from it."""
    from argparse import RawDescriptionHelpFormatter

    from btq_lang.commands.arguments import Parser, add_commands

    parser = Parser(
        prog="btq",
        description="Quality-aware behavior trees for BehaviorTree.CPP: check, build and understand .btq files.",
        epilog="exit codes: 0 clean, 1 findings, 2 usage or I/O\n\nstart here: btq init my-robot && btq check my-robot",
        formatter_class=RawDescriptionHelpFormatter,
    )
    parser.add_argument("-V", "--version", action="version", version=f"btq {__version__}")
    add_commands(parser.add_subparsers(title="commands", metavar="COMMAND"))
    return parser


if __name__ == "__main__":
    program()
