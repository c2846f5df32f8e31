"""Counted work against time: does the cost model predict visits, and do visits predict time?"""

import math

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import Where
from ..selection import choose, largest_jobs, VERY_LONG, left_out_note, short_labels, wrong_notes

NAME = "work"
TITLE = "Work and time"
HOW_TO_READ = (
    "Lower left is better. Where the trees differ in their cost: the surface-area cost of each tree against "
    "the nodes that its queries visit; those at one place stand there once. Box tests against time: variants on "
    "one slanted line spend the same time per box test. Counts come from a separate pass and carry no noise. "
    "What the long names of ours have in common stands in the title."
)
MIN_PLACES = 4  # fewer show no relation
COLUMNS = ("task", "scene", "n", "variant", "status", "sah_cost", "node_visits_each", "box_tests_each",
           "query_ns_each")


def measures(cell):
    """(SAH cost, node visits, box tests, ns), the last three per item; NaN if missing."""
    sah = float(cell.tree["sah_cost"]) if cell.tree is not None else math.nan
    return sah, *(float(cell.work[name]) for name in ("node_visits", "box_tests", "query_ns"))


def places(points, names):
    """[(cell that stands there, x, y, label)]: points at one place are one."""
    at = {}
    for cell, x, y in points:
        at.setdefault((x, y), []).append(cell)
    found = []
    for (x, y), cells in at.items():
        words = [names[id(c)].split(".") for c in cells]
        shared = ".".join(word for word in words[0] if all(word in other for other in words))
        label = f"{len(cells)} of {shared or len(points)}" if len(cells) > 1 else names[id(cells[0])]
        found.append((next((c for c in cells if c.status != "wrong"), cells[0]), x, y, label))
    return found


def scatter(ax, job, points, x_name, y_name, time_on_y):
    """points: [(cell, x, y)]."""
    xs, ys = [x for _, x, _ in points], [y for *_, y in points]
    style.count_axis(ax.xaxis, min(xs), max(xs), room=0.12)
    (style.time_axis if time_on_y else style.count_axis)(ax.yaxis, min(ys), max(ys), room=0.12)
    names, shared = short_labels([cell for cell, *_ in points])
    standing = places(points, names)
    for cell, x, y, _ in standing:
        ax.plot([x], [y], **{**style.point_style(cell, 7), "linestyle": ""}, zorder=5)
        if cell.status == "wrong":
            style.cross_out(ax, x, y)
    style.title(ax, f"{job} · ours: {shared}" if shared else str(job))
    ax.set_xlabel(METRICS[x_name].axis)
    ax.set_ylabel(METRICS[y_name].axis)
    labels.beside_points(ax, [(x, y, label, style.text_colour(c)) for c, x, y, label in standing])


def draw(run):
    by_task = {}
    for job in largest_jobs(run.jobs):
        counted = [c for c in run.of(job) if c.work is not None and not math.isnan(c.work["box_tests"])]
        counted = list({(c.contender, c.precision): c for c in reversed(counted)}.values())[::-1]  # of any executor
        if job.where == Where("", 1) and len({measures(cell) for cell in counted}) >= MIN_PLACES and not run.tasks[job.task].in_frames:
            by_task.setdefault(job.task, []).append((job, counted))
    if not by_task:
        raise Skip(f"no job has {MIN_PLACES} variants that differ in their work")
    pictures = []
    for task, jobs in by_task.items():
        rows, notes, panels = [], [], []
        for job, counted in jobs:
            shown, left_out = choose(counted)
            values = [(cell, *measures(cell)) for cell in shown]
            with_tree = [(c, sah, visits) for c, sah, visits, _, _ in values if sah > 0 and visits > 0]
            if len({(sah, visits) for _, sah, visits in with_tree}) >= 2:
                panels.append((job, with_tree, "sah_cost", "node_visits", False))
            panels.append((job, [(c, tests, ns) for c, _, _, tests, ns in values], "box_tests", "query_each", True))
            rows += [(task, job.scene, job.n, c.label, c.status, *rest) for c, *rest in values]
            notes += [*left_out_note(left_out, f"variants of {job}"), *wrong_notes(counted)]
        crowded = max(len(cell.label) for _, points, *_ in panels for cell, *_ in points) > VERY_LONG
        figure, axes = style.panels(len(panels), **style.pair_of_panels(crowded))
        for ax, panel in zip(axes, panels):
            scatter(ax, *panel)
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}", f"Counted work against time of {len(rows)} variants of {task}.",
                                COLUMNS, rows, notes))
    return pictures
