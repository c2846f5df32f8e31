"""The report: one HTML file that needs no network and no script."""

from html import escape

from . import history, registry
from .findings import CALL, KERNEL, RACE, comparison_rows
from .inline_svg import InlineSvgs
from .picture import cell_text, svgs_of_panels
from .selection import wrong_text
from boxwood.results.reader import NO_COUNT, NO_ID
from boxwood.results.words import time_text

STYLE = """
:root { --paper: #fff; --ink: #222; --soft: #555; --line: #e4e4e4; --link: #0058a3; --bad: #b00000; color-scheme: light dark; }
@media screen and (prefers-color-scheme: dark) {
  :root { --paper: #171717; --ink: #e6e6e6; --soft: #a8a8a8; --line: #3a3a3a; --link: #7cb8ff; --bad: #ff7b72; }
  img, svg image { filter: invert(1) hue-rotate(180deg); } }
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: var(--ink); background: var(--paper);
       max-width: 90rem; margin: 1.2rem auto; padding: 0 1rem; overflow-wrap: anywhere; }
p, ul { max-width: 60rem; }
h1 { font-size: 1.5rem; margin: 0; } h2 { font-size: 1.25rem; margin-top: 2.2rem; }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .3rem; } a { color: var(--link); }
.lead { color: var(--soft); margin: .2rem 0; }
nav ul { columns: 15rem; padding-left: 1.2rem; margin: .3rem 0; }
figure { margin: .6rem 0 1.2rem; } img { max-width: 100%; height: auto; }
figcaption, .note { color: var(--soft); font-size: .88rem; }
.panels { display: flex; flex-wrap: wrap; gap: .8rem 1.4rem; align-items: flex-start; }
.panel { flex: 0 1 calc(.92 * var(--w)); max-width: 100%; overflow-x: auto; }
.panel svg { display: block; width: 100%; min-width: calc(.7 * var(--w)); height: auto; fill: var(--ink);
             font-family: "DejaVu Sans", Verdana, sans-serif; }
.panel .halo text { paint-order: stroke; stroke: var(--paper); stroke-width: 2.4px; stroke-linejoin: round; }
table { border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { text-align: left; padding: .18rem .7rem .18rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.n { text-align: right; } td:first-child { min-width: 9rem; } h3::first-letter { text-transform: uppercase; }
.scroll { overflow-x: auto; margin-bottom: 1.1rem; } pre { overflow-x: auto; }
details .scroll { max-height: 30rem; overflow-y: auto; }
summary { cursor: pointer; font-size: .88rem; color: var(--link); }
.wrong { color: var(--bad); font-weight: 600; }
@media (max-width: 40rem) { .panels { flex-direction: column; } .panel { flex: none; width: 100%; } }
@media print { body { max-width: none; margin: 0; } figure, tr { break-inside: avoid; }
               .scroll, details .scroll { max-height: none; overflow: visible; } }
"""
MAX_ROWS = 60  # of a table: the rest is in the file


def shown(value):
    """(text, is number) of a table cell, numbers short enough to read."""
    if value is None or value != value or value in (NO_ID, NO_COUNT):
        return "", False
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1e5 else f"{value:,.0f}", True
    if isinstance(value, int):
        return f"{value:,}", True
    return str(value), False


def table(columns, rows):
    """The first rows, and how many more the file has."""
    lines = ["<div class=scroll><table><thead><tr>"]
    lines += [f"<th scope=col>{escape(str(column))}</th>" for column in columns]
    lines.append("</tr></thead><tbody>")
    for row in rows[:MAX_ROWS]:
        lines.append("<tr>")
        for value in row:
            text, number = shown(value)
            kind = " class=n" if number else " class=wrong" if text == "wrong" else ""
            lines.append(f"<td{kind}>{escape(text)}</td>")
        lines.append("</tr>")
    lines.append("</tbody></table></div>")
    if len(rows) > MAX_ROWS:
        lines.append(f"<p class=note>The first {MAX_ROWS} of {len(rows):,} rows; <code>boxwood show --csv</code> and the CSV "
                     "files of <code>scripts/plot</code> have all.</p>")
    return "".join(lines)


