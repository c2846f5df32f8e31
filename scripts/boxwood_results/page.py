"""The report: one HTML file that needs no network and no script."""

import base64
from html import escape

from . import registry
from .findings import comparison_rows
from .picture import as_inline_svg, cell_text
from .selection import wrong_text
from .words import time_text

STYLE = """
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff;
       max-width: 90rem; margin: 2rem auto; padding: 0 1.2rem; }
p, ul { max-width: 60rem; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.25rem; margin-top: 2.4rem; }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .3rem; }
.lead { color: #555; margin-top: 0; }
figure { margin: .6rem 0 1.2rem; } figure svg, figure img { max-width: 100%; height: auto; }
figcaption, .note { color: #555; font-size: .88rem; }
table { border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .18rem .7rem .18rem 0; border-bottom: 1px solid #e4e4e4; vertical-align: top; }
td.number { text-align: right; }
.scroll { overflow-x: auto; margin-bottom: 1.1rem; }
details .scroll { max-height: 30rem; overflow-y: auto; }
summary { cursor: pointer; font-size: .88rem; color: #0058a3; }
.wrong { color: #b00000; font-weight: 600; }
@media print { body { max-width: none; margin: 0; } figure, tr { break-inside: avoid; }
               .scroll, details .scroll { max-height: none; overflow: visible; } }
"""
MISSING = (2**32 - 1, 2**64 - 1)


def shown(value):
    """(text, is number) of a table cell, numbers short enough to read."""
    if value is None or value != value or value in MISSING:
        return "", False
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1e5 else f"{value:,.0f}", True
    if isinstance(value, int):
        return f"{value:,}", True
    return str(value), False


def table(columns, rows):
    lines = ["<div class=scroll><table><thead><tr>"]
    lines += [f"<th scope=col>{escape(str(column))}</th>" for column in columns]
    lines.append("</tr></thead><tbody>")
    for row in rows:
        lines.append("<tr>")
        for value in row:
            text, number = shown(value)
            kind = " class=number" if number else " class=wrong" if text == "wrong" else ""
            lines.append(f"<td{kind}>{escape(text)}</td>")
        lines.append("</tr>")
    return "".join([*lines, "</tbody></table></div>"])


def folded(summary, body):
    return f"<details><summary>{escape(summary)}</summary>{body}</details>"


def figure_html(picture):
    svg = as_inline_svg(picture).replace("<svg", f'<svg role="img" aria-label="{escape(picture.alt)}"', 1)
    notes = "".join(f"<p class=note>{escape(note)}</p>" for note in dict.fromkeys(picture.notes))
    numbers = folded(f"The {len(picture.rows):,} numbers in this figure", table(picture.columns, picture.rows))
    return f"<h3>{escape(picture.title)}</h3><figure>{svg}</figure>{notes}{numbers}"


def figures_html(run):
    parts = []
    for name in registry.FIGURES:
        drawn = registry.draw(name, run)
        parts.append(f"<h2>{escape(drawn.title)}</h2>")
        if drawn.skipped:
            parts.append(f"<p class=note>No figure: {escape(drawn.skipped)}.</p>")
            continue
        parts.append(f"<p class=note>{escape(drawn.how_to_read)}</p>")
        parts += [figure_html(picture) for picture in drawn.pictures]
    return "".join(parts)


def findings_html(run, headlines):
    """The rows that `boxwood show` prints, in the same words."""
    parts = []
    for topic in run.topics:
        rows = [(f.question, f.together, f.alone, f.certainty)
                for f in run.findings if f.topic == topic["topic"] and f.is_headline == headlines]
        if rows:
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
    return "<h2>Kernels on hard cases</h2>" + folded(f"All {len(rows):,} kernels on hard cases", table(columns, rows))


STRIP = "strip_"  # texts that hold frames of a scene side by side, as SVG


def scenes_html(run):
    """Frames of moving scenes. A picture from a file cannot run scripts as an image."""
    parts = []
    for name, svg in sorted(run.source.texts.items()):
        if name.startswith(STRIP):
            scene = name.removeprefix(STRIP)
            data = base64.b64encode(svg.encode()).decode()
            parts.append(f"<h3>{escape(scene)}</h3><figure><img alt=\"Frames of the moving scene {escape(scene)}, side by "
                         f"side, drawn with few bodies\" src=\"data:image/svg+xml;base64,{data}\"></figure>")
    return f"<h2>Scenes that move</h2>{''.join(parts)}" if parts else ""


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


def machine_html(run):
    env = run.source["env"]
    # As text: one column of values of all kinds reads best from the left.
    rows = [(name, *(shown(as_plain(row[name]))[0] for row in env)) for name in env.dtype.names]
    columns = ("", *(f"machine state {row['env_id']}" for row in env))
    texts = "".join(folded(name, f"<pre>{escape(text)}</pre>") for name, text in sorted(run.source.texts.items())
                    if text and not name.startswith(STRIP))
    packages = [(row["library"], row["version"] or "absent", row["build"]) for row in run.source["packages"]]
    libraries = table(("library", "version", "build"), packages)
    return f"{table(columns, rows)}{folded('Libraries and peers', libraries)}{texts}"


def as_plain(value):
    return value.item() if hasattr(value, "item") else value


def report(run):
    """The whole page as text."""
    columns, rows = comparison_rows(run.comparisons)
    missing = (f"<p class=note>{run.missing_samples} samples hold no time and are left out.</p>"
               if run.missing_samples else "")
    changed = f"<p class=wrong>Warning: {escape(run.changed)}.</p>" if run.changed else ""
    return "".join(
        [
            "<!DOCTYPE html><html lang=en><head><meta charset=utf-8>",
            '<meta name=viewport content="width=device-width, initial-scale=1">',
            f"<title>Boxwood: {escape(run.name)}</title><style>{STYLE}</style></head><body>",
            f"<h1>Boxwood: {escape(run.name)}</h1>",
            f"<p class=note>{escape(cell_text(run.source.attrs.get('created_utc')))}</p>{changed}{trust_html(run)}{missing}",
            "<h2>Main findings</h2><p class=note>Losses first. Our best against the best rival of the same run: above 1 "
            "Boxwood is the faster.</p>", main_findings_html(run),
            folded(f"All {len(rows):,} comparisons, ours against ours and threads too", table(columns, rows)),
            figures_html(run),
            scenes_html(run),
            kernels_html(run),
            "<h2>Is it right</h2>", checks_html(run),
            "<h2>Unsupported and absent</h2>", unsupported_html(run),
            "<h2>All timings</h2>", cells_html(run),
            "<h2>Machine</h2>", machine_html(run),
            "</body></html>\n",
        ]
    )
