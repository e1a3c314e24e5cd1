#!/usr/bin/python3
"""Sheets to be signed in a real browser, of a run, of a static proof and of load cases: one page of A4 whatever they hold.

    sheet_test.py STEPLAP MODELS [--keep FOLDER]
"""
import json
import os
import subprocess
import unittest

import report_test as base

WORK, MODELS = base.WORK, base.MODELS
LORRY = os.path.join(MODELS, "cases", "lorry.toml")
HOSTILE = '''
[[case]]
name = "<b>bold</b>"
source = "</script><script>document.title = 1</script>"
'''


SIGNED = ("Prepared by", "Approved by", "Name", "Date", "Place")
# 23 limits with long sources: no sheet leaves a limit out.
LIMITS = "".join(f'[[acceptance]]\nname = "limit {i}"\nchannel = "transformer.x"\nwithin = {i + 100}\nreason = "{"clause after clause, " * 6}{i}."\n'
                 for i in range(20))
BOLD = '''
title = "</script><script>document.title = 1</script>"
[[acceptance]]
name = "<b>bold</b>"
channel = "slide"
within = "30 mm"
reason = "<i>contract</i>"
'''


def write(name, text):
    with open(os.path.join(WORK.name, name), "w", encoding="utf-8") as file:
        file.write(f'extends = "{LORRY}"\n{text}')


def result(*path):
    with open(os.path.join(WORK.name, *path), encoding="utf-8") as file:
        return json.load(file)


class Sheet(base.Page):
    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()  # the folder stays: both classes use it


class RunSheetTest(Sheet):
    @classmethod
    def setUpClass(cls):
        write("limits.toml", LIMITS)
        write("bold.toml", BOLD)
        paper = [os.path.join(MODELS, "paper", name + ".toml") for name in ("interference", "weak_clamping")]
        layouts = [os.path.join(MODELS, "layouts", name + ".toml") for name in ("five_limb", "rail_wagon")]
        base.steplap("simulate", *paper, *layouts, "limits.toml", "bold.toml", "-q", "-o", "out")
        base.steplap("simulate", LORRY, "-q", "-o", "changed", "--set", "signal.acceleration.peak=-9 m/s^2")
        cls.runs = ["out/" + name for name in ("interference", "weak_clamping", "five_limb", "rail_wagon", "limits", "bold")] + ["changed/lorry"]
        for folder in cls.runs:
            base.steplap("report", folder, "--sheet", "-q")
        done = subprocess.run([base.STEPLAP, "assess", "--static", "road", "--plane", "lengthwise", paper[0], "-o", "road", "-q"], cwd=WORK.name, check=False)
        assert done.returncode in (0, 4, 5), done.returncode
        base.steplap("report", "road", "--sheet", "-q")
        cls.browser = base.start_browser()

    def test_every_sheet_is_one_page_with_room_for_two_signatures(self):
        for folder in [*self.runs, "road"]:
            with self.subTest(folder=folder):
                self.open(folder + "/sheet.html")
                self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])
                sheets = self.print_page(folder.replace("/", "_"))
                self.assertEqual(len(sheets), 1)
                for words in SIGNED:
                    self.assertIn(words, sheets[0])
                self.assertEqual(sheets[0].count("Signature"), 2)

    def test_the_limits_are_those_of_the_run_with_source_error_and_utilisation(self):
        for folder in self.runs:
            with self.subTest(folder=folder):
                summary = result(folder, "summary.json")
                self.open(folder + "/sheet.html")
                rows = self.run_js("return [...document.querySelectorAll('#limits tbody tr')].map((r) => [...r.children].map((c) => c.textContent))")
                criteria = summary["judgement"]["criteria"]
                self.assertEqual(sorted(row[0] for row in rows), sorted(c["name"] for c in criteria))
                used = [float(row[6].split()[0].strip("%<>\u00a0")) for row in rows if row[6] != "–"]
                self.assertEqual(used, sorted(used, reverse=True))  # what is nearest to its limit comes first
                judged = [u["share"] for u in summary["overview"]["utilisations"] if u["is_judged"]]
                self.assertAlmostEqual(used[0], 100 * max(judged), delta=0.5 + 0.005 * 100 * max(judged))  # three digits are shown
                for c in criteria:
                    own = next(row for row in rows if row[0] == c["name"] and (not c["reason"] or row[2] == c["reason"]))
                    self.assertNotIn(own[4], ("", "–"))  # an error, or that it is not known
                    self.assertEqual(own[2], c["reason"] or "not stated")

    def test_the_sheet_names_load_case_machine_digest_and_version(self):
        self.open("changed/lorry/sheet.html")
        sheet, summary = self.print_page("changed")[0], result("changed", "lorry", "summary.json")
        for words in ("trapezoid, peak = -9 m/s^2, duration = 2.5", "changed by signal.acceleration.peak=-9 m/s^2", "drive", summary["overview"]["reason"],
                      summary["model"]["inputs"][0]["sha256"][:16], f"steplap {summary['program']['version']}", "lorry", "transformer"):
            self.assertIn(words, sheet)
        self.assertEqual(len(self.all(".drawing .body")), 2)

    def test_a_static_proof_shows_the_reactions_of_each_part_in_each_case(self):
        proof = result("road", "static.json")["static_proofs"][0]
        self.open("road/sheet.html")
        self.assertGreater(len(self.all(".drawing .body")), 4)
        rows = self.run_js("return [...document.querySelectorAll('.reactions tbody tr')].map((r) => [...r.children].map((c) => c.textContent))")
        wanted = {r["name"] for c in proof["cases"] for r in c["reactions"] if r["unit"] in ("N", "N m")}
        self.assertEqual({row[0] for row in rows}, wanted)
        worst = max((r for c in proof["cases"] for r in c["reactions"] if r["share"] is not None), key=lambda r: r["share"])
        self.assertEqual(rows[0][0], worst["name"])  # the highest utilisation comes first
        self.assertAlmostEqual(float(rows[0][-1].split()[0].strip("%\u00a0")), 100 * worst["share"], delta=0.5)  # whole per cent
        self.assertEqual(len(rows[0]), 1 + len(proof["cases"]) + 2)

    def test_markup_in_names_stays_text(self):
        self.open("out/bold/sheet.html")
        self.assertEqual(self.all("#sheet table b, #sheet i, #sheet script"), [])
        self.assertIn("<i>contract</i>", self.find("#limits").text)
        self.assertEqual(self.browser.title, "steplap run: bold")


