"""What `bench/store.py` compares is comparable: btq and the SQL by hand count the same violations of a store."""

from __future__ import annotations

from pathlib import Path

import store


def test_summaries_of_a_made_up_store_count_the_same(tmp_path: Path) -> None:
    store.made_up(tmp_path, 2 * store.IN_A_LOG)
    violated = store.by_hand(tmp_path)
    assert 500 < violated < 1500  # one in a hundred, by a hash
    assert store.by_btq(tmp_path) == violated
