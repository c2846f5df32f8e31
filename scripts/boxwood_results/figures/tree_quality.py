"""Builders alone: the time to build against the quality of the tree."""

import math

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..selection import largest_jobs, wrong_notes

NAME = "tree_quality"
TITLE = "How good a tree a build time buys"
HOW_TO_READ = (
    "Lower left is better: less time to build a binary tree, and a tree that costs less to traverse by the "
    "surface-area model. Thin lines reach from the least time of the rounds to their 95th percentile. The line joins the builders that none beats in both. A "
    "builder that splits items makes more leaves than items."
)
COLUMNS = ("scene", "n", "threads", "builder", "library", "status", "build_ns", "sah_cost")


def sah(cell):
    return float(cell.tree["sah_cost"]) if cell.tree is not None else math.nan


def draw_panel(ax, job, cells, rows):
    best = sorted((cell for cell in cells if cell.tree["on_front"]), key=lambda c: c.median("build"))
    builds, costs = [c.median("build") for c in cells], [sah(c) for c in cells]
    style.time_axis(ax.xaxis, min(builds), max(builds), room=0.12)
    style.count_axis(ax.yaxis, min(costs), max(costs), room=0.12)
    ax.plot([c.median("build") for c in best], [sah(c) for c in best], color=style.FAINT, linewidth=1.2, zorder=1)
    marks = []
    for cell in cells:
        x, y = cell.median("build"), sah(cell)
        ax.plot([x], [y], **{**style.point_style(cell, 7), "linestyle": ""}, zorder=5)
        style.whiskers(ax, cell, x, y, "build")
        if cell.status == "wrong":
            style.cross_out(ax, x, y)
        marks.append((x, y, cell.label, style.text_colour(cell)))
        rows.append((job.scene, job.n, job.where.column, cell.label, cell.library, cell.status, x, y))
    style.title(ax, str(job))
    ax.set_xlabel(METRICS["build"].axis)
    ax.set_ylabel(METRICS["sah_cost"].axis)
    labels.beside_points(ax, marks, lines=[[(c.median("build"), sah(c)) for c in best]])


def draw(run):
    jobs = []
    for job in largest_jobs(run.jobs):
        cells = [c for c in run.of(job) if c.task.is_build and c.has("build") and sah(c) > 0]
        if len(cells) >= 2:
            jobs.append((job, cells))
    if not jobs:
        raise Skip("no two builders were timed alone (the task build)")
    figure, axes = style.panels(len(jobs), width=5.4, height=3.9)
    rows, notes = [], []
    for ax, (job, cells) in zip(axes, jobs):
        draw_panel(ax, job, cells, rows)
        notes += wrong_notes(cells)
    return [Picture(NAME, figure, TITLE, f"Time to build against surface-area cost of {len(rows)} trees.", COLUMNS, rows,
                    notes)]
