"""The tables of a published run: run -> [header, row, ...] of texts."""

from dataclasses import dataclass, field
from math import isnan

from .figures import forest
from .findings import CALL, ERRORS, PEERS, Ratio
from .moving import played_scenes
from .run import Where
from .selection import wrong_counts
from boxwood.results.words import count_text, time_text

ONE, TWO = Where("", 1), Where("", 2)
OPEN = " ?"  # behind a ratio that the file calls open


def marked(text, comparison):
    return text + (OPEN if comparison.is_open else "")


def time_of(row):
    """The time of ours in a comparison, as the file has it."""
    return time_text(row.b.median(row.phase))


def ratio_of(row):
    """A peer that several threads slow down stands with what it took on one."""
    by_one = row.a.job.where == ONE and row.b.job.where != ONE
    return marked(row.text, row) + (" on 1 thread" if by_one else "")


COLD = "cold_build+query"


def cold(run):
    """{(job, class): comparisons} of first builds, of the fastest of ours."""
    found = {}
    for row in sorted(run.family(PEERS, COLD), key=lambda row: row.b.median(COLD)):
        if row.verdict != "wrong":
            ours, rows = found.setdefault((row.b.job, row.contender_class), (row.b, []))
            rows += [row] if row.b is ours else []
    return {key: tuple(rows) for key, (_, rows) in found.items()}


@dataclass(frozen=True)
class Question:
    """The best of ours against every peer."""

    text: str
    group: str  # what it shares with the same question on other scenes
    measured: str
    ours: str  # its name and time
    rows: tuple  # its comparisons
    unanswered: dict = field(default_factory=dict)  # library -> (one of its cells, why it has no comparison)

    @property
    def known(self):
        """{library: its comparison}, each by its fastest variant."""
        return forest.fastest(self.rows)

    @property
    def closest(self):
        """The comparison with the library that is lost to for sure, else with the fastest: one of `known`."""
        ordered = sorted(self.known.values(), key=lambda row: (row.verdict != "slower", row.gain.mid))
        return ordered[0]


def asked_of(text, group, measured, rows, wrong=()):
    rows = tuple(rows)
    answered = {row.a.library for row in rows}
    unanswered = {}
    for cell in sorted(wrong, key=lambda cell: cell.median("query")):
        if cell.library not in answered:
            in_time = f" (query {time_text(cell.median('query'))})" if cell.has("query") else ""
            unanswered.setdefault(cell.library, (cell, f"{wrong_counts(cell)}{in_time}"))
    return [Question(text, group, measured, f"{rows[0].b.label} {time_of(rows[0])}", rows, unanswered)] if rows else []


def questions(run, tasks):
    found = [block for block in forest.races(run) if block.job.task in tasks and block.job.where in (ONE, TWO)]
    classes = {row["cell_id"]: row["class"] for row in run.source["cells"]}
    cold_builds, asked = cold(run), []
    for block in sorted(found, key=lambda block: (block.job.task, block.job.where, block.job.scene, block.job.n)):
        task, finding = run.tasks[block.job.task], block.finding
        group = ", ".join(filter(None, (task.title, block.contender_class, "" if block.job.where == ONE else "2 threads")))
        wrong = [cell for cell in run.cells if cell.job == block.job and cell.is_peer and cell.status == "wrong"
                 and classes[cell.cell_id] == block.contender_class]
        asked += asked_of(finding.question, group, task.total_title, block.together.values(), wrong)
        asked += asked_of(finding.question, group, "query alone", block.alone.values(), wrong)
        asked += asked_of(finding.question, group, "first build and query, fresh process",
                          cold_builds.get((block.job, block.contender_class), ()))
    return asked + kernel_questions(run, tasks)


def kernel_questions(run, tasks):
    """Of kernels alone, family by family: ours that the file races, else our fastest that always answers rightly, against each
    variant of a library that does."""
    of_job, raced = {}, {row.ours.job: row.ours for row in run.findings if row.topic == CALL and row.ours}
    for point in run.kernels:
        if point.task in tasks and point.cell.job.where == ONE and point.supported:
            of_job.setdefault(point.cell.job, []).append(point)
    compared = {(row.a.cell_id, row.b.cell_id): row for row in run.family(PEERS, "query")}
    return [question for job, points in of_job.items() for question in kernel_question(run, points, raced.get(job), compared)]


