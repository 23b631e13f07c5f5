"""The part of the parser that reads what is attached to a node: attributes in brackets, qualities and requirements.

One invariant: it stays on the current logical line; `nodes` handles lines and blocks.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.cursor import VALUES, shown
from btq_lang.grammar.requirements import RequirementParser
from btq_lang.syntax.suggestions import CHILDREN, value_meant
from btq_lang.syntax.tokens import (
    BRACED,
    CATEGORIES,
    CLOSE,
    NAME,
    NEWLINE,
    NODE_CLAUSES,
    NUMBER,
    OPEN,
    OPERATOR,
    QUANTITY,
    STRING,
    SYMBOL,
)
from btq_lang.syntax.tree import (
    NodeClause,
    Pair,
    ReqRef,
    Requirement,
    SatisficedQuality,
    Satisfices,
    Satisfies,
    Tags,
    Word,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span


class AttributeParser(RequirementParser):
    """A cursor that can read what is attached to a node."""

    # ---- attributes ----

    def pairs(self) -> tuple[Pair, ...]:
        """Pairs = "(" { ( "parameters" Pair { "," Pair } | Pair ) [ "," ] } ")";  none where no bracket opens"""
        if self.kind != OPEN:
            return ()
        clauses: list[NodeClause] = []
        pairs = self.attributes(clauses)
        if clauses:
            span = Span(clauses[0].start, clauses[0].end).shifted(self.base)
            note = "write qualities and requirements after a node, or on a line of their own in the block of a tree"
            self.complain(span, "only `key = value` pairs are allowed in these brackets", notes=(note,))
        return pairs

    def attributes(self, clauses: list[NodeClause]) -> tuple[Pair, ...]:
        """Attributes = "(" { Attribute [ "," ] } ")";  Attribute = "parameters" Pair … | NodeClause | Pair"""
        pairs: list[Pair] = []
        self.advance()
        self.group += 1
        while self.kind != CLOSE and self.kind != NEWLINE:
            if self.at_key():
                pairs.append(self.pair())
            elif self.kind == NAME and self.raw in NODE_CLAUSES:
                clauses.append(self.node_clause())
            elif self.at_word("parameters"):
                self.advance()
                if not self.at_key():
                    self.expected("`key = value` after `parameters`")
                continue
            else:
                self.not_an_attribute(pairs, clauses)
            if self.raw == ",":
                self.advance()
        self.group -= 1
        self.advance()
        return tuple(pairs)

    def not_an_attribute(self, pairs: list[Pair], clauses: list[NodeClause]) -> None:
        """Report what is in brackets and is not an attribute, and read it as what it was probably meant to be."""
        index = self.index
        if self.at_name() and (self.is_operator(index + 1, ":") or self.is_operator(index + 1, "==")):
            sign = self.starts[index + 1]
            is_assignment = self.text.startswith(":=", sign)
            span = Span(sign, sign + (2 if is_assignment else len(self.raws[index + 1])))
            written = "=" if self.text[sign - 1] in " \t" else " ="
            message = f"expected `=` between key and value, found `{self.text[span.start : span.end]}`"
            self.complain(span, message, replace_fix("Write `=`", span, written, safe=True))
            if is_assignment:
                self.advance()
            pairs.append(self.pair())
            return
        if self.kind == NAME and self.kinds[index + 1] in (NAME, STRING) and (meant := self.misspelt_clause()):
            clauses.append(self.node_clause(meant))
            return
        notes: tuple[str, ...] = ()
        if self.kinds[index - 1] in (NAME, NUMBER, QUANTITY) and self.kind in (NAME, NUMBER, QUANTITY):
            notes = ("a value or name of several words goes in quotes",)
        elif self.kinds[index - 1] == OPEN and self.kind in (NUMBER, QUANTITY, STRING):
            notes = (f"a value goes after the name of its port: `port = {shown(self.raw)}`",)
        elif self.kinds[index - 1] == OPEN and self.kind == NAME and self.raws[index + 1] == ",":
            notes = (CHILDREN,)
        elif self.raw in ("+", "%") and self.kinds[index - 1] in (STRING, NAME, BRACED):
            self.complain(self.here(), _PUT_TOGETHER, notes=(_LITERAL_OR_ENTRY,))
            self.recover()
            return
        fixes = self.id_in_brackets() or self.classic_quality(clauses)
        if self.kind == NAME and self.kinds[index + 1] in (STRING, NUMBER, QUANTITY, BRACED):
            gap = Span(self.here().end, self.starts[index + 1])
            fixes = (replace_fix("Put `=` after it", gap, " = "),)
        self.expected("an attribute: key = value", notes, fixes)
        if self.index == index:
            self.advance()

    def id_in_brackets(self) -> tuple[Fix, ...]:
        """The fix for `SubTree (PickPlace)`, where the ID needs no brackets."""
        index = self.index
        if index != 2 or self.kind != NAME or self.raws[0] not in CATEGORIES or self.kinds[index + 1] != CLOSE:
            return ()
        before = Span(self.starts[0] + len(self.raws[0]), self.here().start)
        after = Span(self.here().end, self.starts[index + 1] + len(self.raws[index + 1]))
        return (Fix("Remove the brackets", (FixEdit(Place(before), " "), FixEdit(Place(after), ""))),)

    def classic_quality(self, clauses: list[NodeClause]) -> tuple[Fix, ...]:
        """The fix for `satisfices performance (QualityReq …)`, which lacks `Quality =` before the quality."""
        if self.kind != OPEN or not self.is_word(self.index + 1, "QualityReq") or not clauses:
            return ()
        last = clauses[-1]
        if not isinstance(last, Satisfices) or not last.qualities or last.end != self.last_end():
            return ()
        start = last.qualities[-1].path.span.start + self.base
        return (replace_fix("Put `Quality =` before the quality", Span(start, start), "Quality = "),)

    def pair(self) -> Pair:
        """Pair = Name "=" Value"""
        index = self.index
        key = Word(self.kind, self.starts[index] - self.base, self.raw)
        self.go_to(index + 2)
        return Pair(key, self.value())

    def value(self) -> Word | None:
        """Value = STRING | NAME | NUMBER | QUANTITY | BRACED"""
        whole = self.kind in VALUES
        if not whole and (self.kind not in (SYMBOL, OPERATOR) or self.raw in ("=", ",")):
            self.expected("a value: a string, a name, a number, a quantity or {key}")
            return None
        word = self.take()
        if whole and (self.kind == CLOSE or not self.joins() or self.at_key()):
            return word
        if self.kind == STRING and word.kind != STRING:
            return self.half_quoted(word)
        return self.needs_quotes(word)

    def half_quoted(self, word: Word) -> Word:
        """`charger" …`: the rest is a string only because a quote is missing; or Python is meant: `f"dock{n}"`."""
        span = word.span.shifted(self.base)
        if word.raw.lower() in _STRING_PREFIXES and self.adjacent(self.index):
            end = self.here().end
            self.complain(Span(span.start, end), _PUT_TOGETHER, notes=(_LITERAL_OR_ENTRY,))
            self.recover()
            return Word(NAME, word.start, self.text[span.start : end])
        fix = Fix(f"Put {self.raw[0]} before it", (FixEdit(Place(Span(span.start, span.start)), self.raw[0]),))
        start = self.starts[self.index]
        unclosed = [problem for problem in self.lexer.problems[self.known :] if problem.span.start == start]
        message = f"missing quote before `{word.raw}`"
        if self.complain_instead(unclosed, Diagnostic("syntax-error", span, message, fixes=(fix,))):
            self.inside_out = min(self.inside_out, span.end)
        self.recover()
        return word

    def joins(self) -> bool:
        """Whether the current token forms one value with the one before it: there is no blank between."""
        if not self.adjacent(self.index):
            return False
        return self.kind not in (NEWLINE, OPEN, CLOSE) and self.raw not in (",", "=")

    def ends_value(self) -> bool:
        """Whether the next token may follow a value."""
        return self.kind in (NEWLINE, CLOSE) or self.raw == "," or self.raw in _ATTRIBUTE_WORDS or self.at_key()

    def needs_quotes(self, word: Word) -> Word:
        """`map/frame`, `/map`: read what is written without a blank as one value, and report that it needs quotes."""
        cause = self.lost_quote() or self.wrong_unit()
        while self.joins():
            self.advance()
        start = word.start + self.base
        end = self.last_end() + self.base
        raw = self.text[start:end]
        if cause is not None:
            self.report(cause)
        elif word.kind == STRING:
            note = "write a quote in a string as \\\", in a script as '; or add a closing quote that is missing above"
            fixes: tuple[Fix, ...] = ()
            if raw[0] == raw[-1] == '"' and raw.count('"') == 4 and "'" not in raw and self.ends_value():
                note = "write a quote in a string as \\\", in a script as '"
                single = raw[1:-1].replace('"', "'")
                fixes = (write_fix(f'"{single}"', Span(start, end)),)
            self.complain(Span(start, end), "unexpected text right after a string", *fixes, notes=(note,))
        else:
            # A quote or a brace in it indicates another mistake.
            safe = self.ends_value() and not set(raw) & set("\"'{}\\")
            self.complain(Span(start, end), "this value needs quotes", value_meant(self.text, start, end, safe=safe))
        return Word(NAME, word.start, raw)

    # ---- qualities and requirements on nodes ----

    def misspelt_clause(self) -> str | None:
        """Report a misspelt word, `satisfys rq1`, and return the one that was probably meant."""
        meant = meant_clause(self.raw) if self.raw not in _ATTRIBUTE_WORDS else None
        if meant is not None:
            self.attaches_nothing(self.here(), meant)
        return meant

    def attaches_nothing(self, span: Span, meant: str) -> None:
        """Report a misspelt satisfices, satisfies or tags."""
        word = self.text[span.start : span.end]
        by = self.index + 1
        place = span
        if word == "satisfied" and self.is_word(by, "by") and self.kinds[by + 1] in (NAME, STRING):
            place = Span(span.start, self.starts[by] + len("by"))
        message = f"unknown word `{word}`; did you mean `{meant}`?"
        self.complain(span, message, replace_fix(f"Replace `{word}` with `{meant}`", place, meant))

    def node_clause(self, meant: str = "") -> NodeClause:
        """ "satisfices" Quality { "," Quality } | "satisfies" ReqUse { "," ReqUse } | "tags" Name { "," Name }

        Args:
            meant: the word to read instead of the current one.
        """
        start = self.start()
        word = self.take().raw
        if meant:
            word = meant
        if word == "satisfices":
            qualities = self.satisfices()
            return Satisfices(start, self.last_end(), qualities)
        if word == "satisfies":
            uses = self.satisfies()
            return Satisfies(start, self.last_end(), uses)
        names = self.listed(lambda: self.name("a tag"), self.list_goes_on)
        return Tags(start, self.last_end(), names)

    def satisfices(self) -> tuple[SatisficedQuality, ...]:
        """Quality { "," Quality };  classic files omit the commas"""
        self.skip_sign(":")
        return self.listed(self.quality, lambda: self.at_quality() or self.list_goes_on(qualities=True))

    def at_quality(self) -> bool:
        return self.kind == NAME and self.raw == "Quality" and self.is_operator(self.index + 1, "=")

    def quality(self) -> SatisficedQuality | None:
        """ "Quality" "=" QualityPath [ "(" Requirement { [ "," ] Requirement } ")" ] | QualityPath"""
        classic = self.at_quality()
        if classic:
            self.advance()
            self.advance()
        elif self.at_word("Quality") and (self.is_operator(self.index + 1, ":") or self.names_follow(self.index + 1)):
            self.advance()
            has_sign = self.at(":")
            place = Span(self.last_end() + self.base, self.here().end if has_sign else self.here().start)
            blank = "" if self.text[place.end : place.end + 1] in (" ", "\t") else " "
            message = f"expected `=` after `Quality`, found {self.found()}"
            self.complain(self.here(), message, replace_fix("Write `=`", place, f" ={blank}", safe=True))
            self.accept(":")
            classic = True
        path = self.quality_path()
        if path is None:
            return None
        if not classic or self.kind != OPEN:
            return SatisficedQuality(path)
        self.advance()
        self.group += 1
        requirements: list[Requirement] = []
        while self.at_word("QualityReq"):
            requirements.append(self.requirement())
            self.accept(",")
        self.close_group("QualityReq or `)`")
        return SatisficedQuality(path, tuple(requirements))

    def names_follow(self, index: int) -> bool:
        """Whether a quality's name follows, so that `Quality` before it lacks its `=`."""
        if self.kinds[index] not in (NAME, STRING) or self.raws[index] in _ATTRIBUTE_WORDS:
            return False
        return not self.is_operator(index + 1, "=")

    def satisfies(self) -> tuple[Requirement | ReqRef, ...]:
        """ReqUse { "," ReqUse };  classic files omit the commas"""
        self.skip_sign(":", "=")
        if self.at_word("by") and self.kinds[self.index + 1] in (NAME, STRING):
            self.advance()  # `satisfied by r`, reported at its first word
        if not self.group:
            self.skip_brackets("requirements of a node need no brackets")
        return self.listed(self.req_use, lambda: self.at_word("QualityReq") or self.list_goes_on())

    def req_use(self) -> Requirement | ReqRef | None:
        """ReqUse = Requirement | ReqRef"""
        if self.at_word("QualityReq"):
            return self.requirement()
        if self.kind == NAME and self.raw.lower() in _REQUIREMENTS and self.kinds[self.index + 1] in (NAME, STRING):
            return self.requirement_in_other_words()
        if self.kind == NEWLINE and self.index and self.raws[self.index - 1] == ",":
            end = self.last_end() + self.base
            fix = replace_fix("Remove `,`", Span(end - 1, end), "", safe=True)
            self.expected("another requirement after the comma", (), (fix,))
            return None
        name = self.requirement_id("a requirement: its ID, or QualityReq and a definition")
        return self.req_ref(name) if name is not None else None

    def requirement_in_other_words(self) -> Requirement | ReqRef | None:
        """`satisfies QualityRequirement ID = r`, `satisfies requirement r`"""
        word = self.here()
        if self.is_word(self.index + 1, "ID") and self.is_operator(self.index + 2, "="):
            message = f"unknown word `{self.raw}`; did you mean `QualityReq`?"
            self.complain(word, message, replace_fix(f"Replace `{self.raw}` with `QualityReq`", word, "QualityReq"))
            return self.requirement()
        if self.raws[self.index + 1] in _ATTRIBUTE_WORDS or self.is_operator(self.index + 2, "="):
            return self.req_ref(self.take())
        fix = replace_fix(f"Remove `{self.raw}`", Span(word.start, self.starts[self.index + 1]), "")
        self.complain(word, "a requirement is named by its ID alone", fix)
        self.advance()
        return self.req_ref(self.take())

    def list_goes_on(self, qualities: bool = False) -> bool:
        """Skip a comma if another element follows it; in brackets an attribute may follow instead."""
        if self.at_word("and") and self.kinds[self.index + 1] in (NAME, STRING) and not self.group:
            return self.accept_and()
        if not self.at(","):
            return False
        following = self.index + 1
        if self.group:
            if self.kinds[following] == CLOSE:
                return False
            if self.is_operator(following + 1, "=") and not (qualities and self.is_word(following, "Quality")):
                return False
            if self.kinds[following] == NAME and self.raws[following] in _ATTRIBUTE_WORDS:
                return False
        self.advance()
        return True


def meant_clause(word: str) -> str | None:
    """Which of satisfices, satisfies and tags a word probably means."""
    if likely := near(word, NODE_CLAUSES, limit=1):
        return likely[0]
    return "satisfies" if word.startswith("satisf") else None


_ATTRIBUTE_WORDS: Final = NODE_CLAUSES | {"parameters"}
_STRING_PREFIXES: Final = frozenset(("f", "r", "b", "u", "fr", "rf", "br", "rb"))
_PUT_TOGETHER: Final = "a value is one literal or one entry, and nothing puts several together"
_LITERAL_OR_ENTRY: Final = "write a text in quotes or an entry `{key}`, to which a Script before can give `'dock' .. n`"
_REQUIREMENTS: Final = frozenset(("requirement", "req", "qualityrequirement", "qualityreq"))
