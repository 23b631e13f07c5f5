"""A session says after every change what a new one would say of the same texts."""

from __future__ import annotations

import gc
import random
from collections import Counter
from pathlib import Path

import pytest
from seeds import seeds

from btq_lang.checks import _reported
from btq_lang.ide.colours import Colours, TokenEdit, colours, delta
from btq_lang.ide.completion import complete
from btq_lang.ide.navigation import find_references
from btq_lang.ide.outline import document_symbols
from btq_lang.lsp.convert import Converter
from btq_lang.lsp.session import Session
from btq_lang.workspace.queries import Store, _Answer
from btq_lang.workspace.workspace import Workspace

MAIN = """include "skills.btq"
include "requirements.btq"
Root Main
BehaviorTree Main
    ->
        Pick (from = {shelf}) satisfies rq1
        SubTree Carry (to = "x")
        Place satisfies rq2
"""
SKILLS = """Action Pick
    input from : string
BehaviorTree Carry
    input to : string
    Move (to = {to})
"""
REQUIREMENTS = """QualityReq rq1 : safety "Slowly"
    takes at most 3 s
"""
XML = """<root BTCPP_format="4">
  <BehaviorTree ID="Nav">
    <Sequence><Pick from="{a}"/><SubTree ID="Carry"/><AlwaysSuccess name=""/></Sequence>
  </BehaviorTree>
</root>
"""
TOP = """<root BTCPP_format="4">
  <BehaviorTree ID="Top"><Sequence><SubTree ID="Nav"/><SubTree ID="Carry" ot="x"/><Pick/></Sequence></BehaviorTree>
</root>
"""  # of which nav.xml and the other files are the pool
PROJECTS = (
    "",
    'include-paths = ["lib"]\n',
    'engine = "4.6"\n',
    'ignore = ["unknown-node", "missing-include"]\n',
    'select = ["unused-tree", "unknown-requirement", "include-with-errors"]\n',
)
FACTORIES = """[[factory]]
name = "all"
load = ["main.btq", "*.btq", "*.xml"]
main = "Main"
[[factory]]
name = "some"
load = ["skills.btq", "requirements.btq", "gone/*.btq"]
"""
OTHER = "BehaviorTree Alone\n    Pick\n"
FILES = {"main.btq": MAIN, "skills.btq": SKILLS, "requirements.btq": REQUIREMENTS, "other.btq": OTHER}
WITH_XML = {
    "main.btq": 'include "nav.xml"\ninclude "skills.btq"\nBehaviorTree Main\n    SubTree Nav\n',
    "skills.btq": SKILLS,
    "nav.xml": XML,
    "top.xml": TOP,
    "dock.xml": XML.replace("Nav", "Dock").replace("Carry", "Nav"),
}
PIECES = (
    *(
        "\n",
        "    ",
        "Pick",
        "rq1",
        "rq2",
        "Carry",
        "satisfies ",
        '"',
        "(",
        ")",
        "{",
        "# ",
        'include "other.btq"\n',
        "BehaviorTree ",
    ),
    *("QualityReq rq2 ", "input ", "Root ", "3 s", "takes ", "Action Place\n"),
)
XML_PIECES = (
    *(
        "<",
        ">",
        "/",
        '"',
        " ",
        "\n",
        "🤖",
        "<!-- ",
        "-->",
        "Carry",
        "Nav",
        "Dock",
        'ID="',
        "Sequence",
        "&amp;",
        "<Pick/>",
    ),
    *(
        '<SubTree ID="Carry"/>',
        '<SubTree ID="Dock" to="x"/>',
        '<include path="dock.xml"/>',
        '<BehaviorTree ID="Dock"/>',
    ),
    '<TreeNodesModel><Action ID="Pick"><input_port name="from" type="int"/></Action></TreeNodesModel>',
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def session_of(folder: Path, texts: dict[str, str]) -> Session:
    session = Session()
    session.folders = (str(folder),)
    session.open.update(texts)
    session.reload()
    return session


@pytest.mark.usefixtures("strict_queries")
@pytest.mark.parametrize("seed", seeds(4))
def test_what_is_told_is_what_a_new_session_finds(folder: Path, seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0 if seed % 2 else 100_000)
    chance = random.Random(seed)
    if seed % 4 > 1:
        (folder / "btq.toml").write_text(FACTORIES, encoding="utf-8")
    session = session_of(folder, {})
    told = {path: session.diagnostics(path) for path in session.paths()}
    texts: dict[str, str] = {}
    known: dict[str, Colours] = {}
    kept = Converter()
    for step in range(60):
        name = chance.choice(sorted(FILES))
        path = f"{folder}/{name}"
        if path in texts and chance.random() < 0.1:
            del texts[path]
            changed = session.close(path)
        else:
            text = texts.get(path, FILES[name])
            at = chance.randrange(len(text) + 1)
            gone = chance.choice((0, 0, 1, 5, 20))
            texts[path] = text[:at] + chance.choice(PIECES) + text[at + gone :]
            changed = session.edit(path, texts[path])
        told.update({each: session.diagnostics(each) for each in changed})
        session.let_go()
        new = session_of(folder, texts)
        assert told == {each: new.diagnostics(each) for each in new.paths()}, (seed, step, texts)
        for each in new.paths():
            assert shown_by(session, each, kept) == shown_by(new, each, Converter()), (seed, step, texts)
        if path in texts:
            workspaces = session.workspace_of(path), new.workspace_of(path)
            assert workspaces[0] == workspaces[1]
            at = chance.randrange(len(texts[path]) + 1)
            for feature in (complete, find_references):
                mine, fresh = (feature(each, path, at) for each in workspaces if each is not None)
                assert mine == fresh
            outlines = [document_symbols(each, path) for each in workspaces if each is not None]
            assert outlines[0] == outlines[1]
            coloured, anew = (colours(each, path, "utf-16") for each in workspaces if each is not None)
            assert coloured.data == anew.data
            assert patched(known.get(path, coloured).data, delta(known.get(path, coloured), coloured)) == coloured.data
            if chance.random() < 0.5:  # an editor asks for what several edits have changed, in several places
                known[path] = coloured


@pytest.mark.usefixtures("strict_queries")
@pytest.mark.parametrize("seed", seeds(4))
def test_files_come_and_go_and_the_project_changes(folder: Path, seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("btq_lang.workspace.queries._FEW", 0 if seed % 2 else 10_000)
    chance = random.Random(seed)
    (folder / "lib").mkdir()
    texts = {f"{folder}/main.btq": MAIN, f"{folder}/skills.btq": SKILLS, f"{folder}/top.xml": TOP}
    session = session_of(folder, texts)
    places = [folder / name for name in (*FILES, "lib/skills.btq", "lib/requirements.btq", "nav.xml")]
    for step in range(60):
        place, change = chance.choice(places), chance.randrange(6)
        if change == 0:
            place.write_text(XML if place.suffix == ".xml" else chance.choice([*FILES.values()]), encoding="utf-8")
        elif change == 1:
            place.unlink(missing_ok=True)
        elif change == 2 and place.suffix == ".btq" and place.exists():
            place.rename(chance.choice(places[:-1]))
        elif change == 3:
            (folder / "btq.toml").write_text(chance.choice((*PROJECTS, FACTORIES)), encoding="utf-8")
        else:
            path = chance.choice(sorted(texts))
            at = chance.randrange(len(texts[path]) + 1)
            texts[path] = texts[path][:at] + chance.choice((*PIECES, 'include "nav.xml"\n')) + texts[path][at:]
            if chance.random() < (0.6 if path.endswith(".xml") else 0.2):
                texts[path] = TOP if path.endswith(".xml") else MAIN
            session.edit(path, texts[path])
        if change < 4:
            session.reload()
        new = session_of(folder, texts)
        assert session.paths() == new.paths()
        for path in chance.sample(new.paths(), chance.randrange(len(new.paths()) + 1)):
            assert session.diagnostics(path) == new.diagnostics(path), (seed, step, path, texts)
        session.let_go()


def shown_by(session: Session, path: str, convert: Converter) -> str:
    """What is published for a file."""
    workspace = session.workspace_of(path)
    assert workspace is not None
    return convert.findings(workspace, path, session.findings(path))


@pytest.mark.parametrize("line", ["\n", "\n\n  # here\n"])
def test_findings_follow_lines_that_come_and_go_in_either_file(folder: Path, line: str) -> None:
    path, other = str(folder / "main.btq"), str(folder / "skills.btq")
    texts = {path: MAIN.replace("Place", "Pick (form = 1)"), other: SKILLS}
    session, convert = session_of(folder, texts), Converter()
    shown_by(session, path, convert)
    for edited in (other, path, other, path):
        before = session.open[edited]
        session.edit(edited, before.removeprefix(line) if before.startswith(line) else line + before)
        shown = shown_by(session, path, convert)
        assert shown == shown_by(session, path, Converter())
        assert '"relatedInformation": [{' in shown


def patched(data: list[int], changes: list[TokenEdit]) -> list[int]:
    """The integers after changes that all refer to the original; the changes are in order and do not overlap."""
    patched, end = [], 0
    for one in changes:
        assert end <= one.start
        patched += [*data[end : one.start], *one.data]
        end = one.start + one.delete_count
    assert end <= len(data)
    return [*patched, *data[end:]]


def test_only_what_is_worked_in_is_held(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def held() -> set[str]:
        (workspace,) = session.workspaces()
        return {Path(path).name for path, file in workspace.files.items() if file.is_parsed}

    session = session_of(folder, {f"{folder}/other.btq": OTHER})
    told = {path: session.diagnostics(path) for path in session.paths()}
    session.let_go()
    assert held() == set(FILES)  # they are few
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0)
    session.let_go()
    assert held() == {"other.btq"}
    session.edit(f"{folder}/skills.btq", SKILLS)
    session.let_go()
    assert held() == {"other.btq"}  # the other one is open now, but says what is on the disk
    assert {path: session.diagnostics(path) for path in session.paths()} == told
    session.reload()
    assert {path: session.diagnostics(path) for path in session.paths()} == told
    session.let_go()
    assert held() == set(FILES)  # all of one mission


def test_many_files_are_let_go_of_in_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def held() -> int:
        (workspace,) = session.workspaces()
        return sum(file.is_parsed for file in workspace.files.values())

    for number in range(12):
        (tmp_path / f"tree{number}.btq").write_text(OTHER, encoding="utf-8")
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0)
    session = session_of(tmp_path, {})
    for path in session.paths():
        session.diagnostics(path)
    parts = [held()]
    while held():
        session.let_go()
        parts.append(held())
    assert parts == [12, 7, 2, 0]


def test_a_closed_file_is_let_go_of_with_all_that_was_found_in_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0)
    path, convert = str(tmp_path / "main.btq"), Converter()
    text = OTHER.replace("Pick", "Sequnce")
    (tmp_path / "main.btq").write_text(text, encoding="utf-8")
    session = session_of(tmp_path, {path: text})
    told = shown_by(session, path, convert)
    assert "Sequnce" in told
    assert session.close(path) == (path,)
    for _ in range(2):
        session.let_go()
        assert shown_by(session, path, convert) == told


