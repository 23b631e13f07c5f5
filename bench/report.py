"""What the benchmarks have in common: goals, the machine in words, and the options of their command lines."""

from __future__ import annotations

import argparse
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

# An installed btq has its bytecode beside it; where writing it is switched off, every start would compile all modules.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True)
class Goal:
    """A figure that btq must reach, with the figure reached."""

    text: str
    reached: float
    met: bool


def machine() -> str:
    """What it was measured on, and how busy that was."""
    load = ", ".join(f"{one:.1f}" for one in os.getloadavg())
    system = f"{platform.system()} {platform.machine()}"
    return f"Python {platform.python_version()}, {os.cpu_count()} cores, {system}, load {load}"


def shown(goals: Sequence[Goal]) -> list[str]:
    """A table of goals in Markdown, as in docs/performance.md."""
    rows = [f"| {goal.text} | {goal.reached:,.2f} | {'met' if goal.met else 'missed'} |" for goal in goals]
    return ["| goal | reached | |", "|---|---|---|", *rows]


def as_data(measured: Mapping[str, object], goals: Sequence[Goal]) -> dict[str, object]:
    """Everything that was measured, for machines."""
    return {
        "python": platform.python_version(),
        "platform": platform.platform(),
        "cores": os.cpu_count(),
        "load": os.getloadavg(),
        **measured,
        "goals": [{"goal": goal.text, "reached": goal.reached, "met": goal.met} for goal in goals],
    }


def options(described: str | None) -> argparse.ArgumentParser:
    """A command line with the options that all have."""
    parser = argparse.ArgumentParser(description=described, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spelling", choices=("short", "classic"), default="short")
    parser.add_argument("--json", action="store_true", help="print JSON with every single time")
    return parser
