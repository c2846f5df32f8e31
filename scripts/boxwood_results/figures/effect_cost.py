"""The cost of each effect: a scene with it against the same scene without it."""

from .. import style
from ..findings import footer
from ..moving import played_scenes
from ..picture import Picture, Skip
from boxwood.results.words import time_text

NAME = "effect_cost"
TITLE = "What an effect costs, against ourselves"
HOW_TO_READ = (
    "Each mark is the time of a frame with something over the time without it, paired within rounds: right of the line "
    "it costs time. Round marks: one effect of the scene. Diamonds: all stages, over only those that the scene requires. "
    "Bars are the intervals that decided; the shaded bands are the A/A noise floors; what is open is pale."
)
COLUMNS = ("scene", "n", "threads", "what", "with_ns", "without_ns", "ratio", "ratio_lo", "ratio_hi")
GAP = 0.12  # inches above a scene
EFFECT, ALL = ("#0072B2", "o"), ("#D55E00", "D")


def entries_of(scene):
    """[(cost, look)] of one scene, the most costly effect first."""
    return [(cost, EFFECT) for cost in scene.effects] + [(cost, ALL) for cost in [scene.all_stages_cost] if cost]


def cost_text(ns):
    """What a frame with it takes more than without."""
    return f"{'+' if ns >= 0 else '-'}{time_text(abs(ns))}"


def draw(run):
    scenes = [(scene, entries_of(scene)) for scene in played_scenes(run)]
    scenes = [(scene, entries) for scene, entries in scenes if entries]
    if not scenes:
        raise Skip("no scene was played with an effect and without it (bench/configs/effects.toml does)")
    height = sum(GAP + style.ROW * (1 + len(entries)) for _, entries in scenes) + 0.1
    left, panel, right, top, bottom = 2.0, 4.0, 3.1, 0.2, 0.6
    size = (left + panel + right, height + top + bottom)
    figure = style.plt.figure(figsize=size)
    ax = figure.add_axes((left / size[0], bottom / size[1], panel / size[0], height / size[1]))
    rows, marks, ends, y = [], [], [0.9, 1.2], 0.0
    for scene, entries in scenes:
        job = scene.job
        y += GAP + style.ROW / 2
        style.row_heading(ax, -left / panel + 0.02, y, f"{job}".replace(f" · {job.task}", ""), 8.5)
        y += style.ROW / 2
        for cost, look in entries:
            ratio = cost.ratio
            y += style.ROW / 2
            marks.append((ratio, y, look, cost.comparison.is_open, cost.comparison.floor))
            style.row_texts(ax, y, cost.what, f"{ratio.text}   {cost_text(cost.extra_ns)} a frame")
            ends += [ratio.lo, ratio.hi] if ratio.known else [ratio.mid]
            rows.append((job.scene, job.n, job.where.column, cost.what, cost.with_ns, cost.without_ns, ratio.mid, ratio.lo,
                         ratio.hi))
            y += style.ROW / 2
    style.draw_marks(ax, marks)
    style.ratio_axis(ax, min(ends), max(ends), "time of a frame with it / without it (right: it costs time)", room=0.04)
    ax.tick_params(axis="x", labeltop=height > style.TALL)
    ax.set_ylim(height, 0)
    return [Picture(NAME, figure, TITLE, f"Time of a frame with an effect over the time without it, for {len(rows)} effects of scenes.", COLUMNS, rows,
                    [footer(run)])]