def test_a_file_that_two_projects_have(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0)
    one, other = tmp_path / "one", tmp_path / "other"
    files = {
        one / "btq.toml": "",
        other / "btq.toml": "",
        one / "requirements.btq": REQUIREMENTS,
        one / "main.btq": 'include "requirements.btq"\n' + REQUIREMENTS.replace("3 s", "4 s"),
        other / "main.btq": 'include "../one/requirements.btq"\n' + REQUIREMENTS.replace("3 s", "5 s"),
    }
    for file, text in files.items():
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
    opened, convert = str(one / "main.btq"), Converter()
    texts = {opened: files[one / "main.btq"]}
    session = session_of(tmp_path, texts)
    assert len(session.workspaces()) == 2
    for comment in ("# a\n", "# b\n"):
        texts[opened] = comment + texts[opened]
        session.edit(opened, texts[opened])
        new = session_of(tmp_path, texts)
        for path in new.paths():
            told = shown_by(session, path, convert)
            assert told == shown_by(new, path, Converter())
            assert ("conflicting-requirement" in told) == path.endswith("main.btq")
            session.let_go()


def test_where_a_missing_name_stands_is_known_of_files_that_are_not_held(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0)
    other = f"{folder}/other.btq"
    session = session_of(folder, {other: OTHER})
    for path in session.paths():
        session.diagnostics(path)
    session.let_go()
    session.edit(other, OTHER.replace("Pick", "SubTree Carry"))
    (unknown,) = session.diagnostics(other)
    assert [fix.title for fix in unknown.fixes] == ["Include `skills.btq`"]
    workspace = session.workspace_of(other)
    assert workspace is not None
    assert [path for path, file in workspace.files.items() if file.is_parsed] == [other]


