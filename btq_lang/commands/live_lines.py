"""The news of a running robot as lines, each written when it comes."""

from __future__ import annotations

from datetime import datetime, timezone
from typing import TYPE_CHECKING, Final, TextIO

from btq_lang.evidence.verdicts import NEVER
from btq_lang.evidence.wording import moment
from btq_lang.render.cells import printable

if TYPE_CHECKING:
    from btq_lang.evidence.watching import News, Watched


class Lines:
    """Writes a line for each news."""

    def __init__(self, stream: TextIO) -> None:
        self._stream: Final = stream

    def __enter__(self) -> Lines:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def show(self, news: News) -> None:
        """Write a line."""
        self._stream.write(f"{line(news)}\n")
        self._stream.flush()

    def refresh(self, watched: Watched) -> None:
        """Nothing: what was written stays."""


def line(news: News) -> str:
    """News with their time, in UTC."""
    time = moment(news.time) if news.time is not None else datetime.now(timezone.utc)
    clock = f"{time:%H:%M:%S}.{time.microsecond // 1000:03}" if time is not None else " " * len("00:00:00.000")
    word = f"{news.verdict:{len(NEVER)}}  " if news.verdict is not None else ""
    return printable(f"{clock}  {word}{news.text}")
