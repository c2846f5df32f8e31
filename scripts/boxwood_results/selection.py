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


def fullest(races):
    """Of each kind the race with the most items among those with the most libraries and at least half of the variants: at a
    size that only some ran, the others would go unseen."""
    kinds = {}
    for race in races:
        kinds.setdefault(race.kind, []).append(race)
    return [fullest_of(alike) for alike in kinds.values()]


def fullest_of(races):
    libraries = max(len(race.libraries) for race in races)
    races = [race for race in races if len(race.libraries) == libraries]
    variants = max(len(race.variants) for race in races)
    by_size = {race.job.n: race for race in races if 2 * len(race.variants) >= variants}
    return by_size[max(by_size)]


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


def wrong_counts(cell):
    """In a few words."""
    check = cell.check
    if check is None or not (check["missing"] or check["extra"]):
        return "wrong"
    return f"wrong: {check['missing']:,} missing, {check['extra']:,} extra"


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
