"""Which cells a picture shows, so that it stays readable."""

from .run import TOTAL

MAX_LINES = 12


def largest_jobs(jobs):
    """Of each scene, task and number of threads or device, the job with the most items."""
    largest = {}
    for job in jobs:
        key = (job.task, job.scene, job.seed, job.where)
        if key not in largest or job.n > largest[key].n:
            largest[key] = job
    return list(largest.values())


def fullest(entries):
    """Of each scene, task, place and class the entry with the most items among those with the most libraries: at a size that
    only some libraries ran, the others would go unseen. An entry has a job, a contender_class and libraries."""
    best = {}
    for entry in entries:
        job = entry.job
        key = (job.task, job.scene, job.seed, job.where, entry.contender_class)
        if key not in best or rank(entry) > rank(best[key]):
            best[key] = entry
    return list(best.values())


def rank(entry):
    return len(entry.libraries), entry.job.n


def choose(cells, keep=(), limit=MAX_LINES):
    """At most `limit` of the cells of one job: those in `keep`, then the best of each family, then the
    best of the rest; wrong ones last. Returns them and how many were left out."""
    kept = {id(cell) for cell in keep}
    families = set()
    order = []
    for cell in sorted(cells, key=lambda c: (c.status == "wrong", c.median(TOTAL))):
        first = cell.family not in families
        families.add(cell.family)
        order.append((id(cell) not in kept, not first, len(order), cell))
    chosen = [cell for *_, cell in sorted(order, key=lambda item: item[:3])]
    return chosen[:limit], len(chosen) - len(chosen[:limit])


LONG, VERY_LONG = 24, 40  # letters of a label that crowds a panel; with which panels stand below each other


def short_labels(cells):
    """({cell id: label}, words): where labels are long, without the words that all of ours share."""
    full = {id(cell): cell.label for cell in cells}
    ours = [cell.label.split(".") for cell in cells if cell.ours]
    shared = [word for word in ours[0] if all(word in words for words in ours)] if len(ours) > 1 else []
    if max((len(cell.label) for cell in cells if cell.ours), default=0) <= LONG or any(set(words) <= set(shared) for words in ours):
        return full, ""
    for cell in cells:
        if cell.ours:
            full[id(cell)] = ".".join(word for word in cell.label.split(".") if word not in shared)
    return full, ".".join(shared)


def left_out_note(count, what="variants"):
    return [f"{count} further {what} are left out here; the table of all cells has them."] if count else []


def wrong_text(cell):
    """What was wrong with a cell's answers."""
    check = cell.check
    witness = check["witness"] if check is not None else ""
    if check is None or not (check["missing"] or check["extra"]):
        return witness or "its answer changed between rounds"
    counts = f"{check['missing']} missing, {check['extra']} extra"
    return f"{counts} ({witness})" if witness else counts


def wrong_notes(cells):
    """One sentence per cell that answered wrongly."""
    return [
        f"Not ranked: {cell.label} on {cell.job} answered wrongly: {wrong_text(cell)}."
        for cell in cells
        if cell.status == "wrong"
    ]
