"""The page that shows a mission's trees beside its text, and a local server for editors that cannot show it themselves.

One invariant: the page is one file, `page.html`, that loads nothing and runs one script; VS Code's extension shows the
same; `server.py` serves it.  It does not know how to draw: callers supply pictures.
"""

from __future__ import annotations

import os.path


def page(nonce: str) -> str:
    """The page, which runs only scripts with this nonce (https://www.w3.org/TR/CSP3/#security-nonces)."""
    with open(os.path.join(os.path.dirname(__file__), "page.html"), encoding="utf-8") as file:
        return file.read().replace("NONCE", nonce)
