"""Which entries C++ sets on a blackboard, by `set` and by functions around it."""

from __future__ import annotations

import pytest

from btq_lang.cpp.entries import SetEntries, set_entries

WRAPPER = "void put(const std::string & key, const T & value = {}) { blackboard_->set<T>(key, value); }"


@pytest.mark.parametrize(
    ("sources", "names", "has_unseen"),
    [
        (['blackboard->set("a", 1); tree.rootBlackboard()->set<std::string>( "b" , x);'], {"a", "b"}, False),
        ([WRAPPER, 'bb->set("bt.mode", 1); put("bt.goal", g);'], {"bt.mode", "bt.goal"}, False),
        (['params.set(name, 1); blackboard->get("a", x);'], set(), False),
        (["blackboard->set(name, 1);"], set(), True),
        (['bb->set(prefix + "a", 1);'], set(), True),
        (['bb->set("a" + suffix, 1);'], set(), True),
        ([WRAPPER, 'tree->put<bool>("a", true); put("b", 1);'], {"a", "b"}, False),
        ([WRAPPER, "put(name, true);"], set(), True),
        ([WRAPPER, "put(Names::A, true);"], set(), True),
        ([WRAPPER.replace("(key,", "(other,"), 'put("a", 1);'], set(), True),
        (["void put(T key) { if (key) { board.set(key, 1); } }", 'put("a");'], {"a"}, False),
        (["auto put = [&](auto key, auto v) { bb->set(key, v); };", 'put("a", 1);'], {"a"}, False),
        (
            ["void f(T key) { use(key); } void g() { for (auto key : keys) { bb->set(key, 1); } }", 'f("a");'],
            set(),
            True,
        ),
    ],
)
def test_entries(sources: list[str], names: set[str], has_unseen: bool) -> None:
    assert set_entries(sources) == SetEntries(frozenset(names), has_unseen)
