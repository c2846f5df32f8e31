"""Every figure: drawn in each format with its numbers, readable, or left out with a reason."""

import csv
import dataclasses
import itertools
from types import SimpleNamespace

import pytest
import synthetic
from matplotlib.text import Annotation, Text

from boxwood_results import labels, picture, registry, run, style
from boxwood_results.figures import tree_quality_over_time


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


@pytest.mark.parametrize("name", ["builder_tradeoff", "size_scaling", "thread_scaling", "device_gains", "work", "accuracy", "condition",
                                  "moved_share", "tree_quality_over_time"])
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
    for n in (500, 1000, 2000, 4000):
        made.moving_cell("uniform_drift", n, "moving_pairs", "auto", "auto", 3.0 * n, 1.0 * n, frames=2)
    results = run.read(made.write(tmp_path / "a.h5"))
    made = registry.draw("size_scaling", results).pictures[0]
    assert {row[3] for row in made.rows} == {"update+query"}
    assert [ax.get_ylabel() for ax in made.figure.axes if ax.get_ylabel()] == ["time of update and query (lower is better)"]
    cell = min(results.cells, key=lambda cell: cell.job.n)
    assert made.rows[0][8] == pytest.approx(4 * cell.median("query"), rel=0.05)
    assert made.rows[0][9] == pytest.approx(1, abs=0.05)  # the exponent that the file has
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
    assert not any(row[2] == "bars" and "bullet" in row[6] for row in forest.rows)


@pytest.mark.parametrize("name", ["size_scaling", "thread_scaling", "device_gains", "run_health"])
def test_figures_without_data_are_left_out(tmp_path, script, small, name):
    done = script("plot", small, "--figure", name, "--out", tmp_path)
    assert done.returncode == 0 and f"no {name}: " in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_all_that_is_left_out_takes_one_line(tmp_path, script, small):
    done = script("plot", small, "--format", "svg", "--out", tmp_path)
    assert done.returncode == 0 and done.stderr.count("\n") == 1
    assert "size_scaling" in done.stderr and "run_health" in done.stderr and "forest" not in done.stderr


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
    for ours, palette in ((True, style.OURS), (False, style.PEERS)):
        looks = [style.look(SimpleNamespace(ours=ours, place=place, is_plain=True, family="x")) for place in range(len(palette))]
        assert len({colour for colour, _ in looks}) == len({marker for _, marker in looks}) == len(looks)
    assert not {colour for colour, _ in style.OURS} & {colour for colour, _ in style.PEERS}


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
    rows = {(r["panel"], r["kernel"]): r for r in rows_of("accuracy", results, 1)}
    assert rows["touching", "moller_f32"]["per_million"] == pytest.approx(300000)
    assert rows["touching", "guigue_devillers_exact"]["wrong"] == 0
    assert rows["generic", "moller_f32"]["ns"] == pytest.approx(5.1, rel=0.1)  # the samples, not the check's own time


def test_the_zero_band_has_a_bar_up_to_three_over_n(results):
    made = registry.draw("accuracy", results).pictures[1]
    generic = made.figure.axes[0]
    tops = [max(line.get_ydata()) for line in generic.lines if len(set(line.get_xdata())) == 1 and len(line.get_xdata()) == 2]
    assert tops and all(top == pytest.approx(3e6 / 8000) for top in tops)


def test_kernels_stay_out_of_the_other_figures(results):
    assert results.kernels and not any(cell.job.task == "triangle_triangle" for cell in results.cells)


def test_robustness_shows_each_kernel_and_family(results):
    rows = rows_of("robustness", results)
    assert len(rows) == len(synthetic.TRIANGLE_KERNELS) * len(synthetic.CASES)


def test_kernel_cost_is_relative_to_the_fastest_kernel(results):
    rows = {r["kernel"]: r for r in rows_of("kernel_cost", results, 1)}
    assert rows["guigue_devillers_exact"]["times_the_fastest"] == pytest.approx(1.3, rel=0.05)
    assert rows["moller_f32"]["status"] == "wrong"


def visible_texts(ax):
    return [text for text in [*ax.texts, ax.title, ax._left_title] if text.get_text().strip()]


@pytest.mark.parametrize("name", ["ledger", "effect_cost", "frame_times"])
def test_texts_beside_bars_do_not_overlap(results, name):
    for made in registry.draw(name, results).pictures:
        renderer = made.figure.canvas.get_renderer()
        boxes = [(text.get_text(), text_box(text, renderer) if isinstance(text, Annotation) else text.get_window_extent(renderer))
                 for ax in made.figure.axes for text in visible_texts(ax)]
        assert len(boxes) > 5
        for (one, a), (other, b) in itertools.combinations(boxes, 2):
            assert labels.overlap(a, b) < 0.1 * min(a.width * a.height, b.width * b.height), (one, other)
        style.plt.close(made.figure)


