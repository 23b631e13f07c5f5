"""The output of a command as data, for a terminal or an editor."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, TypeAlias

from btq_lang.workspace.loader import LoadProblem

Kind: TypeAlias = Literal["result", "remark", "document"]


class CommandOutput:
    """Texts in the order in which they are shown.

    Attributes:
        texts: each with its kind: a `result` goes to standard output in its encoding, a `document` for programs in
            UTF-8, a `remark` goes to standard error.
    """

    def __init__(self) -> None:
        self.texts: list[tuple[str, Kind]] = []

    def add(self, text: str, kind: Kind) -> None:
        """Add a text as it is."""
        self.texts.append((text, kind))

    def result(self, line: str) -> None:
        """Add a line for standard output."""
        self.add(f"{line}\n", "result")

    def remark(self, line: str) -> None:
        """Add a line for standard error."""
        self.add(f"{line}\n", "remark")

    def problems(self, problems: Iterable[LoadProblem]) -> None:
        """Add problems of reading and writing files."""
        for problem in problems:
            self.remark(f"btq: {problem}")

    def extend(self, others: CommandOutput) -> None:
        """Add all texts of another output."""
        for text, kind in others.texts:
            self.add(text, kind)

    def text(self) -> str:
        """All texts, for an editor."""
        return "".join(text for text, _ in self.texts).removesuffix("\n")
