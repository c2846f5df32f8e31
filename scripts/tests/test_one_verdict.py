"""All readers of one file say the same: the program's show and compare, the figures, the report."""

import csv
import json
import subprocess

import pytest
import synthetic

from boxwood_results import findings, page, registry, run, style


@pytest.fixture(scope="module")
def halves(folder):
    """A synthetic file, and one that is merged from two with other rounds each."""
    parts = []
    for number in (0, 1):
        made = synthetic.full(10)
        for table in ("shards", "samples", "frames", "effects"):
            for row in made.rows[table]:
                row["round"] += 10 * number
        for row in made.rows["shards"]:
            row["pid"] += 1000 * number
        parts.append(made.write(folder / f"half{number}.h5"))
    return synthetic.merged(folder / "both.h5", *parts)


@pytest.fixture(scope="module", params=["full", "halves"])
def file(request):
    return request.getfixturevalue(request.param)


def boxwood(*arguments):
    done = subprocess.run([synthetic.PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_show_python_and_figures_have_the_verdicts_of_the_file(file):
    with synthetic.h5py.File(file) as tables:
        stored = [(int(row["cell_a"]), int(row["cell_b"]), row["phase"].decode(), row["class"].decode(),
                   row["verdict"].decode(), row["reason"].decode(), row["words"].decode()) for row in tables["compare"][:]]
    shown = [(row["cell_a"], row["cell_b"], row["phase"], row["class"], row["verdict"], row["reason"], row["words"])
             for row in json.loads(boxwood("show", file, "--json"))["compare"]]
    results = run.read(file)
    read = [(c.a.cell_id, c.b.cell_id, c.phase, c.contender_class, c.verdict, c.reason, c.verdict_text) for c in results.comparisons]
    assert len(stored) > 300 and stored == shown == read
    assert {row[4] for row in stored} >= {"faster", "slower", "wrong"}
    verdicts = {(c.b.job, c.b.label, c.a.label, c.phase, c.contender_class): c.verdict for c in results.comparisons}
    for name in ("forest", "thread_scaling"):
        for made in registry.draw(name, results).pictures:
            style.plt.close(made.figure)
            for row in (dict(zip(made.columns, row)) for row in made.rows):
                if name == "forest":
                    job = next(c.job for c in results.cells if c.label == row["ours"] and (
                        c.job.task, c.job.scene, c.job.n, c.job.where.column
                    ) == (row["task"], row["scene"], row["n"], row["threads"]))
                    assert row["verdict"] == verdicts[job, row["ours"], row["peer"], row["phase"], row["class"]]
                else:
                    assert row["verdict"] in {c.verdict for c in results.family("threads") if c.b.label == row["variant"]}


def test_screen_all_json_and_report_have_the_findings_of_the_file(file):
    results = run.read(file)
    reported = [(f.question, f.together, f.alone, f.certainty) for f in results.findings]
    shown = json.loads(boxwood("show", file, "--json"))["findings"]
    assert reported == [(row["question"], row["together"], row["alone"], row["certainty"]) for row in shown] and reported
    everything, report = boxwood("show", file, "--all"), page.trust_html(results) + page.main_findings_html(results)
    screen = boxwood("show", file).splitlines()
    for name in ("trust", "correctness", "advice"):
        assert page.escape(results.health[name]) in report and results.health[name] in " ".join(screen)
    for topic in {f.topic for f in results.findings}:
        headings = next(row for row in results.topics if row["topic"] == topic)
        for name in ("question", "together", "alone", "certainty"):
            assert headings[name] in everything and page.escape(headings[name]) in report
    for texts in reported:
        assert all(text in everything and page.escape(text) in report for text in texts)
    races = [row for row in shown if row["topic"] in ("race", "call", "kernel") and row["is_headline"]]
    lost = sum(row["is_loss"] for row in races)
    assert f"loses {lost or 'none'} of {len(races)} questions" in page.tally_text(results)
    headlines = [f for f in results.findings if f.is_headline]
    on_screen = [f for f in headlines
                 if any(line.startswith(f.question[:30]) and f.together in line and f.alone in line for line in screen)]
    assert len(on_screen) >= 10


def test_the_screen_is_one_screen(file):
    """Of 23 lines, and nine more for a device with four sizes."""
    lines = boxwood("show", file).splitlines()
    assert lines[-1] == f"results  {file}" and len(lines) <= 32 and max(map(len, lines[:-1])) <= 120


def test_every_comparison_says_why_it_cannot_tell(file):
    for c in run.read(file).comparisons:
        assert (c.verdict == "cannot_tell") == bool(c.reason)
        if c.verdict == "faster":
            assert c.ratio.hi < 1
        elif c.verdict == "slower":
            assert c.ratio.lo > 1
        elif c.reason == "crosses_1":
            assert c.ratio.lo <= 1 <= c.ratio.hi


def test_families_are_all_there(file):
    families = {c.family for c in run.read(file).comparisons}
    assert families == {findings.PEERS, findings.OURS, findings.THREADS, findings.STAGES, findings.DEVICES}


def test_csv_has_the_medians_of_the_file(file):
    results = run.read(file)
    rows = {(row["cell"], row["phase"]): row for row in csv.DictReader(boxwood("show", file, "--csv").splitlines())}
    for cell in results.cells:
        for phase, row in cell.medians.items():
            assert float(rows[cell.name, phase]["median_ns"]) == row["median_ns"]
            assert rows[cell.name, phase]["status"] == cell.status


def test_compare_passes_a_file_against_itself(file):
    reported = json.loads(boxwood("compare", file, file, "--json", "--all"))
    assert reported["gate"] == "passes" and reported["same_machine"]
    rows = reported["rows"] + reported["peers"]
    assert {(row["verdict"], row["reason"]) for row in rows} <= {
        ("same", ""), ("wrong", ""), ("cannot_tell", "below_the_floor")}
    wrong = {c.name for c in run.read(file).cells if c.status == "wrong" and c.timed}
    assert wrong <= {row["cell"] for row in rows if row["verdict"] == "wrong"}
