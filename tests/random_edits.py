"""Random edits against a server that runs: it is never out of step, logs nothing, and does not grow.

    python tests/random_edits.py --edits 100000 --seed 1

The model is the texts themselves: after an edit the diagnostics that the server publishes for it, and now and then
everything else it is asked, are those that the pure functions find in the texts.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from lsp_editor import Editor, Message, part

from btq_lang.checks import check
from btq_lang.ide.colours import colours
from btq_lang.ide.completion import complete
from btq_lang.ide.outline import Outline, document_symbols
from btq_lang.util.text import LineIndex, Position
from btq_lang.workspace.workspace import Workspace

FILES = {
    "main.btq": """include "skills.btq"
include "demands.btq"
Root Main
apply calm to every Drive
BehaviorTree Main
    -> First
        Drive (to = {shelf}) satisfies rq1
        SubTree Carry (what = "tube" to = {shelf})
        ? Or
            Condition Near
            Timeout (msec = 30 s)
                Drive (to = home)
""",
    "skills.btq": """Action Drive "goes"
    input to : string
Condition Near
BehaviorTree Carry
    input what : string
    input to : string
    ->
        Pick (what = {what})
        Drive (to = {to})
""",
    "demands.btq": """signal speed : m/s from {speed} initially 0 m/s
context slow : speed < 1 m/s
QualityReq rq1 : safety "In time"
    takes at most 30 s
    on violation fail
QualityReq calm(limit : m/s = 1 m/s) : usability "Calm"
    keeps speed <= limit
""",
    "alone.btq": 'Root mainTree\n\tBehaviorTree ID = mainTree\n\t\tScriptAction (name = "Go")\n',
}
_WORDS = """
( ) { } " ' /* */ = : , ä 🤖 静 a e x 1 _ - . Drive Pick Carry rq1 calm rq2 shelf speed slow -> ? R-> || Retry
SubTree satisfies satisfices tags takes at_most keeps on_violation fail 30_s 3_% 1_m/s BehaviorTree QualityReq signal
context apply Root Action include_"alone.btq" input
"""
PIECES = (
    *(word.replace("_", " ") for word in _WORDS.split()),
    "_",
    "\n",
    "\n    ",
    "\n        ",
    "# ",
    "\t",
    "\r\n",
    "\u2028",
)
MOST = 1_500
EVERYTHING, MEMORY = 100, 500  # after so many edits
WHOLE_LINES = 0.05  # of the edits: a line is taken out, or made a comment


class Drift:
    """An editor whose user hits keys at random, and the texts that the server should have."""

    def __init__(self, folder: Path, seed: int) -> None:
        self.chance = random.Random(seed)
        self.texts = dict(FILES)
        for name, text in FILES.items():
            (folder / name).write_text(text, encoding="utf-8")
        self.editor = Editor(folder)
        self.root = folder
        for name, text in FILES.items():
            self.editor.open(name, text)
        self.memory: list[int] = []

    def edits(self, count: int) -> None:
        """So many edits, some of them in bursts; what is published then is compared."""
        done = 0
        while done < count:
            name = self.chance.choice(sorted(self.texts))
            for _ in range(min(self.chance.choice((1, 1, 1, 1, 6)), count - done)):
                self._edit(name)
                done += 1
                if done % MEMORY == 0:
                    self.memory.append(resident(self.editor.process.pid))
            told = self.editor.published(name)
            while told.get("version") != self.editor.versions[name]:
                told = self.editor.published(name)
            workspace = Workspace.of({str(self.root / other): text for other, text in self.texts.items()})
            path = str(self.root / name)
            expected = [(found.rule, *found.span) for found in check(workspace, path)]
            lines = LineIndex(self.texts[name])
            assert [(each["code"], *spanned(lines, each["range"])) for each in told["diagnostics"]] == expected, done
            if self.chance.randrange(EVERYTHING) == 0:
                self._compare_everything(workspace, name, lines)

    def _edit(self, name: str) -> None:
        text = self.texts[name]
        if len(text) > MOST or self.chance.random() < 0.002:
            self.texts[name] = FILES[name]
            self.editor.change(name, FILES[name])
            return
        at = self.chance.randrange(len(text) + 1)
        end = min(at + self.chance.choice((0, 0, 0, 0, 1, 1, 2, 5, 30)), len(text))
        piece = self.chance.choice(PIECES)
        if self.chance.random() < WHOLE_LINES:
            at = text.rfind("\n", 0, at) + 1
            end, piece = self.chance.choice(((at, "# "), (text.find("\n", at) + 1 or len(text), "")))
        self.texts[name] = text[:at] + piece + text[end:]
        lines = LineIndex(text)
        first, last = (lines.position(offset, "utf-16") for offset in (at, end))
        if (lines.offset(first, "utf-16"), lines.offset(last, "utf-16")) != (at, end):
            self.editor.change(name, self.texts[name])  # no position is between \r and \n
        else:
            self.editor.change(name, part(first, last, piece))

    def _compare_everything(self, workspace: Workspace, name: str, lines: LineIndex) -> None:
        path, text = str(self.root / name), self.texts[name]
        offset = self.chance.randrange(len(text) + 1)
        document = self.editor.document(name)
        outline = self.editor.request("textDocument/documentSymbol", **document)
        assert list(flat(outline, lines)) == list(named(document_symbols(workspace, path)))
        tokens = self.editor.request("textDocument/semanticTokens/full", **document)
        assert tokens["data"] == colours(workspace, path, "utf-16").data
        line, column = lines.position(offset, "utf-16")
        completed = self.editor.request("textDocument/completion", **self.editor.at(name, line, column))
        here = lines.offset(lines.position(offset, "utf-16"), "utf-16")
        assert [one["label"] for one in completed["items"]] == [
            one.label for one in complete(workspace, path, here, snippets=False).proposals
        ]
        for method in ("hover", "definition", "documentHighlight"):
            self.editor.request(f"textDocument/{method}", **self.editor.at(name, line, column))
        for method in ("foldingRange", "codeLens", "documentLink"):
            self.editor.request(f"textDocument/{method}", **document)


def resident(pid: int) -> int:
    """The memory of a process, in kilobytes."""
    status = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return int(next(line for line in status.splitlines() if line.startswith("VmRSS:")).split()[1])


def spanned(lines: LineIndex, range_: Message) -> tuple[int, int]:
    start, end = (
        lines.offset(Position(place["line"], place["character"]), "utf-16")
        for place in (range_["start"], range_["end"])
    )
    return start, end


def flat(outline: list[Message], lines: LineIndex) -> Iterator[tuple[str, int, int]]:
    for one in outline:
        yield one["name"], *spanned(lines, one["range"])
        yield from flat(one["children"], lines)


def named(outlines: tuple[Outline, ...]) -> Iterator[tuple[str, int, int]]:
    for one in outlines:
        yield one.name, *one.span
        yield from named(one.children)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--edits", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        drift = Drift(Path(folder), options.seed)
        drift.edits(options.edits)
        took = time.monotonic() - begin
        log = drift.editor.close()
    fifth = max(1, len(drift.memory) // 5)
    parts = [median(drift.memory[at : at + fifth]) / 1024 for at in range(0, len(drift.memory), fifth)]
    print(f"{options.edits} edits in {took:.0f} s, never out of step; logged: {log or 'nothing'}")
    shown = ", ".join(f"{part:.1f} MB" for part in parts)
    print(f"resident memory, fifth by fifth: {shown}; most {max(drift.memory) / 1024:.1f} MB")
    return int(bool(log))


if __name__ == "__main__":
    sys.exit(main())
