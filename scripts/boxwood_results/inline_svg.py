"""Matplotlib's SVG for the inside of an HTML page: small, with classes for styles and variables for colours, so that
it follows the reader's light or dark."""

import colorsys
import re

COLOUR = re.compile(r"#([0-9a-fA-F]{6})\b")
REFERENCE = re.compile(r"(?:(?<=href=\")|(?<=url\())#([^\")]+)")
DIGITS = re.compile(r"(?<![#\w])-?\d+\.\d\d+")
DARKEST, LIGHTEST = 0.09, 0.96  # lightness of white and of black in the dark
NOISE = re.compile(r"<metadata>.*?</metadata>|<!--.*?-->|<defs>\s*<style.*?</style>\s*</defs>|\sxmlns(?::\w+)?=\"[^\"]*\""
                   r"|\s(?:version|gid)=\"[^\"]*\"|\stransform=\"rotate\(-0 [^\"]*\"", re.S)


def in_the_dark(colour):
    """The same hue with its lightness turned round, which keeps every contrast."""
    red, green, blue = (int(colour[k:k + 2], 16) / 255 for k in (0, 2, 4))
    hue, lightness, saturation = colorsys.rgb_to_hls(red, green, blue)
    turned = colorsys.hls_to_rgb(hue, DARKEST + (LIGHTEST - DARKEST) * (1 - lightness), saturation)
    return "".join(f"{round(255 * part):02x}" for part in turned)


STEP = re.compile(r"([ML])(-?[\d.]+) (-?[\d.]+)|z")
CLIP = r' clip-path="(url\(#[^)]*\))"'
CLIPPED = re.compile(rf"(?:<(?:path|use)(?=[^>]*{CLIP})[^>]*/>)+")


def number_text(tenths):
    """12 as '1.2', 30 as '3', -4 as '-.4'."""
    text = f"{tenths / 10:g}"
    return text.replace("0.", ".", 1) if 0 < abs(tenths) < 10 else text


def short_path(path):
    """The same lines in steps from point to point, in tenths; curves stay as they are."""
    if STEP.sub("", path):
        return path
    parts, at, start, before = [], (0, 0), (0, 0), ""
    for step in STEP.finditer(path):
        if step[0] == "z":
            parts.append("z")
            at, before = start, "z"
            continue
        to = tuple(round(10 * float(number)) for number in step.group(2, 3))
        x, y = (number_text(there - here) for here, there in zip(at, to))
        if step[1] == "M":
            parts.append(f"M{number_text(to[0])} {number_text(to[1])}")
            start, before = to, "M"
        elif to[1] == at[1] or to[0] == at[0]:
            parts.append(f"h{x}" if to[1] == at[1] else f"v{y}")
            before = "h"
        else:
            parts.append(("l" if before != "l" else "" if x.startswith("-") else " ") + f"{x} {y}")
            before = "l"
        at = to
    return "".join(parts)


def with_clips_together(svg):
    """Neighbours that are clipped alike in one group."""
    def grouped(run):
        parts, last = [], ""
        for tag in re.findall(r"<[^>]*/>", run[0]):
            clip = re.search(CLIP, tag)[1]
            if clip != last:
                parts.append(f'{"</g>" if last else ""}<g clip-path="{clip}">')
            parts.append(re.sub(CLIP, "", tag))
            last = clip
        return "".join([*parts, "</g>"])

    return CLIPPED.sub(grouped, re.sub(rf"<g{CLIP}>(<use[^>]*)/></g>", r'\2 clip-path="\1"/>', svg))


def without_bare_groups(svg):
    parts, kept = [], []
    for part in re.split(r"(</?g[^>]*>)", svg):
        if part == "</g>":
            if kept.pop():
                parts.append(part)
            continue
        if part == "<g/>":
            continue
        if part.startswith("<g"):
            kept.append(part != "<g>")
            if not kept[-1]:
                continue
        parts.append(part)
    return "".join(parts)


def font(style):
    """`font: bold 9px 'DejaVu Sans', ...` without the family, which the page has."""
    return re.sub(r"font: ((?:\w+ )*?)([\d.]+)px [^;\"]*", lambda m: f"font-size: {m[2]}px" + (
        "; font-weight: bold" if re.search("bold|[6-9]00", m[1]) else ""), style)


class InlineSvgs:
    """Those of one page, and the style that they share."""

    def __init__(self):
        self.classes, self.colours, self.pictures = {}, set(), 0

    def add(self, svg):
        """The picture as a part of the page; its ids are like no other's, its width is the variable --w."""
        self.pictures += 1
        svg = NOISE.sub("", svg[svg.index("<svg"):]).replace("xlink:href=", "href=")
        svg = re.sub(r">\s+<", "><", svg)
        svg = re.sub(r"<g id=\"halo[^\"]*\">", "<g class=halo>", svg)
        points = re.search(r'width="([\d.]+)pt" height="[\d.]+pt"', svg)
        svg = svg.replace(points[0], "", 1)
        svg = re.sub(r' style="([^"]*)"', lambda match: f' class="{self.class_of(match[1])}"', svg)
        ids = {name: f"i{self.pictures}-{number}" for number, name in enumerate(dict.fromkeys(REFERENCE.findall(svg)))}
        svg = re.sub(r' id="([^"]*)"', lambda match: f' id="{ids[match[1]]}"' if match[1] in ids else "", svg)
        svg = REFERENCE.sub(lambda match: f"#{ids[match[1]]}", svg)
        svg = re.sub(r"<[^>]*>", lambda tag: DIGITS.sub(lambda number: f"{float(number[0]):.1f}", tag[0]), svg)
        svg = re.sub(r' d="([^"]*)"', lambda path: f' d="{short_path(re.sub(" ?([A-Za-z]) ?", lambda c: c[1], " ".join(path[1].split())))}"', svg)
        return with_clips_together(without_bare_groups(svg)), f"--w:{float(points[1]):.0f}pt"

    def class_of(self, style):
        style = re.sub(r"([:;]) ", r"\1", font(style))
        self.colours |= {colour.lower() for colour in COLOUR.findall(style)}
        style = COLOUR.sub(lambda match: f"var(--c{match[1].lower()})", style)
        return self.classes.setdefault(style, f"s{len(self.classes)}")

    def css(self):
        rules = "".join(f".{name}{{{style}}}" for style, name in self.classes.items())
        light = ";".join(f"--c{colour}:#{colour}" for colour in sorted(self.colours))
        dark = ";".join(f"--c{colour}:#{in_the_dark(colour)}" for colour in sorted(self.colours))
        return f":root{{{light}}}@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}{rules}"