class CasesSheetTest(Sheet):
    @classmethod
    def setUpClass(cls):
        write("hostile.toml", HOSTILE)
        write("many.toml", "".join(f'[[case]]\nname = "case {i} with a name of its own"\nsource = "{"a long source, " * 8}"\nset = ["signal.acceleration.peak={-0.1 * (i + 1)}"]\n' for i in range(6)))
        for name, model in (("lorry", LORRY), ("hostile", "hostile.toml"), ("many", "many.toml")):
            base.steplap("cases", model, "-q", "-o", name + ".html")
        cls.browser = base.start_browser()

    def test_opens_without_console_messages(self):
        for name in ("lorry", "hostile", "many"):
            self.open(name + ".html")
            self.assertEqual([m["message"] for m in self.browser.get_log("browser")], [])

    def test_one_sheet_has_all_that_is_signed(self):
        done = subprocess.run([base.STEPLAP, "cases", LORRY, "--json"], check=True, capture_output=True, text=True)
        found = json.loads(done.stdout)["results"][0]["load_cases"]
        for name in ("lorry", "many"):
            self.open(name + ".html")
            sheets = self.print_page("cases_" + name)
            self.assertEqual(len(sheets), 1)
            for case in found["cases"]:
                for word in case["name"].split():  # a cell may break between them
                    self.assertIn(word, sheets[0])
            for words in ("HOLD", "EN 12195-1:2010", *SIGNED, found["model"]["inputs"][0]["sha256"][:16]):
                self.assertIn(words, sheets[0])
            self.assertEqual(sheets[0].count("Signature"), 2)

    def test_the_matrix_has_the_utilisations_of_the_results(self):
        self.open("lorry.html")
        done = subprocess.run([base.STEPLAP, "cases", LORRY, "--json"], check=True, capture_output=True, text=True)
        found = json.loads(done.stdout)["results"][0]["load_cases"]
        rows = self.run_js("return [...document.querySelectorAll('#limits tbody tr')].map((r) => [...r.children].map((c) => c.textContent))")
        self.assertEqual(len(rows), len(found["limits"]))
        for row, limit in zip(rows, found["limits"]):
            for cell, case in zip(row[1:], found["cases"]):
                used = next(one["utilisation"] for one in case["limits"] if one["limit"] == limit["limit"])
                self.assertAlmostEqual(float(cell.split()[0].replace("%", "")), 100 * used, delta=0.5 + 0.005 * 100 * used)  # three digits are shown
            self.assertEqual(found["cases"][int(row[1 + len(found["cases"])]) - 1]["name"], limit["governing_case"])

    def test_the_machine_is_drawn(self):
        self.open("lorry.html")
        size = self.run_js("const r = document.querySelector('.drawing svg').getBoundingClientRect(); return [r.width, r.height]")
        self.assertGreater(min(size), 80)  # pixels: it can be made out
        self.assertEqual(len(self.all(".drawing .body")), 2)

    def test_markup_in_names_stays_text(self):
        self.open("hostile.html")
        self.assertEqual(self.all("#cases b, #cases script"), [])
        self.assertIn("<b>bold</b>", self.find("#cases").text)
        self.assertEqual(self.browser.title, "steplap cases: hostile")


if __name__ == "__main__":
    unittest.main(argv=base.sys.argv[:1], verbosity=2)
