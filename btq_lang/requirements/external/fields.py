"""What other tools call the columns, keys and attributes of a requirement."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Final

from btq_lang.workspace.external_requirements import ExternalRequirement


class ImportProblem(Exception):
    """Why a file cannot be imported, and the line and column of the mistake, which count from 1."""

    def __init__(self, message: str, line: int, column: int = 1) -> None:
        super().__init__(message)
        self.message = message
        self.line = line
        self.column = column


def requirement(id_: str, values: Mapping[str, str], path: str, line: int) -> ExternalRequirement:
    """A requirement by the values of its fields, whose names are in lower case; it has no value twice."""
    title, text, status, url = (_first(values, names) for names in (_TITLES, _TEXTS, _STATUSES, _URLS))
    url = url if _WEB.fullmatch(url) else ""
    is_same = " ".join(title.split()) == " ".join(text.split())
    return ExternalRequirement(id_, " ".join(title.split()), "" if is_same else text, status, url, path, line)


def id_among(names: Iterable[str]) -> str | None:
    """Which of some names, in lower case, is that of the id."""
    present = frozenset(names)
    return next((name for name in IDS if name in present), None)


def _first(values: Mapping[str, str], names: Iterable[str]) -> str:
    return next((value for name in names if (value := values.get(name, "").strip())), "")


# Names with `reqif.` are of the ReqIF Implementation Guide of prostep ivip.  `requirement`, `clause` and `verdict` are
# columns of `btq trace --format csv`; other tools write the text into a column `requirement`.
IDS: Final = ("id", "uid", "reqif.foreignid", "requirement id", "object identifier", "key", "requirement")
_TITLES: Final = (
    "title",
    "reqif.name",
    "reqif.chaptername",
    "name",
    "summary",
    "heading",
    "object heading",
    "long-name",
)
_TEXTS: Final = (
    *("text", "reqif.text", "description", "reqif.description", "content", "statement", "object text", "clause"),
    *("requirement", "desc"),
)
_STATUSES: Final = ("status", "state", "reqif.foreignstate", "verdict")
_URLS: Final = ("external_url", "url", "link")
_WEB: Final = re.compile(r"https?://[^\s<>\"'`\\]+")
