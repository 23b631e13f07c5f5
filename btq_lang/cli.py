"""The command line: `btq check`, `format`, `build`, `import`, `trace`, `graph`, `nodes`, `explain`, and others.

Exit codes of all commands: 0 clean, 1 findings, 2 usage or I/O. It parses arguments, calls pure functions and prints
their results.  A command imports what it needs when it runs, because most runs are a `btq check`.
"""

from __future__ import annotations

import codecs
import gc
import os
import sys
from collections.abc import Callable, Sequence
from io import BytesIO, TextIOWrapper
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from argparse import Namespace

    from btq_lang.projects.messages import CommandOutput

CLEAN, FINDINGS, TROUBLE = 0, 1, 2
_SYMBOLS_LIKE_OPTIONS = ("->",)
# The modules of commands whose name cannot be a module's.
_MODULES = {"import": "import_xml", "trace": "tracing", "test": "testing", "simulate": "simulating"}


def program() -> None:
    """The program `btq`: run the command and end the process.

    It skips Python's shutdown: freeing every object takes a tenth of a small check, and the system reclaims all memory
    anyway.
    """
    gc.set_threshold(100_000, 50, 10)  # nearly all objects stay alive: collection takes a tenth of the time
    try:
        code = main()
    except Exception as error:  # a bug in btq: the exit code must not mean findings
        code = _internal_error(error)
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            code = TROUBLE
        except ValueError:  # closed, because its reader has gone
            pass
    os._exit(code)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns its exit code.  `arguments` exclude the program's name; None: those of the process."""
    if sys.stdout is None or sys.stderr is None:  # closed before the start: `btq check >&-`
        nobody = TextIOWrapper(BytesIO(), encoding="utf-8")
        sys.stdout, sys.stderr = sys.stdout or nobody, sys.stderr or nobody
    codecs.register_error("readable", _readable)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # a program that calls this may have put something else there
            stream.reconfigure(errors="readable")
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words in (["--version"], ["-V"]):
        from btq_lang.util.version import __version__

        print(f"btq {__version__}")
        return CLEAN
    if words[:1] == ["check"] and not any(word.startswith("-") for word in words[1:]):
        return _plain_check(words[1:])
    if words[:1] == ["explain"]:  # `->` is a node, not an option
        words[1:] = [f" {word}" if word in _SYMBOLS_LIKE_OPTIONS else word for word in words[1:]]
    # argparse would take the path in `--add-ignore FILE` as the reason, and change all files of the folder.
    words = ["--add-ignore=" if word == "--add-ignore" else word for word in words]
    from btq_lang.commands.arguments import build_parser

    parser = build_parser()
    options, unknown = parser.parse_known_args(words)
    try:
        name, command = options.command, options.parser
    except AttributeError:
        parser.print_help()
        return TROUBLE
    usual_paths = command.get_default("paths")  # only of commands that take any number
    if usual_paths and unknown and not any(word.startswith("-") for word in unknown):
        # argparse takes the paths before or after an option, and leaves the others.
        options.paths = [*(options.paths if options.paths != usual_paths else ()), *unknown]
        unknown = []
    if unknown:
        command.error(f"unrecognized arguments: {' '.join(unknown)}")
    if name == "lsp":
        return _serve(options)
    run, record = _command(name)
    if getattr(options, "config", None) is not None:
        run = _configured(run, options.config)
    return _finish(name, run, record(**{field: getattr(options, field) for field in record.__match_args__}))


def _readable(error: UnicodeError) -> tuple[str, int]:
    """Replace characters that an output lacks; imported only then."""
    from btq_lang.util.readable import replaced

    return replaced(error)


def _plain_check(paths: Sequence[str]) -> int:
    """`btq check PATH …`, the most frequent command: it runs without argparse and other imports."""
    gc.disable()  # objects of imports stay alive; collection takes a tenth of the time of a small check
    from btq_lang.commands.check import run
    from btq_lang.projects.options import CheckOptions

    gc.freeze()
    gc.enable()
    return _finish("check", run, CheckOptions(paths or (".",)))


def _command(name: str) -> tuple[Callable[[Any, CommandOutput], int], Any]:
    """The function that runs a command, and the record of its options, whose fields have argparse's names."""
    from importlib import import_module

    module = import_module(f"btq_lang.commands.{_MODULES.get(name, name)}")
    return module.run, getattr(module, module.run.__annotations__["options"])


def _serve(options: Namespace) -> NoReturn:
    """`btq lsp`: the server, which `btq-lsp` starts too."""
    from btq_lang.projects.options import ServerOptions
    from btq_lang.server import serve  # the protocol's types take longer to import than most commands to run

    # Standard output was the editor's and is closed: it must not be flushed.
    raise SystemExit(serve(ServerOptions(options.tcp, options.log)))


def _configured(run: Callable[[Any, CommandOutput], int], config: str) -> Callable[[Any, CommandOutput], int]:
    """A function that runs a command with one project file for all files, not with the nearest one above each."""
    from btq_lang.projects.options import refuse
    from btq_lang.workspace.loader import absolute, find_project, read, use_project_file

    def run_configured(options: Any, messages: CommandOutput) -> int:
        text, problem = read(absolute(config))
        if text is None:
            refuse(f"--config {config}: {problem.message if problem else 'cannot be read'}")
        use_project_file(absolute(config))
        try:
            refuse(*(f"--config {mistake}" for mistake in find_project(".").problems[:1]))
            return run(options, messages)
        finally:
            use_project_file(None)

    return run_configured


def _finish(name: str, run: Callable[[Any, CommandOutput], int], options: object) -> int:
    from btq_lang.commands.output import Terminal
    from btq_lang.projects.options import Refused

    try:
        code = run(options, Terminal())
        sys.stdout.flush()
    except Refused as refused:
        for reason in refused.args:
            print(f"btq {name}: {reason}", file=sys.stderr)
        return TROUBLE
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader has stopped: `btq check | head`; ruff exits with 0, too
        sys.stderr.close()
        return CLEAN
    except OSError as error:  # standard output cannot be written: a full disk
        print(f"btq: {error.strerror}", file=sys.stderr)
        return TROUBLE
    return code


def _internal_error(error: Exception) -> int:
    from btq_lang.projects.failures import internal_error

    if os.environ.get("BTQ_TRACEBACK"):
        from traceback import print_exception

        print_exception(error)
    message = internal_error(error, f"in `{' '.join(['btq', *sys.argv[1:]])}`")
    print(f"btq: {message}; BTQ_TRACEBACK=1 shows the traceback", file=sys.stderr)
    return TROUBLE


if __name__ == "__main__":
    program()
