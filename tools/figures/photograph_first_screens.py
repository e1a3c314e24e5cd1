#!/usr/bin/python3
"""Takes screenshots of the first screens of twelve pages in light and dark: photograph_first_screens.py STEPLAP PAGES IMAGES.

PAGES contains the pages of runs, of the study slip_probability and of the assessment in the folder arrival. IMAGES receives NAME.png and
NAME_dark.png with 128 colours each.
"""
import io
import os
import subprocess
import sys
import time

from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

PAGES = ["weak_clamping", "three_limb", "five_limb_humping", "rail_wagon_humping", "forklift", "stacked_blocks", "crane_arm",
         "tank_with_lid", "hoist", "slip_probability", "assessment"]
EXPLORED = "models/machines/stacked_blocks.toml"


def photograph(browser, address, path, is_dark):
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                            {"features": [{"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}]})
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1200, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    browser.get(address)
    end = time.monotonic() + 60
    while browser.execute_script("return document.body.dataset.ready === 'false'") and time.monotonic() < end:
        time.sleep(0.1)
    time.sleep(1.0)
    picture = Image.open(io.BytesIO(browser.get_screenshot_as_png())).convert("RGB")
    picture.quantize(128, dither=Image.Dither.NONE).save(path, optimize=True)
    print(path)


def main(program, pages, images):
    os.makedirs(images, exist_ok=True)
    options = Options()
    for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--force-color-profile=srgb"]:
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
    for page in PAGES:
        address = "file://" + os.path.abspath(os.path.join(pages, page + ".html"))
        for is_dark in (False, True):
            photograph(browser, address, os.path.join(images, page + ("_dark" if is_dark else "") + ".png"), is_dark)
    for is_dark in (False, True):
        with subprocess.Popen([program, "explore", EXPLORED, "--no-browser"], stdout=subprocess.PIPE, text=True) as server:
            photograph(browser, server.stdout.readline().strip(), os.path.join(images, "explore" + ("_dark" if is_dark else "") + ".png"),
                       is_dark)
            server.terminate()
    browser.quit()


main(*sys.argv[1:4])