def kernel_question(run, points, raced, compared):
    right = sorted((point for point in points if point.ours and not point.wrong and not point.maybe), key=lambda point: point.ns)
    if not right:
        return []
    best, rows, unanswered = raced or right[0].cell, [], {}
    for point in sorted(points, key=lambda point: point.ns):
        if point.ours:
            continue
        in_time = f" ({time_text(point.cell.median('query'))})"
        row = compared.get((point.cell.cell_id, best.cell_id))
        if point.cell.status == "wrong":
            unanswered.setdefault(point.library, (point.cell, f"wrong in {point.wrong:,} of {point.n:,}{in_time}"))
        elif point.maybe:
            unanswered.setdefault(point.library, (point.cell, f"no answer in {point.maybe:,} of {point.n:,}{in_time}"))
        elif row:
            rows.append(row)
    known = {row.a.library for row in rows}
    title = run.tasks[points[0].task].title
    return [Question(f"{title}, {best.scene_title}", title, "all the calls", f"{best.label} {time_text(best.median('query'))}",
                     tuple(rows), {library: why for library, why in unanswered.items() if library not in known})]


def against_peers(*tasks):
    """Of each question the ratio to the fastest variant of each library, with its interval."""

    def table(run):
        asked = questions(run, tasks)
        peers = [row.a for question in asked for row in question.rows]
        peers += [cell for question in asked for cell, _ in question.unanswered.values()]
        libraries = {cell.library: cell.library_title for cell in sorted(peers, key=lambda cell: cell.place)}
        rows = [["question, on one thread where no more are named", "measured", "ours", *libraries.values()]]
        for question in asked:
            texts = {library: why for library, (_, why) in question.unanswered.items()}
            texts |= {library: ratio_of(row) for library, row in question.known.items()}
            rows.append([question.text, question.measured, question.ours, *(texts.get(library, "") for library in libraries)])
        return rows

    return table


SUMMARY = ["against the fastest peer", "measured", "questions", "won, lost, same", "open: above 1, around it, below", "least (interval)", "middle", "most", "libraries"]
VERDICTS = ("faster", "slower", "same")