def test_an_edit_of_one_file_names_those_that_it_may_break(folder: Path) -> None:
    session = session_of(folder, {})
    skills = f"{folder}/skills.btq"
    linked = [skills, f"{folder}/main.btq", f"{folder}/requirements.btq"]
    assert session.edit(skills, SKILLS) == (skills,)  # opened, and as it is on the disk
    assert list(session.edit(skills, SKILLS.replace("Move", "Drive"))) == linked
    assert list(session.edit(skills, SKILLS.replace("Carry", "Bring"))) == linked
    assert list(session.edit(skills, SKILLS)) == linked
    other = f"{folder}/other.btq"
    assert session.edit(other, OTHER + "    SubTree Carry\n") == (other,)
    every = [skills, other, *linked[1:]]  # that one uses the tree, and its diagnostic names the place
    assert list(session.edit(skills, SKILLS.replace("Carry", "Bring"))) == every
    assert list(session.edit(skills, SKILLS)) == every
    assert list(session.edit(skills, SKILLS.replace("Move", "Drive"))) == linked
    assert list(session.edit(skills, SKILLS)) == linked
    assert session.close(skills) == (skills,)


@pytest.mark.parametrize("name", sorted(FILES))
def test_an_edit_parses_no_file_as_a_whole(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = f"{folder}/{name}"
    session = session_of(folder, {path: FILES[name]})
    for each in session.paths():
        session.diagnostics(each)
    monkeypatch.setattr("btq_lang.workspace.file.parse", lambda text: pytest.fail(text))
    for end in ("# a", "# a comment", "BehaviorTree More\n    Pick\n"):
        for changed in session.edit(path, f"{FILES[name]}{end}"):
            session.diagnostics(changed)


@pytest.mark.scheduled
def test_what_edits_replace_goes_when_it_is_swept(folder: Path) -> None:
    main = f"{folder}/main.btq"
    session = session_of(folder, {})

    def rounds(start: int) -> Counter[str]:
        """Names that come and go, and includes; what there is of each kind of object in the end."""
        for number in range(start, start + 20):
            for text in (MAIN.replace("Carry", f"Carry{number}"), MAIN.replace("include", "# include", 1), MAIN):
                for path in session.edit(main, text):
                    session.diagnostics(path)
                session.let_go()
        for workspace in session.workspaces():
            workspace.store.sweep(always=True)
        gc.collect()  # written nodes and their parents hold each other
        kinds = Counter(type(each).__name__ for each in gc.get_objects())
        return Counter({name: kinds[name] for name in ("File", "Workspace", "ResolvedTree", "View", "set")})

    rounds(0)
    assert rounds(20) == rounds(40)


def test_a_misspelt_include_brings_its_file_whatever_else_the_text_says(folder: Path) -> None:
    main, text = f"{folder}/main.btq", MAIN.replace("include", "enclude")
    session = session_of(folder, {main: text})
    told = [each.rule for each in session.diagnostics(main)]
    as_meant = session_of(folder, {}).diagnostics(main)
    assert told == ["syntax-error", "syntax-error", *[each.rule for each in as_meant]]
    session.edit(main, f"{text}# include")
    assert [each.rule for each in session.diagnostics(main)] == told


def test_a_file_that_no_folder_has(tmp_path: Path) -> None:
    session = Session()
    path = f"{tmp_path}/alone.btq"
    assert session.edit(path, "BehaviorTree Main\n    Sequnce\n        Pick\n") == (path, path)
    assert [found.rule for found in session.diagnostics(path)] == ["unknown-node"]
    assert session.close(path) == ()
    assert session.workspace_of(path) is None
    assert session.diagnostics(path) == ()


def test_the_folders_are_read_once_for_their_settings(folder: Path) -> None:
    session = Session()
    session.folders = (str(folder),)
    assert not session.has_read
    session.edit(str(folder / "main.btq"), MAIN)
    assert session.has_read
    session.settings = {"rules": {"unused-tree": "off"}}
    assert not session.has_read
    session.reload()
    assert session.has_read


def test_severities_that_are_no_words_are_ignored(folder: Path) -> None:
    session = Session()
    session.folders = (str(folder),)
    session.configure({"rules": {"unused-tree": ["off"], "unknown-node": {}, "missing-port": None, "x": "off"}})
    assert str(folder / "main.btq") in session.reload()


def test_a_check_after_all_was_read_again_asks_nothing_again(folder: Path) -> None:
    session = Session()
    session.folders = (str(folder),)
    path = str(folder / "main.btq")
    session.edit(path, MAIN)
    found = session.diagnostics(path)
    kept = [each for each, _ in session.findings(path).of_items]
    session.reload()
    assert found != ()
    assert session.diagnostics(path) == found
    assert [id(each) for each, _ in session.findings(path).of_items] == [*map(id, kept)]


# ---- XML ----


@pytest.mark.usefixtures("strict_queries")
@pytest.mark.parametrize("seed", seeds(6))
def test_what_is_told_of_xml_is_what_a_new_session_finds(
    tmp_path: Path, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0 if seed % 2 else 100_000)
    for name, text in WITH_XML.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    chance = random.Random(seed)
    session = session_of(tmp_path, {})
    told = {path: session.diagnostics(path) for path in session.paths()}
    texts: dict[str, str] = {}
    for step in range(60):
        name = chance.choice(sorted(WITH_XML))
        path = f"{tmp_path}/{name}"
        if path in texts and chance.random() < 0.1:
            del texts[path]
            changed = session.close(path)
        else:
            text = texts.get(path, WITH_XML[name])
            if chance.random() < 0.3:
                text = WITH_XML[name]
            at = chance.randrange(len(text) + 1)
            piece = chance.choice(XML_PIECES if name.endswith(".xml") else PIECES)
            texts[path] = text[:at] + piece + text[at + chance.choice((0, 0, 1, 5, 20)) :]
            changed = session.edit(path, texts[path])
        told.update({each: session.diagnostics(each) for each in changed})
        told = {each: found for each, found in told.items() if session.knows(each)}
        session.let_go()
        new = session_of(tmp_path, texts)
        known = filter(new.knows, new.paths())
        assert told == {each: new.diagnostics(each) for each in known}, (seed, step, texts)
        assert session.workspaces() == new.workspaces()


def test_xml_that_can_be_read_again_is_checked_only_where_it_differs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("btq_lang.lsp.session._MOST_IDLE", 0)
    (tmp_path / "skills.btq").write_text("Action Pick\n    input from : int\n", encoding="utf-8")
    path = str(tmp_path / "main.xml")
    tree = '<BehaviorTree ID="{}"><Pick {}/></BehaviorTree>'.format
    session = session_of(tmp_path, {})
    session.settings = {"rules": {"unused-tree": "off"}}

    def found(*trees: str, end: str = "</root>") -> list[tuple[str, int]]:
        xml = f'<root BTCPP_format="4" main_tree_to_execute="One">{"".join(trees)}{end}'
        session.edit(path, xml)
        told = [(each.rule, xml.count(">", 0, each.span.start)) for each in session.diagnostics(path)]
        session.let_go()
        return told

    checked: list[str] = []
    compute = Store._compute

    def counted(store: Store[Workspace], answer: _Answer) -> object:
        if answer.key[0] is _reported:
            checked.append(answer.key[2].item.name.text)
        return compute(store, answer)

    trees = [tree(name, 'to="1"') for name in ("One", "Two", "Three")]
    assert found(*trees) == [("unknown-port", 2), ("unknown-port", 5), ("unknown-port", 8)]
    monkeypatch.setattr(Store, "_compute", counted)
    for end in ("</root", "</roo", "<Pick></root>", "</root"):
        assert [rule for rule, _ in found(*trees, end=end)] == ["xml-syntax"]
    assert found(trees[0], tree("Two", 'from="1"'), trees[2]) == [("unknown-port", 2), ("unknown-port", 8)]
    assert checked == ["Two"]


def test_open_xml_finds_what_it_lacks_in_its_folder(tmp_path: Path) -> None:
    main, dock = (str(tmp_path / name) for name in ("main.xml", "dock.xml"))
    tree = '<root BTCPP_format="4"><BehaviorTree ID="{}">{}</BehaviorTree></root>'.format
    Path(dock).write_text(tree("Dock", "<AlwaysSuccess/>"))
    session = Session()
    session.edit(main, tree("Main", '<SubTree ID="Dock"/>'))
    assert session.diagnostics(main) == ()
    assert session.paths() == (main,)  # the other is not reported on
    session.edit(main, tree("Main", '<SubTree ID="Undock"/>'))
    assert [each.rule for each in session.diagnostics(main)] == ["unknown-tree"]
    session.edit(dock, tree("Undock", "<AlwaysSuccess/>"))
    assert session.diagnostics(main) == ()


def test_a_project_of_groot_is_a_factory_in_the_editor_too(tmp_path: Path) -> None:
    tree = '<root BTCPP_format="4"><BehaviorTree ID="{}">{}</BehaviorTree></root>'.format
    (tmp_path / "robot.btproj").write_text('<root BTCPP_format="4"><include path="main.xml"/></root>')
    (tmp_path / "dock.xml").write_text(tree("Dock", "<AlwaysSuccess/>"))
    main, project = str(tmp_path / "main.xml"), str(tmp_path / "robot.btproj")
    session = Session()
    session.edit(main, tree("Main", '<SubTree ID="Dock"/>'))
    assert [each.rule for each in session.diagnostics(main)] == ["unknown-tree"]
    assert session.paths() == (main, project)
    (tmp_path / "robot.btproj").write_text('<root><include path="main.xml"/><include path="dock.xml"/></root>')
    session.reload()
    assert session.diagnostics(main) == ()


def test_answers_stay_while_xml_that_includes_files_cannot_be_read(tmp_path: Path) -> None:
    tree = '<root BTCPP_format="4">{}<BehaviorTree ID="{}"><SubTree ID="{}"/></BehaviorTree></root>'.format
    (tmp_path / "dock.xml").write_text(tree("", "Dock", "Main"))
    (tmp_path / "align.xml").write_text(tree("", "Align", "Dock"))
    main = str(tmp_path / "main.xml")
    text = tree('<include path="dock.xml"/>', "Main", "Align")  # the one in the pool
    session = Session()
    session.edit(main, text)
    before = session.workspace_of(main)
    assert before is not None
    store, files = before.store, [*before.files]
    assert sorted(files) == [str(tmp_path / name) for name in ("align.xml", "dock.xml", "main.xml")]
    for damaged in (text[:-1], text[:-2]):
        session.edit(main, damaged)
        assert [each.rule for each in session.diagnostics(main)] == ["xml-syntax"]
        now = session.workspace_of(main)
        assert now is not None
        assert [*now.files] == [main]
    session.edit(main, text)
    after = session.workspace_of(main)
    assert after is not None
    assert ([*after.files], after.store) == (files, store)
    assert session.diagnostics(main) == ()


@pytest.mark.parametrize(
    ("path", "uri"),
    [
        ("/home/a b/ü.btq", "file:///home/a%20b/%C3%BC.btq"),
        ("C:/a b/ü.btq", "file:///C:/a%20b/%C3%BC.btq"),
        ("https://btq.dev/rules", "https://btq.dev/rules"),
    ],
)
def test_the_addresses_of_files(path: str, uri: str) -> None:
    assert Converter().uri(path) == uri
