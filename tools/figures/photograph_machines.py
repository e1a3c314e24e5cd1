#!/usr/bin/python3
"""Takes pictures of models/machines for the gallery in the docs: photograph_machines.py PAGES IMAGES.

PAGES contains the reports <machine>.html, and tank_modes.html from steplap modes.
"""
import os
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

# machine: time shown, s; true if values are shown; bodies with trails
MACHINES = {
    "stacked_blocks": (0.75, True, []),
    "tank_with_lid": (0.9, True, []),
    "forklift": (2.4, True, ["load"]),
    "crane_arm": (4.0, True, ["load"]),
    "atwood": (0.35, True, ["heavy", "light"]),
    "rope_pendulum": (1.1, False, ["bob"]),
    "cradle": (0.42, False, ["ball 1", "ball 5"]),
    "ladder": (1.0, True, []),
    "ball_on_incline": (0.9, True, ["ball"]),
    "watt_linkage": (0.2, True, ["link", "left arm", "right arm"]),
    "brick_wall": (3600.0, True, []),
    "pile": (3600.0, True, []),
    "jamming_slide": (0.1, True, []),
    "hoist": (0.02, True, []),
    "balanced_pendulum": (0.02, True, []),
}


def main(pages, images):
    options = Options()
    for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--force-color-profile=srgb", "--window-size=720,640"]:
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))

    def photograph(page, image, script, *arguments):
        browser.get("file://" + os.path.abspath(os.path.join(pages, page)))
        browser.execute_script(script, *arguments)
        picture = browser.find_element(By.CSS_SELECTOR, ".scene > svg")
        browser.execute_script("arguments[0].scrollIntoView()", picture)
        time.sleep(0.2)
        path = os.path.join(images, image + ".png")
        picture.screenshot(path)
        print(path)

    for machine, (moment, has_values, trails) in MACHINES.items():
        photograph(machine + ".html", "machine_" + machine,
                   "for (const s of steplap.page.scenes) { s.withValues = arguments[1]; s.setTrails(arguments[2]); } "
                   "steplap.page.show(arguments[0])", moment, has_values, trails)
    photograph("tank_modes.html", "machine_tank_mode",
               "steplap.page.setPlaying(false); steplap.page.choose(3); steplap.page.show(0)")
    browser.quit()


if __name__ == "__main__":
    main(*sys.argv[1:3])
