"""What the run says: our best variant of each job against every peer, with verdicts."""

from dataclasses import dataclass

from . import lanes, stats
from .run import SCENE_ASKS, TOTAL, WHOLE_FRAMES


@dataclass
class Comparison:
    """ratio: the peer's time over ours, so above 1 Boxwood is the faster; p of the sign test, adjusted
    within its family."""

    job: object
    ours: object
    peer: object
    phase: str
    ratio: stats.Interval
    p: float
    verdict: str = stats.CANNOT_TELL
    lane: str = lanes.EVERY

    @property
    def text(self):
        """One figure with its interval: '3.12x (2.98 to 3.20)'."""
        text = ratio_text(self.ratio.mid)
        if self.ratio.known:
            text += f" ({ratio_text(self.ratio.lo, '')} to {ratio_text(self.ratio.hi, '')})"
        return text


@dataclass
class Finding:
    job: object
    ours: object  # our ranked cell with the least build + query; None if there is none
    quickest: object  # our ranked cell with the least query, where that is asked alone
    comparisons: list
    wrong: list  # cells of the job that answered wrongly, ours or theirs; of its first lane
    unchecked: list
    lane: str = lanes.EVERY  # of rays: whom they are held against

    @property
    def title(self):
        return f"{self.job}{self.lane and ' · '}{self.lane}"

    def against(self, peer, phase):
        for comparison in self.comparisons:
            if comparison.peer is peer and comparison.phase == phase:
                return comparison
        return None

    @property
    def peers(self):
        return list({id(c.peer): c.peer for c in self.comparisons}.values())


def ratio_text(value, times="x"):
    digits = 0 if value >= 100 else 1 if value >= 10 else 2
    return f"{value:,.{digits}f}{times}"


def time_text(ns):
    """Three digits with the unit that suits: '12.3 ms'."""
    if ns != ns:
        return "-"
    for limit, unit, scale in ((1e3, "ns", 1), (1e6, "µs", 1e3), (1e9, "ms", 1e6)):
        if ns < limit * 0.9995:
            break
    else:
        unit, scale = "s", 1e9
    return f"{ns / scale:.3g} {unit}" if ns / scale < 999.5 else f"{ns / scale:,.0f} {unit}"


def compare(job, ours, peer, phase):
    theirs, our_times = peer.rounds(phase), ours.rounds(phase)
    logs = stats.paired_logs(theirs, our_times)
    if not logs:
        return None
    return Comparison(
        job, ours, peer, phase, stats.paired_ratio(theirs, our_times), stats.sign_test(logs)
    )


def judge(family, floor):
    """Corrects the p of a family of claims and gives each its verdict."""
    for claim, p in zip(family, stats.holm([c.p for c in family])):
        claim.p, claim.verdict = p, stats.verdict(claim.ratio, p, floor)


def findings(run):
    """One Finding per job and lane, in the order of run.jobs, with our best cell of each phase. The claims about it
    are one Holm family, as in `boxwood sweep`."""
    found, floor = [], run.noise_floor
    for job in run.jobs:
        if job.task == SCENE_ASKS:
            continue
        cells = run.of(job)
        wrong = [c for c in run.cells if c.job == job and c.status == "wrong"]  # timed or not
        unchecked = [c for c in cells if c.status == "unchecked"]
        for lane, ranked in lanes.split([cell for cell in cells if cell.ranked]).items():
            found.append(in_lane(job, lane, ranked, floor))
            found[-1].wrong, found[-1].unchecked = wrong, unchecked
            wrong, unchecked = [], []
    return found


def in_lane(job, lane, ranked, floor):
    best = {
        phase: min((c for c in ranked if c.ours and c.rounds(phase)), key=lambda c: c.median(phase), default=None)
        for phase in ((TOTAL,) if job.task in WHOLE_FRAMES else (TOTAL, "query"))
    }
    peers = sorted((c for c in ranked if not c.ours), key=lambda c: c.label)
    comparisons = []
    for phase, ours in best.items():
        family = [c for c in (compare(job, ours, peer, phase) for peer in peers) if c] if ours else []
        judge(family, floor)
        for claim in family:
            claim.lane = lane
        # Where one side has no build, its query holds all the work: only the sum is fair.
        comparisons += [c for c in family if phase == TOTAL or ours.has_build and c.peer.has_build]
    return Finding(job, best[TOTAL], best.get("query"), comparisons, [], [], lane)


def floor_text(run):
    floor = run.noise_floor
    if floor == floor:
        return f"A/A noise floor ±{100 * floor:.1f} %: no difference below it is claimed"
    if not any(cell.twin for cell in (*run.cells, *(p.cell for p in run.kernels))):
        return "A/A noise floor not known: no cell was timed twice, so no small difference is meaningful"
    return (
        f"A/A noise floor not known: it takes {stats.LEAST_FOR_INTERVAL} rounds, and this run has "
        f"{run.rounds}"
    )


def rounds_text(run):
    if run.rounds >= stats.LEAST_FOR_VERDICT:
        return f"{run.rounds} rounds; each ratio is the median of per-round ratios (interval of at least 95 %)"
    return (
        f"{run.rounds} round{'s' * (run.rounds != 1)}: too few for a verdict, which takes "
        f"{stats.LEAST_FOR_VERDICT}; ratios are shown for orientation"
    )


VERDICT_WORDS = {
    stats.FASTER: "faster",
    stats.SLOWER: "slower",
    stats.SAME: "the same",
    stats.CANNOT_TELL: "can't tell",
}


def phases_text(cell):
    """'build 1.2 ms, query 3 ms'."""
    return ", ".join(
        f"{phase} {time_text(cell.median(phase))}"
        for phase in ("build", "update", "query")
        if cell.rounds(phase)
    )


def sentence(finding):
    """A finding in words, for the report."""
    ours = finding.ours
    if ours is None:
        return f"{finding.title}: no ranked variant of ours."
    start = f"{finding.title}: {ours.label}: {phases_text(ours)}"
    totals = [c for c in finding.comparisons if c.phase == TOTAL]
    said = []
    for verdict, lead in (
        (stats.FASTER, "faster than"),
        (stats.SLOWER, "slower than"),
        (stats.SAME, "the same as"),
        (stats.CANNOT_TELL, "no verdict against"),
    ):
        peers = sorted((c for c in totals if c.verdict == verdict), key=lambda c: -c.ratio.mid)
        if peers:
            said.append(f"{lead} " + ", ".join(f"{c.peer.label} {c.text}" for c in peers))
    if not said:
        return f"{start}; no ranked peer."
    return f"{start}. Together: {'; '.join(said)}."


def comparison_rows(found):
    """Columns and rows of every comparison, for a table."""
    columns = ("job", "lane", "ours", "peer", "phase", "rounds", "ratio", "low", "high", "p adjusted", "verdict")
    rows = [
        (str(c.job), c.lane, c.ours.label, c.peer.label, c.phase, c.ratio.n, c.ratio.mid, c.ratio.lo, c.ratio.hi, c.p,
         c.verdict)
        for finding in found
        for c in finding.comparisons
    ]
    return columns, rows
