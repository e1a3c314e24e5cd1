#!/usr/bin/python3
"""The page of a report in a real browser: chromium, driven through its WebDriver.

    report_test.py STEPLAP MODELS [--keep FOLDER]

Simulates the paper's transformer, writes reports and uses them as a reader would. With --keep the
screenshots are left in FOLDER.
"""
import base64
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

STEPLAP, MODELS = (os.path.abspath(path) for path in sys.argv[1:3])
os.environ["no_proxy"] = os.environ["NO_PROXY"] = "localhost,127.0.0.1"  # the driver is on this machine
KEPT = sys.argv[4] if len(sys.argv) > 4 and sys.argv[3] == "--keep" else None
WORK = tempfile.TemporaryDirectory(prefix="steplap-browser-")
SIZES = [(1280, 800), (1920, 1080)]
AXIS = 0.3  # s: the axis of time of the paper's runs, of 0.8 s, whose last event is at 0.24 s

HOSTILE = """title = "<img src=x onerror='document.title=1'></script><b>bold</b>"
[simulation]
end = 0.1
step = 1e-3
[[body]]
name = "<i>ball</i>"
mass = 1
inertia = 1
velocity = [1, 0]
[[plot]]
name = "<script>alert(1)</script>"
title = "<u>title</u>"
channels = ["<i>ball</i>.x"]
"""

# Sheets of 2 × 2 m, the limb's moved by 0.5 m along x; a hole in each, of which a part lies in the other's.
PIERCED = """gravity = [0, 0]
[simulation]
end = 0.01
step = 1e-3
[[body]]
name = "yokes"
fixed = true
[[body]]
name = "limb"
mass = 1000
inertia = 1000
[[element]]
kind = "step_lap_joint"
name = "joint"
limb = "limb"
active_part = "yokes"
[[element]]
kind = "step_lap_interface"
name = "corner"
joint = "joint"
yoke = [[-1, -1], [1, -1], [1, 1], [0, 0.8], [-1, 1]]
limb = [[-0.5, -1], [1.5, -1], [1.5, 1], [-0.5, 1]]
yoke_cutouts = [[[-0.4, -0.4], [0.2, -0.4], [0.2, 0.2], [-0.4, 0.2]]]
limb_cutouts = [[[0, 0], [0, 0.5], [0.5, 0.5], [0.5, 0]], [[0.6, -0.6], [1.2, -0.6], [1.2, -0.3]]]
pressure = "1 MPa"
static_friction = 0.5
"""


def steplap(*arguments):
    subprocess.run([STEPLAP, *arguments], check=True, cwd=WORK.name)


def start_browser():
    options = Options()
    for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--force-color-profile=srgb",
                     "--window-size=1280,800"]:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))


class Page(unittest.TestCase):
    """A page in the browser, opened by a path below WORK."""
    browser = None

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        WORK.cleanup()

    def open(self, page, size=(1280, 800)):
        self.browser.set_window_size(*size)
        self.browser.get("about:blank")  # so that the same page is loaded again, and the logs hold nothing of the last one
        self.browser.get_log("browser")
        self.browser.get_log("performance")
        self.browser.get("file://" + os.path.join(WORK.name, page))
        self.until(lambda: self.find("body").get_attribute("data-ready") == "true")

    def unfold(self):
        self.run_js("for (const d of document.querySelectorAll('details')) d.open = true")

    def until(self, condition, seconds=15):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, "did not come about")
            time.sleep(0.05)

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def run_js(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def print_page(self, name):
        """Texts of the sheets."""
        pdf = base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})["data"])
        path = os.path.join(KEPT or WORK.name, name + ".pdf")
        with open(path, "wb") as file:
            file.write(pdf)
        facts = subprocess.run(["pdfinfo", path], check=True, capture_output=True, text=True).stdout
        self.assertIn("A4", facts)
        text = subprocess.run(["pdftotext", "-layout", path, "-"], check=True, capture_output=True, text=True).stdout
        sheets = text.split("\f")[:-1]
        self.assertEqual(len(sheets), int(re.search(r"Pages:\s+(\d+)", facts).group(1)))
        return [" ".join(sheet.split()) for sheet in sheets]


