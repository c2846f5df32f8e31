"""Build time against query time, with the number of queries at which the slower build pays off."""

import math

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..selection import choose, largest_jobs, VERY_LONG, left_out_note, short_labels, wrong_notes

NAME = "builder_tradeoff"
TITLE = "What a build buys"
HOW_TO_READ = (
    "Lower left is better; thin lines reach from the least time of the rounds to their 95th percentile. Lines join "
    "variants that none beats in both, where the noise does not decide; the number on one is how many queries it takes until "
    "the slower build has paid for itself (no number: the first query does). A contender "
    "without a build of its own stands at the left edge: its query holds all the work. What the long names "
    "of ours have in common stands in the title."
)
COLUMNS = ("task", "scene", "n", "threads", "variant", "library", "status", "build_ns", "query_ns", "break_even_queries")


def front(cells, run):
    """[(cell, queries after which it has paid for itself against the one before, or NaN)]: those that none beats in
    both build and query, by rising build time."""
    cells = {cell.cell_id: cell for cell in cells}
    return [(cells[row["cell_b"]], float(row["queries"])) for row in run.source["break_even"] if row["cell_b"] in cells]


def draw_panel(ax, job, cells, run, rows):
    timed = [cell for cell in cells if not math.isnan(cell.median("query"))]
    steps = front(timed, run)
    best = [cell for cell, _ in steps]
    shown, left_out = choose(timed, keep=best)
    builds = [cell.median("build") for cell in shown if cell.keeps_structure]
    queries = [cell.median("query") for cell in shown]
    edge = min(builds) / 3 if len(builds) < len(shown) else min(builds)
    style.time_axis(ax.xaxis, edge, max(builds), room=0.12)
    style.time_axis(ax.yaxis, min(queries), max(queries), room=0.08)

    def at(cell):
        return (cell.median("build") if cell.keeps_structure else edge), cell.median("query")

    if len(builds) < len(shown):
        ax.axvline(edge, color=style.FAINT, linewidth=5, alpha=0.35, zorder=0)
        ax.text(edge, 0.02, "no build", transform=ax.get_xaxis_transform(), fontsize=7, rotation=90, ha="center",
                va="bottom", color="#666666")
    stripe = [(edge, low) for low in ax.get_ylim()]
    marks = []
    names, shared = short_labels(shown)
    for cell in shown:
        x, y = at(cell)
        ax.plot([x], [y], **{**style.point_style(cell, 7), "linestyle": ""}, zorder=5)
        style.whiskers(ax, cell, x, y, "build" if cell.keeps_structure else None, "query")
        if cell.status == "wrong":
            style.cross_out(ax, x, y)
        marks.append((x, y, names[id(cell)], style.text_colour(cell)))
    pays = {id(cell): queries for cell, queries in steps if queries == queries}
    joints, lines = [], [stripe] if len(builds) < len(shown) else []
    for cheap, dear in zip(best, best[1:]):
        if id(dear) not in pays:  # the noise hides which is better
            continue
        lines.append([at(cheap), at(dear)])
        ax.plot(*zip(*lines[-1]), color=style.FAINT, linewidth=1.2, zorder=1)
        (x0, y0), (x1, y1) = lines[-1]
        count = math.ceil(pays[id(dear)])
        if count > 1:
            joints.append((math.sqrt(x0 * x1), math.sqrt(y0 * y1), f"{count:,} queries", "#555555"))
    style.title(ax, f"{job} · ours: {shared}" if shared else str(job))
    ax.set_xlabel(METRICS["build"].axis)
    ax.set_ylabel(METRICS["query"].axis)
    for cell in shown:
        rows.append(
            (job.task, job.scene, job.n, job.where.column, cell.label, cell.library, cell.status,
             cell.median("build"), cell.median("query"), pays.get(id(cell)))
        )
    labels.beside_points(ax, marks, later=joints, lines=lines)
    return left_out


def draw(run):
    by_task = {}
    for job in largest_jobs(run.jobs):
        cells = run.of(job)
        cells = [cell for cell in cells if cell.has("query") and not cell.has("update")]
        if len([cell for cell in cells if cell.keeps_structure]) >= 2:
            by_task.setdefault(job.task, []).append((job, cells))
    if not by_task:
        raise Skip("it takes at least two variants with a build time on one job")
    pictures = []
    for task, jobs in by_task.items():
        crowded = max(len(cell.label) for _, cells in jobs for cell in cells) > VERY_LONG
        figure, axes = style.panels(len(jobs), **style.pair_of_panels(crowded))
        rows, notes = [], []
        for ax, (job, cells) in zip(axes, jobs):
            left_out = draw_panel(ax, job, cells, run, rows)
            notes += left_out_note(left_out, f"variants of {job}") + wrong_notes(cells)
        pictures.append(
            Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}",
                    f"Time to build against time of a query of {len(rows)} variants of {task}.", COLUMNS, rows, notes)
        )
    return pictures
