"""The report in a browser: nothing wider than a phone, texts apart and legible, in the light and in the dark."""

import json
import re
import shutil
import subprocess

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = pytest.mark.skipif(not CHROMIUM, reason="no Chromium is installed (apt-get install chromium)")

# Loads the report in a frame of so many pixels and writes down what it measured there.
PROBE = """<!DOCTYPE html><meta charset=utf-8><style>body{margin:0}iframe{border:0}</style>
<iframe id=frame src="report.html" width="WIDTH" height="2000"></iframe><pre id=out></pre><script>
const parts = (colour) => colour.match(/[\\d.]+/g).slice(0, 3).map((part) => part / 255);
const linear = (part) => part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
const luminance = (colour) => { const [r, g, b] = parts(colour).map(linear); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
document.getElementById("frame").onload = (event) => {
  const page = event.target.contentDocument, view = event.target.contentWindow;
  const paper = view.getComputedStyle(page.body).backgroundColor;
  const found = {paper, width: page.documentElement.scrollWidth, texts: 0, smallest: 99, overlaps: [], faint: [],
                 findings: page.querySelector("#findings").getBoundingClientRect().top};
  for (const panel of page.querySelectorAll(".panel")) {
    const svg = panel.querySelector("svg"), scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
    // The box around a slanted text says little.
    const upright = (text) => /^((?!rotate).)*$|rotate\\(-?(90|270)/.test(text.getAttribute("transform") || "");
    const texts = [...panel.querySelectorAll("text")].filter(upright).map((text) => ({text, box: text.getBoundingClientRect()}));
    for (const {text} of texts) {
      found.texts += 1;
      found.smallest = Math.min(found.smallest, scale * parseFloat(view.getComputedStyle(text).fontSize));
      const [light, dark] = [luminance(view.getComputedStyle(text).fill), luminance(paper)].sort((a, b) => b - a);
      const onColour = ["ledger", "robustness"].includes(panel.closest("section").firstChild.id); // texts on filled bars
      if (!onColour && (light + 0.05) / (dark + 0.05) < 2.5) found.faint.push(panel.closest("section").firstChild.id + ": " + text.textContent);
    }
    for (let i = 0; i < texts.length; ++i) for (let j = i + 1; j < texts.length; ++j) {
      const [a, b] = [texts[i].box, texts[j].box];
      const common = Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
                     Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
      if (common > 0.3 * Math.min(a.width * a.height, b.width * b.height))
        found.overlaps.push(panel.parentElement.getAttribute("aria-label").slice(0, 60) + ": " + texts[i].text.textContent + " | " + texts[j].text.textContent);
    }
  }
  document.getElementById("out").textContent = JSON.stringify(found);
};
</script>"""


@pytest.fixture(scope="module")
def folder_with_report(full, script, tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    done = script("report", full, "--out", folder / "report.html")
    assert done.returncode == 0, done.stderr
    return folder


def measured(folder, width, scheme):
    (folder / "probe.html").write_text(PROBE.replace("WIDTH", str(width)))
    done = subprocess.run(
        [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files",
         f"--user-data-dir={folder / 'profile'}", f"--blink-settings=preferredColorScheme={0 if scheme == 'dark' else 1}",
         "--virtual-time-budget=10000", f"--window-size={max(width, 500)},2000", "--dump-dom", f"file://{folder}/probe.html"],
        capture_output=True, text=True, timeout=120)
    found = re.search(r"<pre id=\"out\">(\{.*?\})</pre>", done.stdout, re.S)
    assert found, done.stderr[-2000:]
    return json.loads(found[1].replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [380, 1280])
def test_it_is_legible(folder_with_report, width, scheme):
    found = measured(folder_with_report, width, scheme)
    assert found["width"] <= width and found["texts"] > 500
    assert (found["paper"] == "rgb(255, 255, 255)") == (scheme == "light")
    assert found["smallest"] >= (4.5 if width == 380 else 5.2)
    assert found["findings"] < 420
    assert found["faint"] == []
    assert len(found["overlaps"]) == 0, found["overlaps"][:20]
