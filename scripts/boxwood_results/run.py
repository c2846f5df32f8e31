"""A result file as cells: what each contender took, in each round, for each phase of each job."""

import math
from dataclasses import dataclass, field
from statistics import median

from . import stats
from .kernels import KernelPoint
from .reader import load

NO_COUNT = 2**64 - 1  # a missing whole number
AA_TWIN, WRONG_ANSWER, DISTURBED = 4, 8, 1 | 2
RANKED = ("exact", "conservative", "within_bound")
STATUSES = ("wrong", "unsupported", "within_bound", "conservative", "exact")  # the worst first
OURS = "boxwood"
SCENE_ASKS = "scene_queries"  # frames of a moving scene with all that it tasks: ways to play it, not rivals
ORDERS_OF_RAYS = ("sorted_rays", "single_rays")  # other than one call in the order given
WHOLE_QUERY = "typical"  # a kernel row about a whole query, whose cell stays among the others
TOTAL = "build+query"  # within a round: what one use costs; of moving boxes update and query, of trees the build
TOTAL_WORDS = {"moving_pairs": "update and one query", "tree": "build", SCENE_ASKS: "update and queries of a frame"}
# Of these an update may have done the work of the query: its time alone says nothing.
WHOLE_FRAMES = ("moving_pairs", SCENE_ASKS)
# Under both of these a "build" only copies the input: no structure is made (ns per item; part of the query).
COPY_NS, COPY_PART = 8, 0.05


@dataclass(frozen=True)
class Job:
    """What was asked: contenders of one job can be compared."""

    scene: str
    n: int
    seed: int
    task: str
    threads: int

    def __str__(self):
        threads = "1 thread" if self.threads == 1 else f"{self.threads} threads"
        return f"{self.scene} {self.n:,} · {self.task} · {threads}"


@dataclass
class Stage:
    """One stage of a cell's plan: sums over the frames of one pass, times by round."""

    required: bool
    calls: int
    items: int
    bytes: int
    times: list = field(default_factory=list)

    @property
    def ns(self):
        return median(self.times)


@dataclass
class Cell:
    cell_id: int
    name: str
    job: Job
    contender: str
    library: str
    builder: str
    traversal: str
    kernel: str
    precision: str
    executor: str
    n_queries: int
    status: str = "unchecked"
    check: object = None
    times: dict = field(default_factory=dict)  # phase -> {shard_id: ns per iteration}
    twin: dict = field(default_factory=dict)  # the same of the A/A twin
    counters: dict = field(default_factory=dict)
    tree: object = None
    n_frames: int = 1
    scene_json: str = ""  # parameters of the scene
    frames: dict = field(default_factory=dict)  # number -> [(ns to update, ns to query)] of the rounds
    counted: dict = field(default_factory=dict)  # number -> (box tests, SAH); NaN where unknown
    stages: dict = field(default_factory=dict)  # name -> Stage, in the order of the plan

    @property
    def ours(self):
        return self.library == OURS

    @property
    def family(self):
        """What colour stands for: our builder or policy, how a scene is played, or the peer's library."""
        if self.job.task == SCENE_ASKS and self.ours:
            return self.contender
        return self.builder if self.ours and self.builder else self.library

    @property
    def label(self):
        """Short, for use within one job: a traversal that follows from the task is left out."""
        if not self.ours:
            return self.contender
        shown = self.traversal in ORDERS_OF_RAYS
        words = [word for word in self.contender.split(".") if word != "tree" and (shown or word != self.traversal)]
        text = ".".join(words) + (" f64" if self.precision == "f64" else "")
        return text if self.executor == "serial" else f"{text} {self.executor}"

    @property
    def ranked(self):
        return self.status in RANKED and bool(self.rounds(TOTAL))

    @property
    def has_build(self):
        build = self.median("build")
        return build > COPY_NS * self.job.n or build > COPY_PART * self.median("query")

    def rounds(self, phase):
        """{shard_id: ns}. A contender without a build phase takes 0 ns to build."""
        if phase != TOTAL:
            return self.times.get(phase, {})
        first = self.times.get("update" if "update" in self.times else "build")
        query = self.times.get("query")
        if first is None or query is None:
            return query or first or {}
        return {shard: first[shard] + query[shard] for shard in query if shard in first}

    def median(self, phase):
        times = self.rounds(phase)
        return median(times.values()) if times else math.nan if phase != "build" else 0.0

    def interval(self, phase):
        return stats.median_interval(self.rounds(phase).values())


