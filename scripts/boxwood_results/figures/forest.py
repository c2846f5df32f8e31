"""Every peer's time over ours, with intervals, and the band in which nothing is claimed."""

import math
from dataclasses import dataclass

from .. import style
from ..findings import PEERS, RACE, footer
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import TOTAL
from ..selection import largest_jobs, wrong_notes
from ..words import ratio_text

NAME = "forest"
TITLE = "Against the peers"
HOW_TO_READ = (
    "Each mark is a peer's time divided by the time of our best variant, paired within rounds: right of "
    "the line Boxwood is faster, left of it the peer. Bars are the intervals that decided. The "
    "shaded band is the A/A noise floor, within which nothing is claimed; marks without a verdict are pale."
)
COLUMNS = ("task", "class", "scene", "n", "threads", "ours", "peer", "peer_library", "phase", "rounds",
           "ratio", "ratio_lo", "ratio_hi", "verdict", "reason")
TALL = 8  # inches from which the axis stands at the top, too
ROW, GAP, OURS = 0.23, 0.34, 0.17  # inches; the last: a line for our variant below a long heading


@dataclass
class Block:
    """A finding of the file with the comparisons of our two cells against every peer."""

    finding: object
    together: dict  # peer's cell id -> Comparison
    alone: dict

    @property
    def cell(self):
        return self.finding.ours or self.finding.ours_alone

    @property
    def job(self):
        return self.cell.job

    @property
    def peers(self):
        rows = {**self.alone, **self.together}
        return [row.a for row in sorted(rows.values(), key=lambda row: -row.gain.mid)]

    def against(self, peer, column):
        return (self.alone if column else self.together).get(peer.cell_id)


def blocks(run):
    """One for each race against peers, the largest jobs alone; builds alone stand in tree_quality."""
    rows = {}
    for row in run.family(PEERS):
        if row.verdict != "wrong":
            rows.setdefault((row.b.cell_id, row.phase, row.contender_class), {})[row.a.cell_id] = row
    found = []
    for finding in run.findings:
        if finding.topic != RACE or run.tasks[finding.task].is_build or not (finding.rival or finding.rival_alone):
            continue
        sides = [rows.get((ours.cell_id, ours.total if phase == TOTAL else phase, finding.contender_class), {})
                 if ours else {} for ours, phase in ((finding.ours, TOTAL), (finding.ours_alone, "query"))]
        if any(sides):
            found.append(Block(finding, *sides))
    shown = set(largest_jobs(block.job for block in found))
    return sorted((b for b in found if b.job in shown), key=lambda b: (b.job.task, b.job.where, b.job.scene))


def draw_marks(ax, comparisons, heights, floor):
    if not math.isnan(floor):
        ax.axvspan(1 / (1 + floor), 1 + floor, color="#DDDDDD", zorder=0)
    ax.axvline(1, color="#555555", linewidth=1, zorder=1)
    for comparison, height in zip(comparisons, heights):
        if comparison is None:
            continue
        ratio, peer = comparison.gain, comparison.a
        strength = 0.45 if comparison.verdict == "cannot_tell" else 1.0
        colour, marker = style.look(peer)
        if ratio.known:
            ax.plot([ratio.lo, ratio.hi], [height, height], color=colour, linewidth=1.8, alpha=strength, zorder=3)
        ax.plot([ratio.mid], [height], marker=marker, markersize=6.5, color=colour, alpha=strength,
                markeredgecolor="white", markeredgewidth=0.6, zorder=4)


def said_of(comparison):
    words = comparison.verdict_text
    return f"{comparison.b.library_title} {words}" if comparison.verdict in ("faster", "slower") else words


def ratio_axis(ax, comparisons):
    ends = [1.0]
    for comparison in filter(None, comparisons):
        ratio = comparison.gain
        ends += [ratio.lo, ratio.hi] if ratio.known else [ratio.mid]
    # The same room on both sides of 1 would hide small ratios beside large ones; some is kept.
    style.log_axis(ax.xaxis, min(min(ends), 0.7), max(max(ends), 1.4), lambda v: f"{v:g}x", room=0.05)
    ax.set_xlabel(METRICS["ratio"].axis)
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)


