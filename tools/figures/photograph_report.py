#!/usr/bin/python3
"""Screenshots of the report's page for the docs: photograph_report.py PAGES IMAGES.

PAGES holds paper.html and weak_clamping.html.
"""
import os
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

# Image: page, width of the window, time shown [s], element of the page
IMAGES = {
    "report_verdict": ("paper.html", 1280, 0.0, "#verdict"),
    "report_machine": ("paper.html", 1280, 0.1218, "#scenes"),
    "report_slipped": ("weak_clamping.html", 1280, 0.1535, "#machine"),
}


def main(pages, images):
    options = Options()
    for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--force-color-profile=srgb"]:
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
    for image, (page, width, moment, selector) in IMAGES.items():
        browser.set_window_size(width, 900)
        browser.get("file://" + os.path.abspath(os.path.join(pages, page)))
        browser.execute_script("steplap.page.show(arguments[0])", moment)
        height = browser.execute_script("return document.documentElement.scrollHeight")
        browser.set_window_size(width, height + 200)
        time.sleep(0.5)
        path = os.path.join(images, image + ".png")
        browser.find_element(By.CSS_SELECTOR, selector).screenshot(path)
        print(path)
    browser.quit()


if __name__ == "__main__":
    main(*sys.argv[1:3])
