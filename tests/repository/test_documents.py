"""Every block of code in the documents is run, by the test that the table here names.

What asks a network (`pip`, `npm`) and what waits for a person (`btq preview`) is not run in shell blocks: a word of the
same name says yes, and holds the arguments of `btq preview` against its parser.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
import yaml
from evidence_bags import names_of, tree_log, write_bag
from evidence_logs import as_logged, btlog, rows, samples, write_db3

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.parser import parse
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.loader import find_project

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "examples").glob("*/*.md"))]
BLOCK = re.compile(r"^```([\w ]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
# Begins what puts files where an editor looks for them: test_colouring.py and editors/test_neovim.py run it.
INSTALLS = "mkdir -p ~/.local/share/"
FRAGMENTS = ("tutorial.md", "language.md", "xtext.md")

# Who runs the blocks of a language; where that is not the same on every page, of a page.
RUN_BY = {
    "btq": "repository/test_examples.py",
    "btq classic": "btcpp/test_xml_mapping.py",
    "xml": "btcpp/test_xml_mapping.py",
    "import.md xml": "test_an_import_gives_what_the_page_shows",
    "import.md text": "test_an_import_gives_what_the_page_shows",
    "commands.md text": "test_a_diff_says_what_the_page_shows",
    "evidence.md text": "evidence/test_page.py",
    "evidence.md cpp": "engine/test_engine_tutorial.py",
    "tutorial.md cpp": "engine/test_engine_tutorial.py",
    "tutorial.md console": "engine/test_engine_tutorial.py",
    "evidence-store.md python": "evidence/store/test_store_summary.py",
    "evidence-store.md text": "evidence/compare/test_compare.py",
    "console": "requirements/test_requirements_page.py",
    "README.md xml": "repository/test_home_page.py",
    "README.md console": "repository/test_home_page.py",
    "day-in-the-life.md console": "evidence/test_day.py",
    "xml-teams.md xml": "repository/test_xml_teams_page.py",
    "xml-teams.md toml": "repository/test_xml_teams_page.py",
    "xml-teams.md console": "repository/test_xml_teams_page.py",
    "nav2.md console": "evidence/test_recipe_pages.py",
    "nav2.md text": "evidence/test_recipe_pages.py",
    "sh": "test_a_shell_block_runs",
    "editors.md sh": "editors/test_neovim.py",
    "python": "test_the_python_of_a_page",
    "btq scenario": "scenarios/test_scenario_page.py",
    "what-can-happen.md xml": "exploration/test_explore_page.py",
    "what-can-happen.md console": "exploration/test_explore_page.py",
    "how-likely.md console": "prediction/test_how_likely_page.py",
    "test-a-mission.md xml": "scenarios/test_scenario_page.py",
    "test-a-mission.md console": "scenarios/test_scenario_page.py",
    "yaml": "test_ci_knows_its_names",
    "ebnf": "grammar/test_grammar.py",
    "toml": "test_a_project_file_is_read",
    "editors.md toml": "test_editors_recipes_are_well_formed",
    "editors.md json": "test_editors_recipes_are_well_formed",
    "editors.md text": "test_the_extension_is_packed_and_installed",
    "lua": "editors/test_neovim.py",
    "vim": "editors/test_recipes.py",
    "elisp": "editors/test_recipes.py",
    **{f"{page} {kind}": "test_a_fragment_parses" for page in FRAGMENTS for kind in ("text", "btq classic")},
}


def blocks(language: str, *names: str) -> list[tuple[str, str]]:
    """The blocks of a language, of the pages of these names or of all: where each begins, and its text."""
    found: list[tuple[str, str]] = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for match in BLOCK.finditer(text):
            if match[1] == language and (not names or page.name in names):
                line = text.count("\n", 0, match.start()) + 1
                found.append((f"{page.relative_to(ROOT)}:{line}", match[2]))
    return found


def parameters(*found: tuple[str, str]) -> pytest.MarkDecorator:
    """A test runs for each of some blocks."""
    return pytest.mark.parametrize("block", [pytest.param(text, id=place) for place, text in found])


def test_every_block_is_run_by_somebody() -> None:
    tests = Path(__file__).parents[1]
    for page in PAGES:
        for language in {match[1] for match in BLOCK.finditer(page.read_text(encoding="utf-8"))}:
            runner = RUN_BY.get(f"{page.name} {language}") or RUN_BY.get(language)
            assert runner is not None, f"{page.name}: ```{language}"
            assert runner in globals() or (tests / runner).is_file(), runner


# ---- shell ----

PRELUDE = """\
pip() { :; }
python3() { if [ "$2" = venv ]; then mkdir -p .venv/bin && : > .venv/bin/activate; fi; }
"""


@pytest.fixture
def clone(project: Path, tmp_path: Path) -> Path:
    """The project, to be changed."""
    return Path(shutil.copytree(project, tmp_path / "clone"))


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project with the files that the pages speak of, on a branch of four commits."""
    folder = tmp_path_factory.mktemp("documents") / "project"
    shutil.copytree(ROOT / "examples", folder / "examples")
    mission = (ROOT / "examples" / "laboratory" / "mission.btq").read_text(encoding="utf-8")
    classic = (ROOT / "examples" / "classic" / "inspector.qualitybtcpp").read_text(encoding="utf-8")
    (guide, *_) = (
        match[2] for match in BLOCK.finditer((ROOT / "docs" / "tutorial.md").read_text()) if match[1] == "btq"
    )
    files = {"mission.btq": mission, "old.btq": mission, "new.btq": mission.replace("30 s", "20 s")}
    files |= {"missions/a.btq": mission, "extra.btq": guide, "guide.btq": guide, "inspector.qualitybtcpp": classic}
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    git(folder, "init", "-q", "-b", "main")
    for number in range(4):
        if number == 3:
            git(folder, "checkout", "-q", "-b", "work")
        (folder / "extra.btq").write_text(guide.replace("Guide", f"Guide{number}"), encoding="utf-8")
        git(folder, "add", ".")
        git(folder, "commit", "-q", "-m", "x")
    return folder


