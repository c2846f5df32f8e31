"""Every measured number of README.md leads to a file of results/published/, by a command that exists."""

import math
import re
import subprocess
from types import SimpleNamespace

import h5py
import pytest
import synthetic
from synthetic import SCRIPTS, file_of

from boxwood_results import published, published_tables
from boxwood_results.findings import CALL
from boxwood_results.run import Job
from boxwood_results.selection import fullest

ROOT = SCRIPTS.parent
README = (ROOT / "README.md").read_text()
TABLES = "results/published/tables.md"


def test_readme_says_what_the_files_say():
    assert published.problems(ROOT) == []


def test_each_ratio_of_the_summary_stands_in_the_tables():
    tables = (ROOT / TABLES).read_text()
    (summary,) = [text for name, text in published.MARKED.findall(README) if name == "summary"]
    ratios = re.findall(r"[\d.]+x(?: \?)?", summary)
    assert len(ratios) > 20 and not [ratio for ratio in ratios if not re.search(rf"\| {re.escape(ratio.split()[0])} \([^|]*\)", tables)]


def test_each_table_has_its_markers_and_its_sweep():
    shown = [name for page in published.PAGES for name in re.findall(r"<!-- published: (\w+) -->", (ROOT / page).read_text())]
    assert len(shown) > 5 and sorted(shown) == sorted(published.BLOCKS)
    for one in published.ALL:
        assert (ROOT / one.config).exists()


MEASURED = re.compile(r"\b\d+ times (?:as|the)\b|\b\d+\.\d+ times\b|\b\d+(?:\.\d+)?x\b|(?<!above )\b\d+(?:\.\d+)? (?:ms|us|ns)\b")


def documents():
    """The project's pages, but for the log of its changes, as text that no script writes."""
    paths = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    return {path: published.MARKED.sub("", (ROOT / path).read_text()) for path in paths if path != "CHANGELOG.md"}


def test_what_is_measured_stands_between_markers():
    """Elsewhere there is no ratio and no time of a run, which would have no file behind it."""
    for said in ("140 times as long", "0.8 times the time", "1.28 times;", "99.9x (99", "warm 4.3 ms)", "10 us"):
        assert MEASURED.search(said), said
    assert not MEASURED.search("share of the frames above 1 ms") and not MEASURED.search("a sweep 100 times at a random moment")
    found = {path: MEASURED.findall(text) for path, text in documents().items()}
    assert len(found) > 10 and not {path: ratios for path, ratios in found.items() if ratios}


def test_tables_and_pictures_come_from_the_files(root):
    file_of(root, "pairs", synthetic.full(wrong=False))
    file_of(root, "effects", synthetic.full(wrong=False))
    file_of(root, "accuracy", synthetic.full(wrong=False))
    assert published.freeze(root) == ["accuracy-1", "effects-1", "pairs-1"] and published.freeze(root) == []
    written = published.write(root)
    assert {path.name for path in written} == {"README.md", "tables.md", "pairs.png", "accuracy_triangles.png"}
    assert published.problems(root) == []
    text = (root / TABLES).read_text()
    results = published.read(root / "results" / "published" / "pairs.h5")
    of_pairs = next(c for c in results.comparisons if c.family == "peers" and c.a.library == "embree" and c.b.job.task == "pairs"
                    and c.text in text)
    assert of_pairs and re.search(r"\*Track pairs-1, \d+ answers checked: 0 of ours wrong, \d+ of the peers' wrong. Run u of 2025-01-01", text) and "commit abcdef01, noise floor" in text
    assert re.search(r"\*Behind the ratios: [^*]*Embree 3\.13\.5 \(a package of embree[^)]*\) by [\w., ]+;[^*]* Ours for AVX2\.\*\n\n\*Track pairs-1", text)
    assert "| warehouse | 10,000 |" in text and "guigue_devillers_exact" in text and "not published yet" in text

    summary = (root / "README.md").read_text()
    assert re.search(r"\| [^|]+ \| [^|]*query[^|]* \| \d+ \| \d+, \d+, \d+ \| \d+, \d+, \d+ \| \d", summary) and "not published yet" in summary
    (root / TABLES).write_text(text.replace(of_pairs.text, "99.9x (99.8 to 99.9)"))
    assert any("a table differs" in line for line in published.problems(root))
    published.write(root)
    (root / "scripts" / "pictures" / "pairs.png").unlink()
    assert any("not drawn from" in line for line in published.problems(root))