def test_the_ledger_has_every_stage_required_or_not(results):
    rows = [row for row in rows_of("ledger", results) if row["scene"] == "warehouse"]
    ours = {row["stage"]: row for row in rows if row["played"] == "required"}
    all_stages = {row["stage"]: row for row in rows if row["played"] == "all_stages"}
    assert set(ours) == set(all_stages) == set(synthetic.STAGES["warehouse"])
    assert ours["pairs"]["ns_a_frame"] == pytest.approx(210e3, rel=0.05) and ours["pairs"]["required"] == 1
    assert ours["transform"]["ns_a_frame"] == ours["transform"]["calls"] == ours["transform"]["bytes"] == 0
    assert all_stages["transform"]["ns_a_frame"] == pytest.approx(600e3, rel=0.05)
    assert sum(row["share"] for row in ours.values()) == pytest.approx(1)


def test_the_ledger_names_what_nobody_requires(results):
    made = registry.draw("ledger", results).pictures[0]
    texts = " ".join(text.get_text() for ax in made.figure.axes for text in ax.texts)
    assert "not required (0): triangle_pairs, surface, rays, points, regions, nearest" in texts
    assert "not required (0): mesh_trees, rays" in texts
    style.plt.close(made.figure)


def test_effect_costs_are_paired_ratios(results):
    rows = {(row["scene"], row["what"]): row for row in rows_of("effect_cost", results)}
    costs = synthetic.STAGES["warehouse"]
    total = sum(ours for ours, *_ in costs.values())
    without = total - costs["advance_drift"][0] - 0.4 * costs["update"][0]
    assert rows["warehouse", "drift"]["ratio"] == pytest.approx(total / without, rel=0.02)
    all_stages = sum(all_ for _, all_, _ in costs.values())
    assert rows["warehouse", "all stages"]["ratio"] == pytest.approx(all_stages / total, rel=0.02)


def test_frame_times_are_percentiles_of_the_frames_and_not_of_the_rounds(results):
    rows = {row["contender"]: row for row in rows_of("frame_times", results) if row["scene"] == "uniform_drift"}
    auto = rows["auto"]  # two of 20 frames take thrice the update
    assert auto["frames"] == 20
    assert auto["worst_ns"] - auto["p50_ns"] == pytest.approx(2 * 25 * 10000, rel=0.15)
    assert auto["p50_ns"] < auto["p95_ns"] <= auto["p99_ns"] <= auto["worst_ns"]
    assert rows["bullet.dbvt.margin"]["over_1_ms"] == 1


def test_a_structure_that_degrades_climbs(results):
    rows = rows_of("tree_quality_over_time", results)
    last = {row["contender"]: row["over_a_fresh_one"] for row in rows
            if row["scene"] == "uniform_drift" and row["frame"] == 19}
    assert last["bullet.dbvt.margin"] / (480 / 58) == pytest.approx(1.38, rel=0.03)
    assert last["merge"] == pytest.approx(62 / 58, rel=0.03)


def test_degradation_is_counted_where_it_was(results):
    _, counted = registry.draw("tree_quality_over_time", results).pictures
    rows = [dict(zip(counted.columns, row)) for row in counted.rows if row[0] == "uniform_drift"]
    assert {row["contender"] for row in rows} == {"auto", "merge", "rebuild.trigger0", "reinsert"}  # no peers, no cached
    last = {row["contender"]: row for row in rows if row["frame"] == 19}
    assert last["reinsert"]["box_tests_per_item"] == pytest.approx(40 * (1 + 2 * 0.012 * 19))
    assert last["reinsert"]["sah"] == pytest.approx(200 * (1 + 2 * 0.012 * 19))
    assert last["merge"]["box_tests_per_item"] == 40
    style.plt.close("all")


def test_of_many_scenes_those_that_degrade_most_are_drawn_and_all_are_listed(results, monkeypatch):
    module = tree_quality_over_time
    complete = module.draw(results)[0]
    monkeypatch.setattr(module, "MAX_SCENES", 1)
    timed, counted = module.draw(results)
    assert timed.rows == complete.rows and len({row[0] for row in timed.rows}) > 1
    assert sum(bool(ax.lines) for ax in timed.figure.axes) == 1
    assert sum(bool(ax.lines) for ax in counted.figure.axes) == 2
    assert any("the CSV file holds all" in note for note in timed.notes)
    style.plt.close("all")


def test_the_moved_share_comes_from_the_scene(results):
    rows = [row for row in rows_of("moved_share", results) if row["contender"] == "merge"]
    assert [row["moved_share"] for row in rows] == list(synthetic.SHARES)
    assert rows[0]["scene"] == "uniform, drift speed 1"
    assert rows[0]["frame_ns"] == pytest.approx(10000 * (0.01 * 24 + 0.99 * 4 + 62), rel=0.05)


def test_ways_to_play_a_scene_are_no_rivals(results):
    made = [picture for name in ("forest", "thread_scaling", "size_scaling") for picture in registry.draw(name, results).pictures]
    assert made and not any("without" in str(row) or "required" in str(row) for p in made for row in p.rows)


def test_watertight_peers_are_held_against_watertight_kernels(results):
    classes = set()
    for made in registry.draw("forest", results).pictures:
        rows = [dict(zip(made.columns, row)) for row in made.rows if row[0] == "rays_closest"]
        for row in rows:
            assert ("robust" in row["peer"]) == ("watertight" in row["class"]), row
            assert "robust" not in row["peer"] or "watertight" in row["ours"]
        classes |= {row["class"] for row in rows}
        style.plt.close(made.figure)
    assert classes == {"batches", "watertight batches"}
