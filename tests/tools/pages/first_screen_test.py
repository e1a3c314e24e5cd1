#!/usr/bin/python3
"""The first screen of a report in a real browser: verdict, trust, machine, bars and timeline, on three widths, in light and
dark, on paper; two runs in one table.

    first_screen_test.py STEPLAP MODELS [--keep FOLDER]

What a summary says of nearness and of what happened is written into copies of results, so that the page has to show what
a reader can check: shares below, at and beyond the limit, texts that are long, an error that reaches the limit.
"""
import base64
import hashlib
import json
import os
import re
import shutil
import subprocess
import unittest

import report_test as base
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

WORK, MODELS = base.WORK, base.MODELS
SIZES = [(1300, 900), (820, 1180), (390, 844)]
SCHEMES = ["light", "dark"]
PAGES = ["told.html", "two.html", "old.html", "lists.html"]


def share(name, channel, of_limit, value, limit, unit, at, error=None):
    return {"name": name, "channel": channel, "share": of_limit, "value": value, "limit": limit, "unit": unit, "at": at,
            "text": f"{name}: {100 * of_limit:.3g} % of its limit", "beyond": of_limit > 1, "error": error}


def happened(begin, end, what, who, text):
    return {"from": begin, "to": end, "what": what, "who": [who], "count": 1, "amount": None, "text": text}


SHARES = [
    share("front joint: friction", "front joint.margin", 1.25, 0.8, 1.0, "", 0.15),
    share("slide on the floor", "tank bottom.slide", 0.996, 1.992e-3, 2e-3, "m", 0.174, 0.01),
    share("bottom arresting devices", "bottom arresting.force", 0.64, -193529.26, 3e5, "N", 0.1363, 1e-6),
    share("top arresting devices", "top arresting.force", 0.4737, -71057.3, 1.5e5, "N", 0.1968, 1e-6),
    share("a force of a channel that is not written", "nobody.force", 0.05, 5.0, 100.0, "N", 0.3),
]
# Of a run that holds: one criterion, a friction that slipped and one that did not, which no criterion limits.
LISTED = [
    dict(share("tank bottom: friction", "tank bottom.share", 1.0, None, None, "", 0.0851), beyond=True, detail="it slips", is_judged=False),
    dict(share("front joint: displacement", "front joint.slid_share", 0.882, 0.0882, 0.1, "", 0.15), is_judged=True),
    dict(share("top friction: friction", "top friction.share", 0.8, None, None, "", 0.2), is_judged=False),
]
STORY = [
    happened(0.0851, 0.1219, "slips", "tank bottom", "Active part slides 0.79 mm on lower tank from 0.0851 s to 0.1219 s."),
    happened(0.1066, None, "lifts", "rear foot", "Rear foot lifts off at 0.1066 s."),
]
TOLD = {"verdict": "inspect", "reason": "Joint 'front joint' slips at 0.122 s and slides 46 mm.",
        "trust": {"level": "good", "text": "Errors are estimated by a finer run: times to 1e-9 s, forces to 3 N."},
        "worst_instant": 0.15, "story": STORY, "utilisations": SHARES, "moved": ["tank bottom"]}


def rewrite(run, copy, change):
    """A copy of results whose summary is changed, with the checksum that belongs to it (mbd/run/report_json.cpp)."""
    folder = os.path.join(WORK.name, "out", copy)
    shutil.copytree(os.path.join(WORK.name, "out", run), folder)
    path = os.path.join(folder, "summary.json")
    with open(path, encoding="utf-8") as file:
        summary = json.load(file)
    del summary["checksum"]
    change(summary)
    text = json.dumps(summary, indent=2, ensure_ascii=False)[:-2]
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + ',\n  "checksum": "' + hashlib.sha256(text.encode()).hexdigest() + '"\n}\n')