def test_files_are_of_one_commit(root):
    for sweep, commit in (("effects", "a"), ("pairs", "b")):
        file = file_of(root, sweep, synthetic.full(wrong=False))
        with h5py.File(file, "a") as tables:
            rows = tables["env"][:]
            rows["git_commit"] = commit
            tables["env"][:] = rows
        published.freeze(root)
        published.write(root)
        assert any("more than one commit: a, b" in line for line in published.problems(root)) == (commit == "b")


def test_what_was_measured_on_a_gpu_is_of_another_machine_and_of_fewer_rounds(root):
    file_of(root, "effects", synthetic.full(wrong=False))
    file_of(root, "gpu", synthetic.full(wrong=False), "rounds = 99", host="another", gpu="a GPU")
    published.freeze(root)
    published.write(root)
    assert published.problems(root) == [] and (root / "scripts" / "pictures" / "gpu.png").exists()
    text = (root / TABLES).read_text()
    rows = [line.split(" | ") for line in text[text.index("**On a GPU"):].splitlines() if line.startswith("| overlapping pairs")]
    assert len(rows) > 2 and all(len(row) == 9 and re.search(r"[mun]s", row[3]) and "x (" in row[8] for row in rows)
    assert "15 rounds, a GPU, " in text


def test_a_file_in_which_ours_is_wrong_is_said(root):
    file_of(root, "effects", synthetic.full())
    published.freeze(root)
    published.write(root)
    (said,) = published.problems(root)
    assert "ours is wrong" in said and "1 of ours wrong" in said


@pytest.mark.parametrize(
    "env, toml, problem",
    [({"host": "another"}, None, "more than one machine"), ({"isa_max": "AVX2"}, None, "more than one machine"), ({"git_dirty": 1}, None, "in no commit"), ({"flags": "-O2 (peers -O1)"}, None, "hardly optimised"), ({}, "", "does not hold the sweep")])
def test_what_does_not_fit_together_is_said(root, env, toml, problem):
    file_of(root, "effects", synthetic.full(wrong=False))
    made = synthetic.full(wrong=False)
    file = file_of(root, "pairs", made, toml)
    published.freeze(root)
    published.write(root)
    with h5py.File(file, "a") as tables:
        rows = tables["env"][:]
        for column, value in env.items():
            rows[column] = value
        tables["env"][:] = rows
    assert any(problem in line for line in published.problems(root))


@pytest.mark.parametrize("inputs, rounds", [(1, 0), (5, 0), (6, 18)])
def test_what_is_published_has_three_rounds_of_each_input(root, inputs, rounds):
    file = file_of(root, "effects", synthetic.full(wrong=False), f"inputs = {inputs}")  # 15 rounds
    said = [line for line in published.faults(file, published.read(file)) if "inputs" in line]
    assert len(said) == (rounds > 0) and all(f"15 rounds for {inputs} inputs" in line and f"--rounds {rounds}" in line for line in said)


def test_what_is_published_has_the_rounds_of_its_sweep_and_of_a_verdict(root):
    for rounds, toml, wanted in ((15, "rounds = 15", 0), (15, "rounds = 16", 16), (9, "rounds = 3", 0), (8, "rounds = 3", 9)):
        file = file_of(root, "effects", synthetic.small(rounds, twin=True), toml)
        said = [line for line in published.faults(file, published.read(file)) if "are wanted" in line]
        assert len(said) == (wanted > 0) and all(f"{rounds} rounds; {wanted} are wanted" in line for line in said)


