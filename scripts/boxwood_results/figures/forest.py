"""Every peer's time over ours, with intervals, and the band in which nothing is claimed."""

import math

from .. import stats, style
from ..findings import VERDICT_WORDS, findings, floor_text, ratio_text, rounds_text
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import TOTAL, TOTAL_WORDS, WHOLE_FRAMES
from ..selection import largest_jobs, wrong_notes

NAME = "forest"
TITLE = "Against the peers"
HOW_TO_READ = (
    "Each mark is a peer's time divided by the time of our best variant, paired within rounds: right of "
    "the line Boxwood is faster, left of it the peer. Bars are intervals of at least 95 %. The "
    "shaded band is the A/A noise floor, within which nothing is claimed; marks without a verdict are pale."
)
COLUMNS = ("task", "lane", "scene", "n", "threads", "ours", "peer", "peer_library", "phase", "rounds", "ratio", "ratio_lo",
           "ratio_hi", "verdict")
TALL = 8  # inches from which the axis is told at the top, too
ROW, GAP, OURS = 0.23, 0.34, 0.17  # inches; the last: a line for our variant below a long heading


def draw_marks(ax, comparisons, heights, floor):
    if not math.isnan(floor):
        ax.axvspan(1 / (1 + floor), 1 + floor, color="#DDDDDD", zorder=0)
    ax.axvline(1, color="#555555", linewidth=1, zorder=1)
    for comparison, height in zip(comparisons, heights):
        if comparison is None:
            continue
        ratio, peer = comparison.ratio, comparison.peer
        strength = 0.45 if comparison.verdict == stats.CANNOT_TELL else 1.0
        colour, marker = style.look(peer.family)
        if ratio.known:
            ax.plot([ratio.lo, ratio.hi], [height, height], color=colour, linewidth=1.8, alpha=strength, zorder=3)
        ax.plot([ratio.mid], [height], marker=marker, markersize=6.5, color=colour, alpha=strength,
                markeredgecolor="white", markeredgewidth=0.6, zorder=4)


def said_of(verdict):
    words = VERDICT_WORDS[verdict]
    return f"Boxwood {words}" if verdict in (stats.FASTER, stats.SLOWER) else words


def ratio_axis(ax, comparisons):
    ends = [1.0]
    for comparison in filter(None, comparisons):
        ratio = comparison.ratio
        ends += [ratio.lo, ratio.hi] if ratio.known else [ratio.mid]
    # The same room on both sides of 1 would hide small ratios beside large ones; some is kept.
    style.log_axis(ax.xaxis, min(min(ends), 0.7), max(max(ends), 1.4), lambda v: f"{v:g}x", room=0.05)
    ax.set_xlabel(METRICS["ratio"].axis)
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)


def heading(finding, column):
    """(heading, a line below it) of a block; rays have long ones."""
    if column:
        ours = "" if finding.quickest is finding.ours else f"ours: {finding.quickest.label}"
        return ("", ours) if finding.lane else (ours, "")
    head, ours = f"{finding.job.scene} {finding.job.n:,}", f"ours: {finding.ours.label}"
    return (f"{head}, {finding.lane}", ours) if finding.lane else (f"{head}   {ours}", "")


def draw_one(run, task, threads, found, floor):
    """One picture: a block of rows per scene, a column for build + query and one for the query."""
    entries, y = [], 0.0
    for finding in found:
        y -= GAP
        entries.append((y, finding, None))
        y -= OURS if finding.lane else 0
        for peer in sorted(finding.peers, key=lambda p: -finding.against(p, TOTAL).ratio.mid):
            y -= ROW
            entries.append((y, finding, peer))
    height = -y + 0.12
    names, panel, texts, top, bottom = 2.5, 2.9, 2.35, 0.35, 0.8
    phases = (TOTAL,) if task in WHOLE_FRAMES else (TOTAL, "query")
    size = (names + len(phases) * (panel + texts), height + top + bottom)
    figure = style.plt.figure(figsize=size)
    rows = []
    for column, phase in enumerate(phases):
        left = names + column * (panel + texts)
        ax = figure.add_axes((left / size[0], bottom / size[1], panel / size[0], height / size[1]))
        comparisons = [finding.against(peer, phase) if peer else None for _, finding, peer in entries]
        draw_marks(ax, comparisons, [entry[0] for entry in entries], floor)
        ratio_axis(ax, comparisons)
        ax.tick_params(axis="x", labeltop=height > TALL)
        ax.set_ylim(y - 0.12, 0)
        ax.set_yticks([])
        ax.set_title(TOTAL_WORDS.get(task, "build and one query") if phase == TOTAL else "query alone", fontsize=10,
                     weight="bold")
        for (at, finding, peer), comparison in zip(entries, comparisons):
            if peer is None:
                head, ours = heading(finding, column)
                for text, down, size_of in ((head, 0, 8.5), (ours, OURS, 7.5)):
                    if text:
                        ax.text(0.02 if column else -names / panel, at - down, text, weight="bold" if down == 0 else None,
                                transform=ax.get_yaxis_transform(), va="center", fontsize=size_of,
                                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})
                continue
            if column == 0:
                ax.text(-0.03, at, peer.label, transform=ax.get_yaxis_transform(), ha="right", va="center",
                        fontsize=8, color=style.text_colour(peer.family))
            if comparison is None:
                said = "the peer has no build" if not peer.has_build else "no build"
                ax.text(1.03, at, said, transform=ax.get_yaxis_transform(), va="center", fontsize=7.5,
                        color="#777777")
                continue
            said = f"{comparison.text}  {said_of(comparison.verdict)}"
            ax.text(1.03, at, said, transform=ax.get_yaxis_transform(), va="center", fontsize=7.5)
            rows.append((task, finding.lane, finding.job.scene, finding.job.n, threads, comparison.ours.label, peer.label,
                         peer.library, phase, comparison.ratio.n, comparison.ratio.mid, comparison.ratio.lo,
                         comparison.ratio.hi, comparison.verdict))
    said = "; ".join(
        f"{row[2]}, {row[6]}, {row[8]}: {ratio_text(row[10])} {VERDICT_WORDS[row[13]]}" for row in rows
    )
    figure.text(0.02 / size[0], 0.06 / size[1], f"{rounds_text(run)}. {floor_text(run)}.", fontsize=7.5, color="#666666")
    notes = [note for finding in found for note in wrong_notes(finding.wrong)]
    words = "1 thread" if threads == 1 else f"{threads} threads"
    return Picture(f"{NAME}_{task}_{threads}", figure, f"{TITLE}: {task}, {words}",
                   f"Peer's time over Boxwood's. {said}.", COLUMNS, rows, notes)


def draw(run):
    ranked = [f for f in findings(run) if f.comparisons and f.job.task != "tree"]  # builds alone: see tree_quality
    shown = set(largest_jobs(f.job for f in ranked))
    groups = {}
    for finding in ranked:
        if finding.job in shown:
            groups.setdefault((finding.job.task, finding.job.threads), []).append(finding)
    if not groups:
        raise Skip("no job has both a ranked variant of ours and a ranked peer")
    floor = run.noise_floor
    return [draw_one(run, task, threads, found, floor) for (task, threads), found in groups.items()]
