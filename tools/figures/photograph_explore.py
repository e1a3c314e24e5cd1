#!/usr/bin/python3
"""Takes a screenshot of `steplap explore` for the docs: photograph_explore.py STEPLAP MODEL IMAGE.

The pressure on the joints of the paper's transformer is reduced to a third, and the map of pressure and friction is complete.
"""
import subprocess
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service


def main(program, model, image):
    server = subprocess.Popen([program, "explore", model, "--no-browser"], stdout=subprocess.PIPE, text=True)
    options = Options()
    for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--force-color-profile=srgb"]:
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
    run = browser.execute_script

    def until(condition):
        end = time.monotonic() + 600
        while not run("return Boolean(" + condition + ")"):
            if time.monotonic() > end:
                sys.exit("it did not come about: " + condition)
            time.sleep(0.1)

    try:
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1400, "height": 1080, "deviceScaleFactor": 1, "mobile": False})
        browser.get(server.stdout.readline().strip())
        until("document.body.getAttribute('data-ready') === 'true'")
        pressure, friction = run("""const sliders = steplap.page.sliders, path = (ending) => [...sliders.given.keys()].find((p) => p.startsWith('core.') && p.endsWith(ending));
            const found = [path('.pressure'), path('.static_friction')];
            sliders.shown = []; found.forEach((p) => sliders.add(p)); return found""")
        run("steplap.page.sliders.put(arguments[0], 0.3 * steplap.page.sliders.value(arguments[0]))", pressure)
        run("""for (const [id, path] of [['map-x', arguments[0]], ['map-y', arguments[1]]]) document.getElementById(id).value = path;
            document.getElementById('map-start').click()""", pressure, friction)
        until("steplap.page.map.isWhole")
        until("steplap.page.runs()[1].summary.global_error || steplap.page.runs()[1].summary.error_not_estimated")
        run("document.getElementById('worst').click(); document.activeElement.blur(); scrollTo(0, 0)")
        time.sleep(1)
        browser.save_screenshot(image)
        print(image)
    finally:
        browser.quit()
        server.terminate()
        server.wait()


main(*sys.argv[1:4])
