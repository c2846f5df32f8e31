"""What makes a picture readable: axes that end where values do, colours with one meaning, texts clear of lines."""

import math
from types import SimpleNamespace

import pytest
import synthetic

from boxwood_results import labels, registry, run, selection, style
from boxwood_results.figures import accuracy, effect_cost, work
from boxwood_results.kernels import Kernel


@pytest.fixture(scope="module")
def results(full):
    return run.read(full)


def kernel(name, ns, wrong=0, error=math.nan):
    return Kernel("triangle_triangle", "generic", name, True, "boxwood", "no promise", ns, 1000, wrong, 0, error,
                  1000 * wrong, math.nan if wrong else 3000, error == error,
                  (math.inf if error > 1 else error) if error == error else 1000 * wrong, False)


def test_the_axis_of_wrong_answers_ends_at_all():
    figure, (ax,) = style.panels(1)
    accuracy.draw_panel(ax, "generic", [kernel("always_wrong", 5, 1000), kernel("right", 9)], False)
    ticks = [text.get_text() for text in ax.get_yticklabels()]
    assert ticks[0] == "0" and ticks[-1] == "1M"
    assert 1e6 < ax.get_ylim()[1] < 2.5e6  # room for the mark and no further number
    style.plt.close(figure)


@pytest.mark.parametrize("error", [7.0, 1e20, math.inf])
def test_an_error_without_a_right_digit_stands_in_the_band_at_the_top(error):
    figure, (ax,) = style.panels(1)
    accuracy.draw_panel(ax, "generic", [kernel("far_off", 5, 10, error), kernel("near", 9, 0, 1e-12)], True)
    marks = {line.get_xdata()[0]: line.get_ydata()[0] for line in ax.lines if line.get_marker() == "o"}
    assert 1 < marks[5] < ax.get_ylim()[1] < 1e6 and marks[9] == 1e-12
    tick = dict(zip(ax.get_yticks(), (text.get_text() for text in ax.get_yticklabels())))
    assert tick[marks[5]] == "no digit"
    style.plt.close(figure)


def test_settings_keep_the_colour_of_their_builder():
    for place in range(20):  # more than the palette has
        plain = SimpleNamespace(ours=True, place=place, is_plain=True, family="b")
        others = [SimpleNamespace(ours=True, place=place, is_plain=False, family=f"b_leaf_size{k}") for k in range(9)]
        assert {style.look(other)[0] for other in others} == {style.look(plain)[0]}
        assert place >= len(style.OURS) or style.look(plain)[1] not in {style.look(other)[1] for other in others}


def test_kernels_in_one_picture_look_different():
    names = {"features_f32", "features_f64", "features_f64_batch", "cross_product_f64", "certified", "rational"}
    looks = style.looks(names)
    assert set(looks) == names and len({colour for colour, _ in looks.values()}) == len(names)
    assert len({marker for _, marker in looks.values()}) == len(names)


def test_a_text_keeps_clear_of_a_line():
    figure, (ax,) = style.panels(1)
    ax.set(xlim=(0, 10), ylim=(0, 10))
    line = [(5, 5), (9, 5)]  # through the place that is tried first
    labels.beside_points(ax, [(5, 5, "a name", "#000000")], lines=[line])
    box = ax.texts[0].get_window_extent(figure.canvas.get_renderer())
    steps = [ax.transData.transform((5 + 0.05 * k, 5)) for k in range(80)]
    assert not any(box.contains(*step) for step in steps)
    style.plt.close(figure)


@pytest.mark.parametrize("apart, is_joined", [(0.02, True), (0.5, False)])
def test_a_text_that_is_as_near_to_another_point_is_joined_to_its_own(apart, is_joined):
    figure, (ax,) = style.panels(1)
    ax.set(xlim=(0, 10), ylim=(0, 10))
    labels.beside_points(ax, [(5, 5, "a name", "#000000"), (5 + apart, 5, "another", "#000000")])
    assert [text.arrow_patch is not None for text in ax.texts] == [is_joined, is_joined]
    style.plt.close(figure)


def cell(label, ours=True, status="right"):
    return SimpleNamespace(label=label, ours=ours, status=status)


def test_long_names_leave_out_what_they_share():
    cells = [cell("binned_sah.wide8.guigue_devillers_f32"), cell("binned_sah.wide8.sat_f64"), cell("fcl.wide8.x", False)]
    names, shared = selection.short_labels(cells)
    assert shared == "binned_sah.wide8"
    assert [names[id(c)] for c in cells] == ["guigue_devillers_f32", "sat_f64", "fcl.wide8.x"]
    peer = cell("cgal.box_self_intersection_d_of_all", False)
    for kept in ([cell("hilbert.packed"), cell("median.packed"), peer],  # short ones stay as other figures have them
                 [cell("binned_sah_agglomerate_below8_leaf_size8.wide8"), cell("binned_sah_agglomerate_below8_leaf_size8.wide8.watertight")]):
        names, shared = selection.short_labels(kept)
        assert shared == "" and [names[id(c)] for c in kept] == [c.label for c in kept]


def test_variants_at_one_place_stand_there_once():
    cells = [cell("sah.wide8.a", status="wrong"), cell("sah.wide8.b"), cell("lbvh.wide8.a")]
    names = {id(c): c.label for c in cells}
    found = work.places([(cells[0], 1, 2), (cells[1], 1, 2), (cells[2], 1, 3)], names)
    assert found == [(cells[1], 1, 2, "2 of sah.wide8"), (cells[2], 1, 3, "lbvh.wide8.a")]


@pytest.mark.parametrize("name", registry.FIGURES)
def test_no_panel_is_empty(results, name):
    for made in registry.draw(name, results).pictures:
        assert all(ax.has_data() for ax in made.figure.axes)
        style.plt.close(made.figure)


def test_intervals_of_thread_scaling_are_not_cut(results):
    for made in registry.draw("thread_scaling", results).pictures:
        for ax in made.figure.axes:
            low, high = ax.get_ylim()
            assert all(low <= y <= high for line in ax.lines for y in line.get_ydata())
        style.plt.close(made.figure)


def test_a_cost_has_its_sign():
    assert effect_cost.cost_text(-2e6) == "-2.00 ms" and effect_cost.cost_text(1e6) == "+1.00 ms"


def test_a_tall_picture_shows_its_axis_at_the_top_too(tmp_path):
    made = synthetic.Maker(9)
    for k in range(20):
        for contender in ("median.packed", "fcl.dynamic_aabb_tree", "bullet.dbvt"):
            library, builder = ("boxwood", "median") if contender == "median.packed" else (contender.split(".")[0], "")
            made.cell(f"scene_{k}", 500, "pairs", contender, (library, builder, 50, 500, 40), 1)
    figure = registry.draw("forest", run.read(made.write(tmp_path / "a.h5"))).pictures[0].figure
    figure.canvas.draw()
    assert all(tick.label2.get_visible() and tick.label2.get_text() for ax in figure.axes for tick in ax.xaxis.get_major_ticks())
    style.plt.close(figure)
