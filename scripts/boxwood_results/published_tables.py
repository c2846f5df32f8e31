"""The tables of a published run: run -> [header, row, ...] of texts."""

from dataclasses import dataclass

from .figures import forest
from .findings import PEERS
from .moving import played_scenes
from .run import Where
from boxwood.results.words import count_text, ratio_text, time_text

ONE = Where("", 1)
OPEN = " ?"  # behind a ratio that the file calls open


def time_of(row):
    """The time of ours in a comparison, as the file has it."""
    return time_text(row.b.median(row.phase))


def ratio_of(row):
    return row.text + (OPEN if row.verdict == "cannot_tell" else "")


COLD = "cold_build+query"


def cold(run):
    """{(job, class): {library: its comparison}} of first builds, by the fastest of ours and of each library."""
    found = {}
    for row in sorted(run.family(PEERS, COLD), key=lambda row: row.b.median(COLD)):
        if row.verdict != "wrong":
            ours, rows = found.setdefault((row.b.job, row.contender_class), (row.b, []))
            rows += [row] if row.b is ours else []
    return {key: forest.fastest(rows) for key, (_, rows) in found.items()}


@dataclass(frozen=True)
class Question:
    """One question on one thread, and the fastest variant of each library against ours."""

    text: str
    group: str  # what it shares with the same question on other scenes
    measured: str
    known: dict  # library -> comparison

    @property
    def closest(self):
        """The comparison with the fastest peer of all."""
        return next(iter(sorted(self.known.values(), key=lambda row: row.gain.mid)))


def questions(run, tasks):
    found = [block for block in forest.blocks(run) if block.job.task in tasks and block.job.where == ONE]
    cold_builds, races = cold(run), forest.races(run)
    asked = []
    for block in found:
        task = run.tasks[block.job.task]
        group = ", ".join(filter(None, (task.title, block.contender_class)))
        asked.append(Question(block.finding.question, group, task.total_title, block.fastest(0)))
        asked.append(Question(block.finding.question, group, "query alone", block.fastest(1)))
        asked += [Question(race.finding.question, group, "first build and query, fresh process",
                           cold_builds.get((race.job, race.contender_class), {}))
                  for race in races if race.kind == block.kind and race.job.n >= block.job.n]
    return [question for question in asked + kernel_questions(run, tasks) if question.known]


def kernel_questions(run, tasks):
    """Of kernels alone, family by family: the fastest of ours and of each library that is right."""
    kernels = {point.cell.cell_id for point in run.kernels}
    of_job = {}
    for row in run.family(PEERS, "query"):
        job = row.b.job
        if row.b.cell_id in kernels and row.verdict != "wrong" and job.task in tasks and job.where == ONE:
            of_job.setdefault(job, []).append(row)
    asked = []
    for job, rows in of_job.items():
        ours = min((row.b for row in rows), key=lambda cell: cell.median("query"))
        title = run.tasks[job.task].title
        asked.append(Question(f"{title}, {job.scene.replace('_', ' ')}", title, f"{job.n:,} calls",
                              forest.fastest(row for row in rows if row.b is ours)))
    return asked


def against_peers(*tasks):
    """Of each question the ratio to the fastest variant of each library, with its interval."""

    def table(run):
        asked = questions(run, tasks)
        peers = sorted((row.a for question in asked for row in question.known.values()), key=lambda cell: cell.place)
        libraries = {cell.library: cell.library_title for cell in peers}
        rows = [["question, one thread", "measured", "ours", *libraries.values()]]
        for question in asked:
            first = next(iter(question.known.values()))
            rows.append([question.text, question.measured, f"{first.b.label} {time_of(first)}",
                         *(ratio_of(question.known[library]) if library in question.known else "" for library in libraries)])
        return rows

    return table


SUMMARY = ["one thread, against the fastest peer", "measured", "questions", "won, lost, open", "least", "middle", "most"]


def summary(run, tasks):
    """A line for each kind of question: how many are won, and by how much."""
    groups = {}
    for question in questions(run, tasks):
        groups.setdefault((question.group, question.measured), []).append(question.closest)
    lines = []
    for (group, measured), rows in groups.items():
        ordered = sorted(rows, key=lambda row: row.gain.mid)
        counts = [len([row for row in rows if row.verdict in verdicts]) for verdicts in (("faster",), ("slower",), ("same", "cannot_tell"))]
        lines.append([group, measured, str(len(rows)), ", ".join(map(str, counts)),
                      *(f"{ratio_text(row.gain.mid)}x" for row in (ordered[0], ordered[(len(ordered) - 1) // 2], ordered[-1]))])
    return lines


def floors(run, tasks):
    """The noise floors of what a table shows, the least first."""
    return sorted({row.floor for question in questions(run, tasks) for row in question.known.values() if row.floor == row.floor})


def against_ourselves(run):
    """All stages over the required ones: ours against ours."""
    rows = [["scene", "bodies", "required, a frame", "all stages / required"]]
    for scene in played_scenes(run):
        if scene.all_stages_cost:
            rows.append([scene.job.scene, f"{scene.job.n:,}", time_text(scene.all_stages_cost.without_ns),
                         scene.all_stages_cost.ratio.text])
    return rows


def kernels_of(task):
    def table(run):
        rows = [["input", "kernel", "library", "promise", "a call", "wrong per million"]]
        for kernel in run.kernel_costs:
            if kernel.task == task:
                rate = f"0 (of {count_text(kernel.n)})" if not kernel.wrong else f"{kernel.per_million:,.0f}"
                rows.append([kernel.panel, kernel.name, kernel.library, kernel.promise, time_text(kernel.ns), rate])
        return rows

    return table


def markdown(rows):
    lines = ["| " + " | ".join(text.replace("|", "/") for text in row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + " --- |" * len(rows[0]), *lines[1:]])