def git(folder: Path, *words: str) -> None:
    person = ("-c", "user.name=x", "-c", "user.email=x@example.org", "-c", "commit.gpgsign=false")
    subprocess.run(["git", *person, *words], cwd=folder, check=True, capture_output=True)


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """`btq` and `btq-lsp` of this checkout, which write down how each of their runs ended."""
    programs = tmp_path / "programs"
    programs.mkdir()
    parser = "import sys; from btq_lang.commands.arguments import build_parser; build_parser().parse_args(sys.argv[1:])"
    btq = f'if [ "$1" = preview ]; then python="-c" what="{parser}"; else python="-m" what="btq_lang"; fi\n'
    for name, begin, run in (("btq", btq, '"$python" "$what"'), ("btq-lsp", "", "-m btq_lang.server")):
        run = f'"{sys.executable}" {run} "$@"\ncode=$?\necho "$code $*" >> "{tmp_path}/codes"\nexit $code\n'
        (programs / name).write_text(f"#!/bin/sh\n{begin}{run}")
        (programs / name).chmod(0o755)
    return {
        **os.environ,
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "GITHUB_STEP_SUMMARY": str(tmp_path / "summary"),
    }


@pytest.mark.skipif(os.name == "nt", reason="the blocks are for a POSIX shell")
@parameters(*(block for block in blocks("sh") if not block[1].startswith(INSTALLS)))
def test_a_shell_block_runs(block: str, clone: Path, environment: dict[str, str], tmp_path: Path) -> None:
    if any(words in block for words in ("btq verify", "run.db3", "--evidence logs")):
        _write_logs(clone)
    if "btq nodes" in block:
        pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
        for folder in ("src", "include"):
            (clone / folder).mkdir()
            (clone / folder / "skills.cpp").write_text('void f() { factory.registerSimpleAction("Dock", dock); }')
    if "btq import" in block:
        xml = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Dock/></BehaviorTree></root>'
        (clone / "trees").mkdir()
        for name in ("mission.xml", "trees/a.xml", "trees/b.xml"):
            (clone / name).write_text(xml)
        (clone / "mission.btq").unlink()
    run = subprocess.run(
        ["bash", "-u", "-c", PRELUDE + block], cwd=clone, env=environment, capture_output=True, text=True, timeout=300
    )
    assert "command not found" not in run.stderr
    ended = (tmp_path / "codes").read_text().splitlines()
    assert len(ended) == len(re.findall(r"^(?:.*\| )?btq(?:-lsp)? ", block, re.MULTILINE)) > 0
    assert [line for line in ended if line[0] not in "01"] == [], run.stderr


