"""Comparisons for a terminal: a line for each change, those of one mission below its title.

mission.btq (HEAD) -> mission.btq
~ requirement rq1 changed                      mission.btq:19
    - takes at most 30 s
    + takes at most 20 s
+ node BatteryCheck/Recharge/Retry added around ChargeUntilFull   mission.btq:90

1 requirement changed, 1 node added
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from btq_lang.diff.changes import Change
from btq_lang.diff.comparison import MissionComparison, all_changes
from btq_lang.diff.wording import SIGNS, headline, lines, summary

Paint = Callable[[str, str], str]


def render(comparisons: Iterable[MissionComparison], paint: Paint) -> Iterator[str]:
    """The lines; none if nothing changed.

    Args:
        paint: renders a text in a style: `+`, `-`, `~`, `>`, `message` or `gutter`.
    """
    comparisons = tuple(each for each in comparisons if each.changes)
    for comparison in comparisons:
        yield paint("message", comparison.title)
        for change in comparison.changes:
            yield from _change(comparison, change, paint)
        yield ""
    if comparisons:
        yield summary(all_changes(comparisons))


def _change(comparison: MissionComparison, change: Change, paint: Paint) -> Iterator[str]:
    thing, name, happened = headline(change)
    sign = SIGNS[change.what]
    line = " ".join(word for word in (sign, thing, name, happened) if word)
    yield f"{paint(sign, line)}  {paint('gutter', comparison.line(change))}"
    for sign, text in lines(change):
        yield "    " + paint(sign, f"{sign} {text}")
