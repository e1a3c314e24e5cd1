#!/usr/bin/python3
"""Pictures of machines in a real browser: what is drawn, looked at closely, taken home; modes in motion.

    picture_test.py STEPLAP MODELS [--keep FOLDER]
"""
import csv
import glob
import os
import re
import unittest
import xml.etree.ElementTree

import report_test as base
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

WORK, MODELS = base.WORK, base.MODELS
PHONE = (390, 844)
# What the fonts of every system have: ASCII, Latin-1, Greek, and of the rest what WGL4 lists.
EVERYWHERE = re.compile("^[\\n\\t -~\u00a0-\u00ff\u0391-\u03c9\u2013\u2014\u2018-\u201e\u2026\u2190-\u2193\u2206\u2212\u221e\u2248\u2260\u2264\u2265]*$")


# Where pictures are seen from when no model says it: the vehicle that a drive translates, or the ground.
NO_DRIVE = ("rail_wagon_humping", "joint_apart")  # one runs free, into another wagon
VEHICLES = {"stacked_blocks": "deck", "no_interference": "lower tank", "drawbar_train": "lorry", "forklift": "truck", "braking_car": "car", "wheelie": "bike"}
# Magnified motion is drawn no larger than this part of the machine's diagonal (standpoint.js).
DRAWN_MOTION = 0.05
# How the first load is told. The carrier of loads of layouts; nothing but gravity acts on a wall.
LOADS = {"forklift": "Braking: truck is braked with 0.6 g", "three_limb_humping": "Rail humping: trailer is braked with 2 g", "tank_with_lid": "Bump: wagon rises by 60 mm",
         "balanced_drum": "Turning: drum turns at 60 rad/s.", "jamming_slide": "Push acts on slide with 100 N.", "drawbar_train": "Ahead: lorry moves at",
         "rail_wagon_humping": "Wagon and 6 more move at 1.94 m/s at the start.", "brick_wall": "Gravity acts, and no other load."}
# Of each scene, boxes on the screen: texts with marks, and the picture.
BOXES = """const box = (e) => { const r = e.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; }, svg = steplap.page.scenes[0].svg;
    const texts = [...svg.querySelectorAll('.name-text, .state-text, .note-text, .load-text')].filter((e) => e.getBoundingClientRect().width > 0);
    return { picture: box(svg), texts: texts.map((e) => [e.textContent, ...box(e)]) }"""
# Springs as they are drawn at time t: ends, and the size of symbols.
SPRINGS = """const s = steplap.page.scenes[0], pose = s.look(0, s.seenFrom, s.magnification);
    return { u: s.u, width: s.width, height: s.height, springs: s.symbols.springs.map((o) => [o.element.name, ...s.symbols.springEnds(o, pose).flat()]) }"""
# Of bodies with outlines: box of the drawn path and of the corners that the model has, both in m, and pixels a metre.
EXTENTS = """const s = steplap.page.scenes[0], k = s.svg.clientWidth / s.width; // within its border
    return [...s.bodies.values()].filter((b) => b.is_outline_given).map((b) => {
      const group = [...s.svg.querySelectorAll('.body')].find((g) => g.dataset.body === b.name), d = group.querySelector('path').getBBox(), m = group.getScreenCTM();
      const x = b.outline.map((p) => p[0]), y = b.outline.map((p) => p[1]);
      return [b.name, Math.hypot(m.a, m.b) / (k * s.scale), d.x, d.y, d.x + d.width, d.y + d.height, Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)]; })"""


# Returns for each name in a scene its body and the bodies painted at its middle, top first. Names beside their body are left out.
NAMES = """const scene = steplap.page.scenes[arguments[0]]; scene.svg.scrollIntoView({ block: 'center' });
    return [...scene.svg.querySelectorAll('[data-name-of]')].filter((e) => e.style.display !== 'none').map((e) => { const r = e.querySelector('text').getBoundingClientRect(), x = (r.left + r.right) / 2, y = (r.top + r.bottom) / 2;
      const found = document.elementsFromPoint(x, y).map((p) => p.closest('.body')).filter(Boolean), reach = (name) => scene.body(name).reach, own = e.dataset.nameOf;
      return [own, found.map((b) => b.dataset.body).filter((b, i) => b === own || !(found[i].classList.contains('around') && reach(b) > reach(own)))]; })"""
# How far each arrow of a drive stays inside the picture, pixels.
ARROWS = """const scene = steplap.page.scenes[arguments[0]], s = scene.svg.getBoundingClientRect();
    return [...scene.svg.querySelectorAll('.drive:not(.arc)')].map((e) => e.getBoundingClientRect()).filter((r) => r.width + r.height > 0).map((r) => Math.min(r.left - s.left, r.top - s.top, s.right - r.right, s.bottom - r.bottom))"""
# Boxes of the values that are written beside forces, of the names of bodies and of what the picture marks as having happened.
WRITTEN = """return [...steplap.page.scenes[0].svg.querySelectorAll('.value-text, .name-text, .state-text')].map((e) => [e, e.getBoundingClientRect()])
    .filter(([e, r]) => r.width > 0).map(([e, r]) => [e.dataset.valueOf || '', e.textContent, r.left, r.top, r.right, r.bottom])"""
# Of the first scene: texts that lie on another, and texts that lie on the centre of another body than their own.
COVERED = """const s = steplap.page.scenes[0], pose = s.look(steplap.page.time(), s.seenFrom, s.magnification), m = s.svg.getScreenCTM();
    const texts = [...s.svg.querySelectorAll('.name-text, .state-text, .load-text, .value-text')].map((e) => [e, e.getBoundingClientRect()]).filter(([e, r]) => e.textContent && r.width > 0);
    const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom, found = [];
    texts.forEach(([e, r], i) => {
      for (const [other, o] of texts.slice(0, i)) if (meet(r, o)) found.push(`${e.textContent} on ${other.textContent}`);
      for (const body of s.bodies.values()) {
        const [x, y] = s.toScreen(pose(body.name)), p = { x: m.a * x + m.e, y: m.d * y + m.f }, own = e.closest('[data-name-of]');
        if (!body.isLookAlone && own?.dataset.nameOf !== body.name && p.x > r.left && p.x < r.right && p.y > r.top && p.y < r.bottom) found.push(`${e.textContent} over ${body.name}`);
      }
    });
    return found"""