def folded(summary, body):
    return f"<details><summary>{escape(summary)}</summary>{body}</details>"


def section(name, title, body):
    """(name, title, HTML) of a part of the page; None if it holds nothing."""
    return (name, title, f"<section><h2 id={name}>{escape(title)}</h2>{body}</section>") if body else None


def source_text(run):
    """Where and when what a figure shows was measured."""
    env = run.source["env"]
    machines = ", ".join(dict.fromkeys(f"{row['cpu']} ({row['ncpu']} cores)" for row in env))
    return f"{cell_text(run.source.attrs.get('created_utc'))[:10]}, {machines}, {run.rounds} rounds"


def figure_html(picture, command, run, svgs):
    panels = []
    for svg in svgs_of_panels(picture):
        drawn, width = svgs.add(svg)
        panels.append(f'<div class=panel style="{width}">{drawn}</div>')
    notes = "".join(f"<p class=note>{escape(note)}</p>" for note in dict.fromkeys(picture.notes))
    numbers = folded(f"The {len(picture.rows):,} numbers in this figure", table(picture.columns, picture.rows))
    return (f'<h3 id="figure-{picture.name}">{escape(picture.title)}</h3><figure><div class=panels role=img '
            f'aria-label="{escape(picture.alt)}">{"".join(panels)}</div><figcaption>{escape(source_text(run))}. '
            f"<code>{escape(command)}</code></figcaption></figure>{notes}{numbers}")


def figure_sections(run, svgs):
    """A section for each figure whose data the run holds, and what the others lack."""
    sections, lacking = [], []
    for name in registry.FIGURES:
        drawn = registry.draw(name, run)
        if drawn.skipped:
            lacking.append((drawn.title, drawn.skipped))
            continue
        body = [f"<p class=note>{escape(drawn.how_to_read)}</p>"]
        body += [figure_html(picture, f"scripts/plot {run.name} --figure {name}", run, svgs) for picture in drawn.pictures]
        sections.append(section(name, drawn.title, "".join(body)))
    return sections, lacking


def findings_html(run, headlines):
    """The rows that `boxwood show` prints, in the same words."""
    parts = []
    for topic in run.topics:
        rows = [(f.question, f.together, f.alone, f.certainty)
                for f in run.findings if f.topic == topic["topic"] and f.is_headline == headlines]
        if rows:
            parts.append(f"<h3>{escape(topic['title'])}</h3>" if headlines else "")
            parts.append(table([topic[name] for name in ("question", "together", "alone", "certainty")], rows))
    return "".join(parts)


def trust_html(run):
    """Machine and noise, and how many answers were wrong: whether the rest can be believed."""
    health, env = run.health, run.source["env"][0]
    wrong = " class=wrong" if health["wrong_ours"] or health["broken_promises"] else ""
    device = env["gpu"] if "gpu" in env.dtype.names else ""
    machine = f"{env['cpu']}, {env['ncpu']} cores, {f'device {device}, ' if device else ''}host {env['host']}."
    return (f"<p class=lead>{escape(machine)}<br>"
            f"{escape(health['trust'])}<br><span{wrong}>{escape(health['correctness'])}</span></p>")


def main_findings_html(run):
    if run.health["advice"]:
        return f"<p class=wrong>{escape(run.health['advice'])}</p>"
    rest = findings_html(run, False)
    return findings_html(run, True) + (folded("Other sizes and numbers of threads", rest) if rest else "")


def kernels_html(run):
    if not run.kernels:
        return ""
    columns = ("kernels", "cases", "kernel", "library", "promise", "status", "n", "ns", "false pos", "false neg", "maybe",
               "out of bound", "worst relative error", "promise broken", "witness")
    rows = [
        (p.task, p.cases, p.kernel, p.library, p.row["promise"], p.row["status"], p.n, p.ns,
         int(p.row["false_pos"]), int(p.row["false_neg"]), int(p.row["maybe"]), int(p.row["bound_violations"]), p.error,
         "BROKEN" if p.row["is_broken"] else "", p.row["witness"])
        for p in run.kernels
    ]
    return folded(f"All {len(rows):,} kernels on hard cases", table(columns, rows))


STRIP = "strip_"  # texts that hold frames of a scene side by side, as SVG


