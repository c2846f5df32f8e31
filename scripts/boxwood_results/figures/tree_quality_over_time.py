"""How structures degrade: the query of each frame against one by a structure rebuilt for the frame, and counted."""

from .. import labels, style
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import Where
from ..selection import choose, largest_jobs, left_out_note, wrong_notes
from boxwood.results.words import ratio_text

NAME = "tree_quality_over_time"
TITLE = "How trees degrade"
HOW_TO_READ = (
    "Lower is better. Each line is the query of each frame by one way to keep the structure, over the query of the same "
    "frame by our structure that is rebuilt for every frame (where there is none, over its own first frame). A "
    "structure that degrades climbs. A policy that always answers from the pairs that it found before is left out; one "
    "that chooses to stands below 1 there. Where it was counted, a second picture holds what does not depend on the "
    "machine: the tests of boxes that the query of each frame made, per item, and those that a random ray "
    "would make by the surface-area heuristic."
)
COLUMNS = ("scene", "n", "threads", "contender", "library", "status", "frame", "query_ns", "over_a_fresh_one")
COUNTED_COLUMNS = ("scene", "n", "threads", "contender", "library", "status", "frame", "box_tests_per_item", "sah")
MEASURES = ((7, METRICS["box_tests"].axis.replace("box or ray", "item")), (8, METRICS["sah"].axis))  # column, axis
MIN_FRAMES = 10
MAX_SCENES = 8  # of these the pictures show; the CSV files hold all


def ratio_rows(job, cell):
    return [(job.scene, job.n, job.where.column, cell.label, cell.library, cell.status, int(row["frame"]), float(row["query_ns"]),
             float(row["over_fresh"])) for row in cell.frames]


def degradation(panel):
    """Of the way that degrades most."""
    _, cells, *_ = panel
    return max(float(cell.frame_stats["degradation"]) for cell in cells)


def draw_panel(ax, job, cells, fresh):
    ends, all_ratios = [], [1.0]
    for cell in cells:
        frames, ratios = zip(*[(row[6], row[8]) for row in ratio_rows(job, cell)])
        if cell is not fresh:
            style_of = {**style.point_style(cell, 4), "markevery": max(1, len(frames) // 10)}
            ax.plot(frames, ratios, **style_of, linewidth=1.3)
            ends.append((frames[-1], ratios[-1], f"{cell.label}  {ratio_text(ratios[-1])}x", style.text_colour(cell)))
            all_ratios += ratios
    ax.axhline(1, color="#555555", linewidth=1, zorder=1)
    last = max(int(cell.frames[-1]["frame"]) for cell in cells)
    ends.append((last, 1.0, "rebuilt: 1" if fresh else "its first frame: 1", "#555555"))
    style.log_axis(ax.yaxis, min(all_ratios), max(all_ratios), lambda value: f"{value:g}x")
    ax.set_xlim(0, last)
    ax.xaxis.set_major_locator(style.MaxNLocator(6, integer=True))
    style.title(ax, f"{job.scene} {job.n:,} · {job.where}")
    ax.set_xlabel("frame")
    ax.set_ylabel("query over one of a fresh tree")
    return ends


def counted_rows(job, cell):
    return [(job.scene, job.n, job.where.column, cell.label, cell.library, cell.status, int(row["frame"]),
             float(row["box_tests_per_item"]), float(row["sah"])) for row in counted_frames(cell)]


def counted_frames(cell):
    return [row for row in cell.frames if any(row[name] == row[name] for name in ("box_tests_per_item", "sah"))]


def markers_of(number, count):
    """Which of the points of a line bear a marker: others than of the next, as lines may coincide."""
    step = max(1, count // 8)
    return (number % min(step, count), step)


def draw_counted_panel(ax, job, cells, column, axis):
    """Gives the labels of the lines' ends. What is zero, as where cached pairs answered, has no place on the axis."""
    ends, shown = [], []
    for number, cell in enumerate(cells):
        points = [(row[6], row[column]) for row in counted_rows(job, cell) if row[column] > 0]
        if not points:
            continue
        style_of = {**style.point_style(cell, 4), "markevery": markers_of(number, len(points))}
        ax.plot(*zip(*points), **style_of, linewidth=1.3)
        value = points[-1][1]
        ends.append((*points[-1], f"{cell.label}  {value:,.0f}" if value >= 1000 else f"{cell.label}  {value:.3g}",
                     style.text_colour(cell)))
        shown += [value for _, value in points]
    style.count_axis(ax.yaxis, min(shown, default=1), max(shown, default=1))
    ax.set_xlim(0, max(int(counted_frames(cell)[-1]["frame"]) for cell in cells))
    ax.xaxis.set_major_locator(style.MaxNLocator(6, integer=True))
    style.title(ax, f"{job.scene} {job.n:,}")
    ax.set_xlabel("frame")
    ax.set_ylabel(axis)
    return ends


def counted(panels):
    panels = [(job, [cell for cell in cells if counted_frames(cell)]) for job, cells, *_ in panels]
    return [(job, cells) for job, cells in panels if cells]


def draw_counted(drawn, all_panels, notes):
    """The second picture, of the cells that were counted; none if nothing was."""
    panels = counted(drawn)
    if not panels:
        return []
    figure, axes = style.panels(2 * len(panels), width=4.3, labels_right=2.1)
    for place, ax in enumerate(axes):
        job, cells = panels[place // 2]
        labels.at_line_ends(ax, draw_counted_panel(ax, job, cells, *MEASURES[place % 2]))
    rows = [row for job, cells in counted(all_panels) for cell in cells for row in counted_rows(job, cell)]
    alt = f"Box tests per item of the query of each frame, and of a random ray, in {len(panels)} scenes."
    return [Picture(f"{NAME}_counted", figure, "How trees degrade, counted", alt, COUNTED_COLUMNS, rows, notes)]


def draw(run):
    panels = []
    for job in largest_jobs(run.jobs):
        cells = [c for c in run.of(job) if len(c.frames) >= MIN_FRAMES and not c.answers_from_cache]
        if not any(c.stages_played for c in cells) and len(cells) >= 2 and job.where == Where("", 1):
            fresh = next((c for c in cells if c.cell_id == cells[0].frame_stats["fresh_cell"]), None)
            shown, left_out = choose(cells, keep=[fresh] if fresh else (), limit=9)
            panels.append((job, shown, fresh, left_out_note(left_out, f"ways to play {job}") + wrong_notes(cells)))
    if not panels:
        raise Skip(f"no scene of {MIN_FRAMES} or more frames was played in two ways")
    telling = sorted(panels, key=degradation, reverse=True)[:MAX_SCENES]
    drawn = [panel for panel in panels if panel in telling]
    figure, axes = style.panels(len(drawn), width=4.3, labels_right=2.5)
    rows = [row for job, cells, *_ in panels for cell in cells for row in ratio_rows(job, cell)]
    cut = []
    if len(drawn) < len(panels):
        cut = [f"Of {len(panels)} scenes the {len(drawn)} on which one of the ways degrades most; "
               "the CSV file holds all."]
    notes = list(cut)
    for ax, (job, cells, fresh, said) in zip(axes, drawn):
        labels.at_line_ends(ax, draw_panel(ax, job, cells, fresh))
        notes += said
    return [Picture(NAME, figure, TITLE, f"Query of each frame over that of a fresh tree, in {len(drawn)} scenes.", COLUMNS, rows, notes),
            *draw_counted(drawn, panels, cut)]
