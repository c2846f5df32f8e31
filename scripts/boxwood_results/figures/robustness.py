"""Families of hard cases against kernels and peers: how often each is wrong."""

import math

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from .. import style
from ..kernels import MIN_ERROR, by_kernel_family
from ..picture import Picture, Skip

NAME = "robustness"
TITLE = "Robustness"
HOW_TO_READ = (
    "Each row is a family of hard cases, each column a kernel, ours left of the line, peers right of it (no line: no "
    "peers). The number is wrong answers per million, green none; for distances it is the worst relative error (0: below half "
    "an ulp, ?: it gives none), green below 1e-9, and \"out\" counts answers beyond the bound that was given. The darker the worse. A number in brackets "
    "counts what was left undecided per million. A dash: not supported."
)
COLUMNS = ("task", "cases", "kernel", "library", "n", "wrong", "maybe", "max_rel_err")
WIDE = 0.72  # inches of a column
COLOURS = LinearSegmentedColormap.from_list("wrong", ["#FFF3D6", "#F5B971", "#D55E00", "#6E1A00"])
RIGHT = "#D9EFDD"


def entry(point, measured):
    """(text, darkness 0..1 or None if right)."""
    if measured:
        error = point.error
        if point.row["bound_violations"]:
            return f"{int(point.row['bound_violations'])} out", 1.0
        if error != error:
            return "?", None
        if error <= MIN_ERROR:
            return "0", None
        if error < 1e-9:
            return f"{error:.0e}", None
        return ("inf" if math.isinf(error) else f"{error:.0e}"), min(1.0, (math.log10(error) + 9) / 9)
    rate, undecided = float(point.row["wrong_per_million"]), float(point.row["maybe_per_million"])
    text = "0" if not rate else style.count_text(float(f"{rate:.2g}"))
    if undecided:
        text += f" ({style.count_text(float(f'{undecided:.2g}'))})"
    return text, min(1.0, math.log10(max(rate, 1)) / 6) if rate else None


def draw(run):
    pictures = []
    for task, points in by_kernel_family(run).items():
        kernels = sorted((k for k in run.kernel_costs if k.task == task), key=lambda k: (not k.ours, k.ns))
        columns = list(dict.fromkeys((k.ours, k.library, k.name) for k in kernels))
        families = list(dict.fromkeys(p.cases for p in points))
        if not columns:
            continue
        at = {(p.cases, (p.ours, p.library, p.kernel)): p for p in points if p.supported}
        width, height = 2.6 + WIDE * len(columns), 1.9 + 0.2 * len(families)
        figure = style.plt.figure(figsize=(width, height))
        ax = figure.add_axes((2.4 / width, 0.1 / height, WIDE * len(columns) / width, 0.2 * len(families) / height))
        rows, cells = [], {}  # colour -> places
        for y, cases in enumerate(families):
            for x, column in enumerate(columns):
                point = at.get((cases, column))
                if point is None:
                    ax.text(x, y, "-", ha="center", va="center", fontsize=6.5, color="#999999")
                    continue
                text, dark = entry(point, kernels[0].by_error)
                colour = RIGHT if dark is None else COLOURS(dark)
                cells.setdefault(colour, []).append(Path.unit_rectangle().transformed(Affine2D().translate(x - 0.5, y - 0.5)))
                if text:
                    ax.text(x, y, text, ha="center", va="center", fontsize=6.2 if len(text) < 8 else 5.4,
                            color="white" if dark is not None and dark > 0.7 else style.INK)
                rows.append((task, cases, point.kernel, point.library, point.n, point.wrong,
                             int(point.row["maybe"]), point.error))
        for colour, squares in cells.items():
            ax.add_patch(PathPatch(Path.make_compound_path(*squares), facecolor=colour, edgecolor="white"))
        ours = len([name for ours_, _, name in columns if ours_])
        if 0 < ours < len(columns):
            ax.axvline(ours - 0.5, color=style.INK, linewidth=1.2)
        ax.set_xlim(-0.5, len(columns) - 0.5)
        ax.set_ylim(len(families) - 0.5, -0.5)
        ax.set_yticks(np.arange(len(families)), families, fontsize=7)
        ax.xaxis.tick_top()
        ax.set_xticks(np.arange(len(columns)), [name for *_, name in columns], fontsize=7, rotation=40, ha="left")
        ax.tick_params(length=0)
        ax.grid(False)
        for side in ax.spines.values():
            side.set_visible(False)
        pictures.append(Picture(
            f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}",
            f"Wrong answers per million, {len(families)} families of hard cases by {len(columns)} kernels of {task}.",
            COLUMNS, rows))
    if not pictures:
        raise Skip("no kernel was run on hard cases (bench/configs/accuracy.toml and boxwood check do)")
    return pictures
