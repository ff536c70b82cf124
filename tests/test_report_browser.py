#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
A report in a real browser: headless Chromium, without a network. Exit status 77 if there is none.

    test_report_browser.py GEARSIM
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
BROWSERS = ("chromium", "chromium-browser", "google-chrome")

# Put before all else: collects what goes wrong, moves the sound, and says what it has seen in the title of the page.
WATCH = """<script>
const wrong = [];
addEventListener('error', event => wrong.push(String(event.message || event.target.src.slice(0, 40))), true);
addEventListener('load', () => {
    const audio = document.querySelector('audio'), cursor = document.querySelector('.cursor');
    audio.currentTime = audio.duration / 2;
    audio.dispatchEvent(new Event('timeupdate')); // as a browser does while it plays
    setTimeout(() => { document.title = JSON.stringify({
        wrong, images: [...document.images].filter(image => image.naturalWidth > 0).length, all: document.images.length,
        wider: document.documentElement.scrollWidth - innerWidth, duration: audio.duration, top: parseFloat(cursor.style.top),
        classes: [...document.querySelectorAll('th')].filter(cell => cell.textContent == 'class').length,
        loaded: performance.getEntriesByType('resource').filter(one => !one.name.startsWith('data:')).length }); }, 100);
});
</script>"""


def skip(text):
    print(f"skipped: {text}", file=sys.stderr)
    sys.exit(1 if os.environ.get("CI") == "true" else 77)


def dump(browser, path, folder, width):
    """The page as it is when its scripts have run."""
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile",
               "--host-resolver-rules=MAP * ~NOTFOUND", f"--window-size={width},900", "--virtual-time-budget=8000",
               "--dump-dom", f"file://{path}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, check=True)
    title = re.search(r"<title>(\{.*?\})</title>", done.stdout)
    assert title, "the page has not come to its end"
    return json.loads(title[1].replace("&quot;", '"').replace("&amp;", "&"))


def main(gearsim):
    browser = next((path for path in map(shutil.which, BROWSERS) if path), None)
    if browser is None:
        skip("no Chromium")
    with tempfile.TemporaryDirectory() as folder:
        # Two runs from 1000 to 5000 rpm in 2 s.
        params = os.path.join(ROOT, "data", "example", "params.ini")
        runs = [os.path.join(folder, name) for name in ("one.csv", "two.csv")]
        for run, damping in zip(runs, (600, 1200)):
            settings = {"drive.start_rpm": 1000, "drive.end_rpm": 5000, "analysis.duration_s": 2, "mesh.damping_Ns_per_m": damping}
            options = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
            subprocess.run([gearsim, params, "--quiet", "--output", run, *options], check=True)
        # What elastic teeth carry.
        loads = [os.path.join(folder, name) for name in ("static.csv", "load.csv")]
        elastic = ("mesh.stiffness_N_per_m=", "mesh.damping_Ns_per_m=", "analysis.type=static", "load.mean_Nm=20",
                   f"output.load_distribution={loads[1]}")
        options = [word for setting in elastic for word in ("--set", setting)]
        subprocess.run([gearsim, params, "--quiet", "--output", loads[0], *options], check=True)
        path = os.path.join(folder, "r.html")
        command = [os.path.join(ROOT, "scripts", "report"), *runs, *loads, "--output", path, "--gearsim", gearsim, "--flanks",
                   os.path.dirname(params)]
        subprocess.run(command, check=True)

        # Watched, on a wide screen and on a narrow one.
        with open(path, encoding="utf-8") as file:
            page = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(page.replace('<meta charset="utf-8">', '<meta charset="utf-8">' + WATCH, 1))
        for width in (1200, 600):
            seen = dump(browser, path, folder, width)
            print(width, seen)
            assert seen["wrong"] == [], seen
            assert seen["images"] == seen["all"] == 6 + 6 + 2 + 1 + 2, seen
            assert seen["classes"] >= 1, seen
            assert seen["wider"] <= 0, seen
            assert seen["loaded"] == 0, seen
            assert abs(seen["duration"] - 2.0) < 0.02, seen
            assert 50.0 < seen["top"] < 60.0, seen  # half-way: 3000 rpm, between 20 % and 89.5 % of the picture

        # Printed: some pages, no error.
        pdf = os.path.join(folder, "r.pdf")
        subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile",
                        f"--print-to-pdf={pdf}", f"file://{path}"], capture_output=True, timeout=200, check=True)
        with open(pdf, "rb") as file:
            content = file.read()
        assert content.startswith(b"%PDF") and content.count(b"/Type /Page\n") + content.count(b"/Type /Page ") > 2


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} GEARSIM")
    main(os.path.abspath(sys.argv[1]))
