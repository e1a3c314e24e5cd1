#!/usr/bin/python3
"""The page of `steplap explore` in a real browser: dragging, files that change, saving, hostile visitors, the end.

    explore_test.py STEPLAP MODELS [--keep FOLDER]
"""
import http.client
import json
import os
import signal
import socket
import subprocess
import time
import unittest
import urllib.parse

import report_test as base
from selenium.webdriver.common.keys import Keys

STEPLAP, WORK, MODELS = base.STEPLAP, base.WORK, base.MODELS

# A box pushed for a while, on friction: it slides further the less friction there is.
SLED = """title = "A sled"
[parameters]
grip = { value = 0.4, range = [0.05, 0.9], meaning = "friction under the sled" }
[simulation]
end = 1.0
velocity = [2.0, 0.0]
initial = "equilibrium"
[output]
step = 0.005
[[acceptance]]
name = "way"
channel = "sled.x"
within = "0.7 m"
consequence = "reject"
[[body]]
name = "sled"
mass = 100.0
inertia = 10.0
position = [0.0, 0.2]
outline = [[-0.4, -0.2], [0.4, -0.2], [0.4, 0.2], [-0.4, 0.2]]
[[element]]
kind = "polygon_contact"
name = "floor"
a = "sled"
stiffness = "0.1 GN/m2"
dissipation = 0.5
static_friction = "= grip"
"""