class ReportTest(Page):
    @classmethod
    def setUpClass(cls):
        models = [os.path.join(MODELS, "paper", name + ".toml")
                  for name in ("no_interference", "interference", "weak_clamping")]
        steplap("simulate", *models, "-q", "-o", "out")
        steplap("report", "out/no_interference", "out/interference", "-o", "paper.html", "-q")
        steplap("report", "out/weak_clamping", "-q")
        layouts = [os.path.join(MODELS, "layouts", name + ".toml") for name in ("three_limb", "rail_wagon_humping")]
        steplap("simulate", *layouts, "-q", "-o", "out")
        for name in ("three_limb", "rail_wagon_humping"):
            steplap("report", "out/" + name, "-q")
        with open(os.path.join(WORK.name, "hostile.toml"), "w", encoding="utf-8") as file:
            file.write(HOSTILE)
        steplap("simulate", "hostile.toml", "-q", "-o", "out", "--report")
        steplap("simulate", os.path.join(MODELS, "benchmarks", "bouncing_mass.toml"), "-q", "-o", "out", "--report")
        with open(os.path.join(WORK.name, "pierced.toml"), "w", encoding="utf-8") as file:
            file.write(PIERCED)
        steplap("simulate", "pierced.toml", "-q", "-o", "out", "--report")
        cls.browser = start_browser()

    def summary(self, run):
        with open(os.path.join(WORK.name, "out", run, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

    # --- opening ---------------------------------------------------------------------------------

    def test_opens_without_console_messages_or_network(self):
        for page in ("paper.html", "out/weak_clamping/report.html", "out/hostile/report.html"):
            self.open(page)
            self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])
            requests = [json.loads(m["message"])["message"] for m in self.browser.get_log("performance")]
            urls = [r["params"]["request"]["url"] for r in requests if r["method"] == "Network.requestWillBeSent"]
            self.assertEqual([u for u in urls if not u.startswith(("file://", "data:"))], [])
            self.assertEqual(len([u for u in urls if u.startswith("file://")]), 1, urls)
            self.assertLess(os.path.getsize(os.path.join(WORK.name, page)), 5_000_000)

    def test_markup_in_names_stays_text(self):
        self.open("out/hostile/report.html")
        self.assertIn("<b>bold</b>", self.find("#title").text)
        self.assertEqual(self.all("#title b, main i, main u, main img, h3 script"), [])
        self.assertEqual(self.browser.title, "steplap: hostile")
        self.assertIn("<u>title</u>", self.find(".plot h3").text)

    # --- time ------------------------------------------------------------------------------------

    def transforms(self):
        return {e.get_attribute("data-body"): e.get_attribute("transform") for e in self.all("[data-run=no_interference] .body")}

    def test_play_moves_the_bodies_and_stops_at_the_end(self):
        self.open("paper.html")
        self.run_js("steplap.page.show(0)")
        before = self.transforms()
        self.find("#play").click()
        self.until(lambda: self.run_js("return steplap.page.time()") > 0.11)
        after = self.transforms()
        self.assertEqual([name for name in before if before[name] == after[name]], [])  # the lower tank pitches on its springs
        self.run_js("document.getElementById('speed').value = '10'")
        self.until(lambda: self.find("#play").get_attribute("aria-pressed") == "false")
        self.assertEqual(self.run_js("return steplap.page.time()"), AXIS)

    def test_a_single_body_moves_against_the_ground(self):
        self.open("out/bouncing_mass/report.html")
        self.assertEqual(self.run_js("return document.getElementById('seen-from').value"), "ground")
        self.run_js("steplap.page.show(0)")
        shape = self.find(".body")
        before = shape.get_attribute("transform")
        self.find("body").send_keys(Keys.END)
        self.assertNotEqual(shape.get_attribute("transform"), before)

    def test_slider_sets_drawing_plots_and_readings(self):
        self.open("paper.html")
        slider = self.find("#time")
        self.run_js("arguments[0].value = 0.2; arguments[0].dispatchEvent(new Event('input'))", slider)
        self.assertEqual(self.find("#now").text, "t = 0.2000 s")
        for cursor, wanted in self.run_js(
                "return steplap.page.plots.plots.map(p => [parseFloat(p.cursor.style.left), p.graph.toDomXCoord(0.2)])"):
            self.assertAlmostEqual(cursor, wanted, delta=0.5)  # half a pixel
        # Sample at 0.2 s of the trajectory, single precision of the range.
        extremes = self.summary("no_interference")["extremes"]["active part.theta"]
        shown = self.run_js("return steplap.data.runs[0].channel('active part.theta').at(0.2)")
        with open(os.path.join(WORK.name, "out/no_interference/trajectory.csv"), encoding="utf-8") as file:
            heads = file.readline().rstrip("\n").split(",")
            row = next(r for r in (line.split(",") for line in file if not line.startswith("#")) if abs(float(r[0]) - 0.2) < 1e-9)
        wanted = float(row[heads.index("active part.theta [rad]")])
        self.assertAlmostEqual(shown, wanted, delta=1e-6 * (extremes["max"] - extremes["min"]))
        slider.send_keys(Keys.HOME)
        self.assertEqual(self.run_js("return steplap.page.time()"), 0)

    def test_keyboard(self):
        self.open("paper.html")
        body = self.find("body")
        body.send_keys(Keys.HOME)
        body.send_keys(Keys.ARROW_RIGHT)
        self.assertGreater(self.run_js("return steplap.page.time()"), 0)
        body.send_keys(Keys.END)
        self.assertEqual(self.run_js("return steplap.page.time()"), AXIS)
        body.send_keys(Keys.SPACE)
        self.assertEqual(self.find("#play").get_attribute("aria-pressed"), "true")
        body.send_keys(Keys.SPACE)
        self.assertEqual(self.find("#play").get_attribute("aria-pressed"), "false")
        # Everything that can be worked is reached by tabulator, in the order of the page.
        self.find("#time").send_keys(Keys.TAB)
        self.assertEqual(self.browser.switch_to.active_element.get_attribute("id"), "play")

    def test_an_event_sets_the_time(self):
        self.open("paper.html")
        self.unfold()
        button = next(b for b in self.all("#events .event-time") if b.get_attribute("title").startswith("0.08514"))
        button.click()
        self.assertAlmostEqual(self.run_js("return steplap.page.time()"), 0.085142652, delta=1e-9)
        self.assertIn("active part slides", " ".join(e.get_attribute("textContent") for e in self.all("[data-run=no_interference] .state-text")))

    # --- plots -----------------------------------------------------------------------------------

    def windows(self):
        return self.run_js("return steplap.page.plots.plots.map(p => p.graph.xAxisRange())")

    def test_zoom_in_one_plot_zooms_all(self):
        self.open("paper.html")
        area = self.find(".plot[data-plot='Fig. 6'] .graph canvas:last-of-type")
        self.run_js("arguments[0].scrollIntoView({block: 'center'})", area)
        ActionChains(self.browser).move_to_element_with_offset(area, -60, 0).click_and_hold() \
            .move_by_offset(80, 0).release().perform()
        self.until(lambda: self.windows()[0][1] - self.windows()[0][0] < 0.5)
        for window in self.windows():
            self.assertEqual(window, self.windows()[0])
        self.find("#zoom-out").click()
        self.until(lambda: all(w == [0, 0.8] for w in self.windows()))

    def test_figures_of_the_paper_in_order_and_pairs(self):
        self.open("paper.html")
        titles = [h.text for h in self.all(".plot h3")]
        # Before the model's figures stand those that its criteria ask about and none of them shows.
        asked = next(i for i, title in enumerate(titles) if title.startswith("Fig. 4"))
        self.assertEqual([t.split(" (")[0] for t in titles[:asked:2]], ["Horizontal accelerations", "Vertical accelerations", "Shares of what friction holds"])
        figures = titles[asked:]
        for i, number in enumerate(range(4, 10)):
            for j, run in enumerate(("no_interference", "interference")):
                self.assertTrue(figures[2 * i + j].startswith(f"Fig. {number}"), titles)
                self.assertTrue(figures[2 * i + j].endswith(f"({run})"), titles)
        pairs = [e.rect for e in self.all(".plot")]
        self.assertEqual(pairs[0]["y"], pairs[1]["y"])
        self.run_js("const s = document.getElementById('layout'); s.value = 'overlaid'; s.dispatchEvent(new Event('change'))")
        self.assertEqual(len(self.all(".plot")), len(titles) // 2)
        self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])

    def test_every_axis_has_a_unit(self):
        self.open("paper.html")
        for plot in self.all(".plot"):
            self.assertRegex(plot.find_element(By.CSS_SELECTOR, ".dygraph-ylabel").get_attribute("textContent"), r"^\[.+\]$")
            self.assertEqual(plot.find_element(By.CSS_SELECTOR, ".dygraph-xlabel").get_attribute("textContent"), "t [s]")

    def event_lines(self):
        return self.run_js("return steplap.page.plots.plots.map((p) => [p.figure.name, p.eventLines().map((line) => line.text)])")

    def choose_events(self, value):
        self.run_js("const s = document.getElementById('events-of'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))", value)

    def test_curves_show_events_of_their_own_elements_or_of_the_chosen_one(self):
        self.open("out/weak_clamping/report.html")
        own = dict(self.event_lines())
        self.assertEqual({line.split(" slips")[0].split(" sticks")[0] for line in own["Margin"]}, {"front joint", "back joint"})
        self.assertEqual(own["Fig. 4"], [])  # accelerations of bodies, which have no events
        self.choose_events("of tank bottom")
        for _, lines in self.event_lines():
            self.assertTrue(lines and all(line.startswith("tank bottom ") for line in lines))
        self.choose_events("none")
        self.assertEqual([lines for _, lines in self.event_lines() if lines], [])
        self.choose_events("all")
        for _, lines in self.event_lines():
            self.assertGreater(len(lines), max(len(some) for some in own.values()))

    def test_the_pointer_on_an_event_line_names_the_event(self):
        self.open("out/weak_clamping/report.html")
        place = "const p = steplap.page.plots.plots.find((q) => q.figure.name === 'Margin'), line = p.eventLines()[0];"
        self.run_js(place + "p.area.scrollIntoView({ block: 'center' })")
        text = self.run_js(place + """const box = p.area.getBoundingClientRect(), at = (x) => p.area.dispatchEvent(new MouseEvent('mousemove', { clientX: box.left + x }));
            at(p.graph.toDomXCoord(line.t)); const named = [line.text, p.eventName.textContent, p.eventName.hidden];
            at(p.graph.toDomXCoord(line.t) - 30); return [...named, p.eventName.hidden]""")
        self.assertIn(text[0], text[1].split("\n"))
        self.assertEqual(text[2:], [False, True])  # and not where there is none

    def test_the_motion_is_saved_as_an_animated_png(self):
        """80 frames of 50 ms for 0.8 s at a fifth of its speed, in the chunks that the PNG specification asks for."""
        self.open("out/weak_clamping/report.html")
        self.browser.set_script_timeout(300)
        name, data, before, after = self.browser.execute_async_script("""const done = arguments[0], before = steplap.page.time();
            steplap.save.file = (name, type, content) => setTimeout(() => done([name, btoa(content.reduce((s, c) => s + String.fromCharCode(c), '')), before, steplap.page.time()]));
            document.getElementById('speed').value = '0.2'; document.querySelector('[data-save=animation]').click()""")
        content = base64.b64decode(data)
        self.assertEqual((name, content[:8]), ("weak_clamping_motion.png", b"\x89PNG\r\n\x1a\n"))
        chunks, at = [], 8
        while at < len(content):
            size, = struct.unpack(">I", content[at:at + 4])
            kind, body = content[at + 4:at + 8], content[at + 8:at + 8 + size]
            self.assertEqual(zlib.crc32(kind + body), struct.unpack(">I", content[at + 8 + size:at + 12 + size])[0])
            chunks.append((kind, body))
            at += 12 + size
        frames = [body for kind, body in chunks if kind == b"fcTL"]
        self.assertEqual(struct.unpack(">I", dict(chunks)[b"acTL"][:4])[0], len(frames))
        self.assertEqual([struct.unpack(">HH", f[20:24]) for f in frames], [(50, 1000)] * 80)
        numbers = [struct.unpack(">I", body[:4])[0] for kind, body in chunks if kind in (b"fcTL", b"fdAT")]
        self.assertEqual(numbers, list(range(len(numbers))))
        pictures, packed = [], b""
        for kind, body in chunks:
            if kind in (b"fcTL", b"IEND") and packed:
                pictures.append(zlib.decompress(packed))
                packed = b""
            packed += body if kind == b"IDAT" else body[4:] if kind == b"fdAT" else b""
        self.assertEqual(len(pictures), 80)
        self.assertNotEqual(pictures[0], pictures[40])  # the machine has moved
        self.assertEqual(before, after)  # the page is where it was

    # --- verdict ---------------------------------------------------------------------------------

    def test_a_slipped_joint_shows_as_slipped(self):
        self.open("out/weak_clamping/report.html")
        self.assertEqual(self.find(".badge").text, "INSPECT")
        rows = [r.text for r in self.all("#results tr")]
        for joint in ("front joint", "back joint"):
            self.assertTrue(any(r.startswith(joint + " slipped") for r in rows), rows)
        self.run_js("steplap.page.show(0)")
        self.assertEqual(len(self.all(".body.slipped")), 0)  # not yet
        self.find("body").send_keys(Keys.END)
        self.assertEqual(len(self.all(".body.slipped")), 2)
        first = self.summary("weak_clamping")["joints"]["front joint"]["first_slip"]
        self.run_js("steplap.page.show(arguments[0] + 2e-3)", first)
        states = [e.text for e in self.all("[data-joint='front joint'] .joint-state")]
        self.assertEqual(set(states), {"slips"})

    def test_holes_of_the_sheets_are_seen(self):
        self.open("out/pierced/report.html")
        self.run_js("document.querySelector('.inset svg').scrollIntoView({block: 'center'})")
        # What a reader sees on top at a place of the joint, of what is drawn there.
        seen = lambda x, y: self.run_js("""
            const svg = document.querySelector('.inset svg'), inset = steplap.page.insets[0], box = svg.getBoundingClientRect();
            const [u, w] = inset.loop([[arguments[0], arguments[1]]]).slice(1, -1).split(' ').map(Number);
            return document.elementsFromPoint(box.left + u * box.width / 246, box.top + w * box.height / 112)
              .filter((e) => svg.contains(e) && e !== svg).map((e) => e.getAttribute('class'))""", x, y)
        self.assertEqual(seen(-0.75, 0.0), ["yoke"])
        self.assertEqual(seen(0.7, 0.7), ["overlap", "limb", "yoke"])
        self.assertEqual(seen(-0.2, -0.2), ["limb"])  # through the yoke's hole
        self.assertEqual(seen(0.4, 0.3), ["yoke"])  # through the limb's
        self.assertEqual(seen(0.1, 0.1), [])  # through both
        self.assertEqual(seen(0.9, -0.5), ["yoke"])
        self.assertEqual(seen(1.1, -0.4), [])  # the limb's hole beyond the yoke
        self.assertEqual(seen(0.0, 0.9), ["limb"])  # the yoke's notch: a concave sheet shows its overlap, too
        if KEPT:
            self.find(".inset").screenshot(os.path.join(KEPT, "pierced.png"))

    def test_the_verdicts_numbers_are_those_of_the_summary(self):
        self.open("out/weak_clamping/report.html")
        summary = self.summary("weak_clamping")
        self.assertEqual(self.find(".badge").text, summary["judgement"]["verdict"].upper())
        tables = self.all("#results table")
        shown = [r.find_elements(By.CSS_SELECTOR, "[data-value]") for r in tables[0].find_elements(By.CSS_SELECTOR, "tbody tr")]
        criteria = summary["judgement"]["criteria"]
        self.assertEqual(len(shown), len(criteria))
        for cells, criterion in zip(shown, criteria):
            self.assertEqual([float(c.get_attribute("data-value")) for c in cells], [criterion["value"], criterion["limit"]])
        for row, joint in zip(tables[1].find_elements(By.CSS_SELECTOR, "tbody tr"), summary["joints"].values()):
            values = [float(c.get_attribute("data-value")) for c in row.find_elements(By.CSS_SELECTOR, "[data-value]")]
            names = ("first_slip", "smallest_margin", "largest_required_pressure", "slid_x", "slid_y", "slid_angle", "area_lost")
            self.assertEqual(values, [joint[n] for n in names])

    # --- looks -----------------------------------------------------------------------------------

    def test_nothing_overlaps_or_runs_out_of_the_page(self):
        for size in SIZES:
            for page in ("paper.html", "out/weak_clamping/report.html", "out/three_limb/report.html",
                         "out/rail_wagon_humping/report.html"):
                self.open(page, size)
                self.assertLessEqual(self.run_js("return document.documentElement.scrollWidth - innerWidth"), 0)
                self.run_js("steplap.page.show(0)")  # numbers of bodies are set apart where these begin
                boxes = self.run_js("""return [...document.querySelectorAll('.scene')].map(s =>
                    [...s.querySelectorAll('.number-mark, .state-text')].map(e => { const r = e.getBoundingClientRect();
                      return [r.left, r.top, r.right, r.bottom]; }))""")
                for scene in boxes:
                    for i, a in enumerate(scene):
                        for b in scene[:i]:
                            apart = a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3]
                            self.assertTrue(apart, (page, size, a, b))
                if KEPT:
                    self.keep(f"{os.path.dirname(page).replace('/', '_') or 'paper'}_{size[0]}")

    def keep(self, name):
        self.run_js("steplap.page.show(0.1218)")
        height = self.run_js("return document.documentElement.scrollHeight")
        self.browser.set_window_size(self.run_js("return innerWidth"), height)
        time.sleep(0.5)
        self.browser.save_screenshot(os.path.join(KEPT, name + ".png"))
        for section in ("overview", "plots", "results"):
            self.find("#" + section).screenshot(os.path.join(KEPT, f"{name}_{section}.png"))

    def test_prints_with_the_verdict_on_the_first_page(self):
        for page, verdict in (("paper.html", "HOLD"), ("out/weak_clamping/report.html", "INSPECT")):
            self.open(page)
            pdf = base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})["data"])
            path = os.path.join(KEPT or WORK.name, os.path.basename(page) + ".pdf")
            with open(path, "wb") as file:
                file.write(pdf)
            first = subprocess.run(["pdftotext", "-l", "1", "-layout", path, "-"], check=True, capture_output=True, text=True).stdout
            self.assertIn(verdict, first)
            whole = subprocess.run(["pdftotext", "-layout", path, "-"], check=True, capture_output=True, text=True).stdout
            self.assertIn("[kN]", whole)  # the curves are there, as drawings
            self.assertIn("active part", first)  # the machine, with the names of its bodies
            for part in ("Step-lap joints", "Friction", "bottom arresting") if "weak" in page else ("The runs beside each other", "difference"):
                self.assertIn(part.lower(), whole.lower())
            size = subprocess.run(["pdfinfo", path], check=True, capture_output=True, text=True).stdout
            self.assertIn("A4", size)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
