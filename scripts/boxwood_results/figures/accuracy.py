"""What accuracy costs: time of each kernel against how wrong it is, by kind of input."""

import math

from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

from .. import labels, style
from ..picture import Picture, Skip

NAME = "accuracy"
TITLE = "What accuracy costs"
HOW_TO_READ = (
    "Lower left is better. The line joins our kernels that always decide and that no faster such one betters; hollow marks are "
    "peers. A mark that is filled to the half leaves some cases open ('maybe'), which counts as no wrong answer. "
    "A kernel in the zero band at the bottom gave no wrong answer; its bar reaches up to 3/N, the rate that so "
    "many right answers cannot exclude (95 %). Distances are drawn by their worst relative error; their zero band "
    "is half an ulp or less, their band at the top all above 1, where no digit is right. Times are means over the "
    "families of a panel."
)
NO_DIGIT = 1.0
COLUMNS = ("task", "panel", "kernel", "library", "promise", "ns", "n", "wrong", "per_million", "maybe",
           "max_rel_err")


def y_axis(ax, values, bars, measured):
    """A log axis up to all (a million in a million, or an error of 1) with a band for zero below it, and for
    distances one for what is worse above it; gives the heights of the bands."""
    seen = [v for v in (*values, *bars) if v > 0 and math.isfinite(v)]
    low = 10.0 ** math.floor(math.log10(min(seen, default=1e-16 if measured else 1)))
    high = NO_DIGIT if measured else 1e6
    decades = math.log10(high / low)
    band, top = low / 10 ** (0.3 * decades), high * 10 ** (0.1 * decades)
    bottom, ceiling = band / 10 ** (0.22 * decades), high * 10 ** ((0.17 if measured else 0.05) * decades)
    ax.set_yscale("log")
    ax.set_ylim(bottom, ceiling)
    steps = range(round(math.log10(low)), round(math.log10(high)) + 1, max(1, round(decades / 6)))
    ticks = {band: "0", **{10.0**d: f"{10.0**d:.0e}" if measured else style.count_text(10.0**d) for d in steps}}
    if measured:
        ticks[top] = "no digit"
        ax.axhspan(high * 10 ** (0.04 * decades), ceiling, color="#FBE9E0", zorder=0)
    ax.yaxis.set_major_locator(FixedLocator(list(ticks)))
    ax.yaxis.set_minor_locator(NullLocator())
    ax.yaxis.set_major_formatter(FixedFormatter(list(ticks.values())))
    ax.axhspan(bottom, band * 10 ** (0.15 * decades), color="#EAF4EA", zorder=0)
    return band, top


def draw_panel(ax, panel, found, measured):
    values = [r.badness for r in found]
    band, top = y_axis(ax, values, [r.unexcluded for r in found], measured)

    def height(v):
        return (v or band) if math.isfinite(v) else top

    style.time_axis(ax.xaxis, min(r.ns for r in found), max(r.ns for r in found), room=0.15)
    marks, lines = [], []
    for kernel, v in zip(found, values):
        colour, marker = style.kernel_look(kernel)
        y = height(v)
        if kernel.unexcluded == kernel.unexcluded:
            ax.plot([kernel.ns, kernel.ns], [band, kernel.unexcluded], color=colour, linewidth=1, alpha=0.45, zorder=2)
            lines.append([(kernel.ns, band), (kernel.ns, kernel.unexcluded)])
        ax.plot([kernel.ns], [y], marker=marker, markersize=7, linestyle="", zorder=5, markeredgewidth=1.3,
                markeredgecolor="white" if kernel.ours and not kernel.maybe else colour,
                fillstyle="left" if kernel.maybe else "full", markerfacecoloralt="white",
                markerfacecolor="white" if not (kernel.ours or kernel.maybe) else colour)
        marks.append((kernel.ns, y, kernel.name, style.readable(colour)))
    best = [(kernel.ns, height(v)) for kernel, v in zip(found, values) if kernel.on_front]
    ax.plot([x for x, _ in best], [y for _, y in best], color=style.FAINT, linewidth=1.1, zorder=1)
    style.title(ax, f"{panel} input, {max(r.n for r in found):,} cases")
    ax.set_xlabel("time per call (lower is better)")
    ax.set_ylabel("worst relative error" if measured else "wrong answers per million")
    lines.append(best)
    labels.beside_points(ax, marks, lines=lines)


def draw(run):
    pictures = []
    for task in dict.fromkeys(kernel.task for kernel in run.kernel_costs):
        of_task = [kernel for kernel in run.kernel_costs if kernel.task == task]
        panels = [(panel, [kernel for kernel in of_task if kernel.panel == panel])
                  for panel in dict.fromkeys(kernel.panel for kernel in of_task)]
        measured = panels[0][1][0].by_error
        figure, axes = style.panels(len(panels), width=10.5, height=4.3, columns=1)
        rows = []
        for ax, (panel, found) in zip(axes, panels):
            draw_panel(ax, panel, found, measured)
            rows += [(task, panel, r.name, r.library, r.promise, r.ns, r.n, r.wrong, r.per_million, r.maybe,
                      r.error) for r in found]
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}",
                                f"Time per call against wrong answers of {len(rows)} kernels of {task}.", COLUMNS, rows))
    if not pictures:
        raise Skip("no kernel was run on hard cases (bench/configs/accuracy.toml and boxwood check do)")
    return pictures
