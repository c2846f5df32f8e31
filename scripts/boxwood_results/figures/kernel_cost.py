"""What accuracy costs where people pay for it: whole queries with each kernel under the same tree."""

from .. import style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..selection import largest_jobs, left_out_note
from boxwood.results.words import ratio_text, time_tick

NAME = "kernel_cost"
TITLE = "What a kernel costs in a whole query"
HOW_TO_READ = (
    "Shorter is better. Each bar is the time of one whole query with one kernel under the same tree; the number is its "
    "time over that of the fastest of its tree. A hollow bar answered wrongly: how many answers are missing or too many "
    "stands beside it."
)
COLUMNS = ("task", "scene", "n", "threads", "tree", "kernel", "status", "query_ns", "times_the_fastest", "missing", "extra")


TREES = 2  # drawn of each job, those with the quickest kernels


def drawn(jobs):
    """Of groups of (job, tree, cells) the quickest of each job, in their order."""
    places = {}
    for place, (job, _, cells) in sorted(enumerate(jobs), key=lambda item: item[1][2][0].median("query")):
        places.setdefault(job, []).append(place)
    return [jobs[place] for place in sorted(place for of_job in places.values() for place in of_job[:TREES])]


def groups(run):
    """Of each group of the file its cells, the fastest first."""
    found = {}
    for cell in run.cells:
        if cell.query_kernel is not None:
            found.setdefault(cell.query_kernel["group"], []).append(cell)
    return [sorted(cells, key=lambda cell: cell.times_fastest) for cells in found.values()]


def draw(run):
    by_task, shown = {}, largest_jobs(run.jobs)
    for cells in groups(run):
        job, tree = cells[0].job, cells[0].query_kernel["tree"]
        if job in shown:
            by_task.setdefault(job.task, []).append((job, tree, cells))
    if not by_task:
        raise Skip("no whole query was run with two kernels under the same tree")
    pictures = []
    for task, jobs in by_task.items():
        shown_jobs = drawn(jobs)
        most = max(len(cells) for *_, cells in shown_jobs)
        figure, axes = style.panels(len(shown_jobs), width=6.0, height=1.25 + 0.26 * most)
        rows = [(job.task, job.scene, job.n, job.where.column, tree, cell.kernel, cell.status, cell.median("query"),
                 cell.times_fastest, int(cell.check["missing"]) if cell.check is not None else None,
                 int(cell.check["extra"]) if cell.check is not None else None) for job, tree, cells in jobs for cell in cells]
        for ax, (job, tree, cells) in zip(axes, shown_jobs):
            for y, cell in enumerate(cells):
                time, wrong = cell.median("query"), cell.status == "wrong"
                colour = style.OUR_LOOK[0]
                ax.barh(y, time, height=0.7, color="white" if wrong else colour, edgecolor=colour, linewidth=1.2)
                lost = f"  {int(cell.check['missing']):,} missing, {int(cell.check['extra']):,} extra" if wrong else ""
                ax.text(time, y, f" {ratio_text(cell.times_fastest)}x{lost}", va="center", fontsize=7.5)
            ax.set_yticks(range(len(cells)), [cell.kernel for cell in cells], fontsize=7.5)
            ax.set_ylim(len(cells) - 0.4, -0.6)
            ax.set_xlim(0, 1.45 * max(cell.median("query") for cell in cells))
            ax.xaxis.set_major_formatter(lambda value, _: time_tick(value) if value else "0")
            ax.xaxis.set_major_locator(style.MaxNLocator(4))
            ax.grid(axis="y", visible=False)
            ax.set_title(f"{job}\n{tree}, {cells[0].executor}", fontsize=8.5)
            ax.set_xlabel(METRICS["query"].axis, fontsize=8)
            box = ax.get_position()
            ax.set_position([box.x0 + 0.28 * box.width, box.y0, 0.72 * box.width, box.height])
        pictures.append(Picture(f"{NAME}_{task}", figure, f"{TITLE}: {run.tasks[task].title}", f"Time of whole queries of {task} with {len(rows)} kernels under the same trees.", COLUMNS, rows,
                                left_out_note(len(jobs) - len(shown_jobs), "trees")))
    return pictures
