"""What is shown of measured runs: one list of tables and pictures, each with the sweep that it stands on. README.md has a
summary and the pictures, results/published/tables.md every row. A sweep is a track, which is quoted by name and version: its
scenes are frozen by their content in tracks.csv."""

import csv
import hashlib
import re
import subprocess
import tomllib
from dataclasses import dataclass
from pathlib import Path

from . import dropin_times, marks, picture, published_tables, python_times, recomputed, rederived, registry, verdicts
from .checkout import machine as machine_of
from .picture import cell_text
from .published_tables import against_ourselves, against_peers, kernels_of, markdown
from .run import read
from boxwood.results.reader import BadFile
from boxwood.results.words import ratio_text

MAX_BYTES = 2_000_000
BEGIN, END = "<!-- published: {} -->", "<!-- /published: {} -->"
MARKED = re.compile(r"<!-- published: (\w+) -->\n(.*?)<!-- /published: \1 -->", re.S)


@dataclass(frozen=True)
class Published:
    """A table and where it comes from. Several may stand on one sweep."""

    name: str
    sweep: str  # results/published/SWEEP.h5, measured by bench/configs/SWEEP.toml as it is shipped
    title: str
    table: object  # run -> [header, row, ...] of texts
    tasks: tuple = ()  # whose races against peers it holds
    picture: tuple = ()  # (figure, picture's name, file below scripts/pictures)
    noise_tasks: tuple = ()  # whose noise floors it shows, where it has no races
    on_device: bool = False  # measured where there is a GPU: on another machine, and for as many rounds as it is there

    @property
    def config(self):
        return f"bench/configs/{self.sweep}.toml"

    def file(self, root):
        return root / "results" / "published" / f"{self.sweep}.h5"


def races(name, sweep, title, tasks, picture=()):
    return Published(name, sweep, f"{title}: a peer's time over ours", against_peers(*tasks), tasks, picture)