@dataclass
class Run:
    """One result file, read. Kernels on hard cases are no cells: they are judged and drawn apart."""

    source: object  # reader.Tables
    cells: list
    jobs: list
    missing_samples: int
    kernels: list = field(default_factory=list)  # KernelPoint

    @property
    def name(self):
        return self.source.path.name

    def of(self, job):
        """Timed cells of a job."""
        return [cell for cell in self.cells if cell.job == job and cell.rounds(TOTAL)]

    @property
    def rounds(self):
        return len(self.source["shards"])

    @property
    def noise_floor(self):
        """Relative difference that the A/A cell shows between two timings of the same thing."""
        return stats.noise_floor(
            stats.paired_logs(cell.twin[phase], cell.times.get(phase, {}))
            for cell in (*self.cells, *(point.cell for point in self.kernels))
            for phase in cell.twin
        )


def worst(status, other):
    return min(status, other, key=STATUSES.index)


def read_cells(source):
    scenes = {row["scene_id"]: row for row in source["scenes"]}
    variants = {row["variant_id"]: row for row in source["variants"]}
    cells = {}
    for row in source["cells"]:
        scene, variant = scenes[row["scene_id"]], variants[row["variant_id"]]
        job = Job(
            scene["name"], int(row["n_items"]), int(scene["seed"]), row["task"],
            int(row["threads"]),
        )
        cells[row["cell_id"]] = Cell(
            int(row["cell_id"]), row["name"], job, variant["name"], variant["library"],
            variant["builder"], variant["traversal"], variant["kernel"], row["precision"], row["executor"],
            int(row["n_queries"]), n_frames=max(1, int(column(scene, "n_frames", 1))),
            scene_json=column(scene, "params_json", ""),
        )
    return cells


def column(row, name, default):
    """Of a column that the figures can do without."""
    return row[name] if name in row.dtype.names else default


def add_samples(cells, samples):
    missing = 0
    for row in samples:
        cell = cells[row["cell_id"]]
        if row["flags"] & WRONG_ANSWER:
            cell.status = "wrong"
        if not row["wall_ns"] >= 0 or (row["phase"] != "build" and row["wall_ns"] == 0):
            missing += 1
            continue
        phases = cell.twin if row["flags"] & AA_TWIN else cell.times
        phases.setdefault(row["phase"], {})[int(row["shard_id"])] = float(row["wall_ns"])
    return missing


def add_checks(cells, checks):
    for row in checks:
        cell = cells[row["cell_id"]]
        status = row["status"] if row["status"] in STATUSES else "wrong"
        if cell.status == "unchecked" or worst(status, cell.status) == status:
            cell.status, cell.check = status, row


def add_frames(cells, table):
    names = ("cell_id", "frame", "update_ns", "query_ns")
    for cell_id, frame, update, query in zip(*(table[name].tolist() for name in names)):
        if update + query >= 0:
            cells[cell_id].frames.setdefault(frame, []).append((update, query))
    if not {"box_tests", "sah"} <= set(table.dtype.names):  # before schema minor 4
        return
    for cell_id, frame, tests, sah in zip(*(table[name].tolist() for name in ("cell_id", "frame", "box_tests", "sah"))):
        if tests != NO_COUNT or sah == sah:
            cells[cell_id].counted[frame] = (math.nan if tests == NO_COUNT else float(tests), sah)


def add_stages(cells, table):
    for row in table:
        stages = cells[row["cell_id"]].stages
        stage = stages.setdefault(row["stage"], Stage(
            bool(row["required"]), int(row["calls"]), int(row["items"]), int(row["bytes"])))
        stage.times.append(float(row["total_ns"]))


def kernel_points(cells, source):
    """The kernels' rows with their times; their cells are taken out of `cells`."""
    conditions = {}
    for row in source["conditions"] if source["conditions"] is not None else ():
        conditions.setdefault(row["cell_id"], []).append(row)
    points = [
        KernelPoint(row, cells[row["cell_id"]], conditions.get(row["cell_id"], []))
        for row in (source["kernels"] if source["kernels"] is not None else ())
        if row["family"] != WHOLE_QUERY
    ]
    for point in points:
        cells.pop(point.cell.cell_id, None)
    return points


def read(path):
    """Loads a result file; raises reader.BadFile."""
    source = load(path)
    cells = read_cells(source)
    missing = add_samples(cells, source["samples"])
    add_checks(cells, source["checks"])
    for row in source["counters"] if source["counters"] is not None else ():
        cells[row["cell_id"]].counters[row["counter"]] = int(row["value"])
    for row in source["trees"] if source["trees"] is not None else ():
        cells[row["cell_id"]].tree = row
    if source["frames"] is not None:
        add_frames(cells, source["frames"])
    if source["effects"] is not None:
        add_stages(cells, source["effects"])
    kernels = kernel_points(cells, source)
    ordered = list(cells.values())
    jobs = sorted(
        {cell.job for cell in ordered if cell.rounds(TOTAL)},
        key=lambda job: (job.task, job.scene, job.n, job.threads, job.seed),
    )
    return Run(source, ordered, jobs, missing, kernels)
