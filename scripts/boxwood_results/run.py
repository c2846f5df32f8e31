"""A result file as cells: what each contender took, in each round, for each phase of each job."""

import json
import math
from dataclasses import dataclass, field

from .findings import read_comparisons, read_findings
from .kernels import KernelPoint, read_costs
from boxwood.results.reader import load

AA_TWIN, DISTURBED = 4, 1 | 2
WHOLE_QUERY = "typical"  # a kernel row about a whole query, whose cell stays among the others
REQUIRED, ALL_STAGES = "required", "all"  # ways to play a scene; any other is the effect left out
DEVICES = {"cuda": "a device, end to end", "cuda_resident": "a device, resident",
           "cuda_graph": "a device, by a graph"}  # executors
TOTAL = "total"  # stands for the phase of a task that says what one use costs


@dataclass(frozen=True)
class Task:
    """A row of /tasks."""

    title: str  # "nearest hit"
    total: str  # the phase that says what one use costs
    total_title: str  # "build and one query"

    @property
    def is_build(self):
        return self.total == "build"

    @property
    def in_frames(self):
        """An update may have done the work of the query: its time alone says nothing."""
        return self.total == "update+query"


@dataclass(frozen=True, order=True)
class Where:
    """By whom a job is done."""

    device: str  # an executor of DEVICES, or empty: by threads
    threads: int

    @property
    def column(self):
        """As the tables have it."""
        return self.device or self.threads

    def __str__(self):
        return DEVICES.get(self.device) or ("1 thread" if self.threads == 1 else f"{self.threads} threads")


@dataclass(frozen=True)
class Job:
    """What is done: contenders of one job can be compared."""

    scene: str
    n: int
    seed: int
    task: str
    where: Where

    def __str__(self):
        return f"{self.scene} {self.n:,} · {self.task} · {self.where}"


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
    status: str
    task: Task
    library_title: str
    is_peer: bool
    place: int  # of its builder, policy, way to play or library in its registry
    is_plain: bool  # else its builder or policy has settings, or an optimizer
    answers_from_cache: bool  # its query tells nothing of its structure
    keeps_structure: bool  # else its build only copies the input
    stages_played: str  # of ways to play a scene: required, all, or the effect left out
    label: str  # short, for use within one job
    relative_error: float = 0  # of a distance: how much of the answer it may be too far
    is_certified: bool = True  # of a distance; else it is as plain doubles measure it
    check: object = None
    medians: dict = field(default_factory=dict)  # phase -> row of /medians
    counters: dict = field(default_factory=dict)
    tree: object = None
    scene_json: str = ""  # parameters of the scene
    scene_title: str = ""  # the scene for readers
    frames: list = field(default_factory=list)  # rows of /frame_medians
    frame_stats: object = None
    stages: dict = field(default_factory=dict)  # name -> row of /stage_costs, in the order of the plan
    work: object = None
    query_kernel: object = None  # row of /query_kernels

    @property
    def ours(self):
        return not self.is_peer

    @property
    def family(self):
        """What colour stands for: our builder or policy, how a scene is played, or the peer's library."""
        if self.stages_played:
            return self.contender
        return self.builder if self.ours and self.builder else self.library

    @property
    def lacks_effect(self):
        """A scene played without one of its effects: another scene, drawn by itself."""
        return self.stages_played not in ("", REQUIRED, ALL_STAGES)

    def set_label(self, names_traversal, names_executor):
        """Whether to name what follows from most jobs."""
        words = [word for word in self.contender.split(".") if word != "tree" and (names_traversal or word != self.traversal)]
        text = ".".join(words) + (" f64" if self.precision == "f64" else "")
        self.label = f"{text} {self.executor}" if names_executor else text

    @property
    def times_fastest(self):
        """Its query over that of the fastest kernel under the same tree."""
        return float(self.query_kernel["times_fastest"])

    @property
    def timed(self):
        return bool(self.medians)

    @property
    def total(self):
        return self.task.total

    def has(self, phase):
        return (self.total if phase == TOTAL else phase) in self.medians

    def median(self, phase):
        row = self.medians.get(self.total if phase == TOTAL else phase)
        return math.nan if row is None else float(row["median_ns"])

    def spread(self, phase):
        """From the least of its rounds to the 95th percentile; None without times."""
        row = self.medians.get(phase)
        return None if row is None else (float(row["min_ns"]), float(row["p95_ns"]))