def test_without_git_nothing_is_known_to_have_changed(root, monkeypatch):
    file_of(root, "effects", synthetic.full(wrong=False))
    monkeypatch.setenv("PATH", str(root))
    assert published.changed_since(root) == []


def test_a_sweep_that_has_changed_since_is_said_on_the_page(root):
    file_of(root, "effects", synthetic.full(wrong=False), "rounds = 3")
    published.freeze(root)
    published.write(root)
    assert published.problems(root) == [] and "[`bench/configs/effects.toml`](../../bench/configs/effects.toml) as it was then" in (root / TABLES).read_text()
    file_of(root, "effects", synthetic.full(wrong=False))
    published.write(root)
    assert published.problems(root) == [] and "as it was then" not in (root / TABLES).read_text()


def test_a_track_whose_scenes_change_has_another_version(root):
    file = file_of(root, "effects", synthetic.full(wrong=False))
    published.freeze(root)
    published.write(root)
    assert published.problems(root) == []
    with h5py.File(file, "a") as tables:
        rows = tables["scenes"][:]
        rows["content_hash"][0] += 1
        tables["scenes"][:] = rows
    assert any("not those of track effects-1" in line for line in published.problems(root))
    assert published.freeze(root) == ["effects-2"]


def test_a_file_without_its_seal_is_said(root):
    file = file_of(root, "effects", synthetic.full(wrong=False))
    published.freeze(root)
    published.write(root)
    with h5py.File(file, "a") as tables:
        tables.attrs["note"] = "mine"
    assert [line for line in published.problems(root) if "its seal is gone" in line]


def test_a_frozen_track_without_its_file_is_said(root):
    file = file_of(root, "effects", synthetic.full(wrong=False))
    published.freeze(root)
    file.unlink()
    published.write(root)
    (problem,) = published.problems(root)
    assert f"{file}: track effects-1 is frozen" in problem and "scripts/reproduce effects --publish" in problem


def test_a_stray_file_is_said(root):
    (root / "results" / "published" / "other.h5").write_bytes(b"")
    published.write(root)
    assert any("no table stands on it" in line for line in published.problems(root))


def test_commands(root):
    assert subprocess.run([SCRIPTS / "published", "--check"], timeout=100).returncode == 0
    bad = subprocess.run([SCRIPTS / "reproduce", "nix"], capture_output=True, text=True, timeout=60)
    assert bad.returncode == 2 and "invalid choice" in bad.stderr
    said = subprocess.run([SCRIPTS / "reproduce", "--help"], capture_output=True, text=True, timeout=60).stdout
    assert all(f"{one.name} " in said and one.config in said for one in published.ALL)


def minutes(text):
    hours, whole, seconds = (int(part) if part else 0 for part in re.search(r"about (?:(\d+) h )?(?:(\d+) min ?)?(?:(\d+) s)?", text).groups())
    return 60 * hours + whole + seconds / 60


# The time that README gives for each config: of --quick the later runs, since the first builds as well.
TIMES = {"quick": r"--quick .*: about \w+ minutes the first time, then (\w+)", "default": r"it takes about (\d+) minutes"}
IN_WORDS = {"one": 1, "two": 2, "three": 3}


@pytest.mark.parametrize("config", TIMES)
def test_times_in_readme_agree_with_the_dry_run(config, tmp_path):
    guess = synthetic.answer("sweep", "--config", ROOT / "bench" / "configs" / f"{config}.toml", "--out", tmp_path / "x.h5",
                             "--dry-run").stderr
    said = re.search(TIMES[config], README)[1]
    said = IN_WORDS.get(said) or int(said)
    assert 0.5 * said < minutes(guess) < 1.6 * said


