"""Kernels on hard cases: what each kernel costs and how often it is wrong."""

import math
from collections import defaultdict
from dataclasses import dataclass

PANELS = ("generic", "touching", "degenerate")
DISTANCES = ("triangle_distance", "segment_segment", "point_triangle", "point_segment")
LEAST_ERROR = 2.0**-53  # a relative error below half an ulp of a double is none


@dataclass
class KernelPoint:
    """One kernel, ours or a peer's, on one family of hard cases."""

    row: object
    cell: object
    conditions: list  # rows of the table `conditions`

    @property
    def task(self):
        return self.row["task"]

    @property
    def panel(self):
        return self.row["panel"]

    @property
    def cases(self):
        """The family with its parameters."""
        return self.cell.job.scene

    @property
    def kernel(self):
        """As a label; a peer that has one name in both precisions says which."""
        kernel, precision = self.row["kernel"], self.cell.precision
        return kernel if self.ours or precision == "f64" or precision in kernel else f"{kernel} {precision}"

    @property
    def ours(self):
        return self.cell.ours

    @property
    def library(self):
        return self.cell.library

    @property
    def supported(self):
        return self.row["status"] != "unsupported" and self.n > 0

    @property
    def n(self):
        return int(self.row["n"])

    @property
    def ns(self):
        """Per call: the sweep's median where there is one, else the check's own timing."""
        sweep = self.cell.median("query")
        return sweep / self.n if sweep == sweep and self.n else float(self.row["ns_per_call"])

    @property
    def wrong(self):
        return sum(int(self.row[name]) for name in ("false_pos", "false_neg", "bound_violations"))

    @property
    def error(self):
        return float(self.row["max_rel_err"])

    @property
    def breaks_promise(self):
        """Whether one of ours did what its kernel promises not to do."""
        row, promise = self.row, self.row["promise"]
        misses = promise in ("never-miss", "certified", "exact") and row["false_neg"]
        falsehoods = promise in ("never-false", "certified", "exact") and row["false_pos"]
        return self.ours and promise != "no promise" and bool(misses or falsehoods or row["bound_violations"])

    @property
    def tiers(self):
        return [int(self.row[f"tier_{k}"]) for k in range(4)]


@dataclass
class Kernel:
    """One kernel over all families of one panel."""

    name: str
    ours: bool
    library: str
    promise: str
    ns: float  # mean over the families
    n: int
    wrong: int
    maybe: int
    error: float  # the worst; NaN if it gives no numbers

    @property
    def per_million(self):
        return 1e6 * self.wrong / self.n


def kernels(points):
    """The kernels of some points of one kernel family, those of ours first, by rising time."""
    groups = defaultdict(list)
    for point in points:
        if point.supported and point.ns == point.ns:
            groups[point.ours, point.library, point.kernel].append(point)
    made = []
    for (ours, library, name), members in groups.items():
        errors = [p.error for p in members if p.error == p.error]
        made.append(
            Kernel(name, ours, library, members[0].row["promise"], sum(p.ns for p in members) / len(members),
                 sum(p.n for p in members), sum(p.wrong for p in members),
                 sum(int(p.row["maybe"]) for p in members), max(errors, default=math.nan))
        )
    return sorted(made, key=lambda r: (not r.ours, r.ns))


def by_kernel_family(run):
    groups = defaultdict(list)
    for point in run.kernels:
        groups[point.task].append(point)
    return dict(groups)


def is_measured(task):
    """Whether a kernel is judged by its error (distances), not by yes or no."""
    return task in DISTANCES


def take_home(run):
    """A sentence per kernel family and panel: the cheapest of our kernels without a wrong answer."""
    lines = []
    for task, points in by_kernel_family(run).items():
        for panel in PANELS:
            ours = [r for r in kernels([p for p in points if p.panel == panel]) if r.ours]
            if not ours:
                continue
            fastest = ours[0]
            right = [r for r in ours if r.wrong == 0 and r.maybe == 0]
            start = f"{task}, {panel} input: "
            if not right:
                lines.append(start + f"no kernel without a wrong answer; the fastest is {fastest.name}")
                continue
            best = right[0]
            lines.append(
                start + f"cheapest kernel with no wrong answer: {best.name}, {best.ns:,.{0 if best.ns >= 100 else 1}f} ns, at "
                f"{best.ns / fastest.ns:,.2f} times the fastest ({fastest.name})"
            )
    return lines
