"""Build time against query time, with the number of queries at which the slower build pays off."""

import math

from .. import labels, style
from ..findings import time_text
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..selection import choose, front, largest_jobs, VERY_LONG, left_out_note, short_labels, wrong_notes

NAME = "builder_tradeoff"
TITLE = "What a build buys"
HOW_TO_READ = (
    "Lower left is better. The line joins the variants that none beats in both; the number on a "
    "piece is how many queries it takes until the slower build has paid for itself (no number: the "
    "first query does). A contender "
    "without a build of its own stands at the left edge: its query holds all the work. What the long names "
    "of ours have in common stands in the title."
)
COLUMNS = ("task", "scene", "n", "threads", "variant", "library", "status", "build_ns", "query_ns", "break_even_queries")


def break_even(cheap, dear):
    """Queries after which the dearer build has paid for itself."""
    return (dear.median("build") - cheap.median("build")) / (cheap.median("query") - dear.median("query"))


def draw_panel(ax, job, cells, rows):
    timed = [cell for cell in cells if not math.isnan(cell.median("query"))]
    best = front([cell for cell in timed if cell.ranked])
    shown, left_out = choose(timed, keep=best)
    builds = [cell.median("build") for cell in shown if cell.has_build]
    queries = [cell.median("query") for cell in shown]
    edge = min(builds) / 3 if len(builds) < len(shown) else min(builds)
    style.time_axis(ax.xaxis, edge, max(builds), room=0.12)
    style.time_axis(ax.yaxis, min(queries), max(queries), room=0.08)

    def at(cell):
        return (cell.median("build") if cell.has_build else edge), cell.median("query")

    if len(builds) < len(shown):
        ax.axvline(edge, color=style.FAINT, linewidth=5, alpha=0.35, zorder=0)
        ax.text(edge, 0.02, "no build", transform=ax.get_xaxis_transform(), fontsize=7, rotation=90, ha="center",
                va="bottom", color="#666666")
    line, stripe = [at(cell) for cell in best], [(edge, low) for low in ax.get_ylim()]
    ax.plot(*zip(*line), color=style.FAINT, linewidth=1.2, zorder=1)
    marks = []
    names, shared = short_labels(shown)
    for cell in shown:
        x, y = at(cell)
        ax.plot([x], [y], **{**style.point_style(cell, 7), "linestyle": ""}, zorder=5)
        if cell.status == "wrong":
            style.cross_out(ax, x, y)
        marks.append((x, y, names[id(cell)], style.text_colour(cell.family)))
    pays = {id(dear): break_even(cheap, dear) for cheap, dear in zip(best, best[1:])}
    joints = []
    for cheap, dear in zip(best, best[1:]):
        (x0, y0), (x1, y1) = at(cheap), at(dear)
        count = math.ceil(pays[id(dear)])
        if count > 1:
            joints.append((math.sqrt(x0 * x1), math.sqrt(y0 * y1), f"{count:,} queries", "#555555"))
    style.title(ax, f"{job} · ours: {shared}" if shared else str(job))
    ax.set_xlabel(METRICS["build"].axis)
    ax.set_ylabel(METRICS["query"].axis)
    for cell in shown:
        rows.append(
            (job.task, job.scene, job.n, job.threads, cell.label, cell.library, cell.status,
             cell.median("build"), cell.median("query"), pays.get(id(cell)))
        )
    labels.beside_points(ax, marks, later=joints, lines=[line, stripe] if len(builds) < len(shown) else [line])
    return left_out


def draw(run):
    by_ask = {}
    for job in largest_jobs(run.jobs):
        cells = run.of(job)
        cells = [cell for cell in cells if cell.rounds("query") and not cell.rounds("update")]
        if sum(cell.has_build for cell in cells) >= 2:
            by_ask.setdefault(job.task, []).append((job, cells))
    if not by_ask:
        raise Skip("it takes at least two variants with a build time on one job")
    pictures = []
    for task, jobs in by_ask.items():
        crowded = max(len(cell.label) for _, cells in jobs for cell in cells) > VERY_LONG
        figure, axes = style.panels(len(jobs), **style.pair_of_panels(crowded))
        rows, notes = [], []
        for ax, (job, cells) in zip(axes, jobs):
            left_out = draw_panel(ax, job, cells, rows)
            notes += left_out_note(left_out, f"variants of {job}") + wrong_notes(cells)
        alt = "; ".join(
            f"{job}: no variant beats "
            + ", ".join(
                f"{cell.label} (build {time_text(cell.median('build'))}, query {time_text(cell.median('query'))})"
                for cell in front([c for c in cells if c.ranked])
            )
            for job, cells in jobs
        )
        pictures.append(
            Picture(f"{NAME}_{task}", figure, f"{TITLE}: {task}",
                    f"Build time against query time. {alt}.", COLUMNS, rows, notes)
        )
    return pictures
