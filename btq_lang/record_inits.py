"""What an `__init__` of so many fields does, for the numbers of fields that most records have.

One invariant: it gives each setter, in order, its value; no setter returns anything, so `or` goes on to the next.  It
stands here in full because to compile those that one check needs would take as long as to parse fifty nodes.
"""

from __future__ import annotations

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, Final

INITS: Final[dict[int, Callable[..., Any]]] = {
    1: lambda a: lambda self, aa: a(self, aa),
    2: lambda a, b: lambda self, aa, bb: a(self, aa) or b(self, bb),
    3: lambda a, b, c: lambda self, aa, bb, cc: a(self, aa) or b(self, bb) or c(self, cc),
    4: lambda a, b, c, d: lambda self, aa, bb, cc, dd: a(self, aa) or b(self, bb) or c(self, cc) or d(self, dd),
    5: lambda a, b, c, d, e: (
        lambda self, aa, bb, cc, dd, ee: a(self, aa) or b(self, bb) or c(self, cc) or d(self, dd) or e(self, ee)
    ),
    6: lambda a, b, c, d, e, f: (
        lambda self, aa, bb, cc, dd, ee, ff: (
            a(self, aa) or b(self, bb) or c(self, cc) or d(self, dd) or e(self, ee) or f(self, ff)
        )
    ),
    7: lambda a, b, c, d, e, f, g: (
        lambda self, aa, bb, cc, dd, ee, ff, gg: (
            a(self, aa) or b(self, bb) or c(self, cc) or d(self, dd) or e(self, ee) or f(self, ff) or g(self, gg)
        )
    ),
    8: lambda a, b, c, d, e, f, g, h: (
        lambda self, aa, bb, cc, dd, ee, ff, gg, hh: (
            a(self, aa)
            or b(self, bb)
            or c(self, cc)
            or d(self, dd)
            or e(self, ee)
            or f(self, ff)
            or g(self, gg)
            or h(self, hh)
        )
    ),
    9: lambda a, b, c, d, e, f, g, h, i: (
        lambda self, aa, bb, cc, dd, ee, ff, gg, hh, ii: (
            a(self, aa)
            or b(self, bb)
            or c(self, cc)
            or d(self, dd)
            or e(self, ee)
            or f(self, ff)
            or g(self, gg)
            or h(self, hh)
            or i(self, ii)
        )
    ),
    10: lambda a, b, c, d, e, f, g, h, i, j: (
        lambda self, aa, bb, cc, dd, ee, ff, gg, hh, ii, jj: (
            a(self, aa)
            or b(self, bb)
            or c(self, cc)
            or d(self, dd)
            or e(self, ee)
            or f(self, ff)
            or g(self, gg)
            or h(self, hh)
            or i(self, ii)
            or j(self, jj)
        )
    ),
    13: lambda a, b, c, d, e, f, g, h, i, j, k, m, n: (
        lambda self, aa, bb, cc, dd, ee, ff, gg, hh, ii, jj, kk, mm, nn: (
            a(self, aa)
            or b(self, bb)
            or c(self, cc)
            or d(self, dd)
            or e(self, ee)
            or f(self, ff)
            or g(self, gg)
            or h(self, hh)
            or i(self, ii)
            or j(self, jj)
            or k(self, kk)
            or m(self, mm)
            or n(self, nn)
        )
    ),
    17: lambda a, b, c, d, e, f, g, h, i, j, k, m, n, p, q, r, s: (
        lambda self, aa, bb, cc, dd, ee, ff, gg, hh, ii, jj, kk, mm, nn, pp, qq, rr, ss: (
            a(self, aa)
            or b(self, bb)
            or c(self, cc)
            or d(self, dd)
            or e(self, ee)
            or f(self, ff)
            or g(self, gg)
            or h(self, hh)
            or i(self, ii)
            or j(self, jj)
            or k(self, kk)
            or m(self, mm)
            or n(self, nn)
            or p(self, pp)
            or q(self, qq)
            or r(self, rr)
            or s(self, ss)
        )
    ),
}
