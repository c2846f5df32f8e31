"""What README.md shows of measured runs: one list of tables and pictures, each with the sweep that it stands on. A sweep is
a track, which is quoted by name and version: its scenes are frozen by their content in tracks.csv."""

import csv
import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

from . import picture, registry
from .figures import forest
from .findings import PEERS
from .moving import played_scenes
from .picture import cell_text
from boxwood.results.reader import BadFile
from .run import Where, read
from boxwood.results.words import count_text, ratio_text, time_text

ONE = Where("", 1)
MAX_BYTES = 2_000_000
BEGIN, END = "<!-- published: {} -->", "<!-- /published: {} -->"
MARKED = re.compile(r"<!-- published: (\w+) -->\n(.*?)<!-- /published: \1 -->", re.S)


@dataclass(frozen=True)
class Published:
    """A table of README.md and where it comes from. Several may stand on one sweep."""

    name: str
    sweep: str  # results/published/SWEEP.h5, measured by bench/configs/SWEEP.toml as it is shipped
    title: str
    table: object  # run -> [header, row, ...] of texts
    picture: tuple = ()  # (figure, picture's name, file below scripts/pictures)

    @property
    def config(self):
        return f"bench/configs/{self.sweep}.toml"

    def file(self, root):
        return root / "results" / "published" / f"{self.sweep}.h5"


def time_of(row):
    """The time of ours in a comparison, as the file has it."""
    return time_text(row.b.median(row.phase))


COLD = "cold_build+query"


def cold(run):
    """{(job, class): {library: its comparison}} of first builds, by the fastest of ours and of each library."""
    found = {}
    for row in sorted(run.family(PEERS, COLD), key=lambda row: row.b.median(COLD)):
        if row.verdict != "wrong":
            ours, rows = found.setdefault((row.b.job, row.contender_class), (row.b, []))
            rows += [row] if row.b is ours else []
    return {key: forest.fastest(rows) for key, (_, rows) in found.items()}


def against_peers(*tasks):
    """Of each question the ratio to the fastest variant of each library, with its interval."""

    def table(run):
        found = [block for block in forest.blocks(run) if block.job.task in tasks and block.job.where == ONE]
        cold_builds, races = cold(run), forest.races(run)
        libraries = dict(sorted(((library, cell) for block in found for library, cell in block.libraries.items()),
                                key=lambda item: item[1].place))
        rows = [["question, one thread", "measured", "ours", *(cell.library_title for cell in libraries.values())]]

        def add(question, words, known):
            if known:
                first = next(iter(known.values()))
                rows.append([question, words, f"{first.b.label} {time_of(first)}",
                             *(known[library].text if library in known else "" for library in libraries)])

        for block in found:
            add(block.finding.question, run.tasks[block.job.task].total_title, block.fastest(0))
            add(block.finding.question, "query alone", block.fastest(1))
            for race in races:
                if race.kind == block.kind and race.job.n >= block.job.n:
                    add(race.finding.question, "first build and query, fresh process",
                        cold_builds.get((race.job, race.contender_class)))
        return rows

    return table


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


ALL = (
    Published("pairs", "pairs", "Overlapping pairs: a peer's time over ours", against_peers("pairs"),
              ("forest", "forest_pairs_1", "pairs.png")),
    Published("rays", "rays", "Rays: a peer's time over ours", against_peers("rays_closest", "rays_any", "rays_all")),
    Published("queries", "queries", "Points, regions and nearest items: a peer's time over ours",
              against_peers("points", "regions", "nearest", "closest_points")),
    Published("moving", "dynamic", "Moving boxes, update and query of a frame: a peer's time over ours",
              against_peers("moving_pairs")),
    Published("effects", "effects", "All stages over the required ones, ours against ourselves", against_ourselves),
    Published("accuracy", "accuracy", "Triangle against triangle: what a call costs and how often it is wrong",
              kernels_of("triangle_triangle"), ("accuracy", "accuracy_triangle_triangle", "accuracy_triangles.png")),
)
BY_NAME = {one.name: one for one in ALL}


def scenes_of(run):
    """A hash of the scenes of a file: names, sizes, seeds and content."""
    lines = sorted(f"{row['name']} {row['n_items']} {row['seed']} {int(row['content_hash']):016x}" for row in run.source["scenes"])
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def tracks(root):
    """{sweep: (version, hash of its scenes)}, as they were frozen."""
    path = root / "results" / "published" / "tracks.csv"
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        return {row["track"]: (int(row["version"]), row["scenes"]) for row in csv.DictReader(file)}