def _write_logs(folder: Path) -> None:
    """Logs of one run of the mission, cut off at once, and samples."""
    xml = as_logged(write(export(open_workspace(f"{folder}/mission.btq"), f"{folder}/mission.btq").document))
    (folder / "logs").mkdir()
    (folder / "logs" / "run.btlog").write_bytes(btlog(xml, rows("0 1R")))
    write_db3(folder / "run.db3", xml, [rows("0 1R")])
    write_bag(folder / "bag", tree_log(rows("0 1R"), names_of(xml)))
    (folder / "battery.csv").write_text(samples("battery", {0: 50}), encoding="utf-8")


# ---- the language, and what is made of it ----


@parameters(*blocks("text", *FRAGMENTS), *blocks("btq classic", *FRAGMENTS))
def test_a_fragment_parses(block: str) -> None:
    """As a file, or as what stands in a tree."""
    inside = "BehaviorTree X\n" + re.sub(r"(?m)^(?=.)", "    ", block)
    assert [] in [[each.message for each in parse(text).diagnostics] for text in (block, inside)]


@pytest.mark.parametrize("page", ["python.md"])
def test_the_python_of_a_page(page: str) -> None:
    """Its blocks one after the other, in a clone."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    program = "\n".join(match[2] for match in BLOCK.finditer(text) if match[1] == "python")
    run = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")


def test_an_import_gives_what_the_page_shows(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "import.md").read_text(encoding="utf-8")
    ((_, xml), (_, btq)) = BLOCK.findall(text)
    (tmp_path / "fetch.xml").write_text(xml, encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-m", "btq_lang", "import", "fetch.xml"], cwd=tmp_path, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "fetch.btq").read_text(encoding="utf-8") == btq


def test_a_diff_says_what_the_page_shows(tmp_path: Path) -> None:
    ((_, shown),) = blocks("text", "commands.md")
    before = (ROOT / "examples" / "laboratory" / "mission.btq").read_text(encoding="utf-8")
    after = before
    charge = "            R? ChargeUntilFull\n                BatteryFull\n                Charge\n"
    pick, read = "        Pick (from = {source})\n", "        ReadLabel (label = {label}) satisfies rq3\n"
    for old, new in (
        ("takes at most 30 s", "takes at most 20 s"),
        (charge, "            Retry (num_attempts = 2)\n" + re.sub("(?m)^", "    ", charge).rstrip(" ")),
        ("PickPlace", "Carry"),
        (pick + read, read + pick),
    ):
        assert old in after
        after = after.replace(old, new)
    (tmp_path / "laboratory.btq").write_text(before, encoding="utf-8")
    (tmp_path / "new.btq").write_text(after, encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-m", "btq_lang", "diff", "laboratory.btq", "new.btq"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 1
    assert run.stdout == shown


# ---- settings ----


@parameters(*blocks("toml", "commands.md", "evidence.md", "language.md", "nav2.md"))
def test_a_project_file_is_read(block: str, tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text(block, encoding="utf-8")
    found = find_project(str(tmp_path))
    assert (found.path is not None, found.problems) == (True, ())


def test_editors_recipes_are_well_formed() -> None:
    toml = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
    text = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8")
    kate, xml = (json.loads(match[2]) for match in BLOCK.finditer(text) if match[1] == "json")
    helix, project = (toml.loads(match[2]) for match in BLOCK.finditer(text) if match[1] == "toml")
    assert kate["servers"]["btq"]["command"] == ["btq-lsp"]
    assert helix["language-server"]["btq"]["command"] == "btq-lsp"
    assert helix["language"][0]["file-types"] == ["btq", "qualitybtcpp"]
    assert xml == {"xml.fileAssociations": [{"pattern": "missions/*.xml", "systemId": "btq.xsd"}]}
    assert project == {}


@pytest.mark.skipif(os.name == "nt", reason="the commands are for a POSIX shell")
@pytest.mark.parametrize("page", ["docs/editors.md", "README.md"])
def test_the_extension_is_packed_and_installed(page: str, tmp_path: Path) -> None:
    """The commands of the page fit each other and the scripts, also where there is no Node.js.

    Here `npm run package` makes an empty file where the real one packs, and `code` only looks whether it is there; the
    real ones are run by editors/test_package.py, where they are installed.
    """
    (command,) = re.findall(r"^.*\bnpm ci .*--install-extension .*$", (ROOT / page).read_text("utf-8"), re.MULTILINE)
    manifest = json.loads((ROOT / "editors" / "vscode" / "package.json").read_text("utf-8"))
    assert manifest["scripts"]["package"] == "node scripts/package.mjs"
    stubs = f"""
        npm() {{
            local folder=.
            for word; do [ "$word" != --prefix ] || {{ folder=editors/vscode; }}; done
            [ -f "$folder/package-lock.json" ] || return 1
            case " $* " in
                *" ci "*) ;;
                *" package -- "*) : > "${{@: -1}}" ;;
                *" package "*) : > "$folder/btq-{manifest["version"]}.vsix" ;;
                *) return 1 ;;
            esac
        }}
        code() {{ [ "$1" = --install-extension ] && [ -f "$2" ] && echo "$2" > "{tmp_path}/installed"; }}
    """
    for name in ("package.json", "package-lock.json"):
        (tmp_path / "editors" / "vscode").mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "editors" / "vscode" / name, tmp_path / "editors" / "vscode")
    subprocess.run(["bash", "-euc", stubs + command], cwd=tmp_path, check=True)
    assert (tmp_path / "installed").read_text().strip() in ("btq.vsix", f"btq-{manifest['version']}.vsix")


def test_ci_knows_its_names() -> None:
    """Hooks, the action's inputs and outputs, and the commands of the page are those there are."""
    text = (ROOT / "docs" / "ci.md").read_text(encoding="utf-8")
    hooks, workflow, simulation, comparing, scenarios, gitlab_scenarios, gitlab = (
        yaml.safe_load(match[2]) for match in BLOCK.finditer(text) if match[1] == "yaml"
    )
    known = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    assert hooks["repos"][0]["hooks"] == [{"id": hook["id"]} for hook in known]
    action = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
    _, step, comment = workflow["jobs"]["btq"]["steps"]
    assert set(step["with"]) <= set(action["inputs"])
    assert re.findall(r"steps\.btq\.outputs\.(\w+)", json.dumps(comment)) == ["diff", "diff"]
    assert "diff" in action["outputs"]
    assert [*simulation["jobs"]] == ["simulation"]  # evidence/test_recipe_pages.py runs it
    assert [each["run"] for each in comparing[2:]] == [  # evidence/store/test_store.py runs them, with other paths
        "btq verify logs --mission missions/mission.btq"
        ' --store evidence --label "$GITHUB_SHA" --exit-zero -o verdicts.md',
        'btq compare evidence main "$GITHUB_SHA" -o comparison.md',
    ]
    testing = "btq test missions --format junit -o scenarios.xml"  # scenarios/test_command.py has JUnit
    assert scenarios[0] == {"run": testing}
    assert scenarios[1]["with"]["path"] == "scenarios.xml"
    assert gitlab_scenarios["scenarios"]["script"][1] == testing
    assert gitlab_scenarios["scenarios"]["artifacts"]["reports"] == {"junit": "scenarios.xml"}
    assert gitlab["btq"]["script"][1] == "btq check --output-file btq.json"
    assert gitlab["btq"]["artifacts"]["reports"] == {"codequality": "btq.json"}
