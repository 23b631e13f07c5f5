"""The language server, for every LSP client: over standard input and output, or TCP on this machine alone.

A thin adapter: the modules of `lsp` turn requests into calls of features; `editor` has the state of the client, and
`session` the open files.
"""

from __future__ import annotations

import argparse
import functools
import logging
import os
import sys
from collections.abc import Sequence

from btq_lang.lsp import register
from btq_lang.lsp.editor import NOT_JSON, RequestRefused, Server, Traced
from btq_lang.projects.options import ServerOptions, add_server_options
from btq_lang.util.version import __version__


def main(arguments: Sequence[str] | None = None) -> int:
    """Serve until the editor exits."""
    # A fixed width: to find the terminal's, argparse imports shutil, and that bz2 and lzma: half a megabyte.
    formatter = functools.partial(argparse.HelpFormatter, width=78)
    parser = argparse.ArgumentParser("btq-lsp", description=_DESCRIPTION, formatter_class=formatter)
    add_server_options(parser)
    parser.add_argument("-V", "--version", action="version", version=f"btq-lsp {__version__}")
    options = parser.parse_args(arguments)
    return serve(ServerOptions(options.tcp, options.log))


def serve(options: ServerOptions) -> int:
    """Serve with these options; returns the exit code."""
    logging.basicConfig(stream=sys.stderr, level=options.log.upper())
    sys.setrecursionlimit(10_000)  # trees are up to 256 levels deep, and their outline is converted recursively
    server = make_server()
    logging.getLogger().addHandler(Traced(server))
    for handler in logging.getLogger().handlers:
        handler.addFilter(_is_worth_a_line)
    if options.tcp is not None:
        return _serve_tcp(server, options.tcp)
    output, sys.stdout = sys.stdout.buffer, sys.stderr  # printed text must not get into the protocol
    server.start_io(stdout=output)
    return server.exit_code


def _serve_tcp(server: Server, port: str) -> int:
    """Serve one editor that connects to a port of this machine."""
    try:
        if not (port.isascii() and port.isdigit() and int(port) <= _LAST_PORT):
            raise OSError(f"expected a port of this machine, 0 to {_LAST_PORT}")
        server.start_tcp("127.0.0.1", int(port))
    except OSError as error:
        why = os.strerror(error.errno) if error.errno else error
        print(f"btq-lsp: cannot serve on `--tcp {port}`: {why}", file=sys.stderr)
        return _TROUBLE
    except SystemExit:  # pygls raises it at `exit`
        pass
    return server.exit_code


def make_server() -> Server:
    """A new server without files."""
    server = Server()
    register(server)
    return server


_TROUBLE = 2  # usage or I/O, as in all commands
_LAST_PORT = 65_535
_DESCRIPTION = "The language server of btq, for editors."


def _is_worth_a_line(record: logging.LogRecord) -> bool:
    """Whether to log a record: the user sees refusals, and messages that are not JSON have their own line."""
    error = record.exc_info[1] if record.exc_info else None
    is_not_json = isinstance(error, NOT_JSON) and record.name.startswith("pygls.")
    return not (is_not_json or isinstance(error, RequestRefused))


if __name__ == "__main__":
    sys.exit(main())
