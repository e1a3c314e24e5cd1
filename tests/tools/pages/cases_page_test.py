#!/usr/bin/python3
"""The sheet of load cases in a real browser: one page of A4 with drawing, cases, sources and room for signatures.

    cases_page_test.py STEPLAP MODELS [--keep FOLDER]
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


def write(name, text):
    with open(os.path.join(WORK.name, name), "w", encoding="utf-8") as file:
        file.write(f'extends = "{LORRY}"\n{text}')


class CasesPageTest(base.Page):
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
            for words in ("HOLD", "EN 12195-1:2010", "Prepared by", "Approved by", found["model"]["inputs"][0]["sha256"][:16]):
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
        size = self.run_js("const r = document.querySelector('#drawing svg').getBoundingClientRect(); return [r.width, r.height]")
        self.assertGreater(min(size), 80)  # pixels: it can be made out
        self.assertEqual(len(self.all("#drawing .body")), 2)

    def test_markup_in_names_stays_text(self):
        self.open("hostile.html")
        self.assertEqual(self.all("#cases b, #cases script"), [])
        self.assertIn("<b>bold</b>", self.find("#cases").text)
        self.assertEqual(self.browser.title, "steplap cases: hostile")


if __name__ == "__main__":
    unittest.main(argv=base.sys.argv[:1], verbosity=2)
