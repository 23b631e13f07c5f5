"""Truncated files, and files with changed bytes: a result or one clear error, in every format.

`python tests/whole/test_damaged_logs.py 20000` makes that many of each format, with another seed each time unless one
follows; it prints the seed.
"""

from __future__ import annotations

import random
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import duckdb
import pytest

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from evidence_bags import names_of, number, text, tree_log, write_bag
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows, write_db3
from seeds import SEED, share_of

from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.judging import Means
from btq_lang.evidence.model import NamedLog
from btq_lang.evidence.readers import NotALog, read
from btq_lang.evidence.readers.samples import NoSamples
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.runs import activations
from btq_lang.evidence.signal_sources import Declared
from btq_lang.evidence.verifying import verify
from btq_lang.workspace.project_evidence import SignalSource
from btq_lang.workspace.workspace import Workspace

TWO_RUNS = rows("0 1R 2R 5 2S 3S 1S 2I 3I 1I 20 1R 2R 30 2F 1F 2I 1I")
CHANGES = tree_log(TWO_RUNS, names_of(MAIN_XML))
DEMANDS = "QualityReq rq : safety\n    Move needs battery > 1 %\n    Move takes at most 6 ms\n"
MISSION = Candidate(Workspace.of({"a.btq": f"signal battery : % from {{level}}\n{DEMANDS}{MAIN}"}), "a.btq", "a", None)
SOURCES = (SignalSource("battery", topic="/charge", field="data"),)
MUTATIONS = 1000


# ---- a file of each format ----


def _bag(storage: str, compression: str = "none") -> Callable[[Path], Path]:
    def write(folder: Path) -> Path:
        extra = [number("/charge", START, 50.0), text("/tree", START, MAIN_XML)]
        write_bag(folder / "bag", [*CHANGES, *extra], storage, compression)  # type: ignore[arg-type]  # a name from a list
        (file,) = (each for each in (folder / "bag").iterdir() if each.suffix in (".mcap", ".db3"))
        return file

    return write


def _metadata(folder: Path) -> Path:
    return _bag("mcap")(folder).parent / "metadata.yaml"


def _btlog(folder: Path) -> Path:
    (folder / "a.btlog").write_bytes(btlog(MAIN_XML, TWO_RUNS))
    return folder / "a.btlog"


def _klein(folder: Path) -> Path:
    _btlog(folder)
    lines = [f'{{"klein_blackboard": 1, "first_timestamp": {START}, "tree_id": "Main"}}']
    lines += [f'{{"t": {each}, "board": "Main", "key": "level", "value": {each}}}' for each in range(3)]
    (folder / "a.bb.jsonl").write_text("\n".join(lines), encoding="utf-8")
    return folder / "a.bb.jsonl"


def _db3(folder: Path) -> Path:
    write_db3(folder / "a.db3", MAIN_XML, [TWO_RUNS, TWO_RUNS], {0: '{"level": 50}'})
    return folder / "a.db3"


def _csv(folder: Path) -> Path:
    (folder / "a.csv").write_text(f"t,battery\n{START / 1e6:.6f},50\n{START / 1e6 + 1:.6f},\n", encoding="utf-8")
    return folder / "a.csv"


def _parquet(folder: Path) -> Path:
    duckdb.sql(f"COPY (SELECT 1.5 AS t, 50 AS battery, 'x' AS other) TO '{folder}/a.parquet' (FORMAT parquet)")
    return folder / "a.parquet"


FORMATS = {
    "btlog": _btlog,
    "db3": _db3,
    "klein": _klein,
    "mcap": _bag("mcap"),
    "mcap-zstd": _bag("mcap", "storage"),
    "bag-db3": _bag("sqlite3"),
    "metadata": _metadata,
    "csv": _csv,
    "parquet": _parquet,
}


def tried(file: Path) -> int:
    """How many errors a file has; whatever it holds, it has no more than one, and nothing is raised."""
    if file.suffix in (".csv", ".parquet"):
        try:
            read_samples(str(file))
        except NoSamples:
            return 1
        return 0
    log = {"a.bb.jsonl": file.with_name("a.btlog"), "metadata.yaml": file.parent}.get(file.name, file)
    report = verify([str(log)], Means([MISSION], declared=Declared(SOURCES), shown=str))
    assert len(report.problems) <= 1
    assert all(len(problem) > len(f"{log}: ") for problem in report.problems)
    return len(report.problems)


