"""What a tree does without a run: exact where nodes do not depend on entries, conditions or a tick's moment.

One invariant: what it says agrees with drawn runs, and where it cannot be certain of that, it says which node is why.

    times.py      distributions of durations
    folded.py     how a node may end
    fold.py       what nodes do, by what their children do
    parallel.py   children that run at the same time
"""

from btq_lang.prediction.exact.fold import PERIOD, TreeFold, exact_success
from btq_lang.prediction.exact.folded import Folded, FoldedOutcome, NotExact
from btq_lang.prediction.exact.times import Times

__all__ = ["PERIOD", "Folded", "FoldedOutcome", "NotExact", "Times", "TreeFold", "exact_success"]