def entry(n, libraries, contender_class="", scene="uniform", variants=3):
    return SimpleNamespace(job=Job(scene, n, 1, "pairs", published_tables.ONE), kind=(scene, contender_class), libraries=dict.fromkeys(libraries),
                           variants=range(variants))


def test_a_race_is_shown_at_the_largest_size_that_most_libraries_ran():
    few, most, small = entry(10**6, ["fcl"]), entry(10**5, ["fcl", "cgal"]), entry(10**4, ["fcl", "cgal"])
    assert fullest([few, small, most]) == [most]
    cut, rather_full = entry(10**6, ["fcl", "cgal"], variants=1), entry(10**6, ["fcl", "cgal"], variants=2)
    assert fullest([most, cut]) == [most] and fullest([most, rather_full]) == [rather_full]
    # A size of one class alone takes no row from another class, nor one scene's from another's.
    single, elsewhere = entry(10**6, ["fcl"], "single rays"), entry(10**6, ["fcl"], scene="clusters")
    assert fullest([most, single, elsewhere]) == [most, single, elsewhere]


def test_kernels_have_a_row_for_each_family(tmp_path):
    run = published.read(synthetic.full(wrong=False).write(tmp_path / "kernels.h5"))
    rows = published_tables.against_peers("triangle_triangle")(run)[1:]
    families = {point.cases.replace("_", " ") for point in run.kernels if point.task == "triangle_triangle"}
    assert {row[0].removeprefix("triangle triangle, ") for row in rows} == families
    for row in rows:
        cases = row[0].removeprefix("triangle triangle, ")
        points = [point for point in run.kernels if point.task == "triangle_triangle" and point.cases.replace("_", " ") == cases]
        ours = min(point.ns for point in points if point.ours and not point.wrong and not point.maybe)
        best = {}
        for point in points:
            if not point.ours and point.cell.status != "wrong":
                best[point.library] = min(best.get(point.library, math.inf), point.ns / ours)
        said = [float(re.match(r"[\d.]+", text)[0]) for text in row[3:] if text]
        assert sorted(said) == pytest.approx(sorted(best.values()), rel=0.05)


def test_a_call_is_shown_by_the_kernel_and_the_words_of_the_file():
    run = published.read(ROOT / "results" / "published" / "shapes.h5")
    rows = {row[0]: row for row in published_tables.against_peers("shape_collide")(run)[1:]}
    calls = [row for row in run.findings if row.topic == CALL and row.task == "shape_collide" and row.rival]
    assert len(calls) > 20
    for found in calls:
        row = rows[f"{run.tasks[found.task].title}, {found.ours.scene_title}"]
        assert row[2].startswith(found.ours.label + " ") and "cases" in row[0]


def test_a_library_that_is_wrong_or_silent_is_named_in_the_row(tmp_path):
    made = synthetic.full(wrong=False)
    kernels = {number: name for name, number in made.ids["cells"].items() if "/triangle_triangle/" in name}
    peers = {row["name"] for row in made.rows["variants"] if row["library"] == "fcl"}
    family = next(name.split("/")[0] for name in kernels.values())
    for row in made.rows["kernels"]:
        if row["task"] == "triangle_triangle" and row["kernel"] in peers:
            row["maybe"] = 7 if kernels[row["cell_id"]].startswith(family + "/") else 0
    rows = published_tables.against_peers("triangle_triangle")(published.read(made.write(tmp_path / "silent.h5")))
    cells = {row[0]: row[1:] for row in rows[1:]}
    silent = f"triangle triangle, {family.replace('_', ' ')}"
    assert any(re.fullmatch(r"no answer in 7 of 4,000 \([\d.]+ [mun]?s\)", text) for text in cells.pop(silent))
    assert not any("no answer" in text for row in cells.values() for text in row)