def mutate(file: Path, mutations: Sequence[int], seed: int) -> int:
    """Change some bytes of a file, again and again; how many of the files of these numbers were in error."""
    whole = file.read_bytes()
    chance = random.Random(seed)
    errors = 0
    for mutation in range(mutations[-1] + 1):
        data = bytearray(whole)
        for _ in range(chance.choice((1, 1, 2, 8))):
            data[chance.randrange(len(data))] = chance.choice((0, 1, 0x7F, 0xFF, chance.randrange(256)))
        if mutation not in mutations:
            continue
        with file.open("r+b") as there:  # emptying a file first costs more than most readers take for it
            there.write(data)
        try:
            errors += tried(file)
        except BaseException:
            print(f"{file.name}: mutation {mutation} of seed {seed}")
            raise
    return errors


@pytest.mark.parametrize("form", FORMATS)
def test_bytes_that_somebody_has_changed(form: str, tmp_path: Path) -> None:
    file = FORMATS[form](tmp_path)
    assert tried(file) == 0
    mutations = share_of(range(MUTATIONS), 4)
    errors = mutate(file, mutations, 25 + SEED)
    assert errors < len(mutations)
    if form != "metadata":  # without which the files beside it are read, but a type that it names may be gone
        assert (errors > 0) == (form != "klein")


# ---- prefixes ----


def runs_of(file: Path) -> list[str] | None:
    """The outcomes of the runs in a log, or how many changes a log without a tree has; None where it is an error."""
    found: list[str] = []
    try:
        for each in read(str(file)):
            if isinstance(each, NamedLog):
                found += ["change"] * len(each.times)
            else:
                found += [activation.outcome for activation in activations(each) if activation.uid == 1]
    except NotALog:
        return None
    return found


def prefixes(file: Path, whole: bytes, lengths: Iterable[int]) -> Iterator[int]:
    """Let a file grow to the whole: how long it is."""
    file.write_bytes(b"")
    for length in [*lengths, len(whole)]:
        with file.open("ab") as end:
            end.write(whole[file.stat().st_size : length])
        yield length


@pytest.mark.parametrize("form", ["btlog", "db3", "mcap", "mcap-zstd", "bag-db3"])
def test_every_prefix_is_read_or_is_one_error(form: str, tmp_path: Path) -> None:
    """And the longer it is, the more there is in it."""
    file = FORMATS[form](tmp_path)
    whole = file.read_bytes()
    most = 0
    # SQLite reads pages of 4096 bytes.
    lengths = range(0, len(whole), 61) if form in ("db3", "bag-db3") else share_of(range(len(whole)), 8)
    for length in prefixes(file, whole, lengths):
        found = runs_of(file)
        assert len(found or ()) >= most, length
        most = len(found or ())
    assert most > 0


@pytest.mark.parametrize("name", ["lab", "nav", "nav_noidle"])
def test_every_prefix_of_the_headers_of_real_logs(name: str, shared: Path, tmp_path: Path) -> None:
    whole = (shared / "logs" / f"{name}.btlog").read_bytes()
    header = 23 + int.from_bytes(whole[19:23], "little") + 8
    file = tmp_path / "a.btlog"
    for length in prefixes(file, whole[:header], share_of(range(header), 8)):
        assert runs_of(file) == (None if length < header else [])


@pytest.mark.parametrize("name", ["lab", "lab_sessions", "nav"])
def test_what_is_whole_of_a_cut_database_is_read(name: str, shared: Path, tmp_path: Path) -> None:
    """Half of the file has about half of the runs, and a line says how much is missing."""
    whole = (shared / "logs" / f"{name}.db3").read_bytes()
    file = tmp_path / "a.db3"
    file.write_bytes(whole)
    every = runs_of(file) or []
    file.write_bytes(whole[: len(whole) // 2])
    sessions = 0
    for session in read(str(file)):
        assert not isinstance(session, NamedLog)
        [*activations(session)]
        assert (
            session.remarks[0] == f"cut off: the last {len(whole) - len(whole) // 2} bytes of the database are missing"
        )
        sessions += 1
    assert sessions > 0
    found = runs_of(file) or []
    assert len(every) // 4 < len(found) < len(every)
    assert found[:-1] == every[: len(found) - 1]


if __name__ == "__main__":
    wanted = int(sys.argv[1])
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(1 << 32)
    print(f"seed {seed}")
    for form, write in FORMATS.items():
        with tempfile.TemporaryDirectory() as folder:
            file = write(Path(folder))
            print(f"{form}: {mutate(file, range(wanted), seed)} of {wanted} are errors", flush=True)
