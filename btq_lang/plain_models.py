"""Plain lines of models, read word by word: a short cut past the tokens, as `plain_requirements` is for requirements.

One invariant, that of `plain`: what is read here is what the parser makes of the tokens, with nothing to complain of,
and of anything unusual the answer is None.  Plain is a line whose words stand one blank apart, with nothing behind.
"""

from __future__ import annotations

from btq_lang.plain_requirements import line_at
from btq_lang.syntax import Port, Word, is_name
from btq_lang.tokens import CATEGORIES, DIRECTIONS, NAME


def plain_model(text: str, start: int, base: int) -> tuple[Word, Word, int] | None:
    """( "Action" | … ) Name NL: the line that begins a model, and nothing else in it

    Args:
        start: where the line's first word begins.
        base: where the item begins; offsets in the tree count from there.

    Returns:
        The category, the name, and where the next line begins.
    """
    line, following = line_at(text, start)
    words = line.split(" ")
    if following < 0 or len(words) != 2 or words[0] not in CATEGORIES or not is_name(words[1]):
        return None
    category = Word(NAME, start - base, words[0])
    return category, Word(NAME, category.end + 1, words[1]), following


def plain_port(text: str, start: int, base: int) -> tuple[Port, int] | None:
    """( "input" | … ) NAME ":" NAME NL: a line in the block of a model"""
    line, following = line_at(text, start)
    words = line.split(" ")
    if following < 0 or len(words) != 4 or words[0] not in DIRECTIONS or words[2] != ":":
        return None
    if not is_name(words[1]) or not is_name(words[3]):
        return None
    direction = Word(NAME, start - base, words[0])
    name = Word(NAME, direction.end + 1, words[1])
    type_ = Word(NAME, name.end + len(" : "), words[3])
    return Port(direction.start, type_.end, direction, name, type_, None, (), None), following
