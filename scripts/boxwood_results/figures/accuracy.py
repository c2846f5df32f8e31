"""What accuracy costs: time of each rung against how wrong it is, by kind of input."""

import math

from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from .. import labels, style
from ..kernels import LEAST_ERROR, PANELS, by_kernel_family, is_measured, rungs
from ..picture import Picture, Skip

NAME = "accuracy"
TITLE = "What accuracy costs"
HOW_TO_READ = (
    "Lower left is better. The line joins our rungs that no faster one of ours betters; hollow marks are peers. "
    "A rung in the zero lane at the bottom gave no wrong answer; its bar reaches up to 3/N, the rate that so "
    "many right answers cannot exclude (95 %). Distances are drawn by their worst relative error; their lane "
    "is half an ulp or less. Times are means over the families of a panel."
)
COLUMNS = ("kernel_family", "panel", "rung", "library", "promise", "ns", "n", "wrong", "per_million", "maybe",
           "max_rel_err")


def value(rung, measured):
    """What is on the y axis; 0 in the lane."""
    if not measured:
        return rung.per_million
    if rung.error != rung.error:
        return 0.0
    return rung.error if rung.error > LEAST_ERROR else 0.0


def y_axis(ax, values, bars, measured):
    """A log axis with a lane for zero below it; gives the height of the lane."""
    seen = [v for v in (*values, *bars) if v > 0 and math.isfinite(v)]
    low = 10.0 ** math.floor(math.log10(min(seen, default=1e-16 if measured else 1)))
    high = 10.0 ** math.ceil(math.log10(max(max(seen, default=1), 100 * low)) + 0.2)
    decades = math.log10(high / low)
    lane = low / 10 ** (0.3 * decades)
    ax.set_yscale("log")
    ax.set_ylim(lane / 10 ** (0.22 * decades), high)
    steps = range(round(math.log10(low)), round(math.log10(high)) + 1, max(1, round(decades / 6)))
    ticks = [lane] + [10.0**d for d in steps]
    ax.yaxis.set_major_locator(FixedLocator(ticks))
    ax.yaxis.set_minor_locator(NullLocator())
    ax.yaxis.set_major_formatter(
        FuncFormatter(lambda v, _: "0" if v <= lane * 1.01 else f"{v:.0e}" if measured else style.count_text(v))
    )
    ax.axhspan(lane / 10 ** (0.22 * decades), lane * 10 ** (0.15 * decades), color="#EAF4EA", zorder=0)
    return lane


def draw_panel(ax, panel, found, measured):
    values = [value(r, measured) for r in found]
    bars = [0 if measured or v else 3e6 / r.n for v, r in zip(values, found)]
    lane = y_axis(ax, values, bars, measured)
    style.time_axis(ax.xaxis, min(r.ns for r in found), max(r.ns for r in found), room=0.15)
    marks = []
    for rung, v, bar in zip(found, values, bars):
        colour, marker = style.look(rung.library if not rung.ours else "binned_sah")
        y = v or lane
        if not v and bar:
            ax.plot([rung.ns, rung.ns], [lane, bar], color=colour, linewidth=1, alpha=0.45, zorder=2)
        ax.plot([rung.ns], [y], marker=marker, markersize=7, linestyle="", zorder=5, markeredgewidth=1.3,
                markeredgecolor=colour if not rung.ours else "white",
                markerfacecolor="white" if not rung.ours else colour)
        marks.append((rung.ns, y, rung.name, style.text_colour(rung.library if not rung.ours else "binned_sah")))
    best = []  # no other rung of ours is both faster and less wrong
    for rung, v in zip(found, values):
        if rung.ours and (not best or v < best[-1][2]):
            best.append((rung.ns, v or lane, v))
    ax.plot([x for x, _, _ in best], [y for _, y, _ in best], color=style.FAINT, linewidth=1.1, zorder=1)
    style.title(ax, f"{panel} input, {max(r.n for r in found):,} cases")
    ax.set_xlabel("time per call (lower is better)")
    ax.set_ylabel("worst relative error" if measured else "wrong answers per million")
    labels.beside_points(ax, marks)


def draw(run):
    pictures = []
    for kernel_family, points in by_kernel_family(run).items():
        measured = is_measured(kernel_family)
        panels = [(p, rungs([q for q in points if q.panel == p])) for p in PANELS]
        panels = [(panel, found) for panel, found in panels if found]
        if not panels:
            continue
        figure, axes = style.panels(len(panels), width=7.4, height=4.6, columns=2)
        rows = []
        for ax, (panel, found) in zip(axes, panels):
            draw_panel(ax, panel, found, measured)
            rows += [(kernel_family, panel, r.name, r.library, r.promise, r.ns, r.n, r.wrong, r.per_million, r.maybe,
                      r.error) for r in found]
        said = "; ".join(
            f"{row[2]} on {row[1]} input: {row[5]:.3g} ns, {row[7]} of {row[6]} wrong" for row in rows
        )
        pictures.append(Picture(f"{NAME}_{kernel_family}", figure, f"{TITLE}: {kernel_family}",
                                f"Time per call against wrong answers. {said}.", COLUMNS, rows))
    if not pictures:
        raise Skip("no kernel was run on hard cases (bench/configs/accuracy.toml and boxwood check do)")
    return pictures
