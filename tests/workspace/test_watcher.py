"""Watching, with a clock and a disk that are only numbers and a dictionary."""

from __future__ import annotations

from collections.abc import Mapping

from btq_lang.workspace.watcher import INTERVAL, watch


class Stop(Exception):
    """The end of the script: what Ctrl-C is to a real wait."""


class Disk:
    """Stamps by path, and what happens to them during each wait; None removes a file."""

    def __init__(self, *script: Mapping[str, int | None], looking_takes: float = 0.0) -> None:
        self.stamps: dict[str, int] = {"a": 1, "b": 1}
        self.script = list(script)
        self.looking_takes = looking_takes
        self.time = 0.0
        self.waits: list[float] = []

    def wait(self, seconds: float) -> None:
        self.waits.append(round(seconds, 3))
        self.time += seconds
        if not self.script:
            raise Stop
        for path, stamp in self.script.pop(0).items():
            if stamp is None:
                del self.stamps[path]
            else:
                self.stamps[path] = stamp

    def files(self) -> list[str]:
        self.time += self.looking_takes
        return [*self.stamps, "never there"]

    def changes(self) -> list[tuple[str, ...]]:
        found: list[tuple[str, ...]] = []
        try:
            for change in watch(self.files, self.stamps.get, self.wait, lambda: self.time):
                found.append(change)
        except Stop:
            return found
        raise AssertionError("watching ended by itself")


def test_changed_new_and_removed_files_are_told() -> None:
    disk = Disk({}, {"a": 2}, {}, {"c": 1, "b": None}, {}, {})
    assert disk.changes() == [("a",), ("b", "c")]


def test_nothing_is_told_where_nothing_changes() -> None:
    assert Disk({}, {}, {}).changes() == []


def test_a_change_is_told_once_when_the_files_rest() -> None:
    disk = Disk({"a": 2}, {"a": 3}, {"b": 2}, {}, {})
    assert disk.changes() == [("a", "b")]
    assert disk.waits == [INTERVAL, 0.05, 0.05, 0.05, INTERVAL, INTERVAL]


def test_a_change_that_is_taken_back_is_none() -> None:
    assert Disk({"a": 2}, {"a": 1}, {}, {}).changes() == []


def test_a_file_that_never_rests_is_told_all_the_same() -> None:
    disk = Disk(*({"a": number} for number in range(2, 24)))
    assert disk.changes() == [("a",)]
    assert disk.waits == [INTERVAL, *[0.05] * 20, INTERVAL, 0.05]


def test_looking_takes_a_tenth_of_the_time_at_most() -> None:
    disk = Disk({}, {}, looking_takes=0.2)
    assert disk.changes() == []
    assert disk.waits == [INTERVAL, 2.0, 2.0]
