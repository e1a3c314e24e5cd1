#!/usr/bin/python3
"""The page of an assessment in a real browser: decision first, one sheet to sign, hostile and endless texts, dark, telephone.

    assessment_page_test.py STEPLAP MODELS [--keep FOLDER]

The assessments are written by hand (assessment_sample.py), so that every value that is looked for is known.
"""
import hashlib
import json
import os
import re
import subprocess
import unittest

import assessment_sample as sample
import report_test as base

WORK = base.WORK
DATA = {"plain": (sample.assessment(), None), "long": (sample.long_assessment(), sample.static_proofs()), "hostile": (sample.hostile_assessment(), None),
        "bare": (sample.bare_assessment(), None), "static": (None, sample.static_proofs())}
SIGNED = ["Name", "Date", "Place", "Signature"]


def write(name, assessment, static=None):
    folder = os.path.join(WORK.name, name)
    os.makedirs(folder, exist_ok=True)
    for file, content in (("assessment.json", assessment), ("static.json", static)):
        if content is not None:
            with open(os.path.join(folder, file), "w", encoding="utf-8") as stream:
                stream.write(content if isinstance(content, str) else signed(content))
    return folder


def signed(content):
    """The text of a file with its checksum, as steplap writes it (docs/reference/results.md)."""
    text = json.dumps(content, indent=1)[: -len("\n}")]
    return f'{text},\n  "checksum": "{hashlib.sha256(text.encode()).hexdigest()}"\n}}\n'


def report(*arguments):
    return subprocess.run([base.STEPLAP, "report", *arguments], cwd=WORK.name, capture_output=True, text=True, check=False)


