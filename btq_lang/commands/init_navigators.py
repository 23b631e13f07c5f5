"""The factories of a first project file for the parameter files of Nav2.

One invariant: a factory is written only if the distribution is known and with it no more is unknown; else it is a
comment, which says why.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Container, Sequence

from btq_lang.commands.packages import Packages


def navigator_tables(
    packages: Packages,
    taken: Collection[str],
    goals: Sequence[str],
    fits: Callable[[str | None], bool],
    trouble: Callable[[str], str],
) -> str:
    """The tables, one for each parameter file.

    Args:
        taken: the names of other factories.
        goals: patterns of trees that programs name, which may be for goals.
        fits: whether the distribution for which a file is, if it tells, is known to be that of the project.
        trouble: what is unknown only with some tables in the project file; empty if nothing is.
    """
    written = comments = ""
    names: list[str] = []
    for path, distribution in packages.parameters.items():
        names.append(free_name("navigator", (*taken, *names)))
        table = f"name = {json.dumps(names[-1])}\nnav2 = {json.dumps(path, ensure_ascii=False)}\n"
        heading = "[[factory]]  # what bt_navigator loads"
        load = f"# load = {json.dumps(goals, ensure_ascii=False)}  # {_FOR_GOALS}\n" if goals else ""
        obstacle = "" if fits(distribution) else "name its distribution in `nodes` first"
        obstacle = obstacle or trouble(f"{written}\n{heading}\n{table}")
        if obstacle:
            comments += f"\n# {heading}; {obstacle}\n" + "".join(f"# {line}\n" for line in table.splitlines()) + load
        else:
            written += f"\n{heading}\n{table}{load}"
    return written + comments


def free_name(name: str, taken: Container[str]) -> str:
    """A name for a factory that no other has."""
    return next(each for each in (name, *(f"{name}{number}" for number in range(2, 10_000))) if each not in taken)


_FOR_GOALS = "Python or a launch file names them: keep what is for goals"
