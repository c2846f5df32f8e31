"""Every figure: drawn in each format with its numbers, readable, or left out with a reason."""

import csv
import dataclasses
import itertools

import pytest
import synthetic
from matplotlib.text import Annotation, Text

from boxwood_results import labels, picture, registry, run, style
from boxwood_results.metrics import METRICS


@pytest.fixture(scope="module")
def results(full):
    return run.read(full)


@pytest.mark.parametrize("name", registry.FIGURES)
def test_a_figure_is_written_with_its_numbers(tmp_path, results, name):
    drawn = registry.draw(name, results)
    assert drawn.pictures, drawn.skipped
    for number, made in enumerate(drawn.pictures):
        *paths, numbers = picture.save(made, tmp_path, ("png",) if number else ("png", "svg", "pdf"))
        starts = {".svg": b"<?xml", ".png": b"\x89PNG", ".pdf": b"%PDF"}
        for path in paths:
            assert path.read_bytes().startswith(starts[path.suffix]) and path.stat().st_size > 3000
        rows = list(csv.DictReader(numbers.open()))
        assert len(rows) == len(made.rows) > 0 and list(rows[0]) == list(made.columns)
        assert len(made.alt) > 40
        style.plt.close(made.figure)


def text_box(annotation, renderer):
    """Without the thin line to its point."""
    annotation.update_positions(renderer)
    return Text.get_window_extent(annotation, renderer)


@pytest.mark.parametrize("name", ["builder_tradeoff", "scaling", "speedup", "work", "accuracy", "condition"])
def test_labels_do_not_overlap(results, name):
    for made in registry.draw(name, results).pictures:
        renderer = made.figure.canvas.get_renderer()
        for ax in made.figure.axes:
            boxes = [text_box(text, renderer) for text in ax.texts if isinstance(text, Annotation)]
            assert boxes
            for a, b in itertools.combinations(boxes, 2):
                assert labels.overlap(a, b) < 0.1 * min(a.width * a.height, b.width * b.height), made.name
        style.plt.close(made.figure)


def test_frames_grow_by_update_and_query(tmp_path):
    made = synthetic.Maker(3)
    for n in (500, 1000, 2000):
        made.cell("uniform_drift", n, "pairs", "auto.packed", ("boxwood", "auto", 100, 50, 0), 1)
    results = run.read(made.write(tmp_path / "a.h5"))
    for cell in results.cells:  # as a run of frames has them
        cell.job = dataclasses.replace(cell.job, ask="moving_pairs")
        cell.times["update"] = {shard: 3 * ns for shard, ns in cell.times["query"].items()}
    results.jobs = sorted({cell.job for cell in results.cells}, key=lambda job: job.n)
    made = registry.draw("scaling", results).pictures[0]
    assert {row[3] for row in made.rows} == {"update+query"}
    assert [ax.get_ylabel() for ax in made.figure.axes if ax.get_ylabel()] == [METRICS["frame"].axis]
    cell = min(results.cells, key=lambda cell: cell.job.n)
    assert made.rows[0][8] == pytest.approx(4 * cell.median("query"), rel=0.01)
    style.plt.close(made.figure)


def test_break_even_is_right(results):
    made = registry.draw("builder_tradeoff", results).pictures[0]
    rows = [dict(zip(made.columns, row)) for row in made.rows]
    panel = {r["variant"]: r for r in rows if r["scene"] == "uniform" and r["threads"] == 1}
    cheap, dear = panel["median.wide8"], panel["binned_sah.wide8"]
    queries = dear["break_even_queries"]
    cost = [r["build_ns"] + queries * r["query_ns"] for r in (cheap, dear)]
    assert cost[0] == pytest.approx(cost[1])
    assert panel["fcl.dynamic_aabb_tree"]["break_even_queries"] is None


def test_wrong_cells_are_marked_and_listed(results):
    made = registry.draw("builder_tradeoff", results).pictures[0]
    assert any("bullet.dbvt on bars" in note and "2 missing" in note for note in made.notes)
    crosses = [line for ax in made.figure.axes for line in ax.lines if line.get_marker() == "x"]
    assert len(crosses) == 1
    forest = registry.draw("forest", results).pictures[0]
    assert not any(row[1] == "bars" and "bullet" in row[5] for row in forest.rows)


