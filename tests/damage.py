"""Missions that are damaged by chance, and everything that btq does with a text done to each: nothing may raise.

    python tests/damage.py --cases 200000 --seed 1 --shard 3/40 --state done.txt
    python tests/damage.py --seed 1 --case 4711

A case is a few items of one mission, some of another one put between them, and one to five sorts of damage.  It follows
from the seed, its number and the texts of this repository, so a failure names both and shows the mission.  A shard is
every n-th case; one that the state file lists is not done again, and one that fails is not listed.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "ide")]  # as pytest has them

from check_asserts import assert_sound  # noqa: E402
from feature_asserts import answer_everything  # noqa: E402
from mission_strategies import made_up, missions, odd_missions  # noqa: E402

from btq_lang.btcpp.document import write  # noqa: E402
from btq_lang.btcpp.enforcement import enforced  # noqa: E402
from btq_lang.btcpp.export import export  # noqa: E402
from btq_lang.btcpp.importing import import_xml  # noqa: E402
from btq_lang.btcpp.outputs import bundle  # noqa: E402
from btq_lang.btcpp.restoring import restored  # noqa: E402
from btq_lang.btcpp.side_file import BuiltFile, side_file  # noqa: E402
from btq_lang.checks import check  # noqa: E402
from btq_lang.diagnostics.rules import Severity  # noqa: E402
from btq_lang.diff import compare  # noqa: E402
from btq_lang.formatter import format_text  # noqa: E402
from btq_lang.graph.picture import picture  # noqa: E402
from btq_lang.lexer import tokens  # noqa: E402
from btq_lang.parser import parse  # noqa: E402
from btq_lang.trace import write as write_overview  # noqa: E402
from btq_lang.trace.collect import collect  # noqa: E402
from btq_lang.workspace.workspace import Workspace  # noqa: E402

MAIN = "main.btq"
MOST_LINES = 16  # of a mission before it is damaged
BLOCK = re.compile(r"^```btq[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
BRACKETS = ("(", ")", "{", "}", '"', "'", "/*", "*/", "#", "\n", "=", ",", ":")
BLANKS = ("", " ", "    ", "        ", "\t", "            ")


class Case(NamedTuple):
    """A damaged mission.

    Attributes:
        whole: the mission before the damage.
        offset: where editor features are asked.
    """

    whole: str
    text: str
    offset: int


# ---- the missions ----


def case(seed: int, number: int) -> Case:
    """The case of a number."""
    chance = random.Random(f"{seed} {number}")
    whole = _some_items(chance, chance.choice(_sources()))
    text = whole
    for _ in range(chance.randint(1, 5)):
        text = damaged(chance, text)
    return Case(whole, text, chance.randint(0, len(text)))


def damaged(chance: random.Random, text: str) -> str:
    """A text with one thing changed for the worse."""
    return chance.choice(_DAMAGES)(chance, text)


def _some_items(chance: random.Random, group: tuple[tuple[str, ...], ...]) -> str:
    """Items of a mission that stand one below another, perhaps with one of another mission between them."""
    items = chance.choice(group)
    at = chance.randrange(len(items))
    found: list[str] = []
    while at < len(items) and sum(item.count("\n") for item in found) < MOST_LINES:
        found.append(_short(chance, items[at]))
        at += 1
    if chance.random() < 0.5:
        others = chance.choice(chance.choice(_sources()))
        found.insert(chance.randint(0, len(found)), _short(chance, chance.choice(others)))
    return "".join(found)


def _short(chance: random.Random, item: str) -> str:
    lines = item.splitlines(keepends=True)
    if len(lines) > MOST_LINES:
        at = chance.randint(1, len(lines) - MOST_LINES + 1)
        lines = [lines[0], *lines[at : at + MOST_LINES - 1]]
    return "".join(lines)


@cache
def _sources() -> tuple[tuple[tuple[str, ...], ...], ...]:
    """The missions of each origin, each as the texts of its items."""
    examples = [path for path in (ROOT / "examples").rglob("*") if path.suffix in (".btq", ".qualitybtcpp")]
    golden = (ROOT / "tests" / "btcpp" / "golden").glob("*.btq")
    pages = (ROOT / "btq_lang" / "diagnostics" / "rules").glob("*.md")
    blocks = (block for page in sorted(pages) for block in BLOCK.findall(page.read_text("utf-8")))
    every_form = [(ROOT / "tests" / "every_form.btq").read_text("utf-8")]
    groups: tuple[Iterable[str], ...] = (
        (path.read_text("utf-8") for path in sorted(examples)),
        (path.read_text("utf-8") for path in sorted(golden)),
        blocks,
        every_form,
        (*made_up(missions(), 60), *made_up(odd_missions(), 60)),
    )
    return tuple(tuple(items for text in group if (items := tuple(_items(text)))) for group in groups)


def _items(text: str) -> Iterator[str]:
    starts = [entry.start for entry in parse(text).entries if not entry.in_root]
    for start, end in zip(starts, [*starts[1:], len(text)], strict=True):
        if text[start:end].strip():
            yield text[start:end]


@cache
def _all_words() -> tuple[str, ...]:
    return tuple(sorted({token.text for line in _all_lines() for token in tokens(line) if token.text.strip()}))


@cache
def _all_lines() -> tuple[str, ...]:
    items = {item for group in _sources() for mission in group for item in mission}
    return tuple(sorted({line for item in items for line in item.splitlines() if line.strip()}))


# ---- the damage ----


def _put_in_words(chance: random.Random, text: str) -> str:
    at = chance.choice([0, *[token.start for token in tokens(text)]])
    words = " ".join(chance.choices(_all_words(), k=chance.choice((1, 1, 2, 3))))
    return f"{text[:at]}{words}{chance.choice((' ', ''))}{text[at:]}"


def _put_in_a_line(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    at = chance.randint(0, len(lines))
    margin = chance.choice((*BLANKS, *[_margin(line) for line in lines[at - 1 : at + 1]]))
    lines.insert(at, f"{margin}{chance.choice(_all_lines()).strip()}\n")
    return "".join(lines)


def _drop_lines(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    at = chance.randint(0, len(lines))
    return "".join(lines[:at] + lines[at + chance.choice((1, 1, 1, 2, 5)) :])


def _double_lines(chance: random.Random, text: str) -> str:
    """Some lines once more, behind themselves or anywhere."""
    lines = text.splitlines(keepends=True)
    at = chance.randint(0, len(lines))
    some = lines[at : at + chance.choice((1, 1, 2, 5))]
    there = chance.choice((at + len(some), chance.randint(0, len(lines))))
    return "".join(lines[:there] + some + lines[there:])


def _indent_a_line(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True) or [""]
    at = chance.randrange(len(lines))
    margin = chance.choice((*BLANKS, f"{_margin(lines[at])}    ", _margin(lines[at])[4:]))
    lines[at] = margin + lines[at].lstrip(" \t")
    return "".join(lines)


def _change_a_bracket(chance: random.Random, text: str) -> str:
    """A bracket or a quote gone, put in, or become another one."""
    there = [match.span() for match in re.finditer(r"/\*|\*/|[(){}\"'#=,:\n]", text)]
    start, end = chance.choice(there) if there and chance.random() < 0.7 else [chance.randint(0, len(text))] * 2
    return text[:start] + chance.choice(("", *BRACKETS)) + text[end:]


def _change_a_word(chance: random.Random, text: str) -> str:
    """A word gone, or become another one."""
    words = [token for token in tokens(text) if token.text.strip()]
    if not words:
        return text
    word = chance.choice(words)
    return text[: word.start] + chance.choice(("", chance.choice(_all_words()))) + text[word.end :]


def _mix_up_names(chance: random.Random, text: str) -> str:
    """A name become another one of the same text: so trees come to run themselves."""
    names = [token for token in tokens(text) if token.text[:1].isalpha()]
    if not names:
        return text
    one, other = chance.choice(names), chance.choice(names)
    return text[: one.start] + other.text + text[one.end :]


def _margin(line: str) -> str:
    return line[: len(line) - len(line.lstrip(" \t"))]


_DAMAGES: tuple[Callable[[random.Random, str], str], ...] = (
    _put_in_words,
    _put_in_a_line,
    _drop_lines,
    _double_lines,
    _indent_a_line,
    _change_a_bracket,
    _change_a_word,
    _mix_up_names,
)


# ---- what is done to each ----


def examine(one: Case) -> None:
    """Parse, check and format a mission, ask every feature, draw, trace and compare it, build it, and import that."""
    workspace = Workspace.of({MAIN: one.text})
    found = check(workspace, MAIN)
    assert_sound(workspace, MAIN, found, are_fewer=False)
    format_text(one.text)
    answer_everything(one.text, one.offset, workspace, found)
    picture(workspace, MAIN)
    write_overview(collect([(workspace, (MAIN,))]), "json")
    compare(Workspace.of({MAIN: one.whole}), (MAIN,), workspace, (MAIN,))
    if all(each.effective_severity is not Severity.ERROR for each in found):
        _build_and_import(workspace)


def _build_and_import(workspace: Workspace) -> None:
    for write_out in (export, bundle):
        done = write_out(workspace, MAIN)
        if done.problems:
            return
        made = enforced(workspace, MAIN, done, write_out is bundle)
        xml = write(made.export.document)
        built = BuiltFile(MAIN, "main.xml", xml, (made.export.document,), made.export.elements, made.clauses)
        side = side_file(workspace, built)
        imported = import_xml(xml)
        assert imported.is_complete
        if side is not None:
            assert restored(xml, imported.text, side) is not None
            restored(f"{xml}\n", imported.text, side)
        check(Workspace.of({MAIN: imported.text}), MAIN)


def run(seed: int, numbers: Iterable[int]) -> list[int]:
    """The cases that fail; each is printed, with how to do it again."""
    failed = []
    for number in numbers:
        one = case(seed, number)
        try:
            examine(one)
        except Exception:
            failed.append(number)
            print(f"---- case {number}, offset {one.offset}: python tests/damage.py --seed {seed} --case {number}")
            print(one.text)
            print("".join(traceback.format_exc().splitlines(keepends=True)[-14:]), flush=True)
    return failed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--case", type=int, help="this one alone")
    parser.add_argument("--shard", default="1/1", metavar="I/N")
    parser.add_argument("--state", type=Path, help="a file that lists the shards that are done")
    options = parser.parse_args()
    if options.case is not None:
        return int(bool(run(options.seed, [options.case])))
    at, shards = map(int, options.shard.split("/"))
    name = f"seed {options.seed}, {options.cases} cases, shard {at}/{shards}"
    done = options.state.read_text("utf-8").splitlines() if options.state and options.state.exists() else []
    if any(line.startswith(f"{name}:") for line in done):
        print(f"{name}: done before")
        return 0
    begin = time.monotonic()
    failed = run(options.seed, range(at - 1, options.cases, shards))
    said = f"{name}: {len(failed)} failed, {time.monotonic() - begin:.0f} s"
    print(said)
    if not failed and options.state:
        with options.state.open("a", encoding="utf-8") as state:
            print(said, file=state)
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
