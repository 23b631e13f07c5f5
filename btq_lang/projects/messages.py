"""What a command prints, as data: a terminal or an editor shows it."""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.workspace.loader import LoadProblem


class CommandOutput:
    """Lines in the order in which they are shown.

    Attributes:
        lines: each with whether it is a remark, for standard error, and not a result, for standard output.
    """

    def __init__(self) -> None:
        self.lines: list[tuple[str, bool]] = []

    def result(self, line: str) -> None:
        """Add a line for standard output."""
        self.lines.append((line, False))

    def remark(self, line: str) -> None:
        """Add a line for standard error."""
        self.lines.append((line, True))

    def problems(self, problems: Iterable[LoadProblem]) -> None:
        """Add what could not be read or written."""
        for problem in problems:
            self.remark(f"btq: {problem}")

    def text(self) -> str:
        """All lines, for an editor."""
        return "\n".join(line for line, _ in self.lines)
