"""XML that is damaged by chance, a little: the engine often reads it still, and other tools do not.

A case follows from the seed, its number and the texts, so a failure that names them can be made again.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"^```xml[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)

# What has a meaning in XML, or is near to it.
PIECES = (
    *(
        "<",
        ">",
        "/>",
        "</",
        "&",
        ";",
        "'",
        '"',
        "=",
        " ",
        "\n",
        "\t",
        "\v",
        "\f",
        "\r",
        ":",
        "-",
        "--",
        "?",
        "!",
        "]]>",
    ),
    *("&amp;", "&lt;", "&x;", "&#10;", "&#0;", "&#xFFFE;", "&#x110000;", "&#X41;", "&#65", "&é;", "& ", "&&"),
    *(
        "<!-- a -->",
        "<!-- a -- b -->",
        "<!-- a --->",
        "<!--",
        "-->",
        "<![CDATA[<a>]]>",
        "<![CDATA[",
        "<!a>",
        "<!DOCTYPE a>",
    ),
    *("<?a b?>", "<?xml?>", "<?", "?>", "text", "<a/>", "</a>", "<a>", "< a/>", "<a b='1'c='2'/>", "<a></a b='1'>"),
    *("a:b", "x:", ' x:a="1"', ' xmlns:x="u"', ' xmlns:x=""', ' xmlns:y="u v"', ' xmlns:xml="u"', ' xml:id="1"'),
    *("\0", "\x01", "\x7f", "\ufeff", "\ufffe", "é", "×", "→", "·", "\u0370", "\U00010400", "😀", "\u2028", "\xa0"),
)
HEADS = (
    *('<?xml version="1.0"?>\n', "<?xml version='1.0' encoding='UTF-8' standalone=\"yes\"?>", '<?xml version="1.5"?>'),
    *(
        '<?xml version="2.0"?>',
        '<?xml version="1.0" encoding="latin1"?>',
        '<?xml version="1.0" encoding="1"?>',
        "<?xml?>",
    ),
    *("<?a:b?>", "<!-- a -->", "<!DOCTYPE root>", '<!DOCTYPE root SYSTEM "a.dtd">', "<!doctype a>", "\ufeff", "text"),
    *('<!DOCTYPE root PUBLIC "-//a" "b">', '<!DOCTYPE root PUBLIC "{" "b">', "<!DOCTYPE root [<!ENTITI x>]>"),
    *('<!DOCTYPE root [<!ENTITY x "ha">]>', '<!DOCTYPE root [<!ENTITY x "<b>"><!-- ]" -->]>'),
)


def damaged_xml(seed: int, number: int, texts: tuple[str, ...]) -> str:
    """The case of a number."""
    chance = random.Random(f"{seed} {number}")
    text = chance.choice(texts)
    if chance.random() < 0.2:
        text = chance.choice(HEADS) + re.sub(r"\A<\?.*?\?>", "", text)
    for _ in range(chance.choice((1, 1, 1, 1, 2, 2, 3, 5))):
        text = chance.choice(_DAMAGES)(chance, text)
    return text


@cache
def own_texts() -> tuple[str, ...]:
    """The XML of this repository."""
    pages = sorted((ROOT / "btq_lang" / "diagnostics" / "rules").glob("*.md"))
    blocks = (block for page in pages for block in BLOCK.findall(page.read_text("utf-8")))
    golden = sorted((ROOT / "tests" / "btcpp" / "golden").glob("*.xml"))
    return (*blocks, *(path.read_text("utf-8") for path in golden))


def _put_in(chance: random.Random, text: str) -> str:
    at = _place(chance, text)
    return text[:at] + chance.choice(PIECES) + text[at:]


def _drop(chance: random.Random, text: str) -> str:
    at = _place(chance, text)
    return text[:at] + text[at + chance.choice((1, 1, 1, 2, 5)) :]


def _change(chance: random.Random, text: str) -> str:
    at = _place(chance, text)
    return text[:at] + chance.choice(PIECES) + text[at + 1 :]


def _double(chance: random.Random, text: str) -> str:
    """An attribute, a tag or a comment once more."""
    pieces = [match.span() for match in re.finditer(r'\s\w+="[^"]*"|<!--.*?-->|<\w[^<>]*/>', text, re.DOTALL)]
    start, end = chance.choice(pieces or [(0, 0)])
    return text[:end] + text[start:end] + text[end:]


def _place(chance: random.Random, text: str) -> int:
    """Anywhere, or beside a character that has a meaning."""
    signs = [match.start() for match in re.finditer(r"[<>=\"'&/!-]", text)]
    if signs and chance.random() < 0.6:
        return chance.choice(signs) + chance.choice((0, 1))
    return chance.randint(0, len(text))


_DAMAGES: tuple[Callable[[random.Random, str], str], ...] = (_put_in, _put_in, _put_in, _drop, _change, _double)