@pytest.mark.parametrize("name", ["scaling", "speedup", "run_health"])
def test_figures_without_data_are_left_out(tmp_path, script, small, name):
    done = script("plot", small, "--figure", name, "--out", tmp_path)
    assert done.returncode == 0 and f"no {name}: " in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_run_with_peers_alone_is_drawn(tmp_path):
    made = synthetic.Maker(3)
    for contender in ("fcl.dynamic_aabb_tree", "bullet.dbvt"):
        made.cell("uniform", 500, "pairs", contender, synthetic.PAIR_CONTENDERS[contender], 1)
    results = run.read(made.write(tmp_path / "a.h5"))
    assert registry.draw("forest", results).skipped
    assert registry.draw("builder_tradeoff", results).pictures


def test_a_crowd_is_thinned_and_said(tmp_path):
    made = synthetic.Maker(2)
    for k in range(30):
        spec = ("boxwood", f"builder_{k % 3}", 50 + k, 500 - k, 40)
        made.cell("uniform", 500, "pairs", f"builder_{k % 3}.v{k}", spec, 1)
    drawn = registry.draw("work", run.read(made.write(tmp_path / "a.h5"))).pictures[0]
    assert len(drawn.rows) == 12 and any("18 further" in note for note in drawn.notes)


def test_families_look_different():
    looks = [style.look(family) for family in style.FAMILIES]
    assert len({colour for colour, _ in looks}) == len({marker for _, marker in looks}) == len(looks)
    assert style.look("ploc") == style.look("ploc")


def test_spread_keeps_order_and_gap():
    placed = labels.spread([5, 50, 50, 52, 99, 99], 10, 0, 100)
    assert all(b - a >= 10 - 1e-9 for a, b in zip(placed, placed[1:]))
    assert placed[0] == 5 and placed[-1] <= 100


@pytest.mark.parametrize("low, high", [(1, 1.2), (3, 8), (20, 700), (1, 1e6), (0.7, 1.4), (9.99, 10.01)])
def test_ticks_are_few_and_not_none(low, high):
    assert 2 <= len(style.log_ticks(low, high)) <= 7 or high / low < 1.01


def rows_of(name, results, place=0):
    made = registry.draw(name, results).pictures[place]
    return [dict(zip(made.columns, row)) for row in made.rows]


def test_accuracy_counts_wrong_answers_per_million(results):
    rows = {(r["panel"], r["rung"]): r for r in rows_of("accuracy", results)}
    assert rows["touching", "moller_f32"]["per_million"] == pytest.approx(300000)
    assert rows["touching", "guigue_devillers_exact"]["wrong"] == 0
    assert rows["generic", "moller_f32"]["ns"] == pytest.approx(5.1, rel=0.1)  # the samples, not the check's own time


def test_the_zero_lane_has_a_bar_up_to_three_over_n(results):
    made = registry.draw("accuracy", results).pictures[0]
    generic = made.figure.axes[0]
    tops = [max(line.get_ydata()) for line in generic.lines if len(set(line.get_xdata())) == 1 and len(line.get_xdata()) == 2]
    assert tops and all(top == pytest.approx(3e6 / 8000) for top in tops)


def test_kernels_stay_out_of_the_other_figures(results):
    assert results.kernels and not any(cell.job.ask == "triangle_triangle" for cell in results.cells)


def test_robustness_shows_each_kernel_and_family(results):
    rows = rows_of("robustness", results)
    assert len(rows) == len(synthetic.TRIANGLE_RUNGS) * len(synthetic.CASES)


def test_price_is_relative_to_the_fastest_kernel(results):
    rows = {r["kernel"]: r for r in rows_of("price", results)}
    assert rows["guigue_devillers_exact"]["times_the_fastest"] == pytest.approx(1.3, rel=0.05)
    assert rows["moller_f32"]["status"] == "wrong"
