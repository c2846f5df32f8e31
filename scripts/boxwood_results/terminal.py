"""The table of main findings, as plain text."""

from .findings import VERDICT_WORDS, findings, floor_text, phases_text, rounds_text
from . import moving
from .kernels import take_home
from .run import TOTAL
from .selection import wrong_text


def machine_line(run):
    env = run.source["env"][0]
    return f"{env['cpu']}, {env['ncpu']} cores, host {env['host']}"


def rate_text(cell):
    """Queries per second where one query holds many, as rays do."""
    if not cell.job.task.startswith("rays") or not 0 < cell.n_queries < 2**63:
        return ""
    return f", {cell.n_queries / cell.median('query') * 1e3:.3g} M rays/s"


def columns_text(rows):
    """Rows of strings, set in columns."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return ["  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip() for row in rows]


def comparison_row(finding, peer):
    total, query = finding.against(peer, TOTAL), finding.against(peer, "query")
    return (
        f"    {peer.label}",
        total.text,
        VERDICT_WORDS[total.verdict],
        query.text if query else "-",
        VERDICT_WORDS[query.verdict] if query else "no build of its own" if not peer.has_build else "",
        peer.status,
    )


def summary(run):
    """All lines of scripts/summary."""
    found = findings(run)
    lines = [f"{run.source.path}: {machine_line(run)}", rounds_text(run), floor_text(run)]
    if found:
        lines += ["", "Peer's time / ours, paired within rounds: above 1 Boxwood is the faster."]
    header = ("    peer", "build+query", "so ours is", "query", "so ours is", "check of the peer")
    rows, places = [header], []
    for finding in found:
        places.append((len(rows), finding))
        rows += [comparison_row(finding, peer) for peer in finding.peers]
    table = columns_text(rows)
    if found:
        lines.append(table[0])
    for place, (start, finding) in enumerate(places):
        end = places[place + 1][0] if place + 1 < len(places) else len(rows)
        lines += ["", finding.title]
        ours = finding.ours
        if ours is None:
            lines.append("  no ranked variant of ours")
        else:
            lines.append(
                f"  ours: {ours.label}: {phases_text(ours)}{rate_text(ours)}; {ours.status}"
            )
            quickest = finding.quickest
            if quickest not in (None, ours):
                lines.append(
                    f"  ours for queries alone: {quickest.label}: {phases_text(quickest)}{rate_text(quickest)}; "
                    f"{quickest.status}"
                )
        lines += table[start:end]
        lines += [f"    {cell.label}: WRONG, not ranked: {wrong_text(cell)}" for cell in finding.wrong]
        lines += [f"    {cell.label}: not checked, not ranked" for cell in finding.unchecked]
    scenes = moving.take_home(run)
    if scenes:
        lines += ["", "Scenes that move, with what they task:", *(f"  {line}" for line in scenes)]
    if run.kernels:
        lines += ["", *kernel_lines(run)]
    return lines + ["", *closing_lines(run)]


def kernel_lines(run):
    broken = [
        f"  BROKEN PROMISE: {p.kernel} ({p.row['promise']}) on {p.cases}, {p.task}: {p.row['witness']}"
        for p in run.kernels
        if p.breaks_promise
    ]
    return ["What accuracy costs:", *(f"  {line}" for line in take_home(run)), *broken]


def closing_lines(run):
    lines = []
    for what, statuses in (
        ("timed cells", [cell.status for cell in run.cells if cell.rounds(TOTAL)]),
        ("kernels on hard cases", [p.row["status"] for p in run.kernels]),
    ):
        said = ", ".join(f"{statuses.count(status)} {status}" for status in sorted(set(statuses)))
        if statuses:
            lines.append(f"checks: {len(statuses)} {what}: {said}")
    unsupported = sum(cell.status == "unsupported" for cell in run.cells)
    if unsupported:
        lines.append(f"unsupported: {unsupported} cells, each with its reason in the report")
    if run.missing_samples:
        lines.append(f"missing: {run.missing_samples} samples hold no time and are left out")
    return lines