def scenes_table_html(run):
    """What was measured on, frozen by its content."""
    def of(row, name):
        return row[name] if name in row.dtype.names else ""

    rows = [(row["name"], of(row, "human_name"), int(row["n_items"]), str(row["seed"]), f"{int(row['content_hash']):016x}",
             of(row, "source"), of(row, "licence")) for row in run.source["scenes"]]
    return folded(f"All {len(rows):,} scenes", table(("scene", "in words", "items", "seed", "content (XXH3)", "source", "licence"), rows))


def data_url(svg):
    """For an attribute in double quotes, as readable as it may stand there."""
    for plain, coded in (("%", "%25"), ("#", "%23"), ("&", "%26"), ('"', "%22"), ("\n", " ")):
        svg = svg.replace(plain, coded)
    return f"data:image/svg+xml,{svg}"


STRIPS_SIZE = 550_000  # characters that pictures of scenes take, so that a page of many scenes stays below a megabyte


def scenes_html(run):
    """Frames of moving scenes. A picture from a file cannot run scripts as an image."""
    parts, left, left_out = [], STRIPS_SIZE, []
    for name, svg in sorted(run.source.texts.items()):
        if not name.startswith(STRIP):
            continue
        scene, url = name.removeprefix(STRIP), data_url(svg)
        left -= len(url)
        if left < 0:
            left_out.append(scene)
            continue
        parts.append(f"<h3>{escape(scene)}</h3><figure><img alt=\"Frames of the moving scene {escape(scene)}, side by "
                     f"side, drawn with few bodies\" src=\"{url}\"></figure>")
    if left_out:
        parts.append(f"<p>Not drawn, to keep this page small: {escape(', '.join(left_out))}. <code>boxwood scene NAME --frame 0,10 "
                     "--svg FILE.svg</code> draws one.</p>")
    return "".join(parts)


def cells_html(run):
    columns = ("cell", "check", "phase", "rounds", "median", "MAD", "min", "p95", "p99", "times the machine's limit")
    rows = [
        (cell.name, cell.status, phase, int(row["n"]),
         *(time_text(float(row[name])) for name in ("median_ns", "mad_ns", "min_ns", "p95_ns", "p99_ns")),
         float(row["times_limit"]) if cell.ours else None)
        for cell in run.cells for phase, row in cell.medians.items()
    ]
    return folded(f"All {len(rows):,} timings", table(columns, rows))


def checks_html(run):
    timed = [cell for cell in run.cells if cell.timed]
    counts = {}
    for cell in timed:
        key = (cell.library, cell.status)
        counts[key] = counts.get(key, 0) + 1
    parts = [
        "<p>Every timed cell is checked against an oracle outside the timed region. A wrong answer is never ranked.</p>",
        table(("library", "status", "timed cells"), [(*key, count) for key, count in sorted(counts.items())]),
    ]
    wrong = [(cell.name, cell.status, wrong_text(cell)) for cell in run.cells if cell.status == "wrong"]
    if wrong:
        parts += ["<h3>Wrong answers</h3>", table(("cell", "status", "what"), wrong)]
    rows = [
        (cell.name, cell.status, cell.check["oracle"] if "oracle" in cell.check.dtype.names else "",
         int(cell.check["n_checked"]), int(cell.check["missing"]), int(cell.check["extra"]))
        for cell in timed if cell.check is not None
    ]
    columns = ("cell", "status", "oracle", "checked", "missing", "extra")
    return "".join([*parts, folded(f"All {len(rows):,} checks", table(columns, rows))])


def unsupported_html(run):
    rows = [(cell.name, cell.check["witness"]) for cell in run.cells if cell.status == "unsupported"]
    parts = [folded(f"{len(rows):,} cells are unsupported", table(("cell", "why"), rows)) if rows
             else "<p>Nothing is unsupported.</p>"]
    absent = sorted({row["library"] for row in run.source["packages"] if not row["present"]})
    if absent:
        parts.append(f"<p>Peers absent on this machine: {escape(', '.join(absent))}.</p>")
    notes = [(row["name"], row["notes"]) for row in run.source["variants"] if row["notes"]]
    if notes:
        parts.append(folded("What differs between the contenders", table(("contender", "notes"), notes)))
    return "".join(parts)


