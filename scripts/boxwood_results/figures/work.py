"""Counted work against time: does the cost model predict visits, and do visits predict time?"""

import math

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import WHOLE_FRAMES
from ..selection import choose, largest_jobs, left_out_note, wrong_notes

NAME = "work"
TITLE = "Work and time"
HOW_TO_READ = (
    "Lower left is better. Left: the surface-area cost of each tree against the nodes that its queries "
    "visit. Right: box tests against time; variants on one slanted line spend the same time per box "
    "test. Counts come from a separate pass and carry no noise."
)
COLUMNS = ("ask", "scene", "n", "variant", "status", "sah_cost", "node_visits_each", "box_tests_each",
           "query_ns_each")


def measures(cell):
    """(SAH cost, node visits, box tests, ns), the last three per item asked about; NaN if missing."""
    each = max(cell.n_queries if 0 < cell.n_queries < 2**63 else cell.job.n, 1)
    sah = float(cell.tree["sah_cost"]) if cell.tree is not None else math.nan
    count = [cell.counters.get(name, 0) / each or math.nan for name in ("node_visits", "box_tests")]
    return sah, *count, cell.median("query") / each


def scatter(ax, job, points, x_name, y_name, time_on_y):
    """points: [(cell, x, y)]."""
    xs, ys = [x for _, x, _ in points], [y for *_, y in points]
    style.count_axis(ax.xaxis, min(xs), max(xs), room=0.12)
    (style.time_axis if time_on_y else style.count_axis)(ax.yaxis, min(ys), max(ys), room=0.12)
    for cell, x, y in points:
        ax.plot([x], [y], **{**style.point_style(cell, 7), "linestyle": ""}, zorder=5)
        if cell.status == "wrong":
            style.cross_out(ax, x, y)
    style.title(ax, str(job))
    ax.set_xlabel(METRICS[x_name].axis)
    ax.set_ylabel(METRICS[y_name].axis)
    labels.beside_points(ax, [(x, y, c.label, style.text_colour(c.family)) for c, x, y in points])


def draw(run):
    by_ask = {}
    for job in largest_jobs(run.jobs):
        counted = [c for c in run.of(job) if not math.isnan(measures(c)[2]) and c.executor == "serial"]
        if job.threads == 1 and len(counted) >= 2 and job.ask not in WHOLE_FRAMES:
            by_ask.setdefault(job.ask, []).append((job, counted))
    if not by_ask:
        raise Skip("no job has two variants with work counters")
    pictures = []
    for ask, jobs in by_ask.items():
        figure, axes = style.panels(2 * len(jobs))
        rows, notes = [], []
        for place, (job, counted) in enumerate(jobs):
            shown, left_out = choose(counted)
            values = [(cell, *measures(cell)) for cell in shown]
            with_tree = [(c, sah, visits) for c, sah, visits, _, _ in values if sah > 0 and visits > 0]
            if len(with_tree) >= 2:
                scatter(axes[2 * place], job, with_tree, "sah_cost", "node_visits", False)
            else:
                axes[2 * place].remove()
            scatter(axes[2 * place + 1], job, [(c, tests, ns) for c, _, _, tests, ns in values], "box_tests",
                    "query_each", True)
            rows += [(ask, job.scene, job.n, c.label, c.status, *rest) for c, *rest in values]
            notes += left_out_note(left_out, f"variants of {job}") + wrong_notes(counted)
        said = "; ".join(f"{row[3]} on {row[1]}: {row[7]:.3g} box tests and {row[8]:.3g} ns each" for row in rows)
        pictures.append(Picture(f"{NAME}_{ask}", figure, f"{TITLE}: {ask}", f"Work against time. {said}.",
                                COLUMNS, rows, notes))
    return pictures
