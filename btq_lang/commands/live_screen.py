"""The news of a running robot: on a terminal its verdicts, drawn again in place, with the last news below them;
elsewhere a line for each.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Sequence
from datetime import datetime, timezone
from time import monotonic, process_time
from typing import TYPE_CHECKING, Final, TextIO

from btq_lang.evidence.table import LEAST, requirement_rows
from btq_lang.evidence.verdicts import NEVER
from btq_lang.evidence.wording import moment
from btq_lang.render.cells import printable
from btq_lang.render.colour import painter

if TYPE_CHECKING:
    from btq_lang.evidence.watching import News, Watched
    from btq_lang.render.colour import Paint


def is_screen(stream: TextIO) -> bool:
    """Whether a stream goes to a terminal that can be drawn on."""
    return stream.isatty() and os.environ.get("TERM", "dumb" if os.name == "posix" else "") != "dumb"


class Screen:
    """The alternate screen of a terminal, which shows its earlier contents again at the end."""

    def __init__(self, stream: TextIO, colour: bool) -> None:
        self._stream: Final = stream
        self._paint: Final = painter(colour)
        self._news: Final[deque[str]] = deque(maxlen=_MOST_NEWS)
        self._next = 0.0

    def __enter__(self) -> Screen:
        self._write(_ENTER)
        return self

    def __exit__(self, *_: object) -> None:
        self._write(_LEAVE)

    def show(self, news: News) -> None:
        """Add news to what is drawn next."""
        self._news.append(_line(news))

    def refresh(self, watched: Watched) -> None:
        """Draw, if the last drawing is long enough ago, so that drawing takes a small part of the time."""
        if monotonic() < self._next:
            return
        begin = process_time()
        size = os.get_terminal_size(self._stream.fileno())
        lines = drawn(watched, [*self._news], size.columns, size.lines, self._paint)
        self._write(_HOME + f"{_END_OF_LINE}\n".join(lines) + _END_OF_SCREEN)
        self._next = monotonic() + max(_PAUSE, (process_time() - begin) * _SHARE)

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()


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
        self._stream.write(f"{_line(news)}\n")
        self._stream.flush()

    def refresh(self, watched: Watched) -> None:
        """Do nothing: written lines stay."""


def _line(news: News) -> str:
    """News with their time, in UTC."""
    time = moment(news.time) if news.time is not None else datetime.now(timezone.utc)
    clock = f"{time:%H:%M:%S}.{time.microsecond // 1000:03}" if time is not None else " " * len("00:00:00.000")
    word = f"{news.verdict:{len(NEVER)}}  " if news.verdict is not None else ""
    return printable(f"{clock}  {word}{news.text}")


def drawn(watched: Watched, news: Sequence[str], columns: int, height: int, paint: Paint) -> Sequence[str]:
    """The lines of the screen: the address and the mission, the verdicts, the last news, and how to end."""
    runs = ", ".join(f"{number} {outcome}" for outcome, number in watched.outcomes.items())
    head = [each for each in (watched.address, watched.mission, f"runs: {runs}" if runs else "") if each]
    top = [paint("message", printable(each)) for each in head]
    rows = [
        row
        for requirements in watched.so_far()
        for row in ("", *requirement_rows(requirements, {}, paint, False, max(columns, LEAST)))
    ]
    below = max(height - len(top) - len(rows) - 3, min(len(news), _LEAST_NEWS))
    room = max(height - len(top) - below - 3, 0)
    if len(rows) > room:
        hidden = len(rows) - room + 1
        rows = [*rows[: room - 1], f"  … {hidden} more lines; the table at the end has all"][:room]
    return [*top, *rows, "", *news[len(news) - below if below < len(news) else 0 :], "", HINT][:height]


HINT: Final = "Ctrl+C ends with the table"
_ENTER: Final = "\x1b[?1049h\x1b[?25l\x1b[?7l"  # alternate screen, no cursor, long lines are cut
_LEAVE: Final = "\x1b[?7h\x1b[?25h\x1b[?1049l"
_HOME: Final = "\x1b[H"
_END_OF_LINE: Final = "\x1b[K"
_END_OF_SCREEN: Final = "\x1b[K\x1b[J"
_PAUSE: Final = 0.25  # s
_SHARE: Final = 20  # the time between two drawings, in times that one takes
_MOST_NEWS: Final = 100
_LEAST_NEWS: Final = 5
