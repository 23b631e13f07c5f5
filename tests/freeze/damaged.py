"""Missions damaged by chance, cut up by regular expressions alone: the same number gives the same text."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from functools import cache

import drawn
import frozen

WORD = re.compile(r'"[^"\n]*"|\{[^}\n]*\}|[^\W\d][\w-]*[?!]?|\d[\w.]*|->|[^\w\s]')
SIGN = re.compile(r"/\*|\*/|[(){}\"'#=,:\n]")
ITEM = re.compile(r"^(?=[^\s#/)])", re.MULTILINE)
SIGNS = ("", "(", ")", "{", "}", '"', "'", "/*", "*/", "#", "\n", "=", ",", ":", "\t", "\r\n", "\u2028", "é")
MARGINS = ("", " ", "    ", "        ", "\t", "            ")
MOST_LINES = 20  # of a mission before the damage


def damaged_mission(number: int) -> tuple[str, str]:
    """A few items of some mission, perhaps one of another among them; and the same with one to five sorts of damage."""
    chance = random.Random(f"damaged {number}")
    items = list(chance.choice(_missions()))
    at = chance.randrange(len(items))
    found: list[str] = []
    while at < len(items) and sum(item.count("\n") for item in found) < MOST_LINES:
        found.append(_shortened(chance, items[at]))
        at += 1
    if chance.random() < 0.5:
        found.insert(chance.randint(0, len(found)), _shortened(chance, chance.choice(chance.choice(_missions()))))
    whole = text = "".join(found)
    for _ in range(chance.randint(1, 5)):
        text = chance.choice(_DAMAGES)(chance, text)
    return whole, text


@cache
def _missions() -> tuple[tuple[str, ...], ...]:
    """The items of each mission."""
    texts = [text for _, text in frozen.missions()]
    texts += [drawn.mission(number) for number in range(1_000_000, 1_000_060)]
    texts += [drawn.odd_mission(number) for number in range(1_000_000, 1_000_060)]
    cut = (tuple(item for item in ITEM.split(text) if item.strip()) for text in texts)
    return tuple(items for items in cut if items)


@cache
def _all_lines() -> tuple[str, ...]:
    lines = {line.strip() for items in _missions() for item in items for line in item.splitlines()}
    return tuple(sorted(lines - {""}))


@cache
def _all_words() -> tuple[str, ...]:
    return tuple(sorted({word for line in _all_lines() for word in WORD.findall(line)}))


def _shortened(chance: random.Random, item: str) -> str:
    lines = item.splitlines(keepends=True)
    if len(lines) > MOST_LINES:
        at = chance.randint(1, len(lines) - MOST_LINES + 1)
        lines = [lines[0], *lines[at : at + MOST_LINES - 1]]
    return "".join(lines)


# ---- the damage ----


def _insert_words(chance: random.Random, text: str) -> str:
    at = chance.choice([0, *(match.start() for match in WORD.finditer(text))])
    words = " ".join(chance.choices(_all_words(), k=chance.choice((1, 1, 2, 3))))
    return f"{text[:at]}{words}{chance.choice((' ', ''))}{text[at:]}"


def _insert_line(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    at = chance.randint(0, len(lines))
    near = [line[: len(line) - len(line.lstrip(" \t"))] for line in lines[max(at - 1, 0) : at + 1]]
    lines.insert(at, f"{chance.choice((*MARGINS, *near, *near))}{chance.choice(_all_lines())}\n")
    return "".join(lines)


def _delete_lines(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    at = chance.randint(0, len(lines))
    return "".join(lines[:at] + lines[at + chance.choice((1, 1, 1, 2, 5)) :])


def _repeat_lines(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    at = chance.randint(0, len(lines))
    some = lines[at : at + chance.choice((1, 1, 2, 5))]
    there = chance.choice((at + len(some), chance.randint(0, len(lines))))
    return "".join(lines[:there] + some + lines[there:])


def _indent_line(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True) or [""]
    at = chance.randrange(len(lines))
    code = lines[at].lstrip(" \t")
    margin = lines[at][: len(lines[at]) - len(code)]
    lines[at] = chance.choice((*MARGINS, f"{margin}    ", margin[4:])) + code
    return "".join(lines)


def _change_sign(chance: random.Random, text: str) -> str:
    there = [match.span() for match in SIGN.finditer(text)]
    start, end = chance.choice(there) if there and chance.random() < 0.7 else (chance.randint(0, len(text)),) * 2
    return text[:start] + chance.choice(SIGNS) + text[end:]


def _change_word(chance: random.Random, text: str) -> str:
    there = [match.span() for match in WORD.finditer(text)]
    if not there:
        return text
    start, end = chance.choice(there)
    return text[:start] + chance.choice(("", chance.choice(_all_words()))) + text[end:]


def _change_letter(chance: random.Random, text: str) -> str:
    """A word misspelt: one letter gone, or two exchanged."""
    at = chance.randint(0, len(text))
    return text[:at] + chance.choice((text[at + 1 :], text[at + 1 : at + 2] + text[at : at + 1] + text[at + 2 :]))


def _exchange_names(chance: random.Random, text: str) -> str:
    """A name becomes another one of the same text: so trees come to run themselves."""
    names = [match for match in WORD.finditer(text) if match[0][:1].isalpha()]
    if not names:
        return text
    one, other = chance.choice(names), chance.choice(names)
    return text[: one.start()] + other[0] + text[one.end() :]


_DAMAGES: tuple[Callable[[random.Random, str], str], ...] = (
    _insert_words,
    _insert_line,
    _delete_lines,
    _repeat_lines,
    _indent_line,
    _change_sign,
    _change_word,
    _change_letter,
    _exchange_names,
)