ALL = (
    races("pairs", "pairs", "Overlapping pairs", ("pairs",), ("forest", "forest_pairs_1", "pairs.png")),
    races("rays", "rays", "Rays", ("rays_closest", "rays_any", "rays_all")),
    races("queries", "queries", "Points, regions and nearest items", ("points", "regions", "nearest", "closest_points")),
    races("narrow", "narrow", "Mesh against mesh",
          ("collide", "collide_all", "contacts", "distance", "tolerance", "continuous")),
    Published("errors", "narrow", "What accuracy costs: the distance of two meshes, query alone, all poses together",
              published_tables.by_error, noise_tasks=("distance",)),
    races("shapes", "shapes", "Convex shape against convex shape", ("shape_collide", "shape_distance", "signed_shape_distance")),
    races("robots", "robots", "Self-collision of robots, all states together", ("robot_self",)),
    races("moving", "dynamic", "Moving boxes, update and query of a frame", ("moving_pairs",)),
    Published("effects", "effects", "All stages over the required ones, ours against ourselves", against_ourselves),
    Published("accuracy", "accuracy", "Triangle against triangle: what a call costs and how often it is wrong",
              kernels_of("triangle_triangle"), (), ("accuracy", "accuracy_triangle_triangle", "accuracy_triangles.png")),
    Published("gpu", "gpu", "On a GPU, beside the processors of its machine", published_tables.on_a_device, (),
              ("device_gains", "device_gains_pairs", "gpu.png"), on_device=True),
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


def command_of(one, run=None):
    """What measures it: of a run what was left out, too, and whether it waited for a quiet machine."""
    if run is None:
        return f"scripts/reproduce {one.name}"
    argv = run.source.texts.get("argv", "") if one.on_device else ""
    options = [f"{option} '{value}'" for option in ("--wait", "--only") for value in re.findall(rf"{option} (\S+)", argv)]
    return " ".join([f"scripts/reproduce {one.name} -- --rounds {run.rounds}", *options])


def noise_of(one, run):
    """The noise floors of what a table shows, in words."""
    def percent(*floors):
        return " to ".join(dict.fromkeys(ratio_text(100 * floor) for floor in floors)) + " %"

    if one.on_device:
        return re.search(r"noise floor [^:]*?%|$", cell_text(run.health["trust"]))[0]
    floors = published_tables.floors(run, one.tasks or one.noise_tasks)
    if not floors:
        return f"noise floor {percent(run.noise_floor)}"
    return "noise floors: " + ", ".join(f"{measured} {percent(*of)}" for measured, of in floors.items())


def sweep_text(run):
    """The sweep file that made a run, as it was then."""
    return run.source.texts.get("sweep_toml", "")


def source_of(one, run, version, root, up):
    """Which run it was, of which track, how right it was, and how to make it again. up: from the page to the root."""
    env = run.source["env"][0]
    as_it_was = "" if sweep_text(run) == (root / one.config).read_text(encoding="utf-8") else " as it was then"
    device = cell_text(env["gpu"]) + ", " if one.on_device else ""
    return (f"*Track {one.sweep}-{version}, {run.health['correctness'].split(' (')[0].rstrip('.')}. Run {cell_text(run.source.attrs['run_uuid'])[:8]} of {cell_text(run.source.attrs['created_utc'])[:10]}: "
            f"[`{one.config}`]({up}{one.config}){as_it_was}, {run.rounds} rounds, {device}{env['cpu']}, {env['ncpu']} cores, commit "
            f"{env['git_commit'][:8]}, {noise_of(one, run)}; "
            f"[`{one.sweep}.h5`]({up}results/published/{one.sweep}.h5). Again: `{command_of(one, run)}`.*")


EMPTY_LINE = "\n\n"
PAGES = {"README.md": "", "results/published/tables.md": "../../"}  # and from there to the root


def not_published(one):
    return f"*{one.title}: not published yet. `{command_of(one)}` measures it.*\n"


def table_block(one, root, up):
    """What stands between the markers of a table: all its rows."""
    if not one.file(root).exists():
        return not_published(one)
    run = read(one.file(root))
    rows = one.table(run)
    if len(rows) == 1:
        raise BadFile(one.file(root), f"it holds nothing for the table '{one.name}'; is it too noisy?")
    version, _ = tracks(root).get(one.sweep, (0, ""))
    said = published_tables.behind(run, one.tasks)
    return f"**{one.title}**\n\n{markdown(rows)}\n\n{f'*{said}*{EMPTY_LINE}' if said else ''}{source_of(one, run, version, root, up)}\n"


def summary_block(root, up):
    """A line for each kind of question against peers."""
    rows, missing, commits = [], [], set()
    for one in ALL:
        if one.tasks and one.file(root).exists():
            run = read(one.file(root))
            rows += published_tables.summary(run, one.tasks)
            commits.add(run.source["env"][0]["git_commit"][:8])
        elif one.tasks:
            missing.append(not_published(one))
    table = [markdown([published_tables.SUMMARY, *rows]) + f"\n\n*Commit {', '.join(sorted(commits))}.*\n"] if rows else []
    return "\n".join(table + missing)


def picture_block(one, root, up):
    if not one.file(root).exists():
        return not_published(one)
    run = read(one.file(root))
    version, _ = tracks(root).get(one.sweep, (0, ""))
    return f"![{one.title}]({up}scripts/pictures/{one.picture[2]})\n\n{source_of(one, run, version, root, up)}\n"


PYTHON = Path("results") / "published" / "python.json"
PYTHON_COMMAND = f"scripts/python_bench --out {PYTHON}"
PYTHON_ROUNDS = 9  # at least


def beside_text(env):
    return "".join(f", {package} {version}" for package, version in env["versions"].items())


def python_block(root, up):
    """What a call from Python costs, and what others take: of scripts/python_bench, which no sweep holds."""
    if not (root / PYTHON).exists():
        return f"*The module `boxwood`: not published yet. `{PYTHON_COMMAND}` measures it.*\n"
    times = python_times.read(root / PYTHON)
    env = times.env
    return (f"{markdown(python_times.table(times))}\n\n*{env['created_utc'][:10]}, {len(times.rows[0].ours)} rounds, {env['cpu']}, {env['ncpu']} cores, "
            f"commit {env['git_commit'][:8]}{beside_text(env)}; [`{PYTHON.name}`]({up}{PYTHON}). Again: "
            f"`{PYTHON_COMMAND} --rounds {len(times.rows[0].ours)}`.*\n")


DROPIN = Path("results") / "published" / "dropin.json"
DROPIN_COMMAND = f"scripts/dropin_bench --out {DROPIN}"


def dropin_block(root, up, table=dropin_times.table):
    """What a program gains that has FCL's or Coal's manager: of scripts/dropin_bench, which no sweep holds."""
    if not (root / DROPIN).exists():
        return f"*FclBroadPhase: not published yet. `{DROPIN_COMMAND}` measures it.*\n"
    times = dropin_times.read(root / DROPIN)
    if len(table(times)) == 1:
        return f"*Not published yet. `{DROPIN_COMMAND}` measures it.*\n"
    env = times.env
    bodies, meshes = (" ".join(map(str, dict.fromkeys(run.bodies for run in times.runs if bool(run.triangles) == are_meshes)))
                      for are_meshes in (False, True))
    return (f"{markdown(table(times))}\n\n*{env['created_utc'][:10]}, {times.rounds} rounds in turns within one process, {env['cpu']}, {env['ncpu']} cores, "
            f"commit {env['git_commit'][:8]}{beside_text(env)}; [`{DROPIN.name}`]({up}{DROPIN}). Again: `{DROPIN_COMMAND} --rounds {times.rounds} --bodies {bodies} "
            f"--meshes {meshes}".rstrip() + "`.*\n")


def marks_block(root, up):
    """Each mark of the work on meshes beside what the files say, reached or not."""
    files = {one.sweep: one.file(root) for one in ALL if one.file(root).exists()}
    of = marks.read(root / marks.FILE)
    runs = {sweep: read(files[sweep]) for sweep in dict.fromkeys(mark.sweep for mark in of) if sweep in files}
    dropin = dropin_times.read(root / DROPIN) if (root / DROPIN).exists() else None
    return f"{markdown(marks.table(of, runs, dropin))}\n\n*Marks: [`{marks.FILE.name}`]({up}{marks.FILE}).*\n"


BLOCKS = {  # marker -> (root, up) -> text
    "summary": summary_block,
    "marks": marks_block,
    "python": python_block,
    "dropin": dropin_block,
    "worlds": lambda root, up: dropin_block(root, up, dropin_times.worlds_table),
    **{one.name: lambda root, up, one=one: table_block(one, root, up) for one in ALL},
    **{f"{one.name}_picture": lambda root, up, one=one: picture_block(one, root, up) for one in ALL if one.picture},
}


def rewritten(page, root):
    """A page with every block as the files have it. An unknown name is an error."""
    def of(match):
        if match[1] not in BLOCKS:
            raise KeyError(f"{page} has the marker '{match[1]}', which published.py does not")
        return f"{BEGIN.format(match[1])}\n{BLOCKS[match[1]](root, PAGES[page])}{END.format(match[1])}"

    return MARKED.sub(of, text_of(page, root))


def text_of(page, root):
    return (root / page).read_text(encoding="utf-8")


def draw(one, root, folder):
    """Writes the picture of a table, stamped with the run; gives its path."""
    run = read(one.file(root))
    figure, name, file = one.picture
    made = next((made for made in registry.draw(figure, run).pictures if made.name == name), None)
    if made is None:
        raise BadFile(one.file(root), f"it does not hold the picture {name}")
    return picture.save_png(made, folder / file, cell_text(run.source.attrs["run_uuid"]))


def faults(file, run, on_device=False):
    """Why a measured file is not fit to be published, as lines of text."""
    found = []
    if file.stat().st_size > MAX_BYTES:
        found.append(f"{file.stat().st_size:,} bytes; at most {MAX_BYTES:,}")
    if not run.source.is_sealed:
        found.append("changed after it was written (its seal is gone)")
    wrong = [*recomputed.differences(run.source), *rederived.differences(file, run.source)]
    if wrong:
        found.append(f"{len(wrong)} of its numbers do not follow from its samples; the first: {wrong[0]}")
    if len({(*machine_of(row), row["gpu"], row["git_commit"]) for row in run.source["env"]}) > 1:
        found.append("of more than one machine or commit")
    if on_device and not cell_text(run.source["env"][0]["gpu"]):
        found.append("measured without a GPU")
    if any(row["git_dirty"] for row in run.source["env"]):
        found.append("measured with changes that are in no commit")
    if any("(peers -O" in cell_text(row["flags"]) for row in run.source["env"]):
        found.append("measured against peers that were hardly optimised, as preset ci compiles them")
    if run.noise_floor != run.noise_floor:
        found.append("too few rounds for a noise floor")
    if run.health["is_too_noisy"]:
        found.append("too noisy to be published")
    if run.health["wrong_ours"] or run.health["broken_promises"]:
        found.append(f"ours is wrong: {cell_text(run.health['correctness'])}")
    if not sweep_text(run):
        found.append("it does not hold the sweep that made it")
    sweep = tomllib.loads(sweep_text(run))
    wanted = max(sweep.get("rounds", 0), verdicts.MIN_ROUNDS_OF_VERDICT)
    if run.rounds < wanted and not on_device:
        found.append(f"{run.rounds} rounds; {wanted} are wanted, by its sweep or for a verdict")
    inputs = sweep.get("inputs", 1)
    if inputs > 1 and run.rounds < verdicts.MIN_ROUNDS_OF_INPUT * inputs:
        found.append(f"{run.rounds} rounds for {inputs} inputs: its intervals cover inputs from {verdicts.MIN_ROUNDS_OF_INPUT} rounds of each, "
                     f"--rounds {verdicts.MIN_ROUNDS_OF_INPUT * inputs}")
    return [f"{file}: {fault}" for fault in found]


def git(root, *arguments):
    try:
        return subprocess.run(["git", "-C", root, *arguments], capture_output=True, text=True, check=False)
    except FileNotFoundError:  # there is no git
        return subprocess.CompletedProcess(arguments, 1, "", "")


def problems(root):
    """What does not fit together, as lines of text; none if all does."""
    found, machines, commits, of_json = [], set(), set(), {}
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
        on_device = any(one.on_device for one in ALL if one.sweep == sweep)
        if not on_device:
            machines |= {machine_of(row) for row in run.source["env"]}
            commits |= {row["git_commit"] for row in run.source["env"]}
        found += faults(file, run, on_device)
        if scenes_of(run) != frozen:
            found.append(f"{file}: its scenes are not those of track {sweep}-{version}; scripts/published --freeze raises the version")
        for one in (one for one in ALL if one.sweep == sweep and one.picture):
            shown = root / "scripts" / "pictures" / one.picture[2]
            if not shown.exists() or picture.stamp_of(shown) != cell_text(run.source.attrs["run_uuid"]):
                found.append(f"{shown}: not drawn from {file}")
    if (root / PYTHON).exists():
        times = python_times.read(root / PYTHON)
        if len(times.rows) < 14 or any(len(row.ours) < PYTHON_ROUNDS for row in times.rows):
            found.append(f"{root / PYTHON}: it lacks questions or rounds (7 questions of two sizes, {PYTHON_ROUNDS} rounds)")
        commits.add(times.env["git_commit"])
        of_json[PYTHON] = times.env
    if (root / DROPIN).exists():
        times = dropin_times.read(root / DROPIN)
        found += [f"{root / DROPIN}: it lacks {what}" for what in dropin_times.lacks(times)]
        commits.add(times.env["git_commit"])
        of_json[DROPIN] = times.env
    for file, env in of_json.items():
        machines.add(machine_of(env))
        if env["git_dirty"]:
            found.append(f"{root / file}: measured with changes that are in no commit")
    machines = {one for one in machines if one[-1] or all(one[:-1] != other[:-1] for other in machines - {one})}
    for what, values in (("one machine", machines), ("one commit", commits)):
        if len(values) > 1:
            found.append(f"results/published: files of more than {what}: {', '.join(map(str, sorted(values)))}")
    strays = {path.stem for path in (root / "results" / "published").glob("*.h5")} - {one.sweep for one in ALL}
    found += [f"results/published/{name}.h5: no table stands on it" for name in sorted(strays)]
    found += [f"{root / page}: a table differs from its file; scripts/published rewrites it" for page in PAGES
              if rewritten(page, root) != text_of(page, root)]
    return found


TIMED = ("CMakeLists.txt", "kernels", "trees", "scenes", "bench/peers", "bench/tasks", "bench/running", "bench/stages", "bench/replay")


def changed_since(root):
    """[(commit of published files, names of files of code that is timed that have changed since)]; without git nothing is known."""
    commits = {row["git_commit"] for one in ALL if one.file(root).exists() for row in read(one.file(root)).source["env"]}
    found = []
    for commit in sorted(commits):
        changed = git(root, "diff", "--name-only", commit, "--", *TIMED).stdout.split()
        names = [name for name in changed if not re.search(r"_test\.c|/testing/|\.md$", name)]
        if names:
            found.append((commit, names))
    return found


def write(root):
    """The pages and pictures, from the files; gives what was written."""
    for page in PAGES:
        (root / page).write_text(rewritten(page, root), encoding="utf-8")
    drawn = [draw(one, root, root / "scripts" / "pictures") for one in ALL if one.picture and one.file(root).exists()]
    return [*(root / page for page in PAGES), *drawn]