def test_first_builds_have_a_row_of_their_own(tmp_path):
    made = synthetic.full(wrong=False)
    cells = {name: number for name, number in made.ids["cells"].items() if "/pairs/" in name and name.endswith("serial-1")}
    job = max((name.split("/pairs/")[0] for name in cells if "embree" in name), key=lambda job: int(re.search(r"/n(\d+)", job)[1]))
    for name, ns in (("median.wide8.self_pairs", 4e6), ("binned_sah.wide8.self_pairs", 5e6), ("embree.rtc_collide.low", 8e6)):
        made.samples(next(number for cell, number in cells.items() if cell.startswith(f"{job}/pairs/{name}/")), published_tables.COLD, ns)
    rows = published.BY_NAME["pairs"].table(published.read(made.write(tmp_path / "cold.h5")))
    first = [row for row in rows if row[1] == "first build and query, fresh process"]
    assert len(first) == 1 and first[0][2].startswith("median.wide8 ")
    named = {title: text for title, text in zip(rows[0], first[0]) if text}
    assert re.match(r"(1\.9|2|2\.0)\d*x \(", named["Embree"]) and "Fcl" not in named


def test_what_an_error_saves_has_a_row_for_each_scene():
    def row(scene, error, share, is_open=False, verdict="slower", is_certified=True):
        usual = {"task": SimpleNamespace(title="distance"), "scene_title": scene, "traversal": "distance", "contender": "median.obb.distance"}
        exact = SimpleNamespace(cell_id=scene, relative_error=0, median=lambda phase: 5e3, **usual)
        other, ratio = SimpleNamespace(relative_error=error, is_certified=is_certified), published_tables.Ratio(share, share, share)
        return SimpleNamespace(a=exact, b=other, ratio=ratio, is_open=is_open, verdict=verdict)

    compared = [row("far", 0.1, 0.4), row("near", 0.001, 0.9, is_open=True), row("near", 0, 0.95, is_certified=False), row("far", 0.001, 0.8), row("", 0.1, 1, verdict="wrong")]
    header, *rows = published_tables.by_error(SimpleNamespace(family=lambda *_: compared))
    assert header[2:] == ["nothing", "nothing, not certified, of that", "0.1 %, of that", "10 %, of that"]
    text = [row("", 0, share).ratio.text for share in (0.8, 0.4, 0.9, 0.95)]
    assert rows == [["distance, far", "median.obb", "5.00 us", "", text[0], text[1]], ["distance, near", "median.obb", "5.00 us", text[3], f"{text[2]} ?", ""]]


def test_a_question_with_a_library_struck_out_is_neither_the_middle_nor_the_most(monkeypatch):
    def question(mid, libraries, struck=()):
        gain = SimpleNamespace(mid=mid, lo=mid, hi=mid)
        cells = {library: SimpleNamespace(library=library, library_title=library, place=place) for place, library in enumerate(libraries)}
        job = SimpleNamespace(job=SimpleNamespace(where=published_tables.ONE))
        row = SimpleNamespace(gain=gain, text=f"{mid}x", is_open=False, verdict="faster" if mid > 1 else "slower", a=job, b=job)
        known = {library: SimpleNamespace(**{**vars(row), "a": cell}) for library, cell in cells.items()}
        return SimpleNamespace(group="shapes", measured="all the calls", rows=(row,), closest=row, known=known,
                               unanswered={library: (None, "wrong in 1") for library in struck})

    asked = [question(0.5, ["fcl"], ["bullet"]), question(2, ["fcl", "bullet"]), question(3, ["fcl", "bullet"]),
             question(4, ["fcl", "bullet"]), question(400, ["fcl"], ["bullet"]), question(5, ["fcl", "bullet"], ["never right"])]
    monkeypatch.setattr(published_tables, "questions", lambda run, tasks: asked)
    (line,) = published_tables.summary(None, ())
    assert line[2:4] == ["6", "5, 1, 0"] and line[5:8] == ["0.5x", "3x", "5x"]