def summary(run, tasks):
    """A line for each kind of question: how many are won, and by how much."""
    groups = {}
    for question in questions(run, tasks):
        if question.rows:
            groups.setdefault((question.group, question.measured), []).append(question)
    lines = []
    for (group, measured), asked in groups.items():
        rows = [question.closest for question in asked]
        ordered = sorted(rows, key=lambda row: row.gain.mid)
        answering = {library for question in asked for library in question.known}
        # Where a library is struck out it may have been the fastest: neither the middle nor the most.
        fair = sorted((question.closest for question in asked if not answering & set(question.unanswered)), key=lambda row: row.gain.mid)
        peers = sorted([row.a for question in asked for row in question.known.values()], key=lambda cell: cell.place)
        counts = [len([row for row in rows if row.verdict == verdict]) for verdict in VERDICTS]
        unsure = [row for row in rows if row.verdict not in VERDICTS]
        above, below = [row for row in unsure if row.gain.lo > 1], [row for row in unsure if row.gain.hi < 1]
        leaning = [len(above), len([row for row in unsure if row not in above and row not in below]), len(below)]
        middle = ratio_of(fair[(len(fair) - 1) // 2]) if len(fair) > 2 else ""
        lines.append([group, measured, str(len(rows)), ", ".join(map(str, counts)), ", ".join(map(str, leaning)),
                      ratio_of(ordered[0]), middle, ratio_of(fair[-1]) if fair else "", ", ".join(dict.fromkeys(cell.library_title for cell in peers))])
    return lines


def floors(run, tasks):
    """{what is measured, on more threads than one so named: (least, greatest)} of the noise floors of what a table shows."""
    found = {}
    for question in questions(run, tasks):
        for row in question.known.values():
            if row.floor == row.floor:
                threads = row.b.job.where.threads
                found.setdefault(question.measured + (f" on {threads} threads" if threads > 1 else ""), []).append(row.floor)
    return {measured: (min(of), max(of)) for measured, of in found.items()}


def behind(run, tasks):
    """Which variant of each library the ratios stand on, and what it and ours were built for, in words."""
    variants = {}
    for question in questions(run, tasks):
        for library, row in question.known.items():
            variants.setdefault(library, {})[row.a.label.removeprefix(f"{library}.")] = row.a
    packages = {row["library"]: row for row in run.source["packages"]}
    texts = []
    for library, known in sorted(variants.items(), key=lambda item: min(cell.place for cell in item[1].values())):
        title, package = next(iter(known.values())).library_title, packages.get(library)
        built = f" {package['version']} ({package['build']})" if package is not None else ""
        texts.append(f"{title}{built} by {', '.join(known)}")
    return f"Behind the ratios: {'; '.join(texts)}. Ours for {run.source['env'][0]['isa_used']}." if texts else ""


def against_ourselves(run):
    """All stages over the required ones: ours against ours."""
    rows = [["scene", "bodies", "required, a frame", "all stages / required"]]
    for scene in played_scenes(run):
        if scene.all_stages_cost:
            rows.append([scene.job.scene, f"{scene.job.n:,}", time_text(scene.all_stages_cost.without_ns),
                         marked(scene.all_stages_cost.ratio.text, scene.all_stages_cost.comparison)])
    return rows


def kind_of_error(cell):
    """(relative error, whether it is not certified, both in words): the order of the columns."""
    text = f"{100 * cell.relative_error:g} %" if cell.relative_error else "nothing"
    return cell.relative_error, not cell.is_certified, text if cell.is_certified else f"{text}, not certified"


def by_error(run):
    """What an error that an answer may have saves, or bounds without a certificate, ours against ours: what accuracy costs."""
    rows_of = {}
    for row in run.family(ERRORS, "query"):
        if row.verdict == "wrong":
            continue
        rows_of.setdefault(row.a.cell_id, []).append(row)
    kinds = sorted({kind_of_error(row.b) for of in rows_of.values() for row in of})
    rows = [["the answer may be too far by", "ours", "nothing", *(f"{text}, of that" for *_, text in kinds)]]
    for of in rows_of.values():
        exact, shares = of[0].a, {kind_of_error(row.b): marked(row.ratio.text, row) for row in of}
        rows.append([f"{exact.task.title}, {exact.scene_title}", exact.contender.removesuffix(f".{exact.traversal}"),
                     time_text(exact.median("query")), *(shares.get(one, "") for one in kinds)])
    return rows


DEVICE_TIMES = {"cpu_2_ns": "2 threads", "cpu_all_ns": "all threads", "end_to_end_ns": "end to end", "device_ns": "of it the device",
                "limit_ns": "its limit", "resident_ns": "resident", "graph_ns": "resident, by a graph"}


def on_a_device(run):
    """Our best on a device beside our best on processors, size by size."""
    cells = {cell.cell_id: cell for cell in run.cells}
    rows = [["question", *DEVICE_TIMES.values(), "the fastest processors / end to end"]]
    for row in run.source["device_gains"]:
        cell = cells[row["cell_device"]]
        gain = Ratio(float(row["ratio"]), float(row["ci_lo"]), float(row["ci_hi"])).inverse()
        times = ["" if isnan(row[column]) else time_text(row[column]) for column in DEVICE_TIMES]
        rays = f"{cell.job.scene.rsplit('_', 1)[-1]} rays, " if row["task"].startswith("rays_") else ""
        rows.append([f"{run.tasks[row['task']].title}, {rays}{cell.scene_title}", *times,
                     f"{gain.text}{OPEN if row['verdict'] == 'cannot_tell' else ''}"])
    return rows


def kernels_of(task):
    def table(run):
        rows = [["input", "kernel", "library", "promise", "called", "a call", "wrong per million", "undecided"]]
        for kernel in run.kernel_costs:
            if kernel.task == task:
                rate = f"0 (of {count_text(kernel.n)})" if not kernel.wrong else f"{kernel.per_million:,.0f}"
                rows.append([kernel.panel, kernel.name, kernel.library, kernel.promise if kernel.ours else "",
                             "in batches" if kernel.name.endswith("_batch") else "one by one", time_text(kernel.ns), rate,
                             kernel.open_text])
        return rows

    return table


def markdown(rows):
    lines = ["| " + " | ".join(text.replace("|", "/") for text in row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + " --- |" * len(rows[0]), *lines[1:]])