def heading(block, column):
    """(heading, a line below it) of a block; rays have long ones."""
    finding = block.finding
    if column:
        alone = finding.ours_alone
        ours = f"ours: {alone.label}" if alone and alone is not finding.ours else ""
        return ("", ours) if finding.contender_class else (ours, "")
    head, ours = f"{block.job.scene} {block.job.n:,}", f"ours: {block.cell.label}"
    return (f"{head}, {finding.contender_class}", ours) if finding.contender_class else (f"{head}   {ours}", "")


def draw_one(run, task, where, found, floor):
    """One picture: a block of rows per scene, a column for build + query and one for the query."""
    entries, y = [], 0.0
    for block in found:
        y -= GAP
        entries.append((y, block, None))
        y -= OURS if block.finding.contender_class else 0
        for peer in block.peers:
            y -= ROW
            entries.append((y, block, peer))
    height = -y + 0.12
    names, panel, texts, top, bottom = 2.5, 2.9, 2.35, 0.35, 0.8
    known = run.tasks[task]
    phases = (TOTAL,) if known.in_frames else (TOTAL, "query")
    size = (names + len(phases) * (panel + texts), height + top + bottom)
    figure = style.plt.figure(figsize=size)
    rows = []
    for column, phase in enumerate(phases):
        left = names + column * (panel + texts)
        ax = figure.add_axes((left / size[0], bottom / size[1], panel / size[0], height / size[1]))
        comparisons = [block.against(peer, column) if peer else None for _, block, peer in entries]
        draw_marks(ax, comparisons, [entry[0] for entry in entries], floor)
        ratio_axis(ax, comparisons)
        ax.tick_params(axis="x", labeltop=height > TALL)
        ax.set_ylim(y - 0.12, 0)
        ax.set_yticks([])
        ax.set_title(known.total_title if phase == TOTAL else "query alone", fontsize=10,
                     weight="bold")
        for (at, block, peer), comparison in zip(entries, comparisons):
            if peer is None:
                head, ours = heading(block, column)
                for text, down, size_of in ((head, 0, 8.5), (ours, OURS, 7.5)):
                    if text:
                        ax.text(0.02 if column else -names / panel, at - down, text, weight="bold" if down == 0 else None,
                                transform=ax.get_yaxis_transform(), va="center", fontsize=size_of,
                                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})
                continue
            if column == 0:
                ax.text(-0.03, at, peer.label, transform=ax.get_yaxis_transform(), ha="right", va="center",
                        fontsize=8, color=style.text_colour(peer))
            if comparison is None:
                said = "the peer has no build" if not peer.keeps_structure else "no build"
                ax.text(1.03, at, said, transform=ax.get_yaxis_transform(), va="center", fontsize=7.5,
                        color="#777777")
                continue
            said = f"{comparison.text}  {said_of(comparison)}"
            ax.text(1.03, at, said, transform=ax.get_yaxis_transform(), va="center", fontsize=7.5)
            gain = comparison.gain
            rows.append((task, block.finding.contender_class, block.job.scene, block.job.n, where.column, comparison.b.label,
                         peer.label, peer.library, comparison.phase, comparison.rounds, gain.mid, gain.lo, gain.hi,
                         comparison.verdict, comparison.reason))
    said = "; ".join(
        f"{row[2]}, {row[6]}, {row[8]}: {ratio_text(row[10])}x {row[13].replace('_', ' ')}" for row in rows
    )
    figure.text(0.02 / size[0], 0.06 / size[1], footer(run), fontsize=7.5, color="#666666")
    jobs = {block.job for block in found}
    notes = wrong_notes([cell for cell in run.cells if cell.job in jobs])
    return Picture(f"{NAME}_{task}_{where.column}", figure, f"{TITLE}: {task}, {where}",
                   f"Peer's time over Boxwood's. {said}.", COLUMNS, rows, notes)


def draw(run):
    groups = {}
    for block in blocks(run):
        groups.setdefault((block.job.task, block.job.where), []).append(block)
    if not groups:
        raise Skip("the run is too noisy for findings" if run.health["is_too_noisy"] else
                   "no job has both a ranked variant of ours and a ranked peer")
    floor = run.noise_floor
    return [draw_one(run, task, where, found, floor) for (task, where), found in groups.items()]
