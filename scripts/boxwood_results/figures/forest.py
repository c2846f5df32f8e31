"""Every peer's time over ours, with intervals, and the band in which nothing is claimed."""

import re
from dataclasses import dataclass

from .. import style
from ..findings import PEERS, RACE, footer
from ..metrics import METRICS
from ..picture import Picture, Skip
from ..run import TOTAL
from ..selection import fullest, wrong_notes

NAME = "forest"
TITLE = "Against the peers"
HOW_TO_READ = (
    "Each mark is the time of a library, by its fastest variant, divided by the time of our best variant, paired within "
    "rounds: right of the line Boxwood is faster, left of it the peer. Bars are the intervals that decided. The shaded bands "
    "are the A/A noise floors of such timings, within which nothing is claimed; marks without a verdict are pale. The table "
    "names the variants."
)
COLUMNS = ("task", "class", "scene", "n", "threads", "ours", "peer", "peer_library", "phase", "rounds",
           "ratio", "ratio_lo", "ratio_hi", "verdict", "reason")
GAP = 0.36  # inches above a block
LETTER = 0.064  # of a text, about, in inches
NAMES, PANEL, TEXTS, TOP, BOTTOM = 0.95, 2.5, 2.35, 0.35, 0.6


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
    def contender_class(self):
        return self.finding.contender_class

    @property
    def kind(self):
        """What it shares with the same race at other sizes."""
        return self.job.task, self.job.scene, self.job.seed, self.job.where, self.contender_class

    def fastest(self, column):
        """{library: its comparison}, each by its fastest variant, in the order of the registry."""
        return fastest((self.alone if column else self.together).values())

    @property
    def libraries(self):
        """{library: one of its cells} of both columns."""
        rows = sorted([*self.together.values(), *self.alone.values()], key=lambda row: row.a.place)
        return {row.a.library: row.a for row in rows}

    @property
    def variants(self):
        """Ids of the peers' cells."""
        return self.together.keys() | self.alone.keys()

    def ours(self, column):
        finding = self.finding
        return (finding.ours_alone or finding.ours) if column else self.cell


def fastest(comparisons):
    """{library: its comparison}, each by its fastest variant, in the order of the registry."""
    best = {}
    for row in sorted(comparisons, key=lambda row: row.gain.mid):
        best.setdefault(row.a.library, row)
    return dict(sorted(best.items(), key=lambda item: item[1].a.place))


def blocks(run):
    """One for each race against peers, at the largest size of the fullest field; builds alone stand in tree_quality."""
    return sorted(fullest(races(run)), key=lambda b: (b.job.task, b.job.where, b.job.scene))


def races(run):
    """One for each race against peers, of every size."""
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
    return found


def said_of(comparison):
    words = comparison.verdict_text
    if comparison.verdict in ("faster", "slower"):
        words = f"{comparison.b.library_title} {words}"
    words = words if comparison.a.job == comparison.b.job else f"{words}, peer on {comparison.a.job.where}"
    return f"{comparison.text}  {words}"


def ratio_axis(ax, comparisons):
    ends = [1.0]
    for comparison in filter(None, comparisons):
        ratio = comparison.gain
        ends += [ratio.lo, ratio.hi] if ratio.known else [ratio.mid]
    # The same room on both sides of 1 would hide small ratios beside large ones; some is kept.
    style.ratio_axis(ax, min(min(ends), 0.7), max(max(ends), 1.4), METRICS["ratio"].axis, room=0.05)


def draw_column(ax, found, column, rows):
    """One measure of all blocks: a row per library."""
    entries, y = [], 0.0
    for block in found:
        y -= GAP
        ours = block.ours(column)
        style.row_heading(ax, -NAMES / PANEL, y, f"{block.job.scene} {block.job.n:,}   ours: {ours.label}", 8)
        known = block.fastest(column)
        for library, peer in block.libraries.items():
            y -= style.ROW
            comparison = known.get(library)
            entries.append((y, comparison))
            said = said_of(comparison) if comparison else (
                "no build" if peer.keeps_structure else "the peer has no build")
            style.row_texts(ax, y, peer.library_title, said, style.text_colour(peer), style.INK if comparison else "#777777")
            if comparison:
                gain = comparison.gain
                rows.append((block.job.task, block.finding.contender_class, block.job.scene, block.job.n, block.job.where.column,
                             comparison.b.label, comparison.a.label, library, comparison.phase, comparison.rounds, gain.mid,
                             gain.lo, gain.hi, comparison.verdict, comparison.reason))
    style.draw_marks(ax, [(comparison.gain, height, style.look(comparison.a), comparison.is_open, comparison.floor)
                          for height, comparison in entries if comparison])
    ratio_axis(ax, [comparison for _, comparison in entries])
    ax.set_ylim(y - 0.12, 0)


def draw_one(run, task, contender_class, where, found):
    """One picture: a block of rows per scene, a panel for build + query and one for the query."""
    height = sum(GAP + style.ROW * len(block.libraries) for block in found) + 0.12
    known = run.tasks[task]
    titles = [known.total_title] if known.in_frames else [known.total_title, "query alone"]
    said = [said_of(comparison) for block in found for column in range(len(titles)) for comparison in block.fastest(column).values() if comparison]
    wide = NAMES + PANEL + max([TEXTS, *(LETTER * len(text) for text in said)])
    size = (wide * len(titles), height + TOP + BOTTOM)
    figure = style.plt.figure(figsize=size)
    rows = []
    for column, title in enumerate(titles):
        ax = figure.add_axes(((column * wide + NAMES) / size[0], BOTTOM / size[1], PANEL / size[0], height / size[1]))
        draw_column(ax, found, column, rows)
        ax.tick_params(axis="x", labeltop=height > style.TALL)
        ax.set_title(title, fontsize=10, weight="bold")
    jobs = {block.job for block in found}
    notes = [footer(run), *wrong_notes([cell for cell in run.cells if cell.job in jobs])]
    words = ", ".join(filter(None, (known.title, contender_class, str(where))))
    name = "_".join([NAME, task, str(where.column), *re.findall(r"\w+", contender_class)])
    return Picture(name, figure, f"{TITLE}: {words}",
                   f"Time of the peers over the time of Boxwood for {words}, in {len(rows)} comparisons.", COLUMNS, rows, notes)


def draw(run):
    groups = {}
    for block in blocks(run):
        groups.setdefault((block.job.task, block.finding.contender_class, block.job.where), []).append(block)
    if not groups:
        raise Skip("the run is too noisy for findings" if run.health["is_too_noisy"] else
                   "no job has both a ranked variant of ours and a ranked peer")
    return [draw_one(run, *group, found) for group, found in groups.items()]