# What the picture marks as having happened: element, sign, words.
HAPPENED = """return [...document.querySelectorAll('.happening')].filter((e) => e.style.display !== 'none').map((e) => [e.dataset.happened, e.querySelector('[data-sign]').dataset.sign, e.querySelector('text').textContent])"""


# Two blocks that stand 1 m apart, and a stone that is thrown from between them without gravity.
THROWN = """title = "thrown"
gravity = [0.0, 0.0]
[simulation]
end = 3.0
step = 1e-2
[[body]]
name = "left"
fixed = true
outline = [[-0.5, 0.0], [-0.4, 0.0], [-0.4, 0.5], [-0.5, 0.5]]
[[body]]
name = "right"
fixed = true
outline = [[0.4, 0.0], [0.5, 0.0], [0.5, 0.5], [0.4, 0.5]]
[[body]]
name = "stone"
mass = 1
inertia = 1
velocity = [100.0, 0.0]
outline = [[-0.1, 0.1], [0.1, 0.1], [0.1, 0.3], [-0.1, 0.3]]
"""


def stem(path):
    return os.path.splitext(os.path.basename(path))[0]


class GalleryTest(base.Page):
    """Every model of the gallery, and two that are hard to draw, as their pages show them at first."""
    @classmethod
    def setUpClass(cls):
        data = os.path.join(os.path.dirname(MODELS), "tests", "data", "pictures", "*.toml")
        cls.models = sorted(glob.glob(os.path.join(MODELS, "machines", "*.toml")) + glob.glob(os.path.join(MODELS, "layouts", "*.toml")) + glob.glob(data))
        cls.models.append(os.path.join(MODELS, "paper", "no_interference.toml"))
        base.steplap("simulate", *cls.models, "-q", "--no-estimate", "-o", "gallery")
        for model in cls.models:
            base.steplap("report", "gallery/" + stem(model), "-q", "-o", f"gallery_{stem(model)}.html")
        cls.browser = base.start_browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()  # the folder is of use to others

    def show_model(self, model):
        self.browser.get("file://" + os.path.join(WORK.name, f"gallery_{stem(model)}.html"))
        self.until(lambda: self.find("body").get_attribute("data-ready") == "true")

    def check_texts(self, where):
        found = self.run_js(BOXES)
        left, top, right, bottom = found["picture"]
        for i, (name, *a) in enumerate(found["texts"]):
            self.assertTrue(a[0] >= left - 1 and a[1] >= top - 1 and a[2] <= right + 1 and a[3] <= bottom + 1, (where, name, a, found["picture"]))
            for other, *b in found["texts"][:i]:
                apart = a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3]
                self.assertTrue(apart, (where, name, other, a, b))

    def check_names_and_arrows(self, where):
        for scene in range(len(self.all(".scene"))):
            for name, found in self.run_js(NAMES, scene):
                self.assertTrue(not found or found[0] == name, (where, scene, name, found))
            for inside in self.run_js(ARROWS, scene):
                self.assertGreater(inside, 3, (where, scene))  # a line and its air

    def check_springs(self):
        found = self.run_js(SPRINGS)
        for i, (name, *a) in enumerate(found["springs"]):
            self.assertGreater(((a[0] - a[2]) ** 2 + (a[1] - a[3]) ** 2) ** 0.5, found["u"], name)  # one sees it
            for other, *b in found["springs"][:i]:
                between = (((a[0] + a[2] - b[0] - b[2]) / 2) ** 2 + ((a[1] + a[3] - b[1] - b[3]) / 2) ** 2) ** 0.5
                self.assertGreater(between, found["u"], (name, other))

    def check_standpoint(self, name, model):
        state = self.run_js("const s = steplap.page.scenes[0]; return [s.seenFrom, s.magnification]")
        is_layout = os.path.dirname(model).endswith("layouts") and name not in NO_DRIVE
        vehicle = ("wagon" if name.startswith("rail_wagon") else "trailer") if is_layout else VEHICLES.get(name)
        self.assertEqual(state[0], "~alongside" if vehicle else "ground")
        turned = self.run_js("""const s = steplap.page.scenes[0]; return Math.max(...[...s.bodies.values()].filter((b) => b.channels).map((b) =>
            { const v = b.channels[2], all = [...v.rest]; return all.reduce((m, x) => Math.max(m, x), -1e9) - all.reduce((m, x) => Math.min(m, x), 1e9); }))""")
        if turned > 0.11:  # twice the bound: it may turn to either side
            self.assertIn(1, self.run_js("const s = steplap.page.scenes[0]; return [...s.usualFactors(s.seenFrom).values()]"))
        # The picture says what is magnified and from where it is seen.
        self.assertEqual(self.find(".motion-text").text.startswith("motion"), state[1] != 1)
        if vehicle:
            self.assertEqual(self.run_js("const s = steplap.page.scenes[0]; return s.standpointText(s.seenFrom)"), f"moves along with {vehicle}")

    def check_extents(self):
        for name, scale, *box in self.run_js(EXTENTS):
            self.assertAlmostEqual(scale, 1, delta=1e-3, msg=name)
            for drawn, wanted in zip(box[:4], box[4:]):
                self.assertAlmostEqual(drawn, wanted, delta=1e-5 * max(map(abs, box)), msg=name)  # single precision of the browser

    def check_scale(self):
        text, pixels, scale = self.run_js("""const s = steplap.page.scenes[0], d = s.scaleBar.getBBox();
            return [s.scaleText.textContent.replace('\\u00a0', ' '), d.width, s.scale]""")
        number, unit = text.split()
        self.assertAlmostEqual(float(number) * {"mm": 1e-3, "m": 1.0, "km": 1e3}[unit] * scale, pixels, delta=1.0)

    def check_magnification(self):
        """Magnified motion is a twentieth of the machine, and never less than the motion. Returns the number of magnified bodies."""
        diagonal, bodies = self.run_js("""const s = steplap.page.scenes[0], diagonal = Math.hypot(...s.still.span);
            return [diagonal, [...s.bodies.values()].filter((b) => b.moves).map((b) => [b.name, s.factorOf(b.name, s.seenFrom, s.magnification), s.motionOf(b, s.seenFrom).displacement])]""")
        for name, factor, displacement in bodies:
            self.assertGreaterEqual(factor, 1, name)
            if factor > 1:
                self.assertLessEqual(factor * displacement, DRAWN_MOTION * diagonal * (1 + 1e-9), name)
        return sum(factor > 1 for _, factor, _ in bodies)

    def check_loads(self, name):
        """Every load has a sentence, a curve and an arrow. Sizes and times are those of the model files."""
        told = self.run_js("return [...document.querySelectorAll('.cause:not(.more) p')].map((p) => p.textContent.replaceAll('\u00a0', ' '))")
        self.assertTrue(told, name)
        self.assertEqual(len(self.all(".cause-curve")), len(told))
        self.assertGreater(len(self.all(".load-text")), 0, told)
        self.assertTrue(told[0].startswith(LOADS.get(name, "")), told)

    def check_opening(self):
        """With limits the page opens where one is nearest, or where a joint has slid. Returns whether there are limits and no joint slid."""
        worst, reason, is_judged, t = self.run_js("""const o = steplap.overview.of(steplap.data.runs[0]);
            return [o.worst_instant, o.reason, o.utilisations.some((u) => u.is_judged), steplap.page.time()]""")
        is_at_limit = is_judged and not reason.startswith("Joint")
        if is_at_limit:
            self.assertAlmostEqual(t, worst, delta=1e-12)
        return is_at_limit

    def test_pages_as_they_open(self):
        """One visit for all checks: a page takes longer to load than to be checked."""
        magnified = at_limit = 0
        for model in self.models:
            with self.subTest(model=stem(model)):
                self.show_model(model)
                at_limit += self.check_opening()
                magnified += self.check_magnification()
                self.check_loads(stem(model))
                self.check_standpoint(stem(model), model)
                self.check_springs()
                self.check_extents()
                self.check_scale()
                for part in (0, 0.35, 1):
                    self.run_js("steplap.page.show(arguments[0] * steplap.data.runs[0].end)", part)
                    self.check_texts(part)
                    self.check_names_and_arrows(part)
        self.assertGreater(magnified, 10)
        self.assertGreater(at_limit, 10)

    def test_two_runs_beside_each_other_are_drawn_as_well_as_one(self):
        base.steplap("simulate", os.path.join(MODELS, "paper", "interference.toml"), "-q", "--no-estimate", "-o", "gallery", "-f")
        pairs = [("no_interference", "interference"), ("three_limb", "five_limb"), ("stacked_blocks", "cradle"), ("tank_with_lid", "crane_arm"), ("rail_wagon_humping", "forklift")]
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        for pair in pairs:
            base.steplap("report", *["gallery/" + name for name in pair], "-q", "-f", "-o", "pair.html")
            for width in (1300, 820, 390):
                with self.subTest(pair=pair, width=width):
                    self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
                    self.open("pair.html")
                    for part in (0, 0.35, 1):
                        self.run_js("steplap.page.show(arguments[0] * Math.max(...steplap.data.runs.map((r) => r.end)))", part)
                        self.check_names_and_arrows(part)
                    if pair[1] == "interference":  # a criterion of both joints, of which another one is the worst in each
                        heads = self.run_js("return [...document.querySelectorAll('#limits h4')].map((h) => h.textContent)")
                        self.assertIn("joint margin (back joint) / joint margin (front joint)", heads)

    def test_names_leave_each_other_room_on_a_telephone(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": PHONE[0], "height": PHONE[1], "deviceScaleFactor": 2, "mobile": True})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        for model in self.models:
            with self.subTest(model=stem(model)):
                self.show_model(model)
                named = self.run_js("return [...steplap.page.scenes[0].marks.values()].filter((mark) => mark.spot).length")
                if len(self.all(".body")) <= 8:  # what is larger may be too crowded for this screen
                    self.assertEqual(named, self.run_js("return steplap.page.scenes[0].marks.size"))
                for part in (0, 0.35, 1):
                    self.run_js("steplap.page.show(arguments[0] * steplap.data.runs[0].end)", part)
                    self.check_texts(part)
                    self.check_names_and_arrows(part)

    def test_springs_to_the_ground_keep_two_thirds_of_their_drawn_length(self):
        for model in ("three_limb", "no_interference", "tank_with_lid"):
            self.open(f"gallery_{model}.html")
            lengths = self.run_js("""const s = steplap.page.scenes[0], springs = s.symbols.springs.filter((o) => o.shape.at.some((p) => s.isHeld(p.body) || s.carrierOf(p.body) === 'ground'));
                return springs.filter((o) => Math.abs(o.shape.direction[1]) > 0.7).map((o) => s.poses.map((pose) => { const [a, b] = s.symbols.springEnds(o, pose); return b[1] - a[1]; }))""")
            self.assertGreater(len(lengths), 0)
            for along in lengths:
                self.assertGreater(min(map(abs, along)), 0.6 * max(map(abs, along)), model)  # 2/3, and the tilt of the body
                self.assertGreater(min(along) * max(along), 0, model)  # none hangs upside down

    def test_the_start_pose_is_dashed_where_a_body_has_left_it(self):
        self.open("gallery_stacked_blocks.html")
        ghosts = lambda t: (self.run_js("steplap.page.show(arguments[0])", t), {e.get_attribute("data-ghost-of") for e in self.all(".ghost") if e.value_of_css_property("display") != "none"})[1]
        self.assertEqual(ghosts(0), set())
        self.assertEqual(ghosts(1.5), {"top block"})  # it slides 0.15 m on the one below
        self.find("[data-layer=ghosts]").click()
        self.assertEqual(self.find(".ghosts").value_of_css_property("display"), "none")

    def test_layers_are_switched(self):
        self.open("gallery_three_limb.html")
        shown = {"names": ".names", "forces": ".forces", "springs": ".spring", "contacts": ".contact", "ghosts": ".ghosts"}
        for layer, selector in shown.items():
            self.assertNotEqual(self.find(selector).value_of_css_property("display"), "none", layer)
            self.find(f"[data-layer={layer}]").click()
            self.assertEqual({e.value_of_css_property("display") for e in self.all(selector)}, {"none"}, layer)
            self.find(f"[data-layer={layer}]").click()
            self.assertNotEqual(self.find(selector).value_of_css_property("display"), "none", layer)

    def test_parts_look_as_what_they_are(self):
        self.open("gallery_three_limb.html")
        count = lambda selector: len(self.all(selector))
        self.assertEqual(count(".tyre"), 10)  # two rows of five
        self.assertEqual(count("[data-body='active part'] .winding:not(.turns)"), 6)  # three limbs, both sides of each
        self.assertEqual((count(".foot"), count("[data-body=tank] .wood:not(.grain)"), count("[data-body=tank] .wall"), count("path.road.line")), (2, 2, 1, 1))
        # Wheels stand on the road, whatever is magnified.
        gap = self.run_js("return document.querySelector('path.road').getBoundingClientRect().top - document.querySelector('.tyre').getBoundingClientRect().bottom")
        self.assertAlmostEqual(gap, 0, delta=2)  # the line around the tyre

    def test_the_load_is_an_arrow_with_its_size(self):
        self.open("gallery_three_limb.html")
        at = lambda t: (self.run_js("steplap.page.show(arguments[0])", t), self.find("[data-load=drive]").text.replace("\u00a0", " "), "acting" in self.find(".drive.load").get_attribute("class").split())[1:]
        self.assertEqual(at(0.322), ("road braking 0.8 g", True))
        self.assertEqual(at(0.15), ("road braking 0.4 g", True))  # half of the rise from 0.1 s to 0.2 s
        self.assertEqual(at(0.05), ("road braking, 0.8 g at most", False))
        self.assertEqual(len(self.all("[data-load]")), 1)  # the road strips stand still: nothing loads them
        # The brake of a truck that tips acts at its front wheels: half a second after its start half of 0.6 g, as the rise of 1 s has it.
        self.open("gallery_forklift.html")
        self.run_js("steplap.page.show(0.7)")
        self.assertEqual(self.find("[data-load=brake]").text.replace("\u00a0", " "), "braking 0.3 g")

    def test_a_lens_shows_a_slide_that_is_too_small_to_be_seen(self):
        """Of 2.2 mm the lens draws 0.6 of its radius, of half the slide half as much. A slide of 145 mm needs no lens."""
        self.open("gallery_three_limb.html")
        self.assertEqual(self.find(".lens-text").text.replace("\u00a0", " "), "slide up to 2.2 mm, limit 3 mm")
        length = """const s = steplap.page.scenes[0], t = arguments[0]; steplap.page.show(t);
            const [x0, y0, x1, y1] = s.lens.group.querySelector('.lens-arrow').getAttribute('d').match(/-?[0-9.]+/g).slice(0, 4).map(Number);
            return [Math.hypot(x1 - x0, y1 - y0) / s.lens.r, steplap.data.runs[0].channel('feet.slide').at(t)]"""
        drawn = {t: self.run_js(length, t) for t in (0.2, 0.322)}
        for share, slide in drawn.values():
            self.assertAlmostEqual(share, 0.6 * abs(slide) / 2.203e-3, delta=0.01)  # half a pixel of 62
        self.assertGreater(drawn[0.322][0], 1.1 * drawn[0.2][0])  # it grows
        self.open("gallery_stacked_blocks.html")
        self.assertEqual(len([e for e in self.all(".lens") if e.is_displayed()]), 0)

    def test_no_label_lies_on_another_or_hides_the_middle_of_a_body(self):
        names = ["no_interference", "three_limb", "five_limb_humping", "rail_wagon", "rail_wagon_humping", "single_phase_two_limb_bump", "forklift", "crane_arm", "stacked_blocks", "hoist",
                 "tank_with_lid", "braking_car"]
        models = [model for model in self.models if stem(model) in names]
        self.assertEqual(len(models), 12)
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        for width in (1200, PHONE[0]):
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
            for model in models:
                with self.subTest(model=stem(model), width=width):
                    self.show_model(model)
                    self.assertEqual(self.run_js(COVERED), [])

    def test_the_page_opens_where_one_sees_what_happened(self):
        """The angle of the brick and the slide of the blocks are extremes of the runs; the truck comes down on its forks at 2.95 s."""
        opened = lambda name, channel: (self.open(f"gallery_{name}.html"), self.run_js("return steplap.page.time()"), self.run_js("const e = steplap.data.runs[0].summary.extremes[arguments[0]]; return [e.t_min, e.t_max, e.min, e.max]", channel))[1:]
        t, (_, _, low, high) = opened("forklift", "truck.theta")
        self.assertTrue(2.5 < t < 2.96, t)
        lean = self.run_js("return Math.abs(steplap.data.runs[0].channel('truck.theta').at(steplap.page.time()))")
        self.assertGreater(lean, 0.3)  # 17 degrees: nobody takes it for upright
        self.assertTrue(self.find("[data-ghost-of=truck]").is_displayed())
        t, _ = opened("stacked_blocks", "top block.x")
        self.assertAlmostEqual(t, 1.03, delta=0.02)  # where the top block has come to rest
        self.assertTrue(self.find("[data-ghost-of='top block']").is_displayed())
        # True motion is drawn as it is: 145.5 mm.
        shift, scale = self.run_js("const s = steplap.page.scenes[0], pose = s.look(steplap.page.time(), s.seenFrom, s.magnification); return [s.shiftOf(s.body('top block'), pose), s.factorOf('top block', s.seenFrom, s.magnification)]")
        self.assertAlmostEqual(shift, 0.1455, delta=1e-3)
        self.assertEqual(scale, 1)

    def test_the_picture_keeps_the_machine_when_a_part_flies_off(self):
        with open(os.path.join(WORK.name, "thrown.toml"), "w", encoding="utf-8") as file:
            file.write(THROWN)
        base.steplap("simulate", "thrown.toml", "-q", "--no-estimate", "-o", "gallery", "-f")
        base.steplap("report", "gallery/thrown", "-q", "-f", "-o", "thrown.html")
        self.open("thrown.html")
        # The stone ends 300 m away. The machine has at least a quarter of the picture: 1 of 1 + 2 * 0.75, less margins.
        share = self.run_js("const s = steplap.page.scenes[0]; return s.scale * s.still.span[0] / s.width")
        self.assertGreater(share, 0.25)

    def test_time_ends_with_the_last_event_that_counts(self):
        self.open("gallery_pile.html")
        last = self.run_js("return Math.max(...steplap.data.runs[0].events.filter((e) => steplap.signs.has(e[4])).map((e) => e[0]))")
        shown = lambda: float(self.find("#time").get_attribute("max"))
        self.assertLess(last, 2.5)
        self.assertEqual(shown(), 10)  # the page opens at the first state that is written after the fall
        self.find("#whole-time").click()
        self.assertEqual(shown(), self.run_js("return steplap.data.runs[0].end"))
        self.open("gallery_three_limb.html")  # events until 0.79 s of 1.2 s
        self.assertEqual(shown(), 1.2)
        self.assertFalse(self.find("#whole-time").is_displayed())

    def test_what_lifted_is_marked_from_when_it_does(self):
        self.open("gallery_no_interference.html")
        events = self.run_js("return steplap.data.runs[0].events.filter((e) => e[1] === 'rear foot' && e[4]).map((e) => [e[0], e[4]])")
        (opened, role), (closed, _) = events[:2]
        self.assertEqual(role, "open")
        at = lambda t: {name: (sign, words) for name, sign, words in (self.run_js("steplap.page.show(arguments[0])", t), self.run_js(HAPPENED))[1]}
        self.assertNotIn("rear foot", at(0.999 * opened))
        self.assertEqual(at(0.5 * (opened + closed))["rear foot"], ("open", "rear foot lifts"))
        self.assertEqual(at(1.001 * closed)["rear foot"], ("open", "rear foot lifted"))
        self.assertIn("moved", self.find(".contact[data-element='rear foot']").get_attribute("class").split())
        self.assertNotIn("tank bottom", at(1.0))  # friction has its own words

    def test_where_many_lift_colour_tells_it_alone(self):
        self.open("gallery_pile.html")
        self.run_js("steplap.page.show(steplap.data.runs[0].end)")
        self.assertEqual(self.run_js(HAPPENED), [])
        self.assertGreater(self.run_js("return steplap.page.scenes[0].moved.size"), 5)

    def test_between_states_far_apart_the_picture_says_that_it_is_not_the_motion(self):
        note = lambda t: (self.run_js("steplap.page.show(arguments[0])", t), self.find(".seen-text").text)[1]
        self.open("gallery_pile.html")  # states each 10 s, all falls within three
        self.assertEqual(self.run_js("return steplap.page.time()"), 10)  # the first state that is written after the fall
        self.assertIn("not the motion", note(0.25))
        self.assertEqual(note(10), "")
        self.open("gallery_no_interference.html")
        for t in (0.0503, 0.1218, 0.3):
            self.assertNotIn("not the motion", note(t))

    def test_the_bar_of_friction_that_slips_is_no_criterion(self):
        self.open("gallery_no_interference.html")
        found = {name: (text, style) for name, text, style in self.run_js("""return [...document.querySelectorAll('.utilisation')].map((u) =>
            ['.who', '.of-limit', '.percent'].map((s, i) => i < 2 ? u.querySelector(s).textContent : u.querySelector(s).className))""")}
        self.assertEqual(found["tank bottom: friction"], ("it slips", "percent plain"))
        self.assertEqual({style for _, style in found.values()}, {"percent plain", "percent good"})  # the verdict is "hold"

    def test_values_leave_each_other_room(self):
        self.open("gallery_pile.html")
        self.find("#values").click()
        for part in (0.3, 0.5, 1):
            self.run_js("steplap.page.show(arguments[0] * steplap.data.runs[0].end)", part)
            found = self.run_js(WRITTEN)
            values = [f[:2] for f in found if f[0]]
            self.assertGreater(len(values), 8, part)
            for i, (_, name, *a) in enumerate(found):
                for _, other, *b in found[:i]:
                    apart = a[0] >= b[2] - 0.5 or b[0] >= a[2] - 0.5 or a[1] >= b[3] - 2 or b[1] >= a[3] - 2  # digits are lower than their box
                    self.assertTrue(apart, (part, name, other, a, b))
            # The largest force has its value, and the picture says how many are left out.
            t, largest = self.run_js("""const run = steplap.data.runs[0], t = steplap.page.time(), s = steplap.page.scenes[0];
                const forces = [...s.svg.querySelectorAll('.force')].map((e) => run.channel(`${e.dataset.element}.force`)).filter(Boolean).map((c) => [c.at(t), c.name]);
                return [t, forces.sort((a, b) => b[0] - a[0])[0][1]]""")
            self.assertIn(largest.rsplit(".", 1)[0], [v[0] for v in values], (part, t))
            shown, all_ = self.run_js("return [steplap.page.scenes[0].symbols.shownValues.shown, steplap.page.scenes[0].symbols.shownValues.all]")
            self.assertEqual(shown, len(values))
            if shown < all_:
                self.assertEqual(self.find(".seen-text").text, f"{shown} of {all_} values; closer for more")

    def test_what_broke_is_marked(self):
        data = os.path.join(os.path.dirname(MODELS), "tests", "data", "cores", "tie_that_breaks_first.toml")
        base.steplap("simulate", data, "-q", "--no-estimate", "-o", "gallery")
        base.steplap("report", "gallery/tie_that_breaks_first", "-q", "-o", "broken.html")
        self.open("broken.html")
        broken = self.run_js("return steplap.data.runs[0].events.filter((e) => e[4] === 'break').map((e) => [e[0], e[1]])")
        self.assertGreater(len(broken), 0)
        t, name = broken[0]
        self.run_js("steplap.page.show(arguments[0])", 0.999 * t)
        self.assertNotIn(name, [h[0] for h in self.run_js(HAPPENED)])
        self.run_js("steplap.page.show(arguments[0])", 1.001 * t)
        self.assertIn([name, "break"], [h[:2] for h in self.run_js(HAPPENED)])

    def test_the_true_scale_is_one_click_away(self):
        self.open("gallery_no_interference.html")
        self.assertEqual(self.run_js("return steplap.page.scenes[0].magnification"), "usual")
        for wanted in (1, "usual"):
            self.run_js("document.querySelector('.motion-text').dispatchEvent(new MouseEvent('click', { bubbles: true }))")
            self.assertEqual(self.run_js("return steplap.page.scenes[0].magnification"), wanted)
            self.assertEqual(self.find("#magnification").get_attribute("value"), str(wanted))

    def test_what_slipped_is_named_in_colour_and_what_holds_is_not(self):
        self.open("gallery_stacked_blocks.html")
        texts = lambda: [e.text for e in self.all(".state-text") if e.text]
        self.run_js("steplap.page.scenes[0].setMoved(['top friction']); steplap.page.show(0)")
        self.assertEqual(texts(), [])
        self.run_js("steplap.page.show(1.5)")
        self.assertEqual(texts(), ["top block slid"])

    def test_windows_of_a_core_are_open(self):
        self.open("gallery_five_limb.html")
        # In the middle of each of the four windows nothing of the yokes is there, at the yoke something is.
        seen = lambda x, y: self.run_js("""const s = steplap.page.scenes[0], k = s.svg.getBoundingClientRect(), [px, py] = s.toScreen([arguments[0], arguments[1]]);
            s.svg.scrollIntoView({ block: 'center' }); const r = s.svg.getBoundingClientRect();
            return document.elementsFromPoint(r.left + px * r.width / s.width, r.top + py * r.width / s.width).map((e) => e.closest('.body')).filter(Boolean).map((e) => e.dataset.body)""", x, y)
        self.run_js("steplap.page.show(0)")  # beside the windings, where the core stands as it was built
        for x in (-2.4, -0.8, 0.8, 2.4):
            self.assertNotIn("active part", seen(x, 1.75))
        self.assertIn("active part", seen(0.8, 1.75 + 1.34))


class PictureTest(base.Page):
    @classmethod
    def setUpClass(cls):
        cls.downloads = os.path.join(WORK.name, "downloads")
        os.mkdir(cls.downloads)
        names = ("ladder", "ball_on_incline", "cradle", "crane_arm", "watt_linkage", "tank_with_lid")
        models = [os.path.join(MODELS, "machines", name + ".toml") for name in names]
        base.steplap("simulate", *models, "-q", "-o", "out")
        with open(models[4], encoding="utf-8") as file, open(os.path.join(WORK.name, "gentle.toml"), "w", encoding="utf-8") as gentle:
            gentle.write(file.read().replace("peak = 2500.0", "peak = 1000.0"))
        base.steplap("simulate", "gentle.toml", "-q", "-o", "out")
        for name in names:
            base.steplap("report", "out/" + name, "-q", "-o", name + ".html")
        base.steplap("report", "out/watt_linkage", "out/gentle", "-q", "-o", "two.html")
        base.steplap("report", "out/crane_arm", "out/cradle", "-q", "-o", "unlike.html")
        base.steplap("simulate", os.path.join(MODELS, "machines", "brick_wall.toml"), "-q", "-o", "out", "--set", "simulation.end=1.0",
                     "--set", "output.step=0.5")
        base.steplap("report", "out/brick_wall", "-q", "-o", "brick_wall.html")
        base.steplap("modes", models[5], "-q", "-o", "modes.csv", "--report", "modes.html")
        cls.browser = base.start_browser()
        cls.browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": cls.downloads})

    def phone(self, page):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": PHONE[0], "height": PHONE[1], "deviceScaleFactor": 2, "mobile": True})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        self.open(page)

    def scene(self, expression):
        return self.run_js(f"const scene = steplap.page.scenes[0]; return {expression}")

    def saved(self, ending):
        self.until(lambda: any(os.path.getsize(path) for path in glob.glob(os.path.join(self.downloads, "*." + ending))))
        path = glob.glob(os.path.join(self.downloads, "*." + ending))[0]
        with open(path, "rb") as file:
            content = file.read()
        os.remove(path)
        return os.path.basename(path), content

    # --- what is there is drawn --------------------------------------------------------------------

    def test_balls_are_circles_of_their_radius(self):
        self.open("cradle.html")
        balls = self.all(".body .round")
        self.assertEqual(len(balls), 5)
        wanted = 2 * 0.025 * self.scene("scene.scale")
        for ball in balls:
            box = self.run_js("const b = arguments[0].getBoundingClientRect(); return [b.width, b.height]", ball)
            for side in box:
                self.assertAlmostEqual(side, wanted, delta=3)  # the line around it
        self.assertEqual(len(self.all(".body path:not(.spoke)")), 0)  # no box of an inertia
        self.assertEqual(len(self.all(".rod")), 5)

    def test_an_incline_is_seen_and_a_contact_is_no_rod(self):
        self.open("ball_on_incline.html")
        line = self.run_js("""const m = document.querySelector('.floor').getCTM(), s = steplap.page.scenes[0];
            const [x0, y0, x1, y1] = s.ground.segments[0]; return [...s.toScreen([x0, y0]), ...s.toScreen([x1, y1])]""")
        slope = (line[3] - line[1]) / (line[2] - line[0])
        self.assertAlmostEqual(slope, 0.36397, delta=1e-4)  # tan 20°, downwards on the screen
        self.assertEqual(len(self.all(".floor .edge")), 1)
        self.assertEqual(len(self.all(".rod")), 0)
        # The ball touches it: its centre is its radius away, all the way down.
        for t in (0.0, 0.6, 1.1):
            self.run_js("steplap.page.show(arguments[0])", t)
            distance = self.run_js("""const s = steplap.page.scenes[0], [x, y] = s.poseAt('ball', arguments[0]);
                return x * Math.sin(Math.PI / 9) + y * Math.cos(Math.PI / 9)""", t)
            self.assertAlmostEqual(distance, 0.06, delta=1e-4)

    def test_half_planes_are_hatched_on_their_solid_side(self):
        self.open("ladder.html")
        self.assertEqual(len(self.all(".plane")), 2)
        sides = self.run_js("""return [...document.querySelectorAll('.plane')].map((plane) => {
            const box = (e) => { const b = e.getBBox(); return [b.x + b.width / 2, b.y + b.height / 2]; };
            const a = box(plane), b = box(plane.nextSibling); return [b[0] - a[0], b[1] - a[1]]; })""")
        floor, wall = sides
        self.assertGreater(floor[1], 1)  # below, on the screen
        self.assertLess(wall[0], -1)  # to the left

    def test_motors_are_arcs_and_ropes_are_lines_over_their_points(self):
        self.open("crane_arm.html")
        self.assertEqual(len(self.all(".arc.motor")), 2)
        self.assertEqual(len(self.all(".rope:not(.slack)")), 1)
        self.assertEqual(len(self.all(".rod")), 0)

    def test_values_on_demand(self):
        self.open("ladder.html")
        self.run_js("steplap.page.show(1)")
        self.assertEqual({e.text for e in self.all(".value-text")}, {""})
        self.find("#values").click()
        texts = {e.get_attribute("data-value-of"): e.text.replace("\u00a0", " ") for e in self.all(".value-text")}
        self.assertEqual(texts["foot"], "137.3 N")  # 14 kg g
        self.assertEqual(texts["head"], "36.8 N")  # tan 15° of it
        # Arrows to one scale: as long as the forces are large.
        lengths = self.run_js("""return ['foot', 'head'].map((name) => { const b = document.querySelector(`.force[data-element=${name}]`).getBBox();
            return Math.max(b.width, b.height); })""")
        self.assertAlmostEqual(lengths[1] / lengths[0], 0.268, delta=0.01)

    def test_outlines_press_each_other_with_arrows(self):
        self.open("brick_wall.html")
        self.run_js("steplap.page.show(1)")
        # From the middle of what touches upwards: 62.5 mm before the centre of brick 1.1, and of 2.1. What they give way by is drawn
        # magnified: the arrow begins at the top of one or at the bottom of the other.
        top, bottom = self.scene("""(() => { const pose = scene.look(1, scene.seenFrom, scene.magnification), at = (body, point) =>
            scene.toScreen(scene.placed({ body, point }, pose)); return [at('brick 1.1', [-0.0625, 0.035]), at('brick 2.1', [0, -0.035])]; })()""")
        found = self.run_js("""const d = document.querySelector('.force[data-element="brick 2.1 on 1.1"]').getAttribute('d');
            return d.match(/-?[0-9.]+/g).slice(0, 4).map(Number)""")
        self.assertAlmostEqual(found[0], top[0], delta=0.5)
        self.assertAlmostEqual(min(abs(found[1] - top[1]), abs(found[1] - bottom[1])), 0.0, delta=0.5)
        self.assertAlmostEqual(found[2], found[0], delta=0.1)
        self.assertLess(found[3], found[1])
        self.find("#values").click()
        texts = {e.get_attribute("data-value-of"): e.text.replace("\u00a0", " ") for e in self.all(".value-text")}
        self.assertEqual(texts["brick 1.1 on ground"], "1.03 kN")  # half of 210 kg
        self.assertEqual({e.text for e in self.all(".state-text")}, {""})  # ten that stick would hide the wall

    def test_trails_show_the_way(self):
        self.open("watt_linkage.html")
        self.run_js("const s = document.getElementById('trails'); s.value = 'link'; s.dispatchEvent(new Event('change')); steplap.page.show(2)")
        box = self.run_js("const b = document.querySelector('[data-trail=link]').getBBox(); return [b.width, b.height]")
        self.assertGreater(box[1], 20)
        self.assertLess(box[0], 1)  # Watt's: straight, to a pixel
        self.assertEqual(len(self.all(".trail")), 1)

    def test_a_body_whose_motion_is_not_written_is_not_taken_for_one_that_rests(self):
        base.steplap("simulate", os.path.join(MODELS, "machines/watt_linkage.toml"), "-q", "-o", "some", "--no-estimate",
                     "--set", "output.channels=['link.*']", "--report")
        self.open("some/watt_linkage/report.html")
        self.assertEqual({e.get_attribute("data-body") for e in self.all(".body.unrecorded")}, {"left arm", "right arm"})
        self.assertIn("not among the channels", self.find("#legend").text)
        # From the link the arms would seem to move, and nothing is far magnified for seeming to rest.
        self.assertEqual(set(self.run_js("return [...steplap.page.scenes[0].usualFactors('link').values()]")), {1})

    # --- closer ------------------------------------------------------------------------------------

    def test_wheel_drag_keys_and_buttons_look_closer(self):
        self.open("crane_arm.html")
        time_at_opening = self.run_js("return steplap.page.time()")
        svg = self.find(".scene svg")
        self.run_js("arguments[0].scrollIntoView({block: 'center'})", svg)
        place = """const s = steplap.page.scenes[0], b = s.svg.getBoundingClientRect();
            return s.toPlane((120) * s.width / b.width, (90) * s.width / b.width)"""
        before, scale = self.run_js(place), self.scene("scene.scale")
        self.run_js("""const b = arguments[0].getBoundingClientRect();
            arguments[0].dispatchEvent(new WheelEvent('wheel', { deltaY: -400, ctrlKey: true, clientX: b.left + 120, clientY: b.top + 90, cancelable: true }))""", svg)
        self.assertGreater(self.scene("scene.scale"), 1.5 * scale)
        for now, then in zip(self.run_js(place), before):  # what is under the pointer stays
            self.assertAlmostEqual(now, then, delta=1.0 / scale)  # events have whole pixels
        centre = self.scene("scene.centre")
        ActionChains(self.browser).move_to_element(svg).click_and_hold().move_by_offset(40, 0).release().perform()
        self.assertAlmostEqual((centre[0] - self.scene("scene.centre")[0]) * self.scene("scene.scale"), 40, delta=2)
        svg.send_keys("0")
        self.assertAlmostEqual(self.scene("scene.scale"), scale)
        svg.send_keys("+")
        self.assertAlmostEqual(self.scene("scene.scale"), 1.25 * scale)
        self.find("#whole").click()
        self.find("#closer").click()
        self.assertAlmostEqual(self.scene("scene.scale"), 1.5 * scale)
        self.assertEqual(self.run_js("return steplap.page.time()"), time_at_opening)  # keys moved no time

    def test_two_fingers_on_a_telephone(self):
        self.phone("crane_arm.html")
        svg, scale = self.find(".scene svg"), self.scene("scene.scale")
        self.run_js("arguments[0].scrollIntoView({block: 'center'})", svg)
        x, y = self.run_js("const b = arguments[0].getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2]", svg)
        def touch(kind, spread):
            points = [{"x": x - spread, "y": y, "id": 1}, {"x": x + spread, "y": y, "id": 2}] if spread else []
            self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setTouchEmulationEnabled", {"enabled": False})
        touch("touchStart", 30)
        for spread in (40, 50, 60):
            touch("touchMove", spread)
        touch("touchEnd", 0)
        self.until(lambda: self.scene("scene.scale") > 1.7 * scale)

    # --- compared, taken home, on a telephone ---------------------------------------------------------

    def test_compared_panels_have_the_same_scales(self):
        self.open("two.html")
        ranges = self.run_js("return steplap.page.plots.plots.map((p) => [p.figure.name, ...p.graph.yAxisRange(), p.scale.unit])")
        self.assertEqual(len(ranges), 4)
        for a, b in zip(ranges[::2], ranges[1::2]):
            self.assertEqual(a, b)
        scales = self.run_js("return steplap.page.scenes.map((s) => [s.scale, s.width, s.height, ...s.centre, s.largestForce])")
        self.assertEqual(scales[0], scales[1])
        # A toy beside a crane has its own.
        self.open("unlike.html")
        scales = self.run_js("return steplap.page.scenes.map((s) => s.scale)")
        self.assertGreater(scales[1], 5 * scales[0])
        # Zoomed in, too.
        self.open("two.html")
        self.run_js("steplap.page.plots.plots[0].graph.updateOptions({ dateWindow: [0.5, 1] })")
        ranges = self.run_js("return steplap.page.plots.plots.map((p) => [...p.graph.xAxisRange(), ...p.graph.yAxisRange()])")
        self.assertEqual(ranges[0], ranges[1])
        self.assertEqual(ranges[0][:2], [0.5, 1])

    def test_figures_and_curves_are_saved_as_files(self):
        self.open("watt_linkage.html")
        self.run_js("steplap.page.plots.plots[0].graph.updateOptions({ dateWindow: [0.1, 0.3] })")
        self.find(".plot [data-save=csv]").click()
        name, content = self.saved("csv")
        self.assertEqual(name, "Travel.csv")
        rows = list(csv.reader(content.decode().splitlines()))
        self.assertEqual(rows[0], ["t [s]", "link.y [m]"])
        with open(os.path.join(WORK.name, "out/watt_linkage/trajectory.csv"), encoding="utf-8") as file:
            written = list(csv.reader(line for line in file if not line.startswith("#")))
        column = written[0].index("link.y [m]")
        wanted = [(float(r[0]), float(r[column])) for r in written[1:] if 0.1 <= float(r[0]) <= 0.3]
        self.assertEqual(len(rows) - 1, len(wanted))
        for row, (t, y) in zip(rows[1:], wanted):
            self.assertEqual(float(row[0]), t)
            self.assertAlmostEqual(float(row[1]), y, delta=1e-8)  # single precision of 0.1 m
        for selector in (".plot", ".scene"):
            self.find(selector + " [data-save=svg]").click()
            root = xml.etree.ElementTree.fromstring(self.saved("svg")[1])
            self.assertGreater(len(list(root.iter("{http://www.w3.org/2000/svg}path"))), 0)
            self.assertFalse([e for e in root.iter() if e.get("class")])  # it stands alone
            self.find(selector + " [data-save=png]").click()
            content = self.saved("png")[1]
            self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(int.from_bytes(content[16:20], "big"), round(2 * float(root.get("width"))))
        self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])

    def test_pages_fit_a_telephone(self):
        for page in ("two.html", "crane_arm.html", "modes.html"):
            self.phone(page)
            self.assertLessEqual(self.run_js("return Math.max(document.documentElement.scrollWidth, document.body.scrollWidth)"), PHONE[0], page)
            self.assertEqual(self.run_js("return innerWidth"), PHONE[0])

    def test_no_sign_that_a_font_may_lack(self):
        for page in ("two.html", "modes.html", "ladder.html"):
            self.open(page)
            if page != "modes.html":
                self.run_js("document.getElementById('values').click(); steplap.page.show(0.5)")
            for text in self.run_js("""const texts = []; const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
                    while (walk.nextNode()) if (walk.currentNode.parentNode.nodeName !== 'SCRIPT') texts.push(walk.currentNode.data); return texts"""):
                self.assertRegex(text, EVERYWHERE)

    # --- modes --------------------------------------------------------------------------------------

    def test_modes_move_as_their_shapes_say(self):
        self.open("modes.html")
        self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])
        with open(os.path.join(WORK.name, "modes.csv"), encoding="utf-8") as file:
            heads, *rows = list(csv.reader(file))
        shown = self.all("#modes-table tbody tr")
        self.assertEqual(len(shown), len(rows))
        self.run_js("steplap.page.setPlaying(false)")
        for k, row in enumerate(rows):
            shown[k].find_element(By.CSS_SELECTOR, "button").click()
            number = float(re.search(r": ([\d.]+)\u00a0?\s*Hz", self.find("#shown").text).group(1))
            self.assertAlmostEqual(number, float(row[heads.index("natural frequency [Hz]")]), delta=1e-4 * number)
            self.assertIn("vibrates and decays", self.find("#shown").text)
            amplitude = None
            for phase, part in ((0, "real"), (0.25, "imaginary")):
                moved = self.run_js("""const s = steplap.page.scene, rest = steplap.data.modes.rest.lid;
                    return s.poseAt('lid', arguments[0]).map((v, i) => v - rest[i])""", phase)
                shape = [float(row[heads.index(f"lid.{c} {part}")]) for c in ("x", "y", "theta")]
                sign = 1 if part == "real" else -1  # Re(z exp(iφ)) at a quarter of a period
                if amplitude is None:
                    most = max(range(3), key=lambda i: abs(shape[i]))
                    amplitude = moved[most] / shape[most]
                    self.assertGreater(amplitude, 0)
                for m, z in zip(moved, shape):
                    self.assertAlmostEqual(m, sign * amplitude * z, delta=1e-12)  # roundings of metres
        before = [e.get_attribute("transform") for e in self.all(".body")]
        self.find("#play").click()
        self.until(lambda: [e.get_attribute("transform") for e in self.all(".body")][1:] != before[1:])
        self.find("body").send_keys(Keys.NULL)


if __name__ == "__main__":
    unittest.main(argv=["picture_test.py"], verbosity=2)
