"""What the module of Python costs beside C++, in CPU time, which a busy machine changes little.

usage: PYTHONPATH=build/release/python python3 tests/tools/python/measure.py PRINT_RUN_TIMES [SAMPLES [SHORT_SAMPLES [RUNS_OF_THE_LEAK]]]
"""
import gc
import resource
import subprocess
import sys
import threading
import time

import numpy as np

import steplap

MODEL, PATH = "models/paper/interference.toml", "element.front block.preload"
CHANNEL = "active part.x"


def resident():
    """kB that the process holds now."""
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))


def run_times(model, count):
    times = []
    for _ in range(count):
        begin = time.thread_time()
        model.run(estimate="never").values
        times.append(time.thread_time() - begin)
    return min(times), sorted(times)[count // 2]


def beside_cpp(program, samples, values_over={}):
    runs = 60
    rounds = []
    over = [f"{key}={value}" for key, value in values_over.items()]
    for _ in range(5):  # by turns, so that what slows the machine slows both
        said = dict(line.split(" ", 1) for line in subprocess.run([program, MODEL, PATH, str(runs), str(max(1, samples // 5)), *over], check=True, capture_output=True, text=True).stdout.splitlines())
        model = steplap.load(MODEL, values_over)
        least, median = run_times(model, runs)
        values = model.value(PATH) * (0.9 + 0.2 * np.arange(max(1, samples // 5)) / max(1, samples // 5))
        before = time.process_time()
        model.samples({PATH: values}, [(CHANNEL, "high")], estimate="never", threads=1)
        rounds.append((float(said["run"].split()[0]), float(said["run"].split()[1]), least, median, float(said["sample"]), (time.process_time() - before) / len(values)))
    c_least, c_median, p_least, p_median = min(r[0] for r in rounds), min(r[1] for r in rounds), min(r[2] for r in rounds), min(r[3] for r in rounds)
    print(*over, f"one run: C++ {1e6 * c_least:.0f} us (median {1e6 * c_median:.0f}), Python {1e6 * p_least:.0f} us (median {1e6 * p_median:.0f})")
    c_sample, p_sample = min(r[4] for r in rounds), min(r[5] for r in rounds)
    print(f"a sample of {samples}: C++ {1e6 * c_sample:.1f} us, Python {1e6 * p_sample:.1f} us, {100 * (p_sample / c_sample - 1):+.1f} %")


def call_overhead():
    """A run that is over at once: nearly all of it is what a call costs."""
    block = steplap.build({"simulation": {"end": 1e-6, "step": 1e-6, "integrator": "rk4"}, "output": {"step": 1e-6, "channels": ["a.x"]}, "body": [{"name": "a", "mass": 1, "inertia": 1}]})
    print(f"a run of one step of one body: {1e6 * run_times(block, 2000)[0]:.0f} us")


def leak(runs):
    model = steplap.load(MODEL, {"simulation.end": 0.001, "output.step": 0.001})
    for _ in range(1000):
        model.run(estimate="never")
    gc.collect()
    first = resident()
    begin = time.process_time()
    for _ in range(runs):
        model.run(estimate="never").values
    print(f"{runs} runs: {first} kB before, {resident()} kB after, {1e6 * (time.process_time() - begin) / runs:.0f} us of CPU time each")


def two_threads():
    """CPU time that two threads of Python get together, over the time that passes; beside it what two processes get on this machine now."""
    model = steplap.load(MODEL)

    def work(count):
        for _ in range(count):
            model.run(estimate="never")

    def cpus(start, count):
        began, cpu = time.monotonic(), time.process_time() + sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
        start(count)
        return (time.process_time() + sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2]) - cpu) / (time.monotonic() - began)

    def threads(count):
        team = [threading.Thread(target=work, args=(count,)) for _ in range(2)]
        for thread in team:
            thread.start()
        for thread in team:
            thread.join()

    def processes(count):
        code = f"import steplap\nm = steplap.load({MODEL!r})\nfor _ in range({count}): m.run(estimate='never')"
        team = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(2)]
        for process in team:
            process.wait()

    count = 100
    print(f"processors at work: one thread {cpus(work, count):.2f}, two threads {cpus(threads, count):.2f}, two processes {cpus(processes, count):.2f}")


if __name__ == "__main__":
    given = [int(a) for a in sys.argv[2:]] + [250, 1000, 1000][len(sys.argv) - 2:]
    beside_cpp(sys.argv[1], given[0])
    beside_cpp(sys.argv[1], given[1], {"simulation.end": 0.001, "output.step": 0.001})
    call_overhead()
    two_threads()
    leak(given[2])