class AssessmentPageTest(base.Page):
    @classmethod
    def setUpClass(cls):
        for name, (assessment, static) in DATA.items():
            done = report(write(name, assessment, static), "-q")
            if done.returncode != 0:
                raise AssertionError(done.stderr)
        cls.browser = base.start_browser()

    def show(self, name, width=1280, height=800, scheme="light"):
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
        self.open(f"{name}/report.html", (width, height))

    # --- on the screen -------------------------------------------------------------------------------

    def test_opens_without_messages_or_network_and_fits_every_width(self):
        for name in DATA:
            for width in (1280, 768, 390):
                with self.subTest(name=name, width=width):
                    self.show(name, width)
                    self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])
                    requests = [json.loads(m["message"])["message"] for m in self.browser.get_log("performance")]
                    urls = [r["params"]["request"]["url"] for r in requests if r["method"] == "Network.requestWillBeSent"]
                    self.assertEqual([u for u in urls if not u.startswith(("file://", "data:"))], [])
                    self.assertLessEqual(self.run_js("return document.documentElement.scrollWidth - innerWidth"), 0)
            self.assertLess(os.path.getsize(os.path.join(WORK.name, name, "report.html")), 5_000_000)

    def test_the_first_screen_holds_decision_reason_and_worst_event(self):
        self.show("plain")
        told = sample.assessment()
        self.assertEqual(self.find("#decision .badge").text, "INSPECT")
        self.assertEqual(self.find("#decision .reason").text, told["reason"])
        bottom = self.run_js("return document.querySelector('#worst tbody tr').getBoundingClientRect().bottom")
        self.assertLess(bottom, 800)
        first = self.find("#worst tbody tr").text
        for part in ("2", "x: 3 g up to 100 Hz", "does not hold", "slips: front joint", "0.97", "0.8 mm", "93 % (47 % to 100 %, 200 runs)"):
            self.assertIn(part, first.replace("\u00a0", " ").replace("\n", " "))
        self.show("plain", 390, 844)
        self.assertLess(self.run_js("return document.querySelector('#decision .reason').getBoundingClientRect().bottom"), 300)

    def test_the_decision_is_a_large_sentence_above_the_machine_and_the_waveform(self):
        self.show("plain")
        sizes = self.run_js("return ['#decision .reason', 'body'].map((s) => parseFloat(getComputedStyle(document.querySelector(s)).fontSize))")
        self.assertGreater(sizes[0], 1.4 * sizes[1])
        self.assertEqual(len(self.all("#worst-event figure.curve[data-event='2'] path")), 2)
        # Seen from the tank that carries the recorder, the active part stands 20 mm forward, magnified as the picture says.
        motion = self.find("#worst-event .motion-text").get_attribute("textContent")
        magnified = float(motion.split("×")[1]) if motion else 1.0
        tank, part = self.run_js("""return ['tank', 'active part'].map((name) => document.querySelector(`#worst-event [data-body="${name}"]`)
            .getAttribute('transform').match(/-?[\\d.e-]+/g).map(Number))""")
        self.assertAlmostEqual((part[4] - tank[4]) / tank[0], 0.02 * magnified, delta=1e-6)  # m; rounding of the transforms
        self.assertIn("Event 2", self.find("#worst-event").text)
        self.print_page("machine")
        self.assertEqual(len(self.all("#sheet .papers .drawing .body")), 2)

    def test_no_peak_stands_without_its_bandwidth(self):
        self.show("plain")
        peaks = self.run_js("return [...document.querySelectorAll('.peak')].map(e => e.textContent)")
        self.assertEqual(len(peaks), 2 * 2 * 3)  # two axes of three events, in two tables
        for peak in peaks:
            self.assertRegex(peak.replace("\u00a0", " "), r"^[xz]: [\d.]+ g up to 100 Hz$")

    def test_events_stand_in_the_order_of_need_and_of_the_voyage(self):
        self.show("plain")
        numbers = "return [...document.querySelectorAll(arguments[0] + ' tbody th')].map(e => e.textContent)"
        self.assertEqual(self.run_js(numbers, "#worst"), ["2", "2", "3", "3", "1", "1"])
        self.assertEqual(self.run_js(numbers, "#events"), ["1", "1", "2", "2", "3", "3"])
        self.assertEqual([int(e.get_attribute("data-event")) for e in self.all("#worst .curve")], [2, 3, 1])

    def test_an_event_opens_with_all_that_is_known_of_it(self):
        self.show("plain")
        self.run_js("document.querySelector('details.event[data-event=\"2\"]').open = true")
        self.until(lambda: self.all("details.event[data-event='2'] table"))
        text = self.find("details.event[data-event='2']").text.replace("\u00a0", " ")
        for part in ("29.4 m/s² (3 g)", "300 mm/s", "bottom arresting", "300 kN", "rear foot", "1.2 mm", "core to tank", "12 mm", "The wooden block above the rear foot closes."):
            self.assertIn(part, text)

    def test_what_the_decision_hangs_on_its_source_and_what_is_unknown(self):
        self.show("plain")
        self.assertIn("at 0.24 instead of 0.2 the front joint holds", self.find("#hangs").text)
        rows = self.run_js("return [...document.querySelectorAll('#hangs tbody tr')].map(r => [...r.cells].map(c => c.textContent))")
        self.assertEqual(self.all("#decision tbody th")[0].text, "joints hold")  # the gravest criterion first
        self.assertEqual([(r[0], r[6]) for r in rows], [("friction of the sheets", "assumed"), ("clamping pressure", "specified")])  # the largest share first
        self.assertIn("bending of sheets and yokes", self.find("#unknown").text)
        self.assertIn("Core insulation resistance", self.find("#tests").text)
        for part in ("ab" * 32, "2 samples are clipped at 16 g.", "x = y, y = -z", "preset core"):
            self.assertIn(part, self.find("#sources").text)

    def test_a_file_that_contradicts_itself_is_shown_to_do_so(self):
        self.show("plain")
        self.assertEqual(self.all(".contradiction"), [])
        data = sample.assessment()
        data["decision"], data["reasons"] = "energise", []
        data["voyage"]["joints"][0]["slid_total"] = 0.005  # its events: 0.8 mm
        data["events"][0]["models"][0]["joints"][1]["slid"] = 0.0003  # and slips: false
        self.assertEqual(report(write("odd", data), "-q").returncode, 0)
        self.show("odd")
        texts = " ".join(e.text for e in self.all(".contradiction")).replace("\u00a0", " ")
        for part in ("although a model does not hold in event 2", "'back joint' slid 0.3 mm, but is said not to slip", "slid 5 mm in the voyage, but 0.8 mm in its events"):
            self.assertIn(part, texts)

    def test_markup_stays_text(self):
        self.show("hostile")
        self.assertEqual(self.browser.title, f"steplap assessment: {os.path.join(WORK.name, 'hostile')}")
        self.unfold()
        self.until(lambda: len(self.all("details.event table")) > 3)
        self.assertEqual(self.all("#sheet b:not([class]) b, main td b, main th b, main img, #sheet img, main script, .reason b, li b b"), [])
        self.assertEqual(self.run_js("return [...document.querySelectorAll('b')].filter(e => e.textContent === 'bold').length"), 0)
        self.assertIn("<b>bold</b>", self.find("#decision .reason").text)

    def test_dark_is_readable(self):
        for name in ("plain", "static"):
            self.show(name, scheme="dark")
            self.unfold()
            low = self.run_js("""
                const parse = (c) => (c.match(/[\\d.]+/g) || []).map(Number);
                const light = (c) => { const [r, g, b] = c.map((v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
                const paper = (e) => { for (; e; e = e.parentElement) { const c = parse(getComputedStyle(e).backgroundColor); if (c.length === 3 || c[3] > 0) return c.slice(0, 3); } return [255, 255, 255]; };
                return [...document.querySelectorAll('header *, main *, footer')].filter((e) => e.getClientRects().length && [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim())).map((e) => {
                  const isText = e.namespaceURI.endsWith('svg'), ink = parse(isText ? getComputedStyle(e).fill : getComputedStyle(e).color).slice(0, 3), [a, b] = [light(ink), light(paper(e))].sort((p, q) => q - p);
                  return [(a + 0.05) / (b + 0.05), e.textContent.slice(0, 40)]; }).filter((r) => !(r[0] >= 4.5))""")
            self.assertEqual(low, [])

    # --- the static proof ------------------------------------------------------------------------------

    def test_the_static_proof_alone_and_its_polar_picture(self):
        self.show("static")
        self.assertEqual(self.find("#decision .badge").text, "OPEN")
        text = self.find("#static").text.replace("\u00a0", " ")
        self.assertIn("rear foot lifts at 8 m/s² (0.816 g), pulled at 0°", text)
        self.assertIn("IEC 60076-1:2011", text)
        self.assertEqual(self.run_js("return [...document.querySelectorAll('#static tbody th')].map(e => e.textContent)"), ["forward", "back", "down", "up"])
        # The joint slips at 12 m/s² along x: two upright lines, as far from the middle to the left as to the right; the foot's at two thirds.
        spots = self.run_js("""const xs = (k) => (document.querySelector(`#static path[data-kind="${k}"]`).getAttribute('d').match(/[ML]([\\d.]+)/g) || []).map((t) => Number(t.slice(1)));
            const c = Number(document.querySelector('#static .ring').getAttribute('cx')); return [xs('slips'), xs('lifts')].map((l) => l.map((x) => x - c))""")
        slips, lifts = spots
        right = max(slips)
        self.assertTrue(all(abs(abs(x) - right) < 0.11 for x in slips), slips)  # a tenth is how places are written
        self.assertTrue(min(slips) < 0 < right)
        self.assertTrue(all(abs(x - right * 8 / 12) < 0.16 for x in lifts), lifts)
        self.assertEqual(len(self.all("#static .polar .case.hold")), 3)
        self.assertEqual(len(self.all("#static .polar .case.open")), 1)

    # --- on paper -----------------------------------------------------------------------------------

    def test_the_first_sheet_can_be_signed_whatever_its_content(self):
        words = {"plain": ["INSPECT", "stays 0.8 mm away from its place", "x: 3 g up to 100 Hz", "slips: front joint", "93 %", "hangs on the friction of the sheets: at 0.24", "assumed, not measured", "Core insulation resistance",
                           "bending of sheets and yokes", "clause 3.3.1", "voyage.csv"],
                 "long": ["OPEN", "The worst of 500 events", "more events on the sheets behind", "more assumptions on the sheets behind", "Static proof", "Criteria and their sources"],
                 "hostile": ["INSPECT", "<b>bold</b>"], "bare": ["ENERGISE", "No event was recorded.", "None are stated."],
                 "static": ["OPEN", "Upwards nothing holds", "forward", "down", "IEC 60076-1:2011", "so slowly that nothing vibrates"]}
        for name, wanted in words.items():
            with self.subTest(name=name):
                self.show(name)
                sheets = self.print_page(name)
                self.assertGreater(len(sheets), 1)
                signers = ["Prepared by", "Approved by"] if name == "static" else ["For the receiver", "For the carrier"]
                for part in [*wanted, *SIGNED, *signers]:
                    self.assertIn(part, sheets[0])
                self.assertNotIn("Signature", " ".join(sheets[1:]))
                self.assertEqual(sheets[0].count("Signature"), 2)

    def test_the_sheet_says_who_travelled_how_and_what_was_seen_of_it(self):
        self.show("plain")
        sheet = self.print_page("plain")[0]
        for part in ("T-4711", "SL-0815", "calibrated 2025-11-02", "range 16 g", "mounted lid, above limb 2", "2026-01-04 10:00", "Rotterdam, 2026-01-05 08:00", "The record covers 55.9 h.", "99.8 %",
                     "inspect, 3 events, x up to 3 g, y up to 0.5 g,", "energise, 4 events, x up to 2.8 g, y up to 0.52 g,",
                     "Dew point of the gas", "Pressure of the gas", "Resistance core to earth", "Visible damage"):
            self.assertIn(part, sheet)
        self.assertEqual(len(self.all('#sheet figure.curve[data-event="2"] path')), 2)  # the worst event, as it was recorded
        blank = len(self.all("#sheet .blank"))
        self.assertEqual(blank, 4 + 1)  # what the receiver finds, and the filter, of which nothing is said
        self.show("bare")
        self.assertEqual(len(self.all("#sheet .blank")), 4 + 1 + 5 + 2)  # the transformer, the recorder, departure and arrival are filled in by hand, too

    def test_printed_text_keeps_its_size(self):
        """A table that is too wide would make the browser shrink all sheets, and the sheet to sign with them."""
        for name in ("plain", "long"):
            self.show(name)
            self.print_page(name)
            box = subprocess.run(["pdftotext", "-l", "1", "-bbox", os.path.join(base.KEPT or WORK.name, name + ".pdf"), "-"], check=True, capture_output=True, text=True).stdout
            rights = [float(x) for x in re.findall(r'xMax="([\d.]+)"', box)]
            self.assertGreater(max(rights), 0.85 * 595)  # of an A4 sheet of 595 points, 34 of margin at each side

    def test_what_the_sheet_leaves_out_stands_behind_it(self):
        self.show("long")
        sheets = self.print_page("long")
        rest = " ".join(sheets[1:])
        for i in range(40):
            self.assertIn(f"much to say about it. {i}", rest)  # the end of each assumption
        for number in (1, 250, 500):
            self.assertRegex(rest, rf"\b{number}\b")

    def test_printed_from_a_telephone_the_sheet_is_the_same(self):
        self.show("plain")
        wide = self.print_page("wide")[0]
        self.show("plain", 390, 844)
        self.assertEqual(self.print_page("narrow")[0], wide)

    # --- what is refused ------------------------------------------------------------------------------

    def test_files_that_were_changed_are_refused(self):
        good = signed(sample.assessment())
        for name, assessment, static in (
                ("cut", good[: len(good) // 2], None), ("milder", good.replace('"inspect"', '"energise"', 1), None),
                ("digit", good.replace("0.97", "0.87", 1), None), ("bare", json.dumps(sample.assessment()), None), ("empty", "", None),
                ("proof", None, signed(sample.static_proofs()).replace('"open"', '"hold"', 1))):
            with self.subTest(name=name):
                self.assertNotIn(good, (assessment, static))
                folder = write("bad_" + name, assessment, static)
                done = report(folder)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("its checksum is not that of its text", done.stderr)
                self.assertIn(".json", done.stderr)
                self.assertFalse(os.path.exists(os.path.join(folder, "report.html")))

    def test_an_assessment_is_not_set_beside_other_folders(self):
        done = report("plain", "static", "-o", "both.html")
        self.assertEqual(done.returncode, 2)
        self.assertIn("name only its folder", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=base.sys.argv[:1], verbosity=2)
