"""Reading the values and conditions of clauses: what each word means, its unit, and what cannot be compared.

One invariant: what cannot be understood is None and one problem, reported at its place, so values are never compared in
different units.  Verbs are for `clauses`.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import a_dimension, to_si
from btq_lang.diagnostics.model import Fix, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements import model
from btq_lang.requirements.contexts import IN_CIRCLE, context_depth, contexts_by_word, contexts_in, written_context
from btq_lang.requirements.paths import PathReader, Problem
from btq_lang.requirements.terms import (
    DURATION,
    OF_PYTHON,
    ONE,
    SORTS,
    TIME,
    Level,
    Term,
    Wanted,
    amounts,
    in_words,
    is_count_of,
    simple,
    sort_of,
    sort_of_value,
    sum_level,
    term_of,
    unit_beside,
)
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import NAME, NUMBER, QUANTITY, STRING
from btq_lang.util.spelling import did_you_mean, long_words
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

Problems: TypeAlias = tuple[Problem, ...]

# ---- what names mean, each with the problems of its definition ----


def signal(store: Store[Workspace], viewpoint: str, name: str) -> tuple[model.ResolvedSignal | None, Problems]:
    """The signal with a name; None if it is not declared."""
    definition = store.ask(inputs.definition, viewpoint, Kind.SIGNAL, name)
    if definition is None:
        return None, ()
    symbol = inputs.symbol(definition[1], Kind.SIGNAL, name)
    item = symbol.target
    assert isinstance(item, syntax.Signal), "its kind says so"
    names = store.ask(inputs.names, viewpoint, Kind.SIGNAL) if item.initially is not None else ()
    reader = Reader(store, viewpoint, *definition, signals=names[: names.index(name)] if name in names else ())
    sort, unit = sort_of(item.unit)
    fresh = reader.quantity(item.fresh, DURATION)
    source = item.source.text[1:-1].strip() if item.source is not None else None
    behaviour = item.behaviour.raw if item.behaviour is not None else "gauge"
    place = reader.place(symbol.span)
    initially = None
    if item.initially is not None:
        initially = reader.argument(model.ResolvedParameter(name, sort, unit, None), item.initially)
    resolved = model.ResolvedSignal(
        name,
        sort,
        unit,
        source or None,
        behaviour,  # type: ignore[arg-type]  # one of the parser's three
        fresh.si if fresh is not None else None,
        initially,  # type: ignore[arg-type]  # an Amount is not a table
        place,
    )
    return resolved, reader.problems


def context(store: Store[Workspace], viewpoint: str, name: str) -> tuple[model.Condition | None, Problems]:
    """The condition of a context; None if it cannot be understood."""
    definition = store.ask(inputs.definition, viewpoint, Kind.CONTEXT, name)
    if definition is None:
        return None, ()
    reader = Reader(store, viewpoint, *definition)
    span = inputs.symbol(definition[1], Kind.CONTEXT, name).span
    depth = store.ask(context_depth, viewpoint, name)
    if depth == IN_CIRCLE:
        reader.complain("cyclic-context", span, f"the context `{name}` refers to itself")
    elif depth > _DEEPEST:
        reader.complain("nested-too-deep", span, f"more than {_DEEPEST} levels of contexts in contexts")
    else:
        written = written_context(definition[1], name)
        for other in contexts_in(store, viewpoint, written):  # before its condition is read, deep in Python's stack
            store.ask(context, viewpoint, other)
        return reader.condition(written.condition), reader.problems
    return None, reader.problems


class Reader(PathReader):
    """Reads values and conditions too."""

    # ---- look-ups ----

    def signal(self, name: str) -> model.ResolvedSignal | None:
        """The signal with a name."""
        if self._signals is not None and name not in self._signals:
            return None
        return self.store.ask(signal, self.viewpoint, name)[0]

    def is_context(self, name: str) -> bool:
        """Whether a context with this name exists, understood or not."""
        if self._signals is not None:
            return False
        return self.store.ask(inputs.definition, self.viewpoint, Kind.CONTEXT, name) is not None

    # ---- values ----

    def bounded(self, written: syntax.Bounded | None, expected: Wanted | None) -> model.Bounded | None:
        """A value, or a table of values, of the expected kind; None: any."""
        if written is None:
            return None
        if isinstance(written, syntax.Amount):
            term = self._amount(written, expected)
            fits = term is not None and (expected is None or self._fits(term, expected))
            return simple(term.value) if term is not None and fits else None
        cases = []
        for case in written.cases:
            value = self.bounded(case.value, expected)
            condition = self.condition(case.condition) if case.condition is not None else None
            if value is None or isinstance(value, model.ResolvedTable) or condition is None:
                return None
            cases.append(model.ResolvedCase(value, condition))
        otherwise = self.bounded(written.otherwise, expected)
        if otherwise is None or isinstance(otherwise, model.ResolvedTable):
            return None
        return model.ResolvedTable((*cases, model.ResolvedCase(otherwise, None)))

    def argument(self, parameter: model.ResolvedParameter, written: syntax.Bounded) -> model.Bounded | None:
        """The argument for a parameter, or the first value of a signal."""
        if parameter.sort == "number":
            unit = parameter.unit
            if unit is None:
                return self.bounded(written, None)
            plain = unit.dimension == model.NO_DIMENSION
            return self.bounded(written, Wanted(a_dimension(unit), (unit.dimension,), None if plain else unit.symbol))
        bounded = self.bounded(written, None)
        for value, place in amounts(bounded, written):
            if sort_of_value(value) != parameter.sort:
                what = "a text in quotes" if parameter.sort == "text" else "`true` or `false`"
                self.complain("unit-mismatch", place, f"expected {what}, found `{self._text_at(place)}`")
                return None
        return bounded

    def quantity(self, word: syntax.Word | None, expected: Wanted) -> model.Quantity | None:
        """A quantity or a number by itself."""
        term = self._number(word, False) if word is not None else None
        if term is None or not self._fits(term, expected):
            return None
        return term.value if isinstance(term.value, model.Quantity) else None

    def _amount(self, amount: syntax.Amount, expected: Wanted | None) -> Term | None:
        if amount.word.kind in (NUMBER, QUANTITY):
            return self._number(amount.word, amount.negative)
        return self._named(amount.word, unit=expected.unit if expected is not None else None, in_bound=True)

    def _number(self, word: syntax.Word, negative: bool) -> Term | None:
        raw = f"-{word.raw}" if negative else word.raw
        if word.kind == NUMBER:
            term = Term(model.Quantity(raw, float(raw), ONE), "number", model.NO_DIMENSION, None, word.span, word=word)
            return term if self._is_finite(float(raw), word) else None
        parsed = parse_quantity(raw)
        if parsed is None:
            return None  # an unknown unit, which is reported
        number, unit, unit_text = parsed
        value = to_si(number, unit)
        if not self._is_finite(value, word):
            return None
        level: Level = "level" if unit.offset else "either"
        return Term(model.Quantity(raw, value, unit), "number", unit.dimension, unit_text, word.span, level, word)

    def _is_finite(self, value: float, word: syntax.Word) -> bool:
        if not isfinite(value):
            self.complain("invalid-literal", word.span, f"`{word.raw}` exceeds the range of numbers")
        return isfinite(value)

    def _named(
        self, word: syntax.Word, beside: Term | None = None, unit: str | None = None, *, in_bound: bool = False
    ) -> Term | None:
        """A parameter, a signal, or a literal that looks like a name.

        Args:
            beside: what it is compared with.
            unit: expected, if it is not compared with anything.
            in_bound: whether no subtraction can be written there.
        """
        name = word.text
        if word.kind == STRING:
            return Term(model.TextValue(name), "text", None, None, word.span)
        if name in ("true", "false"):
            return Term(model.Flag(name == "true"), "bool", None, None, word.span)
        if name in self.parameters:
            return term_of(self.parameters[name], self.parameters[name], word.span)
        if (signal := self.signal(name)) is not None:
            return term_of(model.SignalRead(signal), signal, word.span)
        if self.is_context(name):
            self.complain("unit-mismatch", word.span, f"`{name}` is a context, not a value")
        elif in_bound or not self._is_subtraction(word):
            self.unknown(word, ("parameters", "signals"), unit or unit_beside(beside))
        return None

    def unknown(self, word: syntax.Word, kinds: tuple[str, ...], unit: str = "m") -> None:
        """Report a name that is not declared.

        Args:
            kinds: that the name may have been meant to have.
            unit: with which a signal of that name would be declared.
        """
        if not self.store.ask(inputs.is_complete, self.viewpoint):
            return
        likely = self.near(word.text, *kinds) if word.text not in OF_PYTHON else (word.text.lower(),)
        if not likely and "contexts" in kinds:
            likely = self._sharing_a_word(word.text)
        title = f"Replace `{word.text}` with"
        fixes = tuple(replace_fix(f"{title} `{name}`", word.span, syntax.written(name)) for name in likely)
        if not likely and word.text.casefold() in _WORDS_FOR_NUMBERS:
            number = str(_WORDS_FOR_NUMBERS.index(word.text.casefold()) + 1)
            likely, fixes = (number,), (replace_fix(f"{title} `{number}`", word.span, number),)
        if word.text[-1] in "²³":
            power = "^2" if word.text[-1] == "²" else "^3"
            message = f"unknown unit `{word.text}`; write the power as `{power}`"
            fix = write_fix(power, Span(word.end - 1, word.end))
            self.complain("unknown-unit", word.span, message, fixes=(fix,))
            return
        note = f"{'or ' if likely else ''}declare it: `signal {word.text} : {unit} from {{{word.text}}}`"
        message = f"unknown signal `{word.text}`{did_you_mean(likely)}"
        self.complain("unknown-signal", word.span, message, notes=(note,), fixes=fixes)

    def _sharing_a_word(self, name: str) -> tuple[str, ...]:
        """The contexts that have a word in common with a name: `people_near` for `person_near`; none if more than three
        have."""
        by_word = self.store.ask(contexts_by_word, self.viewpoint)
        sharing = sorted({context for word in long_words(name) for context in by_word.get(word, ())})
        return tuple(sharing) if len(sharing) <= 3 else ()

    def _is_subtraction(self, word: syntax.Word) -> bool:
        """Whether an unknown name is two known ones with a `-` between them, which is then reported."""
        for index, character in enumerate(word.text):
            left, right = word.text[:index], word.text[index + 1 :]
            if character == "-" and self._is_declared(left) and self._is_declared(right):
                message = f"undefined name `{word.text}`; write spaces around `-` to subtract"
                fixes = (write_fix(f"{left} - {right}", word.span, safe=True),)
                notes = ("without spaces `-` is part of the name",)
                self.complain("subtraction-without-blanks", word.span, message, notes=notes, fixes=fixes)
                return True
        return False

    def _is_declared(self, name: str) -> bool:
        return self._is_value(name) or self.is_context(name)

    def _fits(self, term: Term, expected: Wanted) -> bool:
        """Whether a value is of the expected kind; else that is reported."""
        if term.sort != "number":
            self._unexpected(expected.what, term)
            return False
        if term.dimension is None:
            return True
        if term.dimension in expected.dimensions:
            if expected.level == "difference" and term.level == "level":
                self._level(term)
                return False
            return True
        if term.is_bare and expected.unit is not None:
            self._bare(term, f"expected {expected.what}", expected.unit)
        else:
            self._unexpected(expected.what, term)
        return False

    def _unexpected(self, what: str, term: Term) -> None:
        message = f"expected {what}, found `{self._text_at(term.span)}` ({in_words(term)})"
        self.complain("unit-mismatch", term.span, message)

    def _level(self, term: Term) -> None:
        fixes: tuple[Fix, ...] = ()
        if term.word is not None:
            kelvin = f"{term.word.raw.removesuffix(term.unit or '').rstrip()} K"
            fixes = (write_fix(kelvin, term.span),)
        message = f"expected a temperature difference, found `{self._text_at(term.span)}` (a temperature)"
        self.complain("unit-mismatch", term.span, message, notes=("write the difference in K",), fixes=fixes)

    def _bare(self, term: Term, message: str, unit: str) -> None:
        assert term.word is not None, "the caller has looked"
        if self._has_unknown_unit(term):
            return
        number = term.word.raw
        is_share = unit == "%" and 0 < float(number) < 1
        amount = f"{float(number) * 100:.10g}" if is_share else number
        fix = write_fix(f"{amount} {unit}", term.span)
        self.complain("number-without-unit", term.span, f"missing unit after `{number}`; {message}", fixes=(fix,))

    def _has_unknown_unit(self, term: Term) -> bool:
        """Whether the word after a number is reported as an unknown unit: `45 sek`."""
        starts = self.store.ask(inputs.unknown_units, self.path, self.facts)
        after = next((start for start in starts if start >= term.span.end), None)
        return after is not None and not self.text(term.span.end, after).strip()

    # ---- conditions ----

    def condition(self, written: syntax.Condition | None) -> model.Condition | None:
        """A condition; None if a part of it was not understood."""
        if isinstance(written, syntax.Operand):
            return self._lone(written)
        if isinstance(written, syntax.NodeRuns):
            return self._running(written.path, Span(written.start, written.end))
        if isinstance(written, syntax.Not):
            operand = self.condition(written.operand)
            return model.Negation(operand) if operand is not None else None
        if isinstance(written, syntax.Binary) and written.operator in ("and", "or"):
            return self._joined(written)
        if isinstance(written, syntax.Comparison):
            return self._compare(written)
        if isinstance(written, syntax.Binary) and (path := self._as_path(written)) is not None:
            return self._running(path, Span(written.start, written.end))
        if written is not None:
            term = self._expression(written)
            if term is not None:
                self._no_condition(term)
        return None

    def _running(self, path: syntax.Path, asked: Span) -> model.Condition | None:
        target = self.target(path, asked=(asked, "node {}"))
        return model.Running(target) if target is not None else None

    def _joined(self, written: syntax.Binary) -> model.Condition | None:
        parts: list[syntax.Condition] = []
        leftmost: syntax.Condition = written
        while isinstance(leftmost, syntax.Binary) and leftmost.operator == written.operator:
            parts.append(leftmost.right)
            leftmost = leftmost.left
        conditions = [self.condition(part) for part in (leftmost, *reversed(parts))]
        understood = tuple(condition for condition in conditions if condition is not None)
        if len(understood) < len(conditions):
            return None
        return model.All(understood) if written.operator == "and" else model.Any(understood)

    def _lone(self, written: syntax.Operand) -> model.Condition | None:
        """A context, a bool signal or parameter, `true` or `false`, or else a running node."""
        word, name = written.word, written.word.text
        is_value = word.kind in (NUMBER, QUANTITY) or (word.kind == NAME and self._is_value(name))
        if word.kind == NAME and not is_value and self.is_context(name):
            condition, _ = self.store.ask(context, self.viewpoint, name)
            return model.InContext(name, condition) if condition is not None else None
        if is_value or (word.kind == NAME and name in ("true", "false")):
            term = self._expression(written)
            if term is None:
                return None
            if term.sort == "bool" and isinstance(term.value, model.Flag | model.SignalRead | model.ResolvedParameter):
                return term.value
            self._no_condition(term)
            return None
        if word.kind == STRING or self.find((name,)):
            running = self._running(syntax.Path((word,)), word.span)
            if running is not None:
                self._bare_node(word)
            return running
        if not self._is_subtraction(word):
            self.unknown(word, ("parameters", "signals", "contexts", "nodes"), "bool")
        return None

    def _bare_node(self, word: syntax.Word) -> None:
        """Report a node's name as a condition: it holds while the node runs, and may be meant as what it comes to."""
        fixes: tuple[Fix, ...] = (
            replace_fix(f"Write `node {word.raw}`: while it runs", word.span, f"node {word.raw}"),
        )
        if self.text(0, word.start).endswith("followed by"):
            succeeds = f"{word.raw} succeeds"
            fixes = (replace_fix(f"Write `{succeeds}`", word.span, succeeds), *fixes)
        meant = f"btq reads `node {word.raw}`, which is true while it runs"
        message = f"`{word.text}` is a node, not a signal or a context: {meant}"
        self.complain("unknown-signal", word.span, message, fixes=fixes, severity=Severity.WARNING)

    def _no_condition(self, term: Term) -> None:
        if term.sort == "number" and term.dimension is None:
            return
        self._unexpected("a condition", term)

    def _as_path(self, written: syntax.Binary) -> syntax.Path | None:
        """`A/B`, which is parsed as a division, if no name in it is a signal."""
        words: list[syntax.Word] = []
        leftmost: syntax.Condition = written
        while (
            isinstance(leftmost, syntax.Binary)
            and leftmost.operator == "/"
            and isinstance(leftmost.right, syntax.Operand)
        ):
            words.append(leftmost.right.word)
            leftmost = leftmost.left
        if not isinstance(leftmost, syntax.Operand):
            return None
        words.append(leftmost.word)
        if all(word.kind in (NAME, STRING) and not self._is_value(word.text) for word in words):
            return syntax.Path(tuple(reversed(words)))
        return None

    def _compare(self, written: syntax.Comparison) -> model.Condition | None:
        terms: list[Term | None] = [None] * len(written.operands)
        # An undeclared name may get the unit of what it is compared with, so names come last.
        for index, operand in sorted(enumerate(written.operands), key=lambda each: self._is_unknown(each[1])):
            if self._is_unknown(operand) and isinstance(operand, syntax.Operand):
                terms[index] = self._named(operand.word, next(filter(None, terms), None))
            else:
                terms[index] = self._expression(operand)
        understood = [term for term in terms if term is not None]
        if len(understood) < len(terms):
            return None
        # Adjacent pairs, so that one number without a unit is reported once.
        ok = True
        for operator, left, right in zip(written.operators, understood, understood[1:], strict=False):
            ok = self._comparable(left, right, operator) and ok
        ok = ok and self._ages_fit(understood)
        return model.Compare(written.operators, tuple(term.value for term in understood)) if ok else None

    def _ages_fit(self, terms: list[Term]) -> bool:
        """Whether each age is compared with times that do not change meanwhile, so that it is known when it passes
        them."""
        ages = [part for term in terms for part in model.parts_in(term.value) if isinstance(part, model.Age)]
        others = [term for term in terms if not isinstance(term.value, model.Age)]
        changing = (model.Age, model.SignalRead, model.Aggregate)
        if not ages or not any(isinstance(part, changing) for term in others for part in _values_in(term.value)):
            return True
        name = ages[0].signal.name
        message = f"an age is compared with a time that does not change: `age({name}) <= 2 s`"
        self.complain("unit-mismatch", Span(terms[0].span.start, terms[-1].span.end), message)
        return False

    def _is_unknown(self, written: syntax.Condition) -> bool:
        if not isinstance(written, syntax.Operand) or written.word.kind != NAME:
            return False
        return written.word.text not in ("true", "false") and not self._is_declared(written.word.text)

    def _is_value(self, name: str) -> bool:
        """Whether it is the name of a parameter or of a signal."""
        return name in self.parameters or self.signal(name) is not None

    def _comparable(self, left: Term, right: Term, operator: str) -> bool:
        if left.sort != right.sort:
            self._mismatch(left, right, "compare")
            return False
        if left.sort != "number":
            if operator in ("==", "!="):
                return True
            span = Span(left.span.start, right.span.end)
            self.complain("unit-mismatch", span, f"cannot order {in_words(left)}; compare with `==` or `!=`")
            return False
        if left.dimension is None or right.dimension is None:
            return True
        if left.dimension == right.dimension or is_count_of(left, right) or is_count_of(right, left):
            return self._same_level(left, right)
        self._mismatch(left, right, "compare")
        return False

    def _same_level(self, left: Term, right: Term) -> bool:
        if {left.level, right.level} != {"level", "difference"}:
            return True
        self._level(left if left.level == "level" else right)
        return False

    def _mismatch(self, left: Term, right: Term, what: str) -> None:
        """Report that two values measure different things, or one lacks its unit; `what` cannot be done with them."""
        for number, other in ((left, right), (right, left)):
            if number.is_bare and other.unit is not None:
                self._bare(number, f"`{self._text_at(other.span)}` is in {other.unit}", other.unit)
                return
        shown = [f"`{self._text_at(term.span)}` ({in_words(term)})" for term in (left, right)]
        preposition = {"compare": "with", "add": "and", "subtract": "and"}[what]
        message = f"cannot {what} {f' {preposition} '.join(shown)}"
        self.complain("unit-mismatch", Span(left.span.start, right.span.end), message)

    def _text_at(self, span: Span) -> str:
        return self.text(span.start, span.end)

    def _expression(self, written: syntax.Condition) -> Term | None:
        if isinstance(written, syntax.Operand):
            word = written.word
            return self._number(word, False) if word.kind in (NUMBER, QUANTITY) else self._named(word)
        if isinstance(written, syntax.Negative):
            inner = written.operand
            if isinstance(inner, syntax.Operand) and inner.word.kind in (NUMBER, QUANTITY):
                return self._number(inner.word, True)
            term = self._expression(inner)
            return term and Term(model.Minus(term.value), term.sort, term.dimension, term.unit, term.span, term.level)
        if isinstance(written, syntax.Call):
            return self._call(written)
        if isinstance(written, syntax.Choice):
            return self._choice(written)
        if isinstance(written, syntax.Binary) and written.operator in "+-*/":
            return self._arithmetic(written)
        if self.condition(written) is not None:
            span = Span(written.start, written.end)
            self.complain("unit-mismatch", span, f"expected a value, found the condition `{self._text_at(span)}`")
        return None

    def _call(self, written: syntax.Call) -> Term | None:
        word = written.signal
        if word is None:
            return None
        signal = self.signal(word.text)
        if signal is None:
            self.unknown(word, ("signals",))
            return None
        span = Span(written.start, written.end)
        function = written.function.text
        if function == "age":
            return Term(model.Age(signal), "number", TIME, "s", span)
        value = model.Aggregate(function, signal)
        if function == "count":
            return Term(value, "number", model.NO_DIMENSION, None, span)
        if signal.sort != "number":
            message = f"`{function}` requires a number, but `{signal.name}` is {SORTS[signal.sort]}"
            self.complain("unit-mismatch", span, message)
            return None
        unit = signal.unit
        if unit is not None and function in ("change", "stddev"):
            return Term(value, "number", unit.dimension, "K" if unit.offset else unit.symbol, span, "difference")
        return term_of(value, signal, span)

    def _choice(self, written: syntax.Choice) -> Term | None:
        amounts = [*(case.value for case in written.table.cases), written.table.otherwise]
        conditions = [self.condition(case.condition) for case in written.table.cases]
        terms = [self._amount(amount, None) for amount in amounts if amount is not None]
        understood = [term for term in terms if term is not None]
        if len(understood) < len(amounts) or None in conditions:
            return None
        first = understood[0]
        alike = [self._comparable(first, other, "==") for other in understood[1:]]
        if not all(alike):
            return None
        values = [simple(term.value) for term in understood]
        cases = [
            model.ResolvedCase(value, condition)
            for value, condition in zip(values, (*conditions, None), strict=True)
            if value is not None
        ]
        table = model.ResolvedTable(tuple(cases))
        return Term(table, first.sort, first.dimension, first.unit, Span(written.start, written.end), first.level)

    def _arithmetic(self, written: syntax.Binary) -> Term | None:
        left, right = self._expression(written.left), self._expression(written.right)
        if left is None or right is None:
            return None
        span = Span(written.start, written.end)
        for term in (left, right):
            if term.sort != "number":
                value_text = f"`{self._text_at(term.span)}` ({in_words(term)})"
                message = f"`{written.operator}` requires numbers, found {value_text}"
                self.complain("unit-mismatch", span, message)
                return None
        value = model.Arithmetic(written.operator, left.value, right.value)
        if left.dimension is None or right.dimension is None:
            return Term(value, "number", None, None, span)
        if written.operator in "*/":
            return self._product(value, left, right, span)
        if left.dimension != right.dimension:
            self._mismatch(left, right, "add" if written.operator == "+" else "subtract")
            return None
        level = sum_level(written.operator, left.level, right.level)
        if level is None:
            self._level(right)
            return None
        unit = left.unit if level != "difference" or left.level != "level" else "K"
        return Term(value, "number", left.dimension, unit, span, level)

    def _product(self, value: model.Arithmetic, left: Term, right: Term, span: Span) -> Term | None:
        assert left.dimension is not None, "the caller has looked"
        assert right.dimension is not None, "the caller has looked"
        for term in (left, right):
            if term.level == "level":
                message = f"cannot multiply or divide `{self._text_at(term.span)}`, a temperature in degC"
                self.complain("unit-mismatch", term.span, message, notes=("write it in K",))
                return None
        sign = 1 if value.operator == "*" else -1
        pairs = zip(left.dimension, right.dimension, strict=True)
        dimension = tuple([a + sign * b for a, b in pairs])
        of_right = right.unit if sign == 1 and not any(left.dimension) else None
        unit = left.unit if right.dimension == model.NO_DIMENSION else of_right
        return Term(value, "number", dimension, unit, span)


def _values_in(value: model.Number) -> Iterator[object]:
    """The parts of a value; of a table only its values."""
    values = [case.value for case in value.cases] if isinstance(value, model.ResolvedTable) else [value]
    return model.parts_in(tuple(values))


_DEEPEST: Final = 50  # nested contexts: a condition is a tree that is walked recursively
_WORDS_FOR_NUMBERS: Final = ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
