"""Runs that are drawn: how likely a mission does what it must, and how long it takes.

One invariant: what a skill does is declared, measured or shown as assumed, and a condition is never assumed.

    skill.py       what a skill does in a drawn activation
    declared.py    what btq.toml declares of skills and conditions
    measured.py    what logs show of skills, with halted activations
    measuring.py   reads that from logs and stores
    template.py    the table of btq.toml for skills that nothing is known of
    streams.py     the random numbers of one activation, the same in every process
    world.py       signals that change with the time, and entries that follow them
    answers.py     what conditions answer by signals, entries and outages
    thresholds.py  with which values scripts and conditions compare signals
    robot.py       the program of a run
    states.py      the state of a tree as a value
    remembering.py   steps of a tree that are made once
    runs.py        a run: time jumps from one change to the next
    exact/         how likely and how long without a run, where that is exact
    prepared.py    a mission with all its skills
    judging.py     runs judged as a log is
    predicting.py  blocks of runs, in several processes, added up
    changed.py     skills that do something else, with the same random numbers
    what_if.py     changes of a mission or of skills, as they are typed
    comparing.py   a prediction beside those after changes
    words.py       what the judgements say about a demand
    causes.py      why runs miss one
    report.py      a prediction as data
    shown_run.py   one run again, to be drawn or written
    changes_in_words.py   what changes make of demands, in tables
    sentences.py   numbers in words
    text.py, json_document.py, csv_rows.py, markdown.py, page.py   the writers
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.prediction.report import Prediction

FORMATS: Final = ("text", "json", "csv", "markdown", "html")
_MODULES: Final = {"json": "json_document", "csv": "csv_rows", "html": "page"}  # named otherwise


def write(prediction: Prediction, form: str, *, colour: bool = False) -> str:
    """Write a prediction in one of FORMATS; `colour`: ANSI colours, for `text`.

    Raises:
        ValueError: there is no such format.
    """
    if form not in FORMATS:
        raise ValueError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
    text: str = import_module(f"{__name__}.{_MODULES.get(form, form)}").render(prediction, colour)
    return text
