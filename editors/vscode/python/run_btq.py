"""Starts the copy of btq that lies beside this file: `run_btq.py lsp` the server, `run_btq.py check …` a command.

One invariant: it finds nothing but this folder's packages and the standard library's before the interpreter's own, so
an older btq in the same environment does not get in the way.
"""

import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:] = [HERE, os.path.join(HERE, "libs"), *(path for path in sys.path if path != HERE)]

if __name__ == "__main__":
    if sys.argv[1:2] == ["lsp"]:
        from btq_lang.server import main

        sys.exit(main(sys.argv[2:]))
    from btq_lang.cli import main as command

    sys.exit(command(sys.argv[1:]))