class Server:
    """`steplap explore` in a process of its own."""

    def __init__(self, *arguments, folder=None):
        self.process = subprocess.Popen([STEPLAP, "explore", *arguments, "--no-browser"], cwd=folder or WORK.name, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
        self.address = self.process.stdout.readline().strip()
        parts = urllib.parse.urlsplit(self.address)
        self.port, self.token, self.origin = parts.port, parts.path, f"http://{parts.netloc}"

    def ask(self, method, path, body=None, host=None, **headers):
        """Status and text; `path` as it stands, with or without the token."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        connection.putheader("Host", host or f"127.0.0.1:{self.port}")
        for name, value in headers.items():
            connection.putheader(name.replace("_", "-"), value)
        if body is not None:
            connection.putheader("Content-Length", str(len(body)))
        connection.endheaders()
        if body is not None:
            connection.send(body.encode())
        reply = connection.getresponse()
        text = reply.read().decode()
        self.headers = dict(reply.getheaders())
        connection.close()
        return reply.status, text

    def post(self, path, body, **headers):
        return self.ask("POST", self.token + path, json.dumps(body), **{"Origin": self.origin, "Content_Type": "application/json", **headers})

    def run(self, values, **more):
        status, text = self.post("run", {"model": 0, "values": values, "page": "test", "is_settled": False, **more})
        return status, json.loads(text) if status == 200 else text

    def end(self, how=signal.SIGINT):
        self.process.send_signal(how)
        try:
            return self.process.wait(10)
        finally:
            self.process.stdout.close()
            self.process.stderr.close()


class ExploreTest(base.Page):
    @classmethod
    def setUpClass(cls):
        cls.browser = base.start_browser()

    def setUp(self):
        self.folder = os.path.join(WORK.name, self.id().rsplit(".", 1)[1])
        os.mkdir(self.folder)
        self.write("sled.toml", SLED)
        self.server = Server("sled.toml", folder=self.folder)

    def tearDown(self):
        if self.server.process.poll() is None:
            self.server.end()

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def load(self, size=(1280, 900)):
        self.browser.set_window_size(*size)
        self.browser.get_log("browser")
        self.browser.get(self.server.address)
        self.until(lambda: self.find("body").get_attribute("data-ready") == "true")

    def slide(self, path, value):
        """What a finger on the slider does."""
        self.run_js("const s = document.querySelector(`input[type=range][data-path='${arguments[0]}']`); s.value = String(arguments[1]); s.dispatchEvent(new Event('input', { bubbles: true }))", path, value)

    def idle(self):
        self.until(lambda: self.run_js("return steplap.page.isIdle()"))

    def way(self):
        """How far the sled of the new state comes, m."""
        return self.run_js("return steplap.page.runs()[1].summary.extremes['sled.x'].max")

    def badges(self):
        return self.run_js("return [...document.querySelectorAll('.badge')].map((e) => e.textContent)")

    # --- the page ----------------------------------------------------------------------------------

    def test_it_opens_without_a_word_in_the_console_and_asks_nobody_else(self):
        self.browser.get_log("performance")
        self.load()
        self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])
        requests = [json.loads(m["message"])["message"] for m in self.browser.get_log("performance")]
        urls = [r["params"]["request"]["url"] for r in requests if r["method"] == "Network.requestWillBeSent"]
        self.assertEqual([u for u in urls if not u.startswith((self.server.address, "data:"))], [])
        self.assertEqual(self.find("#title").text, "A sled")
        if base.KEPT:
            self.browser.save_screenshot(os.path.join(base.KEPT, "explore.png"))

    def test_sliders_begin_with_parameters_and_have_the_file_s_range(self):
        self.load()
        paths = [e.get_attribute("data-path") for e in self.all("#sliders input[type=range]")]
        self.assertEqual(paths[0], "parameters.grip")
        self.assertEqual([self.find("#sliders input[type=range]").get_attribute(n) for n in ("min", "max")], ["0.05", "0.9"])
        self.assertNotIn("element.floor.static_friction", paths)  # it follows from the parameter
        # Any other number is found by words.
        self.find("#search").send_keys("sled mass")
        self.until(lambda: self.all("#found button"))
        self.find("#search").send_keys(Keys.ENTER)
        self.assertIn("body.sled.mass", [e.get_attribute("data-path") for e in self.all("#sliders input[type=range]")])

    # --- dragging ----------------------------------------------------------------------------------

    def test_a_drag_changes_machine_curves_and_verdict_beside_the_old_state(self):
        self.load()
        self.assertEqual(self.badges(), ["HOLD", "HOLD"])
        self.run_js("steplap.page.show(1)")
        # Where the sled is drawn, m.
        place = lambda k: self.run_js("""const scene = steplap.page.scenes[arguments[0]], at = scene.svg.querySelector('.body[data-body=sled]').getAttribute('transform').match(/[-\\d.e]+/g).map(Number);
            return scene.toPlane(at[4], at[5])[0]""", k)
        before = [place(0), place(1)]
        self.assertAlmostEqual(before[1], before[0], delta=1e-9)
        self.slide("parameters.grip", 0.2)
        self.until(lambda: self.badges() == ["HOLD", "REJECT"])
        self.idle()
        self.assertAlmostEqual(place(0), before[0], delta=1e-9)
        self.assertAlmostEqual(place(1), self.run_js("return steplap.page.runs()[1].channel('sled.x').at(1)"), delta=1e-9)
        self.assertGreater(place(1), before[1] + 0.4)
        # v^2 / (2 mu g): the contact gives way by a ten-thousandth of a millimetre, and friction begins with its first load.
        self.assertAlmostEqual(self.way(), 2.0**2 / (2 * 0.2 * 9.80665), delta=2e-3)
        shown = self.run_js("const p = steplap.page.plots.plots.find((p) => p.series.some((s) => s.name === 'sled.x')), s = p.series.filter((s) => s.name === 'sled.x'); return s.map((x) => x.channel.at(1))")
        self.assertAlmostEqual(shown[1], self.way(), delta=1e-5)
        self.assertLess(shown[0], 0.55)
        limit = self.run_js("return [...document.querySelectorAll('#limits .utilisation')].map((e) => e.textContent)")
        self.assertTrue(any("old" in text for text in limit) and any("new" in text for text in limit), limit)
        # Errors are estimated once the slider rests.
        self.until(lambda: self.run_js("return Boolean(steplap.page.runs()[1].summary.global_error)"))
        self.find(".value[data-value='parameters.grip'] .back").click()
        self.until(lambda: self.badges() == ["HOLD", "HOLD"])

    def test_two_hundred_fast_drags_lose_no_update(self):
        self.load()
        self.run_js("""window.done = false; let k = 0;
            const s = document.querySelector("input[type=range][data-path='parameters.grip']");
            const timer = setInterval(() => { s.value = String(0.1 + 0.003 * ++k); s.dispatchEvent(new Event('input')); if (k === 200) { clearInterval(timer); window.done = true; } }, 4)""")
        self.until(lambda: self.run_js("return window.done"))
        self.idle()
        # The last value wanted is the one shown: 0.1 + 0.003 * 200.
        self.assertAlmostEqual(self.way(), 2.0**2 / (2 * 0.7 * 9.80665), delta=2e-3)
        # The estimate of errors that follows a rest is an update, too: it may still be on its way.
        read = lambda: self.run_js("const a = steplap.page.answers; return [a.last, a.shown, a.wanted]")
        self.until(lambda: read()[1] == read()[0])
        state = read()
        self.assertGreaterEqual(state[0], 200)
        self.assertIsNone(state[2])
        # A finger that rests in between sees every value on which it rests.
        for grip in (0.2, 0.5, 0.3):
            self.slide("parameters.grip", grip)
            self.idle()
            self.assertAlmostEqual(self.way(), 2.0**2 / (2 * grip * 9.80665), delta=2e-3)

    def test_of_what_is_asked_the_newest_is_always_answered_and_never_an_older_one_after_it(self):
        """What asks, by itself: a server that answers early, late and out of order, and gives up what is no longer wanted."""
        self.load()
        seen = self.run_js("""return new Promise((done) => {
            const seen = [], counts = [], underway = new Set();
            let k = 0, seed = 1;
            const answers = new steplap.Answers((answer, asked) => seen.push(asked.request.k));
            answers.post = (path, body) => new Promise((answer) => {
              for (const older of underway) older.isOld = true;
              const own = { isOld: false };
              underway.add(own);
              counts.push(underway.size);
              seed = (seed * 16807) % 2147483647;
              const late = seed % 7 === 0 ? 400 : seed % 40; // ms: some beyond the page's patience
              setTimeout(() => { underway.delete(own); answer(own.isOld && seed % 2 ? { is_superseded: true } : {}); }, late);
            });
            const timer = setInterval(() => { answers.want({ k: ++k }); if (k === 200) { clearInterval(timer); wait(); } }, 5);
            const wait = () => { if (answers.isIdle) setTimeout(() => done([seen, Math.max(...counts)]), 500); else setTimeout(wait, 20); };
        })""")
        self.assertEqual(seen[0][-1], 200)
        self.assertEqual(seen[0], sorted(set(seen[0])))
        self.assertGreater(len(seen[0]), 10)
        self.assertLessEqual(seen[1], 2)

    def test_a_value_that_makes_no_model_is_told_and_the_last_state_stays(self):
        self.load()
        way = self.way()
        field = self.find(".value[data-value='parameters.grip'] .number")
        field.clear()
        field.send_keys("5" + Keys.ENTER)  # beyond the range that the file gives
        self.until(lambda: self.find("#troubles").is_displayed())
        self.assertIn("grip", self.find("#troubles").text)
        self.assertEqual(self.way(), way)
        self.slide("parameters.grip", 0.3)
        self.until(lambda: not self.find("#troubles").is_displayed())
        self.until(lambda: self.way() != way)

    def test_of_several_models_one_is_chosen(self):
        self.write("fast.toml", SLED.replace("A sled", "A fast sled").replace("[2.0, 0.0]", "[3.0, 0.0]"))
        self.server.end()
        self.server = Server("sled.toml", "fast.toml", folder=self.folder)
        self.load()
        self.assertEqual(self.badges(), ["HOLD", "HOLD"])
        self.slide("parameters.grip", 0.2)
        self.until(lambda: self.badges() == ["HOLD", "REJECT"])
        self.find("#model").send_keys("fast")
        self.until(lambda: self.badges() == ["REJECT", "REJECT"])
        self.assertEqual(self.find("#title").text, "A fast sled")
        self.slide("parameters.grip", 0.85)  # 3^2 / (2 * 0.85 * g) = 0.54 m
        self.until(lambda: self.badges() == ["REJECT", "HOLD"])

    def test_a_run_that_takes_long_gives_way_to_newer_values(self):
        import threading

        late = {}
        self.server.end()
        self.server = Server(os.path.join(MODELS, "benchmarks/double_pendulum.toml"), folder=self.folder)  # which never comes to rest
        waiting = threading.Thread(target=lambda: late.update(reply=self.server.run({"simulation.end": 1e5, "output.step": 10})))
        waiting.start()
        time.sleep(0.5)
        status, answer = self.server.run({"simulation.end": 0.5})
        self.assertEqual((status, "data" in answer), (200, True))
        waiting.join(20)
        self.assertEqual(late["reply"], (200, {"is_superseded": True}))
        # The run of another page is not disturbed; it waits for its turn.
        other = threading.Thread(target=lambda: late.update(reply=self.server.run({"simulation.end": 0.4}, page="other")))
        other.start()
        self.assertIn("data", self.server.run({"simulation.end": 0.5})[1])
        other.join(20)
        self.assertIn("data", late["reply"][1])

    def test_keep_makes_the_new_state_the_old_one(self):
        self.load()
        self.slide("parameters.grip", 0.2)
        self.until(lambda: self.badges() == ["HOLD", "REJECT"])
        self.idle()
        self.find("#keep").click()
        self.until(lambda: self.badges() == ["REJECT", "REJECT"])
        self.find("#reset").click()
        self.until(lambda: self.badges() == ["REJECT", "HOLD"])
        self.find("#keep").click()
        self.until(lambda: self.badges() == ["HOLD", "HOLD"])

    def test_all_of_it_is_worked_by_keys(self):
        self.load()
        slider = self.find("input[type=range][data-path='parameters.grip']")
        slider.send_keys(Keys.HOME)
        self.until(lambda: self.badges()[1] == "REJECT")
        slider.send_keys(Keys.ARROW_RIGHT)
        self.assertAlmostEqual(self.run_js("return steplap.page.sliders.value('parameters.grip')"), 0.05 + 0.85 / 100, delta=1e-12)
        slider.send_keys(Keys.END)
        self.until(lambda: self.badges()[1] == "HOLD")
        unnamed = self.run_js("return [...document.querySelectorAll('button, select, input, #map')].filter((e) => e.offsetParent && !(e.textContent.trim() || e.getAttribute('aria-label') || e.closest('label') || document.querySelector(`label[for='${CSS.escape(e.id)}']`) || (e.id && [...document.querySelectorAll('label')].some((l) => l.htmlFor === e.id)))).map((e) => e.outerHTML)")
        self.assertEqual(unnamed, [])
        self.find("#map").send_keys(Keys.TAB)
        self.assertNotEqual(self.run_js("return document.activeElement.id"), "map")  # focus is not trapped

    def test_on_a_tablet_held_upright(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 820, "height": 1180, "deviceScaleFactor": 1, "mobile": True})
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
        try:
            self.load()
            self.assertLessEqual(self.run_js("return document.documentElement.scrollWidth - innerWidth"), 0)
            # Sliders and machine are seen at the same time, and a finger is enough.
            boxes = self.run_js("return ['.scene > svg', \"input[data-path='parameters.grip']\"].map((q) => { const b = document.querySelector(q).getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]; })")
            for box in boxes:
                self.assertGreaterEqual(box[1], 0)
                self.assertLessEqual(box[3], 1180)
            left, top, right, bottom = boxes[1]
            self.assertGreaterEqual(bottom - top, 40)  # pixels: the width of a finger
            y = (top + bottom) / 2
            touch = lambda kind, x: self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [] if x is None else [{"x": x, "y": y}]})
            touch("touchStart", left + 0.41 * (right - left))
            for k in range(10):
                touch("touchMove", left + (0.41 - 0.03 * (k + 1)) * (right - left))
            touch("touchEnd", None)
            self.until(lambda: self.badges()[1] == "REJECT")
            if base.KEPT:
                self.browser.save_screenshot(os.path.join(base.KEPT, "explore_tablet.png"))
        finally:
            self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
            self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})

    def test_a_map_of_two_values_fills_in_and_leads_to_a_pair(self):
        self.load()
        self.find("#search").send_keys("simulation velocity 0")
        self.find("#search").send_keys(Keys.ENTER)
        self.run_js("document.getElementById('map-y').value = 'simulation.velocity.0'; document.getElementById('map-y').dispatchEvent(new Event('change'))")
        self.find("#map-start").click()
        self.until(lambda: self.run_js("return steplap.page.map.isWhole"), 60)
        # The sled holds where v^2 / (2 mu g) is less than 0.7 m. Where it still slides after 1 s and would go beyond 0.7 m within another
        # second at that speed, the verdict is open. The borders themselves are left out by a part in a hundred.
        cells = self.run_js("const m = steplap.page.map; return [...m.cells].map(([key, cell]) => { const [i, j] = key.split(',').map(Number); return [m.valueAt(m.axes[0], i), m.valueAt(m.axes[1], j), cell.verdict]; })")
        self.assertEqual(len(cells), 24 * 24)
        for grip, speed, verdict in cells:
            way = min(speed**2 / (2 * grip * 9.80665), speed - 0.5 * grip * 9.80665 if speed > grip * 9.80665 else 1e9)
            further = way + max(0.0, speed - grip * 9.80665)
            if abs(way / 0.7 - 1) > 0.01 and abs(further / 0.7 - 1) > 0.01:
                expected = "reject" if way > 0.7 else "open" if further > 0.7 else "hold"
                self.assertEqual(verdict, expected, (grip, speed, way))
        self.run_js("steplap.page.map.canvas.focus()")
        before = self.way()
        self.find("#map").send_keys(Keys.ARROW_RIGHT, Keys.ENTER)
        self.until(lambda: self.way() != before)
        if base.KEPT:
            self.browser.save_screenshot(os.path.join(base.KEPT, "explore_map.png"))

    # --- files -------------------------------------------------------------------------------------

    def test_a_file_that_is_saved_shows_the_new_machine_or_its_errors_at_their_lines(self):
        self.load()
        self.write("sled.toml", SLED.replace("mass = 100.0", "mass = -100.0"))
        self.until(lambda: self.find("#troubles").is_displayed())
        line = 1 + SLED[: SLED.index("mass = 100.0")].count("\n")
        self.assertIn(f"sled.toml:{line}:", self.find("#troubles").text)
        self.assertEqual(self.badges(), ["HOLD", "HOLD"])  # the last state without errors
        # As editors do: another file takes its place.
        self.write("next", SLED.replace("[2.0, 0.0]", "[3.0, 0.0]").replace("A sled", "A fast sled"))
        os.replace(os.path.join(self.folder, "next"), os.path.join(self.folder, "sled.toml"))
        self.until(lambda: self.badges() == ["REJECT", "REJECT"])
        self.assertFalse(self.find("#troubles").is_displayed())
        self.assertEqual(self.find("#title").text, "A fast sled")

    def test_saved_changes_give_the_same_bytes_and_the_report_is_of_that_run(self):
        self.load()
        self.slide("parameters.grip", 0.25)
        self.find("#search").send_keys("sled mass")
        self.find("#search").send_keys(Keys.ENTER)
        self.slide("body.sled.mass", 137)
        self.idle()
        self.assertEqual(sorted(os.listdir(self.folder)), ["sled.toml"])  # nothing is written but what is saved
        self.find("#save").click()
        self.until(lambda: "Saved" in self.find("#saved").text)
        saved = os.path.join(self.folder, "sled_changed.toml")
        with open(saved, encoding="utf-8") as file:
            self.assertIn('extends = "sled.toml"', file.read())
        subprocess.run([STEPLAP, "simulate", "sled_changed.toml", "-q", "-o", "a"], cwd=self.folder, check=True)
        subprocess.run([STEPLAP, "simulate", "sled.toml", "--set", "parameters.grip=0.25", "--set", "body.sled.mass=137", "-q", "-o", "b"], cwd=self.folder, check=True)
        for name in ("trajectory.csv", "events.csv", "drawing.json", "model.toml"):
            both = []
            for run in ("a/sled_changed", "b/sled"):
                with open(os.path.join(self.folder, run, name), "rb") as file:
                    both.append(file.read().split(b"\n", 1 if name == "model.toml" else 0)[-1])  # whose first line names the file
            self.assertEqual(both[0], both[1], name)
        with open(os.path.join(self.folder, "a/sled_changed/summary.json"), encoding="utf-8") as file:
            wanted = json.load(file)["extremes"]["sled.x"]["max"]
        self.assertEqual(self.way(), wanted)  # all digits
        # It is not overwritten, and goes nowhere else.
        self.find("#save").click()
        self.until(lambda: "exists" in self.find("#saved").text or "already" in self.find("#saved").text)
        for name in ("../up.toml", "/tmp/up.toml", "x.txt", ".toml", "a/b.toml", "x\n.toml"):
            status, text = self.server.post("save", {"model": 0, "values": {}, "name": name})
            self.assertEqual(status, 200)
            self.assertIn("errors", json.loads(text), name)
        self.assertFalse(os.path.exists(os.path.join(WORK.name, "up.toml")) or os.path.exists("/tmp/up.toml"))
        tabs = self.browser.window_handles
        self.find("#report").click()
        self.until(lambda: len(self.browser.window_handles) == 2)
        self.browser.switch_to.window([w for w in self.browser.window_handles if w not in tabs][0])
        try:
            self.until(lambda: self.find("body").get_attribute("data-ready") == "true")
            self.assertEqual(self.run_js("return steplap.data.runs[0].summary.extremes['sled.x'].max"), wanted)
            # It is in a sandbox: what stands in it cannot ask the server for anything.
            self.assertEqual(self.run_js("return self.origin"), "null")
        finally:
            self.browser.close()
            self.browser.switch_to.window(tabs[0])

    def test_a_file_that_changes_while_values_are_changed_keeps_them(self):
        self.load()
        self.slide("parameters.grip", 0.2)
        self.until(lambda: self.badges() == ["HOLD", "REJECT"])
        self.write("sled.toml", SLED.replace("[2.0, 0.0]", "[1.0, 0.0]"))
        self.until(lambda: self.badges() == ["HOLD", "HOLD"])
        self.idle()
        ways = self.run_js("""return [steplap.page.runs().map((r) => r.summary.extremes['sled.x'].max),
            steplap.page.plots.plots.find((p) => p.series.some((s) => s.name === 'sled.x')).series.filter((s) => s.name === 'sled.x').map((s) => s.channel.at(1))]""")
        for shown in ways:
            for way, grip in zip(shown, (0.4, 0.2)):
                self.assertAlmostEqual(way, 1.0 / (2 * grip * 9.80665), delta=2e-3)

    # --- visitors who were not invited ------------------------------------------------------------

    def test_who_lacks_the_token_or_comes_from_elsewhere_is_refused(self):
        server, token = self.server, self.server.token
        self.assertEqual(server.ask("GET", token)[0], 200)
        for name, value in (("X-Frame-Options", "DENY"), ("Referrer-Policy", "no-referrer"), ("Cache-Control", "no-store"), ("X-Content-Type-Options", "nosniff")):
            self.assertEqual(server.headers[name], value)
        self.assertIn("default-src 'none'", server.headers["Content-Security-Policy"])
        self.assertNotIn("Access-Control-Allow-Origin", server.headers)
        wrong = "/" + ("0" if token[1] != "0" else "1") + token[2:]
        for path in ("/", "/page.js", "//", "/../", wrong, token[:-1], token[:-2] + "/", "/" + token, "http://127.0.0.1" + token, "/first/", "/first/" + "0" * 32, "*"):
            self.assertEqual(server.ask("GET", path)[0], 403, path)
        for path in ("state.toml", "../sled.toml", "..%2fsled.toml", "/etc/passwd", "run/", "page.js/x"):
            self.assertEqual(server.ask("GET", token + path)[0], 404, path)
        # A name of another site that was pointed at 127.0.0.1 (DNS rebinding).
        for host in ("evil.example", f"evil.example:{server.port}", f"localhost:{server.port}", "127.0.0.1", f"127.0.0.1:{server.port}.evil.example"):
            self.assertEqual(server.ask("GET", token, host=host)[0], 403, host)
        for origin in ("http://evil.example", "null", f"http://localhost:{server.port}", f"https://127.0.0.1:{server.port}", f"http://127.0.0.1:{server.port + 1}"):
            self.assertEqual(server.ask("GET", token + "state?since=0", Origin=origin)[0], 403, origin)
            self.assertEqual(server.post("run", {"model": 0, "values": {}}, Origin=origin)[0], 403, origin)
        for site in ("cross-site", "same-site"):
            self.assertEqual(server.ask("GET", token, Sec_Fetch_Site=site)[0], 403, site)
        body = json.dumps({"model": 0, "values": {}})
        self.assertEqual(server.ask("POST", token + "run", body, Content_Type="application/json")[0], 403)  # no origin
        self.assertEqual(server.ask("POST", token + "run", body, Origin=server.origin, Content_Type="text/plain")[0], 403)  # what forms can send
        for method in ("PUT", "DELETE", "OPTIONS", "HEAD", "TRACE"):
            self.assertEqual(server.ask(method, token)[0], 403, method)
        self.assertEqual(server.run({})[0], 200)

    def test_a_page_of_another_site_in_the_same_browser_reads_and_does_nothing(self):
        import threading
        from http.server import BaseHTTPRequestHandler, HTTPServer

        class Other(BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "text/html")
                self.end_headers()
                self.wfile.write(b"<title>other</title>")

            def log_message(self, *arguments):
                pass

        other = HTTPServer(("127.0.0.1", 0), Other)
        threading.Thread(target=other.serve_forever, daemon=True).start()
        try:
            self.browser.get(f"http://127.0.0.1:{other.server_port}/")
            # Even with the token, which it cannot know: as a fetch, a simple request, a script and a frame.
            found = self.browser.execute_async_script("""const [address, done] = arguments, seen = [];
                const body = JSON.stringify({ model: 0, values: {}, name: 'stolen.toml' });
                const fetched = (path, options) => fetch(address + path, options).then((r) => seen.push(r.type === 'opaque' ? 'opaque' : 'read'), () => seen.push('refused'));
                const script = () => new Promise((r) => { const s = document.createElement('script'); s.onload = () => { seen.push('script ran'); r(); }; s.onerror = () => { seen.push('refused'); r(); }; s.src = address + 'page.js'; document.head.append(s); });
                const frame = () => new Promise((r) => { const f = document.createElement('iframe'); f.onload = () => { let text = 'closed'; try { text = f.contentDocument.body.textContent; } catch {} seen.push(text ? 'closed' : 'empty'); r(); }; f.src = address; document.body.append(f); });
                fetched('state?since=0').then(() => fetched('save', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body }))
                  .then(() => fetched('save', { method: 'POST', mode: 'no-cors', headers: { 'Content-Type': 'text/plain' }, body })).then(script).then(frame).then(() => done(seen))""", self.server.address)
            self.assertEqual(found[:2], ["refused", "refused"])
            self.assertIn(found[2], ("opaque", "refused"))
            self.assertEqual(found[3], "refused")
            self.assertEqual(found[4], "closed")
            self.assertEqual(os.listdir(self.folder), ["sled.toml"])
        finally:
            other.shutdown()
            other.server_close()

    def test_what_is_no_request_ends_in_an_answer_and_not_in_the_server_s_end(self):
        server = self.server
        for body in ("", "{", "[]", "null", '{"model": 0}', '{"model": -1, "values": {}}', '{"model": 1, "values": {}}', '{"model": 0, "values": {"a": "b"}}', '{"model": 0, "values": []}', "[" * 100000,
                     '{"model": 0, "values": {}, "page": 3}', '{"model": 0, "values": {}, "is_settled": "yes"}'):
            status, _ = server.ask("POST", server.token + "run", body, Origin=server.origin, Content_Type="application/json")
            self.assertEqual(status, 400, body[:40])
        for values in ({"element.floor.law": 1}, {"title": 1}, {"nothing": 1}, {"parameters.grip": 1e400}, {"body.sled.outline.0.9": 1}, {"a\u0000b": 1}):
            status, text = server.post("run", {"model": 0, "values": values})
            self.assertTrue(status == 400 or "errors" in text, (values, status, text[:200]))
        for query in ("", "?", "?model=0", "?model=9&values=%7B%7D", "?model=0&values=%7", "?model=0&values=%zz", "?model=99999999999999999999&values=%7B%7D"):
            self.assertEqual(server.ask("GET", server.token + "report" + query)[0], 400, query)
        status, text = server.post("cells", {"model": 0, "values": {}, "x": "parameters.grip", "y": "nothing", "cells": [[0.1, 1]]})
        self.assertIn("error", json.loads(text)["cells"][0])
        self.assertEqual(server.post("cells", {"model": 0, "values": {}, "x": "a", "y": "b", "cells": [[0, 0]] * 401})[0], 400)
        for raw in (b"\r\n\r\n", b"GET\r\n\r\n", b"\x16\x03\x01\x02\x00\x01", b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", b"GET " + b"a" * 100000, b"POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n",
                    b"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n"):
            with socket.create_connection(("127.0.0.1", server.port), timeout=5) as connection:
                try:
                    connection.sendall(raw)
                    connection.shutdown(socket.SHUT_WR)
                    reply = connection.recv(1000)
                except OSError:  # it has been closed
                    reply = b""
                self.assertFalse(reply.startswith(b"HTTP/1.1 200"), raw[:30])
        # Connections that say nothing do not keep others out for long.
        silent = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(80)]
        for one in silent:
            one.close()
        self.until(lambda: self.answers())

    def answers(self):
        try:
            return self.server.run({})[0] == 200
        except (OSError, http.client.HTTPException):
            return False

    def test_it_listens_on_this_computer_only(self):
        with open("/proc/net/tcp", encoding="utf-8") as file:
            rows = [line.split() for line in file][1:]
        places = [row[1] for row in rows if row[3] == "0A" and int(row[1].split(":")[1], 16) == self.server.port]
        self.assertEqual(places, ["0100007F:%04X" % self.server.port])
        if os.path.exists("/proc/net/tcp6"):
            with open("/proc/net/tcp6", encoding="utf-8") as file:
                self.assertEqual([line for line in file if ":%04X " % self.server.port in line.split("st")[0][:60] and " 0A " in line], [])

    # --- the end -----------------------------------------------------------------------------------

    def test_ctrl_c_ends_it_and_the_page_says_so(self):
        self.load()
        begin = time.monotonic()
        self.assertEqual(self.server.end(), -signal.SIGINT)  # as a shell expects
        self.assertLess(time.monotonic() - begin, 5)
        self.until(lambda: "has ended" in self.find("#troubles").text)

    def test_it_goes_on_when_the_browser_is_closed(self):
        self.load()
        self.slide("parameters.grip", 0.2)
        self.browser.get("about:blank")
        self.assertEqual(self.server.run({"parameters.grip": 0.3})[0], 200)
        self.load()
        self.assertEqual(self.badges(), ["HOLD", "HOLD"])

    def test_a_port_in_use_and_a_model_with_errors_end_it_with_a_word(self):
        taken = subprocess.run([STEPLAP, "explore", "sled.toml", "--no-browser", "--port", str(self.server.port)], cwd=self.folder, capture_output=True, text=True, timeout=30)
        self.assertEqual(taken.returncode, 2)
        self.assertIn("choose another port", taken.stderr)
        self.write("wrong.toml", SLED.replace("mass = 100.0", "mass = 0"))
        wrong = subprocess.run([STEPLAP, "explore", "wrong.toml", "--no-browser"], cwd=self.folder, capture_output=True, text=True, timeout=30)
        self.assertEqual(wrong.returncode, 3)
        self.assertRegex(wrong.stderr, r"wrong\.toml:\d+:\d+: error: ")
        self.assertEqual(wrong.stdout, "")

    def test_the_browser_s_command_line_holds_an_address_that_serves_once(self):
        """xdg-open's place is taken by a script that writes down what it is given."""
        tools = os.path.join(self.folder, "tools")
        os.mkdir(tools)
        with open(os.path.join(tools, "xdg-open"), "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\necho \"$1\" > {self.folder}/opened.part && mv {self.folder}/opened.part {self.folder}/opened\n")
        os.chmod(os.path.join(tools, "xdg-open"), 0o755)
        environment = {**os.environ, "PATH": tools + ":" + os.environ["PATH"], "DISPLAY": ":99"}
        process = subprocess.Popen([STEPLAP, "explore", "sled.toml"], cwd=self.folder, stdout=subprocess.PIPE, text=True, env=environment)
        try:
            address = process.stdout.readline().strip()
            opened = os.path.join(self.folder, "opened")
            self.until(lambda: os.path.exists(opened))
            with open(opened, encoding="utf-8") as file:
                first = file.read().strip()
            self.assertNotIn(urllib.parse.urlsplit(address).path, first)
            self.browser.get(first)
            self.until(lambda: self.browser.current_url == address)
            self.browser.get(first)
            self.assertIn("served once", self.find("body").text)
        finally:
            process.terminate()
            process.wait(10)
            process.stdout.close()


if __name__ == "__main__":
    unittest.main(argv=["explore_test.py"], verbosity=2)