# Texts with a line per cell, for the sweep that goes on: in the file, and in no report.
OF_THE_SWEEP = {"calibration", "inputs"}


def machine_html(run):
    env = run.source["env"]
    # As text: one column of values of all kinds reads best from the left.
    rows = [(name, *(shown(as_plain(row[name]))[0] for row in env)) for name in env.dtype.names]
    columns = ("", *(f"machine state {row['env_id']}" for row in env))
    texts = "".join(folded(name, f"<pre>{escape(text)}</pre>") for name, text in sorted(run.source.texts.items())
                    if text and not name.startswith(STRIP) and name not in OF_THE_SWEEP)
    packages = [(row["library"], row["version"] or "absent", row["build"]) for row in run.source["packages"]]
    libraries = table(("library", "version", "build"), packages)
    return f"{table(columns, rows)}{folded('Libraries and peers', libraries)}{texts}"


def as_plain(value):
    return value.item() if hasattr(value, "item") else value


def lacking_html(lacking):
    return table(("figure", "what this run lacks for it"), lacking) if lacking else ""


def tally_text(run):
    """How many of the questions asked of rivals are lost, on the first screen."""
    races = [finding for finding in run.findings if finding.is_headline and finding.topic in (RACE, CALL, KERNEL)]
    lost = [finding for finding in races if finding.is_loss]
    of_all = f"Boxwood loses {len(lost) or 'none'} of {len(races)} questions"
    return f"{of_all}, which stand first. " if lost else f"{of_all}. " if races else ""


def findings_section_html(run):
    columns, rows = comparison_rows(run.comparisons)
    return "".join([
        f"<p class=note>{tally_text(run)}Our best against the best rival of the same run: above 1 Boxwood is the faster.</p>",
        main_findings_html(run),
        folded(f"All {len(rows):,} comparisons, ours against ourselves and threads too", table(columns, rows)) if rows else "",
    ])


def contents_html(sections):
    links = "".join(f'<li><a href="#{name}">{escape(title)}</a></li>' for name, title, _ in sections)
    return f"<nav><details><summary>Contents</summary><ul>{links}</ul></details></nav>"


def history_html(runs, run, svgs):
    command = f"scripts/report {' '.join(run.name for run in runs)}"
    pictures = "".join(figure_html(picture, command, run, svgs) for picture in history.pictures(runs))
    return f"<p class=note>{escape(history.HOW_TO_READ)}</p>{pictures}" if pictures else ""


def report(run, runs=()):
    """The whole page as text; runs: all that its history is about, itself among them."""
    svgs = InlineSvgs()
    figures, lacking = figure_sections(run, svgs)
    sections = [part for part in (
        section("findings", "Main findings", findings_section_html(run)), *figures,
        section("history", history.TITLE, history_html(runs, run, svgs)),
        section("scenes", "Scenes", scenes_html(run) + scenes_table_html(run)),
        section("kernels", "Kernels on hard cases", kernels_html(run)),
        section("right", "Is it right", checks_html(run)),
        section("unsupported", "Unsupported and absent", unsupported_html(run)),
        section("timings", "All timings", cells_html(run)),
        section("lacking", "Figures of what was not measured", lacking_html(lacking)),
        section("machine", "Machine", machine_html(run)),
    ) if part]
    missing = (f"<p class=note>{run.missing_samples} samples hold no time and are left out.</p>"
               if run.missing_samples else "")
    changed = f"<p class=wrong>Warning: {escape(run.changed)}.</p>" if run.changed else ""
    return "".join(
        [
            "<!DOCTYPE html><html lang=en><head><meta charset=utf-8>",
            '<meta name=viewport content="width=device-width, initial-scale=1">',
            f"<title>Boxwood: {escape(run.name)}</title><style>{STYLE}{svgs.css()}</style></head><body>",
            f"<h1>Boxwood: {escape(run.name)}</h1>",
            f"<p class=lead>{escape(cell_text(run.source.attrs.get('created_utc')))}</p>{changed}{trust_html(run)}{missing}",
            contents_html(sections),
            *(html for _, _, html in sections),
            "</body></html>\n",
        ]
    )