@dataclass
class Run:
    """One result file, read. Kernels on hard cases are no cells: they are judged and drawn apart."""

    source: object  # reader.Tables
    cells: list
    jobs: list
    missing_samples: int
    comparisons: list
    findings: list
    tasks: dict  # name -> Task
    peers: dict  # library -> a cell of it
    topics: list  # rows of /topics
    kernels: list = field(default_factory=list)  # KernelPoint
    kernel_costs: list = field(default_factory=list)  # kernels.Kernel

    @property
    def name(self):
        return self.source.path.name

    @property
    def changed(self):
        """A warning; empty if the file is as it was written."""
        return "" if self.source.is_sealed else (
            f"'{self.source.path}' was changed after it was written (its seal is gone): what it says need not be what was "
            "measured")

    def of(self, job):
        """Timed cells of a job."""
        return [cell for cell in self.cells if cell.job == job and cell.timed]

    @property
    def health(self):
        return self.source["health"][0]

    @property
    def rounds(self):
        return int(self.health["rounds"])

    @property
    def noise_floor(self):
        """Relative difference that the A/A cell shows between two timings of the same thing."""
        return float(self.health["floor"])

    def family(self, family, phase=None):
        """The comparisons of one family, of one phase if it is given."""
        return [c for c in self.comparisons if c.family == family and phase in (None, c.phase)]


def read_cells(source, tasks):
    scenes = {row["scene_id"]: row for row in source["scenes"]}
    variants = {row["variant_id"]: row for row in source["variants"]}
    cells = {}
    for row in source["cells"]:
        scene, variant = scenes[row["scene_id"]], variants[row["variant_id"]]
        job = Job(
            scene["name"], int(row["n_items"]), int(scene["seed"]), row["task"],
            Where(row["executor"] if row["executor"] in DEVICES else "", int(row["threads"])),
        )
        params = json.loads(column(variant, "params_json", "") or "{}")
        cells[row["cell_id"]] = Cell(
            int(row["cell_id"]), row["name"], job, variant["name"], variant["library"],
            variant["builder"], variant["traversal"], variant["kernel"], row["precision"], row["executor"],
            int(row["n_queries"]), row["status"], tasks[row["task"]], variant["library_title"],
            bool(variant["is_peer"]), int(variant["place"]), bool(variant["is_plain"]),
            bool(variant["answers_from_cache"]), bool(variant["keeps_structure"]), variant["stages"],
            label=variant["name"], relative_error=params.get("relative_error", 0), is_certified=bool(params.get("certified", 1)),
            scene_json=column(scene, "params_json", ""),
            scene_title=column(scene, "human_name", "") or scene["name"].replace("_", " "),
        )
    ours = {}
    for cell in cells.values():
        if cell.ours:
            ours.setdefault(cell.job, []).append(cell)
    for of_job in ours.values():
        traversals, executors = {cell.traversal for cell in of_job}, {cell.executor for cell in of_job}
        for cell in of_job:
            cell.set_label(len(traversals) > 1, len(executors) > 1)
    return cells


def column(row, name, default):
    """Of a column that the figures can do without."""
    return row[name] if name in row.dtype.names else default


def add_medians(cells, medians):
    for row in medians:
        cells[row["cell_id"]].medians[row["phase"]] = row


def add_checks(cells, checks):
    """Of several checks the one that explains the status."""
    for row in checks:
        cell = cells[row["cell_id"]]
        if cell.check is None or row["status"] == cell.status:
            cell.check = row


def add_frames(cells, source):
    for row in source["frame_medians"]:
        cells[row["cell_id"]].frames.append(row)
    for row in source["frame_stats"]:
        cells[row["cell_id"]].frame_stats = row
    for row in source["stage_costs"]:
        cells[row["cell_id"]].stages[row["stage"]] = row


def kernel_points(cells, source):
    """The kernels' rows; their cells are taken out of `cells`."""
    points = [KernelPoint(row, cells[row["cell_id"]]) for row in source["kernels"] if row["family"] != WHOLE_QUERY]
    for point in points:
        cells.pop(point.cell.cell_id, None)
    return points


def read(path):
    """Loads a result file; raises reader.BadFile."""
    source = load(path)
    tasks = {row["task"]: Task(row["title"], row["total"], row["total_title"]) for row in source["tasks"]}
    cells = read_cells(source, tasks)
    add_medians(cells, source["medians"])
    add_checks(cells, source["checks"])
    for row in source["counters"]:
        cells[row["cell_id"]].counters[row["counter"]] = int(row["value"])
    for row in source["trees"]:
        cells[row["cell_id"]].tree = row
    add_frames(cells, source)
    for row in source["work"]:
        cells[row["cell_id"]].work = row
    for row in source["query_kernels"]:
        cells[row["cell_id"]].query_kernel = row
    all_cells = dict(cells)
    peers = {cell.library: cell for cell in cells.values() if not cell.ours}
    kernels = kernel_points(cells, source)
    ordered = list(cells.values())
    jobs = sorted(
        {cell.job for cell in ordered if cell.timed},
        key=lambda job: (job.task, job.scene, job.n, job.where, job.seed),
    )
    missing = len([row for row in source["samples"] if not row["wall_ns"] >= 0])
    return Run(source, ordered, jobs, missing, read_comparisons(source["compare"], all_cells),
               read_findings(source["findings"], all_cells), tasks, peers, list(source["topics"]), kernels,
               read_costs(source["kernel_costs"], peers))
