"""The page that shows a mission's trees beside its text, and the local server for editors without a page of their own.

One invariant: the page is one file, `page.html`, that loads nothing and runs one script; VS Code's extension shows the
same.  It does not know how pictures are made: it is handed them.
"""

from __future__ import annotations

import os.path


def page(nonce: str) -> str:
    """The page; only scripts with this nonce run in it (https://www.w3.org/TR/CSP3/#security-nonces)."""
    with open(os.path.join(os.path.dirname(__file__), "page.html"), encoding="utf-8") as file:
        return file.read().replace("NONCE", nonce)
