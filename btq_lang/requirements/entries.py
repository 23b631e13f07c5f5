"""Reading conditions of scenarios, of questions and of settings, which may name entries in braces."""

from __future__ import annotations

from btq_lang.grammar.cursor import Cursor
from btq_lang.lexer import Lexer
from btq_lang.requirements import model
from btq_lang.requirements.reader import Reader
from btq_lang.requirements.terms import Term
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import BRACED


class ScenarioReader(Reader):
    """A reader to which an entry is a signal of the kind of what it is compared with."""

    def _named(
        self, word: syntax.Word, beside: Term | None = None, unit: str | None = None, *, in_bound: bool = False
    ) -> Term | None:
        if word.kind != BRACED:
            return super()._named(word, beside, unit, in_bound=in_bound)
        sort = beside.sort if beside is not None else "number"
        return Term(model.SignalRead(self._entry(word, sort)), sort, None, None, word.span)

    def _is_unknown(self, written: syntax.Condition) -> bool:
        return _is_entry(written) or super()._is_unknown(written)

    def _lone(self, written: syntax.Operand) -> model.Condition | None:
        if not _is_entry(written):
            return super()._lone(written)
        return model.SignalRead(self._entry(written.word, "bool"))

    def _entry(self, word: syntax.Word, sort: model.Sort) -> model.ResolvedSignal:
        return model.ResolvedSignal(word.raw, sort, None, key_of(word), "gauge", None, None, self.place(word.span))


def line_of_text(text: str) -> Cursor:
    """A cursor at the start of a line that is in no file, and may name entries as the lines of a scenario do."""
    lexer = Lexer(text)
    cursor = Cursor(lexer, lambda _: False)
    lexer.open_line()
    cursor.in_scenario = True
    cursor.scan()
    return cursor


def key_of(word: syntax.Word) -> str:
    """The entry of `{key}` or `{@key}` on the root blackboard."""
    return word.text.strip("{}").strip().removeprefix("@")


def _is_entry(written: syntax.Condition) -> bool:
    return isinstance(written, syntax.Operand) and written.word.kind == BRACED
