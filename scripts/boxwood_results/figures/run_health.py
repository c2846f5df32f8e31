"""Did the machine hold still: each sample against its cell's median, by round and position."""

import math

import numpy as np
from matplotlib.colors import TwoSlopeNorm

from .. import style
from ..picture import Picture, Skip
from ..run import AA_TWIN, DISTURBED

NAME = "run_health"
TITLE = "Did the machine hold still"
HOW_TO_READ = (
    "Each square is one cell's query in one round, in the order it ran: white is within 2 % of its own median over "
    "the rounds, orange slower, purple faster. A stripe down or across means that the machine "
    "drifted. A dash marks a sample that was disturbed (time stolen, or the process switched out); it is "
    "kept and counted."
)
COLUMNS = ("round", "position", "cell", "percent_off_median", "disturbed")
LIMIT = 20  # percent at which the colours end


def draw(run):
    samples = [
        row for row in run.source["samples"]
        if row["phase"] == "query" and row["wall_ns"] > 0 and not row["flags"] & AA_TWIN
    ]
    shards = sorted({(int(row["round"]), int(row["shard_id"])) for row in samples})
    if len(shards) < 3:
        raise Skip("it takes at least 3 rounds to tell drift from chance")
    names = {cell.cell_id: cell.name for cell in (*run.cells, *(point.cell for point in run.kernels))}

    line = {shard: place for place, (_, shard) in enumerate(shards)}
    round_of = {shard: number for number, shard in shards}
    columns = sorted({int(row["position"]) for row in samples})
    place = {position: column for column, position in enumerate(columns)}
    off = np.full((len(shards), len(columns)), math.nan)
    dots, rows = [], []
    for row in samples:
        at = line[int(row["shard_id"])], place[int(row["position"])]
        off[at] = 100 * row["off_median"]
        disturbed = bool(row["flags"] & DISTURBED)
        if disturbed:
            dots.append(at)
        rows.append((int(row["round"]), int(row["position"]), names[int(row["cell_id"])], float(off[at]),
                     int(disturbed)))

    width = min(max(5.5, 0.09 * len(columns)), 11)
    height = min(max(1.8, 0.17 * len(shards)), 5)
    figure = style.plt.figure(figsize=(width + 2.0, height + 1.2))
    total = width + 2.0, height + 1.2
    ax = figure.add_axes((0.7 / total[0], 0.6 / total[1], width / total[0], height / total[1]))
    mesh = ax.imshow(off, aspect="auto", cmap=style.plt.get_cmap("PuOr_r", 11), norm=TwoSlopeNorm(0, -LIMIT, LIMIT), interpolation="none")
    if dots:
        reach = max(0.4, len(columns) / 500)
        ax.plot([x + side for _, x in dots for side in (-reach, reach, math.nan)], [y for y, _ in dots for _ in range(3)],
                color="black", linewidth=1.6, solid_capstyle="butt")
        ax.set_xlim(-0.5, len(columns) - 0.5)
    ax.grid(False)
    ax.set_yticks(range(len(shards)), [str(number) for number, _ in shards], fontsize=7)
    if len(shards) > 20:
        ax.set_yticks(ax.get_yticks()[::5])
    ax.set_xlabel("position in the round's shuffled order")
    ax.set_ylabel("round")
    ax.set_title(f"{len(rows):,} query samples, {len(dots):,} disturbed")
    side = figure.add_axes(((0.7 + width + 0.2) / total[0], 0.6 / total[1], 0.16 / total[0], height / total[1]))
    bar = figure.colorbar(mesh, cax=side, extend="both")
    bar.set_label("off the cell's median (%)")
    bar.outline.set_visible(False)

    worst = next(row for row in run.source["drift"] if row["is_farthest"])
    alt = f"How far each query sample is off its cell's median, {len(shards)} rounds by {len(columns)} positions."
    note = (
        f"The round furthest off is "
        f"{round_of[int(worst['shard_id'])]}, by {100 * worst['off_median']:+.1f} % at its median; {len(dots)} of {len(rows)} samples were disturbed."
    )
    return [Picture(NAME, figure, TITLE, alt, COLUMNS, rows, [note])]
