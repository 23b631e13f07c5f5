"""Quality names: unknown, of another edition, or with several meanings.  Nothing is refused: a model is open."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.qualities import EDITIONS, QualityMatch, find, fold
from btq_lang.checks.view import View
from btq_lang.diagnostics import Diagnostic, Tag, replace_fix
from btq_lang.near import near
from btq_lang.symbols import Kind, Use
from btq_lang.syntax import Entry, Qualities


def unknown_quality(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A name that neither the standard nor the file's own qualities have, and an edition that there is not."""
    if isinstance(entry.item, Qualities) and entry.item.edition is not None:
        edition = entry.item.edition
        if edition.text not in EDITIONS:
            message = f"there is no quality model `{edition.text}`"
            fixes = tuple(replace_fix(f"Replace it by `{name}`", edition.span, name) for name in EDITIONS)
            yield Diagnostic("unknown-quality", edition.span, message, fixes=fixes)
    for use, match in _matches(view, entry):
        if match.kind != "unknown":
            continue
        own = near(use.name, view.scope.names(Kind.QUALITY))
        fixes = tuple(
            replace_fix(f"Replace `{use.name}` by `{name}`", use.span, name) for name in (*own, *match.near)[:3]
        )
        yield Diagnostic(
            "unknown-quality",
            use.span,
            f"`{use.name}` is no quality of {_edition(view)}",
            notes=(f"a quality of your own is declared with a line `quality {use.name.rpartition('.')[2]}`",),
            fixes=fixes,
        )


def old_quality_name(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """An alias, or a name of the edition that was not chosen."""
    for use, match in _matches(view, entry):
        if match.kind not in ("alias", "other-edition") or not match.candidates:
            continue
        new = match.candidates[0].id
        is_alias = match.kind == "alias"
        yield Diagnostic(
            "old-quality-name",
            use.span,
            f"`{use.name}` is another word for `{new}`"
            if is_alias
            else f"`{use.name}` is called `{new}` in {_edition(view)}",
            notes=(match.explanation,) if match.explanation else (),
            fixes=tuple(
                replace_fix(f"Replace it by `{candidate.id}`", use.span, candidate.id, safe=match.safe)
                for candidate in match.candidates[:3]
            ),
            tags=() if is_alias else (Tag.DEPRECATED,),
        )


def ambiguous_quality(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A name with several meanings."""
    for use, match in _matches(view, entry):
        if match.kind == "ambiguous":
            yield Diagnostic(
                "ambiguous-quality",
                use.span,
                f"`{use.name}` means several qualities",
                notes=(match.explanation,) if match.explanation else (),
                fixes=tuple(
                    replace_fix(f"Replace it by `{candidate.id}`: {candidate.name}", use.span, candidate.id)
                    for candidate in match.candidates[:4]
                ),
            )


def _matches(view: View, entry: Entry) -> Iterator[tuple[Use, QualityMatch]]:
    """Each quality named in an entry, but those that the files in scope declare themselves."""
    uses = tuple(view.uses(entry, Kind.QUALITY))
    if not uses:
        return
    own = {fold(name) for name in view.scope.names(Kind.QUALITY)}
    edition = EDITIONS[_edition(view)]
    for use in uses:
        words = tuple(use.name.split("."))
        if fold(words[-1]) not in own:
            yield use, find(words, edition)


def _edition(view: View) -> str:
    """The edition that holds for the file."""
    for entry in view.file.parsed.entries:
        if isinstance(entry.item, Qualities) and entry.item.edition is not None and entry.item.edition.text in EDITIONS:
            return entry.item.edition.text
    return view.workspace.project.qualities
