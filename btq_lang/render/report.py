"""A report: what one run found, as every format takes it."""

from __future__ import annotations

from collections.abc import Mapping

from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.record import Record


class Finding(Record):
    """A diagnostic on its way out: its spans count from the start of `text`, its places have no anchors."""

    path: str
    text: str
    diagnostic: Diagnostic


class Trouble(Record):
    """A file that could not be read or written, or not well, so that what is found in it is not all there is.

    Attributes:
        line: counted from 1, as `column` is; None where the whole file is meant.
    """

    path: str
    message: str
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        place = f":{self.line}:{self.column}" if self.line is not None else ""
        return f"{self.path}{place}: {self.message}"


class Report(Record):
    """What one run found.

    Attributes:
        findings: in the order in which they are to appear.
        texts: the other files that related places and fixes may name; a file that is missing here is shown by its name.
        checked: the files that were asked for, those without findings too.
        troubles: what is in the formats for programs; for people the command prints it by itself.
        nothing: why there are none, where that can be said.
    """

    findings: tuple[Finding, ...]
    texts: Mapping[str, str]
    checked: tuple[str, ...] = ()
    troubles: tuple[Trouble, ...] = ()
    nothing: str | None = None