def freeze(root):
    """Raises the version of each track whose scenes are others than they were; gives the names."""
    known, raised = tracks(root), []
    for sweep in sorted({one.sweep for one in ALL}):
        file = root / "results" / "published" / f"{sweep}.h5"
        if file.exists():
            version, frozen = known.get(sweep, (0, ""))
            scenes = scenes_of(read(file))
            if scenes != frozen:
                known[sweep] = (version + 1, scenes)
                raised.append(f"{sweep}-{version + 1}")
    with (root / "results" / "published" / "tracks.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("track", "version", "scenes"))
        writer.writerows((sweep, *entry) for sweep, entry in sorted(known.items()))
    return raised


def command_of(one):
    return f"scripts/reproduce {one.name}"


def source_of(one, run, version):
    """Which run it was, of which track, how right it was, and how to make it again."""
    env = run.source["env"][0]
    return (f"*Track {one.sweep}-{version}, {run.health['correctness'].split(' (')[0].rstrip('.')}. Run {cell_text(run.source.attrs['run_uuid'])[:8]} of {cell_text(run.source.attrs['created_utc'])[:10]}: "
            f"[`{one.config}`]({one.config}), {run.rounds} rounds, {env['cpu']}, {env['ncpu']} cores, commit "
            f"{env['git_commit'][:8]}, noise floor {ratio_text(100 * run.noise_floor)} %; "
            f"[`{one.sweep}.h5`](results/published/{one.sweep}.h5). Again: `{command_of(one)}`.*")


def markdown(rows):
    lines = ["| " + " | ".join(text.replace("|", "/") for text in row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + " --- |" * len(rows[0]), *lines[1:]])


def block(one, root):
    """What stands between the markers of a table."""
    if not one.file(root).exists():
        return f"*{one.title}: not published yet. `{command_of(one)}` measures it.*\n"
    run = read(one.file(root))
    rows = one.table(run)
    if len(rows) == 1:
        raise BadFile(one.file(root), f"it holds nothing for the table '{one.name}' of README.md; is it too noisy?")
    version, _ = tracks(root).get(one.sweep, (0, ""))
    shown = f"![{one.title}](scripts/pictures/{one.picture[2]})\n\n" if one.picture else ""
    return f"**{one.title}**\n\n{shown}{markdown(rows)}\n\n{source_of(one, run, version)}\n"


def rewritten(text, root):
    """README.md with every table as the files have it. An unknown name is an error."""
    def of(match):
        if match[1] not in BY_NAME:
            raise KeyError(f"README.md has the marker '{match[1]}', which published.py does not")
        return f"{BEGIN.format(match[1])}\n{block(BY_NAME[match[1]], root)}{END.format(match[1])}"

    return MARKED.sub(of, text)


def draw(one, root, folder):
    """Writes the picture of a table, stamped with the run; gives its path."""
    run = read(one.file(root))
    figure, name, file = one.picture
    made = next((made for made in registry.draw(figure, run).pictures if made.name == name), None)
    if made is None:
        raise BadFile(one.file(root), f"it does not hold the picture {name}")
    return picture.save_png(made, folder / file, cell_text(run.source.attrs["run_uuid"]))


def problems(root):
    """What does not fit together, as lines of text; none if all does."""
    found, machines, commits = [], set(), set()
    frozen_tracks = tracks(root)
    for sweep in sorted({one.sweep for one in ALL}):
        file = root / "results" / "published" / f"{sweep}.h5"
        version, frozen = frozen_tracks.get(sweep, (0, ""))
        if not file.exists():
            if version:
                one = next(one for one in ALL if one.sweep == sweep)
                found.append(f"{file}: track {sweep}-{version} is frozen in tracks.csv, and its file is not there; "
                             f"`{command_of(one)} --publish` measures it")
            continue
        run = read(file)
        machines |= {(row["host"], row["cpu"]) for row in run.source["env"]}
        commits |= {row["git_commit"] for row in run.source["env"]}
        if file.stat().st_size > MAX_BYTES:
            found.append(f"{file}: {file.stat().st_size:,} bytes; at most {MAX_BYTES:,}")
        if any(row["git_dirty"] for row in run.source["env"]):
            found.append(f"{file}: measured with changes that are in no commit")
        if scenes_of(run) != frozen:
            found.append(f"{file}: its scenes are not those of track {sweep}-{version}; scripts/published --freeze raises the version")
        if run.noise_floor != run.noise_floor:
            found.append(f"{file}: too few rounds for a noise floor")
        if run.health["is_too_noisy"]:
            found.append(f"{file}: too noisy to be published")
        if run.source.texts.get("sweep_toml", "") != (root / "bench" / "configs" / f"{sweep}.toml").read_text():
            found.append(f"{file}: its sweep is not bench/configs/{sweep}.toml as it stands")
        for one in (one for one in ALL if one.sweep == sweep and one.picture):
            shown = root / "scripts" / "pictures" / one.picture[2]
            if not shown.exists() or picture.stamp_of(shown) != cell_text(run.source.attrs["run_uuid"]):
                found.append(f"{shown}: not drawn from {file}")
    for what, values in (("machine", machines), ("commit", commits)):
        if len(values) > 1:
            found.append(f"results/published: files of more than one {what}: {', '.join(map(str, sorted(values)))}")
    strays = {path.stem for path in (root / "results" / "published").glob("*.h5")} - {one.sweep for one in ALL}
    found += [f"results/published/{name}.h5: no table of README.md stands on it" for name in sorted(strays)]
    readme = root / "README.md"
    if rewritten(readme.read_text(encoding="utf-8"), root) != readme.read_text(encoding="utf-8"):
        found.append(f"{readme}: a table differs from its file; scripts/published rewrites it")
    return found


def write(root):
    """README.md and its pictures, from the files; gives what was written."""
    readme = Path(root) / "README.md"
    readme.write_text(rewritten(readme.read_text(encoding="utf-8"), root), encoding="utf-8")
    drawn = [draw(one, root, root / "scripts" / "pictures") for one in ALL if one.picture and one.file(root).exists()]
    return [readme, *drawn]
