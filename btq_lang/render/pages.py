"""Pages from templates: files `*.html.j2` beside the modules that fill them.

One invariant: every value is escaped but for drawings and style sheets, which a template marks as `safe`.  Jinja2 is
imported only here, and this module only by what writes a page.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Iterator
from functools import cache
from itertools import cycle
from typing import Final, TypeAlias

from jinja2 import Environment, FileSystemLoader, StrictUndefined

PageData: TypeAlias = dict[str, object]  # of a template, by the names that it has for them


def page(template: str, **values: object) -> str:
    """The page that a template makes of values.

    Args:
        template: its path in `btq_lang`.

    Raises:
        jinja2.UndefinedError: the template names a value that is not given.
    """
    return _environment().get_template(template).render(values)


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(os.path.dirname(os.path.dirname(__file__))),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        auto_reload=False,
    )
    environment.filters["code_split"] = _code_split
    return environment


def _code_split(text: str) -> Iterator[tuple[str, bool]]:
    """The pieces of a text, each with whether it is code: between backticks."""
    return zip(_CODE.split(text), cycle((False, True)))


_CODE: Final = re.compile("`([^`]*)`")
