#!/usr/bin/python3
"""Takes screenshots of pages for the docs: photograph_report.py PAGES IMAGES.

PAGES contains paper.html, weak_clamping.html, the sheet arrival.html, and the pages of the studies slip_probability.html and tornado.html.
"""
import base64
import os
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

# image: page; window width; time shown, s (None: the page's own choice); element of the page (None: the first screen)
IMAGES = {
    "report_verdict": ("weak_clamping.html", 1300, None, None),
    "report_machine": ("paper.html", 1280, 0.1218, "#scenes"),
    "report_slipped": ("weak_clamping.html", 1280, 0.1535, "#sheets"),
    "assessment_page": ("arrival.html", 800, None, "#sheet"),
}

# image: page of a study; window width; first and last element of the page to be shown
STUDIES = {
    "study_slip": ("slip_probability.html", 1100, "body", "#plane"),
    "study_tornado": ("tornado.html", 1100, "#indices", "#indices .chart:nth-child(4)"),
}


def photograph_study(browser, page, width, first, last, path):
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    browser.get("file://" + os.path.abspath(page))
    top = browser.execute_script("return document.querySelector(arguments[0]).getBoundingClientRect().top + scrollY", first)
    end = browser.execute_script("return document.querySelector(arguments[0]).getBoundingClientRect().bottom + scrollY", last)
    clip = {"x": 0, "y": top, "width": width, "height": end - top + 8, "scale": 1}
    image = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
    with open(path, "wb") as file:
        file.write(base64.b64decode(image["data"]))
    print(path)


def main(pages, images):
    options = Options()
    for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--force-color-profile=srgb"]:
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
    for image, (page, width, moment, selector) in IMAGES.items():
        browser.set_window_size(width, 900)
        browser.get("file://" + os.path.abspath(os.path.join(pages, page)))
        if moment is not None:
            browser.execute_script("steplap.page.show(arguments[0])", moment)
        height = 850 if selector is None else browser.execute_script("return document.documentElement.scrollHeight")
        browser.set_window_size(width, height + 200)
        time.sleep(0.5)
        path = os.path.join(images, image + ".png")
        if selector is None:
            browser.save_screenshot(path)
        else:
            browser.find_element(By.CSS_SELECTOR, selector).screenshot(path)
        print(path)
    for image, (page, width, first, last) in STUDIES.items():
        photograph_study(browser, os.path.join(pages, page), width, first, last, os.path.join(images, image + ".png"))
    browser.quit()


if __name__ == "__main__":
    main(*sys.argv[1:3])
