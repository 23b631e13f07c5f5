"""A run as lines of text: the tree as it is written, and beside each node when it ran and what became of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.evidence.model import Activation, Outcome
from btq_lang.evidence.runs import activations
from btq_lang.evidence.wording import duration
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.running import START, ScenarioRun
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted


def drawing(mission: ScenarioMission, run: ScenarioRun) -> tuple[str, ...]:
    """The run in lines: a node that ran has a bar of its activations, each with a sign of its end."""
    tree = mission.tree
    in_order = activations(run.session(mission))
    by_node = grouped((each.uid, each) for each in in_order if each.uid in mission.written)
    length = max(run.now, 1)
    shown = [uid for uid in tree.nodes if uid in by_node][:_MOST]
    names = {
        uid: "  " * sum(above in mission.written for above in tree.above(uid)) + tree.nodes[uid].name for uid in shown
    }
    width = max(map(len, names.values()), default=0)
    lines = [
        f"{name.ljust(width)} |{_bar(by_node[uid], length)}| {_words(by_node[uid])}" for uid, name in names.items()
    ]
    axis = f"{' ' * width}  0{duration(run.now / 1000).rjust(_WIDE - 1)}"
    more = len(by_node) - len(shown)
    return (axis, *lines, *([f"and {counted(more, 'node')} more"] if more > 0 else []))


def _bar(ended: Sequence[Activation], length: int) -> str:
    cells = [" "] * _WIDE
    for activation in ended:
        first, last = (_cell(time, length) for time in (activation.begin, activation.end))
        cells[first:last] = "-" * (last - first)
        cells[last] = _SIGNS[activation.outcome]
    return "".join(cells)


def _cell(time: int, length: int) -> int:
    return min((time - START) // 1000 * (_WIDE - 1) // length, _WIDE - 1)


def _words(ended: Sequence[Activation]) -> str:
    numbers = [(word, sum(activation.outcome == outcome for activation in ended)) for outcome, word in _WORDS.items()]
    return ", ".join(word if number == len(ended) == 1 else f"{word} {number}" for word, number in numbers if number)


_WORDS: Final[dict[Outcome, str]] = {"S": "succeeded", "F": "failed", "H": "halted", "O": "running"}
_SIGNS: Final[dict[Outcome, str]] = {"S": "S", "F": "F", "H": "H", "O": ">"}
_WIDE: Final = 40  # columns of a bar
_MOST: Final = 60  # nodes that are drawn
