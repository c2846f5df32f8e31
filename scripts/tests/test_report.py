"""The report is one offline page that survives odd files."""

import re
from html.parser import HTMLParser
from urllib.parse import unquote

import pytest
import synthetic
from synthetic import SCRIPTS

from boxwood_results import run
from boxwood_results.page import main_findings_html, trust_html

VOID = {"meta", "path", "use", "image", "br", "link", "img", "hr", "circle", "rect", "stop"}


class Page(HTMLParser):
    """Collects tags and text, and checks that tags close in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.text, self.ids = [], [], [], []
        self.feed(text)
        assert self.open == [], f"never closed: {self.open}"

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.ids += [value for name, value in attrs if name == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.ids += [value for name, value in attrs if name == "id"]

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open and self.open.pop() == tag, tag

    def handle_data(self, data):
        self.text.append(data)

    def named(self, tag):
        return [attrs for name, attrs in self.tags if name == tag]


@pytest.fixture(scope="module")
def page(full, script, tmp_path_factory):
    out = tmp_path_factory.mktemp("report") / "report.html"
    done = script("report", full, "--out", out)
    assert done.returncode == 0, done.stderr
    return out.read_text(encoding="utf-8")


def test_it_begins_with_trust_and_findings(page, full):
    # test_one_verdict.py holds these two against the program's screen.
    results = run.read(full)
    first, rest = page.split("<h2 id=findings>Main findings</h2>")
    assert trust_html(results) in first and main_findings_html(results) in rest.split("<h2 ")[0]


def test_it_needs_nothing_from_outside(page):
    parsed = Page(page)
    assert not parsed.named("script") and not parsed.named("link") and not parsed.named("iframe")
    assert "http://" not in page and "https://" not in page and "@import" not in page
    for tag, attrs in parsed.tags:
        for name in ("src", "href"):
            if name in attrs:
                assert attrs[name].startswith(("#", "data:")), (tag, attrs[name])
        assert not any(name.startswith("on") for name in attrs), tag


def test_every_picture_has_words_numbers_date_machine_and_command(page):
    parsed = Page(page)
    pictures = [attrs for attrs in parsed.named("div") if attrs.get("class") == "panels"]
    assert len(pictures) >= 8
    assert all(one.get("role") == "img" and 40 < len(one["aria-label"]) < 250 for one in pictures)
    assert all(one["aria-label"].endswith(".") and ". " not in one["aria-label"] for one in pictures), "one sentence"
    assert page.count("numbers in this figure") == len(pictures) == page.count("<figcaption>2025-01-01, Test CPU &amp; ")
    assert len(re.findall("<code>scripts/plot full.h5 --figure [a-z_]+</code>", page)) == len(pictures)
    assert len(parsed.ids) == len(set(parsed.ids)), "an id stands twice"


def test_its_text_is_text_and_its_colours_follow_the_reader(page):
    parsed = Page(page)
    assert len(parsed.named("text")) > 500 and len(page) < 1_000_000
    style = page.split("</style>")[0]
    assert not re.findall(r"(?:fill|stroke)[:=] ?\"?#[0-9a-f]{6}", page)
    used = set(re.findall(r"var\((--[a-z0-9]+)\)", page))
    _, light, dark = style.split(":root{")
    for name in used:
        if re.fullmatch("--c[0-9a-f]{6}", name):
            assert f"{name}:#{name[3:]}" in light and f"{name}:#" in dark, name


@pytest.mark.parametrize("file", sorted((SCRIPTS.parent / "results" / "published").glob("*.h5")), ids=lambda file: file.stem)
def test_of_a_published_file_it_stays_below_a_megabyte(file, script, tmp_path):
    done = script("report", file, "--out", tmp_path / "report.html")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "report.html").stat().st_size < 1_000_000


def test_contents_lead_to_sections_and_none_is_empty(page):
    parsed = Page(page)
    links = [attrs["href"][1:] for attrs in parsed.named("a")]
    sections = re.findall(r"<section><h2 id=(\w+)>[^<]*</h2>(.*?)</section>", page, re.S)
    assert links == [name for name, _ in sections] and len(links) > 10
    for name, body in sections:
        assert len(" ".join(Page(body).text)) > 40, name


def test_references_within_pictures_resolve(page):
    parsed = Page(page)
    ids = set(parsed.ids)
    used = [attrs["href"][1:] for attrs in parsed.named("use")]
    assert used and not set(used) - ids


def test_it_says_what_was_found(page):
    text = " ".join(Page(page).text)
    assert "Test CPU & <Core> 9" in text  # escaped, so that it comes back whole
    assert "noise floor" in text and "quiet enough" in text
    findings = text.split("questions, which stand first", 1)[1]
    assert "LOSES" in findings and findings.index("LOSES") < findings.index(" wins ")
    assert "cheapest, a call" in text and "what they require" in text
    assert "2 missing, 0 extra (pair 3,8)" in text
    assert "FCL's manager runs on one thread" in text
    assert "Peers absent on this machine: bullet" in text


def test_hostile_text_stays_text(tmp_path, script):
    made = synthetic.small()
    made.rows["env"][0]["host"] = "<script>alert(1)</script>"
    made.rows["checks"][0].update(status="wrong", witness='"><img src=x onerror=y>')
    out = tmp_path / "r.html"
    assert script("report", made.write(tmp_path / "a.h5"), "--out", out).returncode == 0
    parsed = Page(out.read_text())
    assert not parsed.named("script") and not parsed.named("img")


def test_one_round_gives_a_page_that_says_so(small, script, tmp_path):
    out = tmp_path / "r.html"
    assert script("report", small, "--out", out).returncode == 0
    text = " ".join(Page(out.read_text()).text)
    assert "1 round, " in text and "too few rounds" in text and "no scene was timed with 4" in text


def test_a_noisy_run_says_repeat_this_instead_of_findings(tmp_path, script):
    made = synthetic.small(9, twin=True)
    for row in made.rows["samples"]:
        if row["flags"] & 4:
            row["wall_ns"] *= 2
    out = tmp_path / "r.html"
    assert script("report", made.write(tmp_path / "a.h5"), "--out", out).returncode == 0
    text = " ".join(Page(out.read_text()).text)
    assert "REPEAT THIS" in text and "LOSES" not in text


def test_a_broken_promise_stands_on_the_first_screen(tmp_path, script):
    made = synthetic.small()
    made.kernels()
    row = next(row for row in made.rows["kernels"] if row["kernel"] == "guigue_devillers_exact")
    row.update(false_neg=1, status="wrong", witness="replay me")
    out = tmp_path / "r.html"
    assert script("report", made.write(tmp_path / "a.h5"), "--out", out).returncode == 0
    text = " ".join(Page(out.read_text()).text)
    assert "PROMISE BROKEN: guigue_devillers_exact on" in text and "replay me" in text and "BROKEN" in text


def test_what_cannot_be_written(small, script, tmp_path):
    done = script("report", small, "--out", tmp_path / "no" / "folder.html")
    assert done.returncode == 2 and "cannot write" in done.stderr and "folder.html" in done.stderr
    blocker = tmp_path / "file"
    blocker.write_text("")
    done = script("plot", small, "--out", blocker / "figures")
    assert done.returncode == 2 and "cannot write" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize("command", ["plot", "report"])
def test_help_has_an_example(script, command):
    done = script(command, "--help")
    assert done.returncode == 0 and f"Example: scripts/{command} " in done.stdout


@pytest.mark.parametrize(
    "arguments", [("plot",), ("plot", "x.h5", "--figure", "nix"), ("report", "x.h5", "--bad")]
)
def test_bad_usage(script, arguments):
    done = script(*arguments)
    assert done.returncode == 2 and "usage:" in done.stderr


def test_history_is_per_machine_and_in_the_order_of_time(tmp_path, script):
    files = []
    for number, (host, date, commit) in enumerate((("one", "2025-03-01", "ccc"), ("one", "2025-01-01", "aaa"), ("two", "2025-02-01", "bbb"),
                                                   ("one", "2025-02-01", "abc"))):
        made = synthetic.small(9, twin=True)
        made.rows["env"][0].update(host=host, git_commit=commit)
        files.append(made.write(tmp_path / f"{number}.h5", attrs={"created_utc": f"{date}T00:00:00Z"}))
    out = tmp_path / "r.html"
    assert script("report", *files, "--out", out).returncode == 0
    page = out.read_text()
    history = page.split("<h2 id=history>")[1].split("</section>")[0]
    text = " ".join(Page("<h2>" + history).text)
    assert "one, Test CPU" in text and "two, Test CPU" not in text  # of machine two there is one file
    assert text.index("aaa") < text.index("abc") < text.index("ccc") and "bbb" not in text
    assert page.startswith("<!DOCTYPE html>") and "<h1>Boxwood: 0.h5</h1>" in page  # the newest
    alone = tmp_path / "alone.html"
    assert script("report", files[0], "--out", alone).returncode == 0 and "id=history" not in alone.read_text()


def test_scenes_are_shown_without_running_anything(tmp_path, script):
    made = synthetic.small()
    made.moving(1000)
    svg = '<svg xmlns="http://www.w3.org/2000/svg"><script>alert(1)</script>\n<text fill="#444">1 % &lt; 2, "so"</text></svg>'
    made.texts["strip_warehouse"] = svg
    out = tmp_path / "r.html"
    assert script("report", made.write(tmp_path / "a.h5"), "--out", out).returncode == 0
    parsed = Page(out.read_text())
    images = parsed.named("img")
    assert len(images) == 1 and "warehouse" in images[0]["alt"]
    kind, data = images[0]["src"].split(",", 1)
    assert kind == "data:image/svg+xml" and unquote(data) == svg.replace("\n", " ")
    assert not parsed.named("script") and "alert(1)" not in " ".join(parsed.text)
    assert "what they require" in " ".join(parsed.text)