class FirstScreenTest(base.Page):
    @classmethod
    def setUpClass(cls):
        names = ("no_interference", "interference")
        base.steplap("simulate", *[os.path.join(MODELS, "paper", name + ".toml") for name in names], "-q", "-o", "out")

        def tell(summary):
            summary["overview"] = TOLD
            summary["judgement"]["verdict"] = "inspect"

        def tell_more(summary):
            nearer = [dict(u, share=u["share"] * 0.5, value=u["value"] * 0.5) for u in SHARES]
            summary["overview"] = dict(TOLD, verdict="hold", reason="All limits are kept.", utilisations=nearer, story=[])

        def ask_nothing(summary):
            summary["overview"] = dict(TOLD, verdict="open", is_judged=False, reason="The model has no criteria.", utilisations=LISTED[2:])
            summary["judgement"] = dict(summary["judgement"], verdict="open", criteria=[])

        rewrite("no_interference", "told", tell)
        rewrite("no_interference", "lists", lambda summary: summary.update(overview=dict(TOLD, verdict="hold", utilisations=LISTED)))
        rewrite("no_interference", "unasked", ask_nothing)
        rewrite("interference", "other", tell_more)
        rewrite("no_interference", "old", lambda summary: summary.pop("overview", None))
        base.steplap("report", "out/told", "-o", "told.html", "-q")
        base.steplap("report", "out/told", "out/other", "-o", "two.html", "-q")
        base.steplap("report", "out/old", "-o", "old.html", "-q")
        base.steplap("report", "out/lists", "-o", "lists.html", "-q")
        base.steplap("report", "out/unasked", "-o", "unasked.html", "-q")
        cls.browser = base.start_browser()

    def show(self, page, size, scheme="light"):
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": size[0] < 600})
        self.open(page)

    def boxes(self, selector, root="body"):
        return self.run_js("""return [...document.querySelector(arguments[1]).querySelectorAll(arguments[0])].map((e) => {
            const r = e.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom, e.textContent]; }).filter((b) => b[2] > b[0] && b[3] > b[1])""", selector, root)

    def assert_apart(self, boxes, where):
        for i, a in enumerate(boxes):
            for b in boxes[:i]:
                apart = a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3]
                self.assertTrue(apart, (where, a, b))

    # --- what it says ------------------------------------------------------------------------------

    def test_verdict_reason_and_trust_are_those_of_the_summary(self):
        self.show("told.html", SIZES[0])
        self.assertEqual(self.find(".badge").text, "INSPECT")
        self.assertEqual(self.find(".reason").text, TOLD["reason"])
        self.assertIn(TOLD["trust"]["text"], self.find("#trust summary").text)
        self.assertEqual(self.find("#trust").get_attribute("open"), None)  # its table is folded
        self.assertEqual([e.text for e in self.all(".story-entry")], [s["text"] for s in STORY])
        self.assertEqual(self.all(".old"), [])

    def test_older_results_open_and_say_that_they_are_older(self):
        self.show("old.html", SIZES[0])
        self.assertIn("older than this program", self.find(".old").text)
        self.assertEqual(self.find(".badge").text, "HOLD")
        self.assertFalse(self.find("#limits").is_displayed())
        self.assertGreater(len(self.all("#lanes .event")), 5)

    def test_bars_are_as_long_as_the_shares(self):
        for size in SIZES:
            self.show("told.html", size)
            bars = self.run_js("""return [...document.querySelectorAll('.utilisation')].map((u) => {
                const track = u.querySelector('.track').getBoundingClientRect(), bar = u.querySelector('.bar').getBoundingClientRect(), limit = u.querySelector('.limit').getBoundingClientRect();
                return [u.querySelector('.who').textContent, (bar.right - track.left) / ((limit.left + limit.right) / 2 - track.left), u.querySelector('.percent').textContent]; })""")
            self.assertEqual([b[0] for b in bars], [u["name"] for u in SHARES])  # the worst first
            for (name, length, _), wanted in zip(bars, SHARES):
                self.assertAlmostEqual(length, wanted["share"], delta=0.02, msg=name)  # two pixels of a bar and of the line at its limit
        texts = [b[2].replace("\u00a0", " ") for b in bars]
        self.assertEqual(texts[0], "125 %")
        self.assertRegex(texts[1], r"^\(99\.6 ± 1\) %$")  # the error reaches the limit
        self.assertEqual(texts[2:], ["64 %", "47 %", "5 %"])

    def test_criteria_are_one_list_and_what_none_limits_is_another_without_alarm(self):
        self.show("lists.html", SIZES[0])
        found = self.run_js("""return [...document.querySelectorAll('#limits h2')].map((h) => [h.textContent,
            [...h.nextElementSibling.nextElementSibling.querySelectorAll('.utilisation')].map((u) => ['.who', '.of-limit'].map((s) => u.querySelector(s).textContent).concat(u.querySelector('.percent').className))])""")
        self.assertEqual([heading for heading, _ in found], ["How near to the limits", "Friction and strength without a criterion"])
        (_, criteria), (_, others) = found
        self.assertEqual([[text.replace("\u00a0", " ") for text in row] for row in criteria], [["front joint: displacement", "8.8 % of 10 %", "percent warn"]])
        self.assertEqual(others, [["tank bottom: friction", "it slips", "percent plain"], ["top friction: friction", "", "percent plain"]])

    def test_without_criteria_there_is_no_verdict(self):
        self.show("unasked.html", SIZES[0])
        self.assertEqual(self.all(".badge"), [])
        self.assertEqual(self.find(".reason").text, "The model has no criteria.")
        self.assertEqual(self.find("#limits h2").text, "Friction and strength without a criterion")

    def test_the_dot_of_a_margin_is_at_its_lowest(self):
        self.show("told.html", SIZES[0])
        value, lowest = self.run_js("""const run = steplap.data.runs[0], name = 'back joint.margin';
            return [steplap.marks.extremeOf({ run, name }).value, run.summary.extremes[name].min]""")
        self.assertEqual(value, lowest)

    def test_couples_of_rounding_are_zero_and_words_agree_with_their_subject(self):
        self.show("told.html", SIZES[0])
        rounding = self.run_js("""const extremes = { a: { unit: 'N', min: 0, max: 1e5 }, b: { unit: 'm', min: 0, max: 2 }, c: { unit: 'N m', min: -4.7e-13, max: 0 } };
            return steplap.numbers.roundingOf({ summary: { extremes } }, 'N m')""")
        self.assertGreater(rounding, 4.7e-13)
        self.assertEqual(self.run_js("return ['rear foot', 'rear wheels', 'feet'].map((name) => steplap.words.sentence(name, 'lifts'))"),
                         ["rear foot lifts", "rear wheels lift", "feet lift"])

    def test_the_first_screen_needs_no_scrolling(self):
        for page in ("told.html", "old.html"):
            self.show(page, SIZES[0])
            for selector in ("#verdict", ".scene > svg", "#timeline"):
                bottom = self.run_js("return document.querySelector(arguments[0]).getBoundingClientRect().bottom", selector)
                self.assertLessEqual(bottom, 900, (page, selector))
        self.show("told.html", SIZES[0])
        for box in self.boxes(".utilisation"):
            self.assertLessEqual(box[3], 900)
        # The machine is the largest thing of it.
        self.assertGreater(self.run_js("return document.querySelector('.scene > svg').getBoundingClientRect().height"), 400)
        self.assertAlmostEqual(self.run_js("return steplap.page.time()"), TOLD["worst_instant"], delta=1e-12)

    # --- what it does ------------------------------------------------------------------------------

    def test_a_bar_leads_to_its_instant_and_curve(self):
        self.show("told.html", SIZES[0])
        self.all(".utilisation")[2].click()
        self.assertAlmostEqual(self.run_js("return steplap.page.time()"), 0.1363, delta=1e-12)
        chosen = self.all(".plot.chosen")
        self.assertEqual(len(chosen), 1)
        self.assertIn("bottom arresting.force", chosen[0].text)
        seen = lambda: self.run_js("const b = arguments[0].getBoundingClientRect(); return b.top >= 0 && b.bottom <= innerHeight", chosen[0])
        self.until(seen)
        # One whose channel is not among the results moves the time alone.
        self.run_js("document.querySelectorAll('.utilisation')[4].click()")
        self.assertAlmostEqual(self.run_js("return steplap.page.time()"), 0.3, delta=1e-12)

    def test_the_slider_of_the_timeline_moves_the_picture(self):
        for size in SIZES:
            self.show("told.html", size)
            place = lambda: self.run_js("return document.querySelector('.body[data-body=\"active part\"]').getAttribute('transform')")
            self.run_js("steplap.page.show(0)")
            before = place()
            slider = self.find("#time")
            self.run_js("arguments[0].scrollIntoView({block: 'center'})", slider)
            box = slider.rect
            ActionChains(self.browser).move_to_element_with_offset(slider, round(-0.2 * box["width"]), 0).click().perform()
            self.until(lambda: self.run_js("return steplap.page.time()") > 0)
            t = self.run_js("return steplap.page.time()")
            self.assertAlmostEqual(t, 0.3 * base.AXIS, delta=0.02 * base.AXIS, msg=str(size))
            self.assertNotEqual(place(), before)
            # Thumb, line through the lanes and axis stand at one place.
            cursor = self.run_js("return document.querySelector('.time-cursor').getBoundingClientRect().left")
            self.assertAlmostEqual(cursor, box["x"] + 8 + (box["width"] - 16) * t / base.AXIS, delta=1.5)  # pixels; the thumb is 16 wide

    def test_signs_of_events_stand_at_their_instants(self):
        self.show("told.html", SIZES[0])
        signs = self.run_js("""const x0 = document.getElementById('lanes').getBoundingClientRect().left, line = steplap.page.timeline;
            return [...document.querySelectorAll('#lanes .event')].map((e) => { const b = e.querySelector('.behind').getBoundingClientRect();
              return [e.dataset.who, (b.left + b.right) / 2 - x0, line.xOf(Number(e.dataset.t)), e.querySelector('[data-sign]').dataset.sign, Number(e.dataset.count)]; })""")
        self.assertGreater(len(signs), 8)
        for who, x, wanted, _, _ in signs:
            self.assertAlmostEqual(x, wanted, delta=1.0, msg=who)
        events = self.run_js("return steplap.data.runs[0].events.filter((e) => e[4]).length")
        self.assertEqual(sum(s[4] for s in signs), events)  # none is lost where several stand together
        self.assertIn(["tank bottom", "slip"], [[s[0], s[3]] for s in signs])
        self.run_js("steplap.page.show(0)")
        self.find("#after").click()
        self.assertAlmostEqual(self.run_js("return steplap.page.time()"), self.run_js("return steplap.data.runs[0].events.filter((e) => e[4])[0][0]"), delta=1e-12)

    def test_keys_and_names_for_those_who_do_not_see_or_point(self):
        self.show("told.html", SIZES[0])
        unnamed = self.run_js("""return [...document.querySelectorAll('button, select, input')].filter((e) => e.style.display !== 'none' && !(e.textContent.trim() || e.getAttribute('aria-label') || e.closest('label'))).map((e) => e.outerHTML)""")
        self.assertEqual(unnamed, [])
        self.run_js("steplap.page.show(0.2)")
        self.assertEqual(self.find("#time").get_attribute("aria-valuetext").replace("\u00a0", " "), "0.2 s")
        self.find("#time").send_keys(Keys.END)
        self.assertEqual(self.run_js("return steplap.page.time()"), base.AXIS)
        self.find("#time").send_keys(Keys.HOME)
        self.assertEqual(self.run_js("return steplap.page.time()"), 0)

    # --- two runs ----------------------------------------------------------------------------------

    def test_two_runs_are_one_table_with_right_differences(self):
        self.show("two.html", SIZES[0])
        self.assertEqual(len(self.all("#results table")), 1)
        heads = [e.text for e in self.all("#results thead th")]
        self.assertEqual(heads, ["", "told", "other", "difference"])
        rows = self.run_js("""let group = ''; return [...document.querySelectorAll('#results tbody tr')].map((r) => {
            if (r.className === 'group') group = r.textContent;
            return r.className === 'group' ? null : [r.cells[0].textContent,
                ...[...r.cells].slice(1).map((c) => [c.textContent, c.dataset.value === undefined ? null : Number(c.dataset.value)]), group]; }).filter(Boolean)""")
        numbers = [r for r in rows if all(c[1] is not None for c in r[1:4])]
        self.assertGreater(len(numbers), 25)
        for name, first, second, difference, group in numbers:
            # Forces, and criteria of |x|, are judged by their size.
            measure = abs if group == "Forces and couples" or "|" in name or name.endswith("largest slide") else float
            self.assertEqual(difference[1], measure(second[1]) - measure(first[1]), name)
        found = {r[0]: r for r in rows}
        self.assertEqual([c[0] for c in found["verdict"][1:3]], ["INSPECT", "HOLD"])
        summaries = []
        for run in ("told", "other"):
            with open(os.path.join(WORK.name, "out", run, "summary.json"), encoding="utf-8") as file:
                summaries.append(json.load(file))
        wanted = [s["joints"]["front joint"]["smallest_margin"] for s in summaries]
        self.assertEqual([c[1] for c in found["front joint: margin"][1:3]], wanted)
        shown = found["bottom arresting"][3][0].replace("\u00a0", " ").replace("−", "-")
        value, unit, change = shown.split()
        self.assertEqual((unit, change), ("kN", "more" if found["bottom arresting"][3][1] > 0 else "less"))
        self.assertAlmostEqual(float(value), abs(found["bottom arresting"][3][1]) / 1000, delta=0.05)  # half of its last digit
        # One run pushes, the other pulls: what the limit of 150 kN compares is 71.1 and 62 kN.
        signs = [found["top arresting"][k][1] < 0 for k in (1, 2)]
        self.assertEqual(signs, [True, False])
        self.assertIn(" kN less", found["top arresting"][3][0].replace("\u00a0", " "))
        # Bars in pairs, machines in one scale.
        self.assertEqual(len(self.all(".utilisation")), 2 * len(SHARES))
        scales = self.run_js("return steplap.page.scenes.map((s) => s.scale)")
        self.assertEqual(scales[0], scales[1])

    def test_bars_of_what_has_another_name_stand_together_and_what_is_alone_says_so(self):
        # The same machine, in which one joint has another name and one criterion is not asked.
        with open(os.path.join(WORK.name, "out/interference/model.toml"), encoding="utf-8") as file:
            text = file.read()
        self.assertGreater(text.count("front joint"), 1)
        with open(os.path.join(WORK.name, "renamed.toml"), "w", encoding="utf-8") as file:
            file.write(text.replace("front joint", "joint A").replace("slide on the floor", "slide of the tank"))
        base.steplap("simulate", "renamed.toml", "-q", "--no-estimate", "-o", "out", "-f")
        base.steplap("simulate", os.path.join(MODELS, "paper", "interference.toml"), "-q", "--no-estimate", "-o", "asked", "-f")
        base.steplap("report", "asked/interference", "out/renamed", "-q", "-f", "-o", "renamed.html")
        self.show("renamed.html", SIZES[0])
        rows = self.run_js("return [...document.querySelectorAll('.bars li')].map((li) => [li.querySelector('h4').textContent, li.querySelectorAll('.utilisation').length])")
        heads = [head for head, _ in rows]
        self.assertIn("front joint: friction / joint A: friction", heads)
        self.assertIn("slide on the floor / slide of the tank", heads)
        for head, count in rows:
            self.assertEqual(count, 1 if " not in " in head else 2, head)
        # The margin is asked of all joints: of each run the worst is shown, which is another joint's.
        self.assertEqual({head.split(" (")[0] for head in heads if " not in " in head} - {"joint margin"}, set())
        # A machine with other parts: what only one of them has says so.
        base.steplap("simulate", os.path.join(MODELS, "machines", "ladder.toml"), "-q", "--no-estimate", "-o", "out", "-f")
        base.steplap("report", "out/interference", "out/ladder", "-q", "-f", "-o", "unlike.html")
        self.show("unlike.html", SIZES[0])
        rows = self.run_js("return [...document.querySelectorAll('.bars li')].map((li) => [li.querySelector('h4').textContent, li.querySelectorAll('.utilisation').length])")
        self.assertGreater(len(rows), 5)
        for head, count in rows:
            self.assertEqual(count, 1, head)
            self.assertRegex(head, " not in (ladder|interference)$")

    # --- looks -------------------------------------------------------------------------------------

    def test_nothing_is_cut_off_or_lies_on_another_at_three_widths_in_light_and_dark(self):
        for size in SIZES:
            for scheme in SCHEMES:
                for page in PAGES:
                    with self.subTest(size=size, scheme=scheme, page=page):
                        self.show(page, size, scheme)
                        self.assertLessEqual(self.run_js("return document.documentElement.scrollWidth - innerWidth"), 0)
                        # No words beyond what holds them.
                        cut = self.run_js("""return [...document.querySelectorAll('.badge, .reason, #trust summary, .utilisation, .utilisation > span, .story-entry, .key, h1, h2, h3, button, #now')]
                            .filter((e) => e.offsetParent && e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== 'inline').map((e) => e.textContent)""")
                        self.assertEqual(cut, [])
                        for run in self.all("#lanes svg.lanes"):
                            signs = self.run_js("return [...arguments[0].querySelectorAll('.event')].map((e) => { const b = e.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom, e.textContent]; })", run)
                            self.assert_apart(signs, "signs")
                        self.assert_apart(self.boxes(".lane-name", "#lanes"), "names of lanes")
                        self.assert_apart(self.boxes(".tick-text", "#time-axis"), "times")
                        for plot in self.all(".plot"):
                            marks = self.run_js("return [...arguments[0].querySelectorAll('.mark-text')].map((e) => { const b = e.getBoundingClientRect(); return [b.left, b.top + 2, b.right, b.bottom - 2, e.textContent]; })", plot)
                            self.assert_apart(marks, "marks of curves")
                        if base.KEPT:
                            self.browser.save_screenshot(os.path.join(base.KEPT, f"{page[:-5]}_{size[0]}_{scheme}.png"))

    def test_dark_and_light_can_be_read(self):
        # Contrast of text against its paper: WCAG asks 4.5 of small text.
        for scheme in SCHEMES:
            self.show("told.html", SIZES[0], scheme)
            found = self.run_js("""
                const part = (v) => (v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
                const light = (rgb) => 0.2126 * part(rgb[0]) + 0.7152 * part(rgb[1]) + 0.0722 * part(rgb[2]);
                const numbers = (text) => text.match(/[\\d.]+/g).map(Number);
                const behind = (e) => { for (; e; e = e.parentElement) { const c = numbers(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
                return [...document.querySelectorAll('.badge, .reason, .percent, .of-limit, .note, .story-entry, td, th, h1, .met, .key, button')].filter((e) => e.offsetParent).map((e) => {
                  const a = light(numbers(getComputedStyle(e).color)), b = light(behind(e));
                  return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), e.className, e.textContent.slice(0, 30)]; });""")
            self.assertGreater(len(found), 50)
            self.assertEqual([f for f in found if f[0] < 4.5], [])
            dark = self.run_js("return getComputedStyle(document.body).backgroundColor")
            self.assertEqual(dark, "rgb(255, 255, 255)" if scheme == "light" else "rgb(21, 24, 28)")

    def test_axes_have_round_ticks_and_limits_and_extremes_are_marked(self):
        self.show("told.html", SIZES[0])
        plots = self.run_js("""return [...document.querySelectorAll('.plot')].map((p) => [p.dataset.plot,
            [...p.querySelectorAll('.dygraph-axis-label-y')].map((e) => e.textContent), [...p.querySelectorAll('.dygraph-axis-label-x')].map((e) => e.textContent),
            [...p.querySelectorAll('.mark-text')].map((e) => e.textContent), p.querySelectorAll('.extreme').length])""")
        self.assertGreater(len(plots), 9)
        for name, ys, xs, _, _ in plots:
            for labels in (ys, xs):
                values = [float(v.replace("−", "-")) for v in labels]
                self.assertGreaterEqual(len(values), 3, (name, labels))
                step = values[1] - values[0]
                mantissa = float(f"{step:e}".split("e")[0])
                self.assertTrue(any(abs(mantissa - m) < 1e-6 for m in (1, 2, 5)), (name, labels))
                for a, b in zip(values, values[1:]):
                    self.assertAlmostEqual(b - a, step, delta=1e-6 * abs(step) + 1e-12)
        found = {p[0]: p for p in plots}
        with open(os.path.join(WORK.name, "out/told/summary.json"), encoding="utf-8") as file:
            extreme = json.load(file)["extremes"]["bottom arresting.force"]
        marks = [m.replace("\u00a0", " ").replace("−", "-") for m in found["Fig. 8"][3]]
        self.assertIn("limit 300 kN", marks)
        value = next(m for m in marks if not m.startswith("limit"))
        self.assertAlmostEqual(float(value.split()[0]), extreme["min"] / 1000, delta=0.05)  # kN, half of the last digit
        self.assertEqual(found["Fig. 8"][4], 1)
        # Numbers are cut off nowhere: each label lies within its figure.
        cut = self.run_js("""return [...document.querySelectorAll('.plot')].flatMap((p) => { const g = p.querySelector('.graph').getBoundingClientRect();
            return [...p.querySelectorAll('.dygraph-axis-label')].filter((e) => { const b = e.getBoundingClientRect(); return b.left < g.left - 1 || b.right > g.right + 1 || e.scrollWidth > e.parentNode.clientWidth + 1; }).map((e) => e.textContent); })""")
        self.assertEqual(cut, [])

    def test_numbers_have_three_or_four_digits_and_all_in_their_title(self):
        self.show("told.html", SIZES[0])
        cells = self.run_js("return [...document.querySelectorAll('#results td[data-value]')].map((e) => [e.textContent, e.title, Number(e.dataset.value)])")
        self.assertGreater(len(cells), 40)
        for text, title, value in cells:
            digits = re.sub(r"±.*|[^\d.]", "", text).lstrip("0.").replace(".", "")
            self.assertLessEqual(len(digits), 4, text)
            if title and value:
                shown = float(title.replace("−", "-").split()[0])
                size = max(1, len(re.sub(r"\D", "", title.split()[0]).lstrip("0")))
                self.assertGreaterEqual(size, len(digits), (text, title))
                if shown != 0:
                    self.assertEqual(shown < 0, value < 0, (text, title))

    def test_the_first_printed_sheet_holds_verdict_machine_and_bars(self):
        for page, words in (("told.html", ["INSPECT", TOLD["reason"]]), ("two.html", ["INSPECT", "HOLD"])):
            self.show(page, SIZES[0], "dark")
            pdf = base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})["data"])
            path = os.path.join(base.KEPT or WORK.name, page + ".pdf")
            with open(path, "wb") as file:
                file.write(pdf)
            first = subprocess.run(["pdftotext", "-l", "1", "-layout", path, "-"], check=True, capture_output=True, text=True).stdout
            for wanted in [*words, "active part", "How near to the limits", *[u["name"] for u in SHARES], "125 %", "active part slid"]:
                self.assertIn(wanted, first.replace("\u00a0", " "))
            image = os.path.join(WORK.name, "sheet")
            subprocess.run(["pdftoppm", "-l", "1", "-r", "20", "-gray", "-singlefile", path, image], check=True)
            with open(image + ".pgm", "rb") as file:
                header = file.readline() + file.readline() + file.readline()
                pixels = file.read()
            self.assertTrue(header.startswith(b"P5"))
            self.assertGreater(sum(p > 200 for p in pixels) / len(pixels), 0.6)  # black on white, whatever the screen was


if __name__ == "__main__":
    unittest.main(argv=["first_screen_test.py"], verbosity=2)
