#!/usr/bin/python3
"""How long `steplap explore` takes from a hand on a slider to the picture, in chromium, and what memory many drags take.

    measure_explore.py STEPLAP MODEL PATH [DRAGS [SAVE.png]]

Moves the slider of PATH through its middle half, a step whenever the last picture is there, and prints milliseconds: from the event of the slider to the
frame that the browser has painted. Of these the part that the server took is what the request lasted. The first 20 drags are left out. Then the memory of
the server (resident) and of the page (JavaScript heap after its garbage is collected), after 200 drags and at the end.
"""
import os
import statistics
import subprocess
import sys
import time

steplap, model, path = sys.argv[1:4]
drags = int(sys.argv[4]) if len(sys.argv) > 4 else 220
picture = sys.argv[5] if len(sys.argv) > 5 else None
sys.argv = [sys.argv[0], steplap, os.path.dirname(model)]
import report_test as base  # noqa: E402: it reads the command line


def resident(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS"))


def processor_seconds(pid):
    with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    server = subprocess.Popen([base.STEPLAP, "explore", model, "--no-browser"], stdout=subprocess.PIPE, text=True)
    address = server.stdout.readline().strip()
    browser = base.start_browser()
    run = browser.execute_script
    try:
        browser.set_window_size(1280, 900)
        browser.get(address)
        while browser.find_element("css selector", "body").get_attribute("data-ready") != "true":
            time.sleep(0.05)
        run("steplap.page.sliders.add(arguments[0])", path)
        time.sleep(1)
        browser.set_script_timeout(3600)

        def drag(count):
            begin = processor_seconds(server.pid)
            result = browser.execute_async_script("""const [path, count, done] = arguments, page = steplap.page, s = page.sliders.rows.get(path).range;
                const low = Number(s.min), high = Number(s.max), asked = [], post = page.answers.post;
                page.answers.post = async function (where, body) { const t = performance.now(), answer = await post.call(this, where, body); if (where === 'run') asked.push(performance.now() - t); return answer; };
                const from = page.latencies.length; page.latencies.length = 0;
                let k = 0, seen = 0;
                const next = () => { if (k === count) { page.answers.post = post; return done([page.latencies.slice(), asked]); }
                  s.value = String(low + (high - low) * (0.5 + 0.25 * Math.sin(++k * 0.7))); s.dispatchEvent(new Event('input', { bubbles: true })); wait(); };
                const wait = () => { if (page.latencies.length > seen) { seen = page.latencies.length; next(); } else setTimeout(wait, 1); };
                next();""", path, count)
            return result, processor_seconds(server.pid) - begin

        def heap():
            browser.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
            return run("return performance.memory.usedJSHeapSize") / 2**20

        (times, asked), seconds = drag(min(drags, 220))
        times, asked = times[20:], asked[20:]
        print(f"{os.path.basename(model)}, {path}: {len(times)} drags")
        print(f"  to the picture: median {statistics.median(times):.0f} ms, worst {max(times):.0f} ms; of this the request: median {statistics.median(asked):.0f} ms")
        print(f"  processor time of the server: {1e3 * seconds / (len(times) + 20):.1f} ms a drag")
        print(f"  memory after {len(times) + 20} drags: server {resident(server.pid):.0f} MB, page {heap():.1f} MB")
        done = len(times) + 20
        while done < drags:
            count = min(500, drags - done)
            drag(count)
            done += count
        if done > 220:
            print(f"  memory after {done} drags: server {resident(server.pid):.0f} MB, page {heap():.1f} MB")
        if picture:
            time.sleep(2)
            browser.save_screenshot(picture)
    finally:
        browser.quit()
        server.terminate()
        server.wait()


main()
