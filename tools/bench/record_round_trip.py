#!/usr/bin/python3
"""Determines which properties a shock recorder needs, so that its record shows whether a joint of the core slipped.

A model is run. Its acceleration at the recorder's position gives a synthetic record, with low-pass filter, sampling rate, offset, noise and
resolution. `steplap record` reads this record, and the model is run again from rest, with its recorder driven as recorded (`prescribed_motion`)
instead of by the vehicle. The two runs are compared: clamping pressure required by the joints, slip or no slip, time of the first slip, slides.

    tools/bench/record_round_trip.py build/release/bin/steplap             the tables of docs/evidence/recorders.md
    tools/bench/record_round_trip.py build/release/bin/steplap --check     some of them compared with bounds; exit code 1 if exceeded

Random numbers are seeded, so results are reproducible. Only the standard library of Python is needed.
"""
import argparse
import concurrent.futures
import csv
import dataclasses
import functools
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
MODEL = os.path.join(HERE, "..", "..", "models", "paper", "weak_clamping.toml")
GRAVITY = 9.80665  # m/s², unit g of the recorder
LOCAL = 9.81       # m/s², gravity of the model
FINE = 1e-4        # output step of the true run, s
QUIET = 0.5        # duration of rest before the run, from which the offset is determined, s
END = 0.8          # duration of the run, s
JOINTS = ("front joint", "back joint")
FIRM = 80e3        # Pa; at this pressure no joint comes close to slipping in either impact
PATIENCE = 120.0   # largest time for a run, s; runs with unrealistic records may take an hour


@dataclasses.dataclass(frozen=True)
class Impact:
    name: str
    peak: float      # peak acceleration of the vehicle, m/s²
    duration: float  # s
    is_rigid: bool = False # true: the upper part of the tank is welded to the lower one; false: it shears on it


# the paper's emergency stop, and a harder stop as short as the coupling of wagons
STOP = Impact("stop", -5.886, 0.1)
SHUNT = Impact("shunt", -19.62, 0.025)
RIGID_STOP, RIGID_SHUNT = (dataclasses.replace(i, name=i.name + " with a rigid tank", is_rigid=True) for i in (STOP, SHUNT))
# possible positions of the recorder: body, and point in the equilibrium pose; the vehicle's motion is that of the lower tank's centre
PLACES = {"frame": ("lower tank", (0.0, 0.79)), "floor": ("lower tank", (0.0, 0.0)), "far end": ("lower tank", (1.5, 0.79)),
          "wall": ("upper tank", (1.81, 1.95)), "lid": ("upper tank", (0.0, 4.0))}
# pressures relative to those that the joints need: both joints slip at the first, both hold at the second
WEAK, STRONG = 0.875, 1.15


@dataclasses.dataclass(frozen=True)
class Recorder:
    rate: float = 200.0      # sampling rate, Hz
    bits: int = 12
    reach: float = 10.0      # largest reading, g
    noise: float = 5.0       # standard deviation of the noise, mg
    offset: float = 20.0     # offset of both axes, mg
    low_pass: float = 0.4    # -3 dB frequency of the recorder's two-pole filter, relative to the sampling rate; 0: no filter
    frequency_class: int = 0 # channel frequency class with which the file is read; 0: none
    rest: bool = True        # true: the mean over the interval at rest is subtracted; false: gravity only
    tilt: float = 0.0        # rotation of the mounted recorder, degrees
    axes: str = "x"          # axes along which the model is driven
    place: str = "frame"     # position of the recorder, a key of PLACES
    drive: str = "place"     # body with the recorded motion: the recorder's "place", or the "vehicle", such that the record results


def toml(base, impact, pressure, body):
    return (f'extends = "{base}"\ntitle = "round trip"\n[[core]]\nname = "core"\npressure = {pressure!r}\n'
            f'[[signal]]\nname = "braking"\npeak = {impact.peak!r}\nduration = {impact.duration!r}\n'
            + ('[[element]]\nname = "tank joint"\nreplace = true\nkind = "weld"\na = "upper tank"\nb = "lower tank"\n'
               '[[element]]\nname = "tank flexibility"\nremove = true\n' if impact.is_rigid else "")
            + "".join(f'[[marker]]\nname = "{name}"\nbody = "{on}"\nat = [{x!r}, {y!r}]\n' for name, (on, (x, y)) in PLACES.items()) + body)


def steplap(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False, timeout=PATIENCE)
    if done.returncode not in (0, 4): # 4: the verdict is open, which does not matter here
        raise RuntimeError(f"steplap {' '.join(arguments)}: {done.stderr}")
    return done.stdout


def simulate(program, folder, name, text):
    path = os.path.join(folder, name + ".toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    steplap(program, "simulate", path, "-o", os.path.join(folder, "out"), "--no-estimate", "-q", "--force")
    with open(os.path.join(folder, "out", name, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    if not summary["completed"]:
        raise RuntimeError(f"{name} did not come to its end")
    return summary["joints"]


def rows_of(path):
    """Yields the rows of a CSV file of steplap as dictionaries with the column names, without units, as keys."""
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            yield {name.split(" [")[0]: float(value) for name, value in row.items()}


def true_run(program, folder, impact, pressure, name):
    """Runs the model. Returns the joints, and for each place ax, ay and angle from t = -QUIET on."""
    columns = [f"{place}.{axis}" for place in PLACES for axis in ("ax", "ay")]
    body = (f'[output]\nstep = {FINE!r}\nchannels = {json.dumps(columns + ["upper tank.theta"])}\nalso = {json.dumps(columns)}\n'
            f'[simulation]\nend = {END!r}\n')
    joints = simulate(program, folder, name, toml(MODEL, impact, pressure, body))
    histories = {}
    for row in rows_of(os.path.join(folder, "out", name, "trajectory.csv")):
        for key, value in row.items():
            histories.setdefault(key, []).append(value)
    if len(histories["upper tank.theta"]) < END / FINE:
        raise RuntimeError("the run has fewer rows than asked for")
    rest = [0.0] * round(QUIET / FINE)
    return joints, {place: [rest + histories[key] for key in (f"{place}.ax", f"{place}.ay", "upper tank.theta")] for place in PLACES}


def low_passed(values, cutoff):
    """Applies a two-pole Butterworth filter forwards, like an analogue filter before sampling. It delays by 0.225/cutoff."""
    if not cutoff:
        return values
    k = math.tan(math.pi * cutoff * FINE)
    a0 = k * k / (1.0 + math.sqrt(2.0) * k + k * k)
    b1 = 2.0 * a0 * (1.0 / (k * k) - 1.0)
    b2 = 1.0 - 4.0 * a0 - b1
    x1 = x2 = y1 = y2 = values[0]
    filtered = []
    for x in values:
        y = a0 * (x + 2.0 * x1 + x2) + b1 * y1 + b2 * y2
        x2, x1, y2, y1 = x1, x, y1, y
        filtered.append(y)
    return filtered


def write_record(path, motion, recorder, seed):
    """Writes the record: acceleration minus gravity in the recorder's axes, which tilt with the lid; in g."""
    dice = random.Random(seed)
    step = 2.0 * recorder.reach / 2 ** recorder.bits
    ax, ay, angles = motion[recorder.place]
    felt_x, felt_y = [], []
    for x, y, angle in zip(ax, ay, angles):
        turned = angle + math.radians(recorder.tilt)
        c, s = math.cos(turned), math.sin(turned)
        felt_x.append((c * x + s * (y + LOCAL)) / GRAVITY)
        felt_y.append((-s * x + c * (y + LOCAL)) / GRAVITY)
    cutoff = recorder.low_pass * recorder.rate
    felt = [low_passed(felt_x, cutoff), low_passed(felt_y, cutoff)]
    stride = round(1.0 / (recorder.rate * FINE))
    if abs(stride * recorder.rate * FINE - 1.0) > 1e-9:
        raise ValueError("the rate does not divide the rate of the truth")
    with open(path, "w", encoding="utf-8") as file:
        file.write("time [s],x [g],y [g]\n")
        for i in range(0, len(ax), stride):
            fields = []
            for values in felt:
                value = values[i] + 1e-3 * recorder.offset + 1e-3 * recorder.noise * dice.gauss(0.0, 1.0)
                value = min(max(round(value / step) * step, -recorder.reach), recorder.reach - step)
                fields.append(f"{value:.9f}")
            file.write(f"{i * FINE:.4f},{','.join(fields)}\n")


def read_record(program, folder, path, recorder):
    """Reads a record by `steplap record`. Returns the path of the conditioned signal."""
    out = os.path.join(folder, "record")
    options = ["--rest", f"0,{QUIET - 0.05}"] if recorder.rest else ["--gravity", "y"]
    if recorder.frequency_class:
        options += ["--cfc", str(recorder.frequency_class)]
    steplap(program, "record", path, *options, "-o", out, "-q", "--force")
    return os.path.join(out, "signal.csv")


def replay_text(impact, pressure, signal, recorder):
    """Returns a model text that moves the recorder as recorded. "held": this replaces vehicle and springs, and the body does not turn."""
    text = '[simulation]\nvelocity = [0.0, 0.0]\n' + f"end = {END!r}\n" + '[[element]]\nname = "vehicle"\nremove = true\n'
    if recorder.drive == "held":
        text += ('[[element]]\nname = "front suspension"\nremove = true\n[[element]]\nname = "rear suspension"\nremove = true\n'
                 '[[signal]]\nname = "nothing"\nkind = "constant"\nvalue = 0.0\n[[element]]\nkind = "prescribed_motion"\nname = "recorder angle"\n'
                 f'a = "{PLACES[recorder.place][0]}"\ncoordinate = "angle"\nsignal = "nothing"\n')
    for axis in recorder.axes:
        column = 2 + "xy".index(axis)
        text += (f'[[signal]]\nname = "recorded {axis}"\nkind = "record"\nfile = "{signal}"\ncolumn = "{column}"\nunit = "m/s^2"\n'
                 f"offset = {-QUIET!r}\n"
                 f'[[element]]\nkind = "prescribed_motion"\nname = "recorder {axis}"\na = "{recorder.place}"\ncoordinate = "{axis}"\n'
                 f'signal = "recorded {axis}"\nas = "acceleration"\n')
    return toml(MODEL, impact, pressure, text)


def slid(joint):
    return math.hypot(joint["slid_x"], joint["slid_y"])


# --- motion of the vehicle that reproduces the record --------------------------------------------------------------------------------
# The drive is a piecewise linear acceleration with GRID between its corners, along x only. Runs with one small corner each give the columns
# of a linear map from drive to record. The drive is corrected by a least-squares fit to the misfit of the record, regularised by the
# roughness of the drive. This is repeated over several runs, because feet slide and lift. Shaking tables reproduce records in the same way.
GRID, ROW = 4e-3, 2e-3 # s between corners; s between compared samples
DOUBT = 0.5            # standard deviation of a compared sample, m/s²
ROUGH = 1.0            # usual second difference of the drive, m/s²
GAIN, REPEATS = 0.6, 8 # fraction of the computed correction that is applied; number of runs
CORNER = 0.05          # size of the small corner, m/s²


def vehicle_run(program, folder, name, impact, pressure, drive, place):
    """Runs the model with a vehicle acceleration that has these corners. Returns the joints and the record along x."""
    path = os.path.join(folder, name + "_drive.csv")
    with open(path, "w", encoding="utf-8") as file:
        file.write("t [s],a [m/s^2]\n" + "".join(f"{i * GRID:.6f},{a!r}\n" for i, a in enumerate(drive)))
    columns = [f"{place}.ax", f"{place}.ay", "upper tank.theta"]
    body = (f'[output]\nstep = {ROW!r}\nchannels = {json.dumps(columns)}\nalso = {json.dumps(columns[:2])}\n'
            f'[simulation]\nend = {END!r}\nvelocity = [0.0, 0.0]\n'
            f'[[signal]]\nname = "sought"\nkind = "record"\nfile = "{path}"\n[[element]]\nname = "vehicle"\nsignal = "sought"\n')
    joints = simulate(program, folder, name, toml(MODEL, impact, pressure, body))
    felt = []
    for row in rows_of(os.path.join(folder, "out", name, "trajectory.csv")):
        angle, ax, ay = row["upper tank.theta"], row[f"{place}.ax"], row[f"{place}.ay"]
        felt.append(math.cos(angle) * ax + math.sin(angle) * (ay + LOCAL))
    return joints, felt


def cholesky(matrix):
    """Returns the lower Cholesky factor of a symmetric matrix; only its lower half is read."""
    lower = []
    for i, row in enumerate(matrix):
        line = []
        for j in range(i + 1):
            rest = row[j] - sum(a * b for a, b in zip(line, lower[j] if j < i else line))
            line.append(math.sqrt(rest) if j == i else rest / lower[j][j])
        lower.append(line)
    return lower


def solve(lower, right):
    n, y = len(right), []
    for i in range(n):
        y.append((right[i] - sum(a * b for a, b in zip(lower[i], y))) / lower[i][i])
    for i in reversed(range(n)):
        y[i] = (y[i] - sum(lower[k][i] * y[k] for k in range(i + 1, n))) / lower[i][i]
    return y


def roughness(corners):
    """Returns the matrix of the weighted squared second differences. A small multiple of the identity makes it invertible."""
    weights = [[0.0] * corners for _ in range(corners)]
    for k in range(1, corners - 1):
        for a, p in ((k - 1, 1), (k, -2), (k + 1, 1)):
            for b, q in ((k - 1, 1), (k, -2), (k + 1, 1)):
                weights[a][b] += (DOUBT / ROUGH) ** 2 * p * q
    for k in range(corners):
        weights[k][k] += (DOUBT / (20.0 * ROUGH)) ** 2
    return weights


@functools.lru_cache(maxsize=None)
def map_of(program, impact, place): # the tank belongs to the impact
    """Returns the columns of the linear map from drive to record, the weights of the drive, and the factor of the normal equations."""
    corners, stride = round(END / GRID) + 1, round(GRID / ROW)
    with tempfile.TemporaryDirectory() as folder:
        single = [CORNER if i == 1 else 0.0 for i in range(corners)]
        response = [v / CORNER for v in vehicle_run(program, folder, "corner", impact, FIRM, single, place)[1]]
    shifted = lambda rows: [response[i - rows] if 0 <= i - rows < len(response) else 0.0 for i in range(len(response))]
    columns = [shifted((k - 1) * stride) for k in range(corners)]
    weights = roughness(corners)
    normal = [[sum(a * b for a, b in zip(columns[i][max(0, (i - 1) * stride):], columns[j][max(0, (i - 1) * stride):])) + weights[i][j]
               for j in range(i + 1)] for i in range(corners)]
    return columns, weights, cholesky(normal)


def vehicle_sought(program, folder, impact, pressure, signal, recorder):
    """Searches the drive of the vehicle that best reproduces the record along x, in a few runs. Returns the joints of the best run."""
    rows = [list(row.values()) for row in rows_of(signal)]
    first, step, values = rows[0][0] - QUIET, rows[1][0] - rows[0][0], [row[1] for row in rows]

    def recorded(t):
        k = min(int((t - first) / step), len(values) - 2)
        return values[k] + ((t - first) / step - k) * (values[k + 1] - values[k])
    columns, weights, lower = map_of(program, impact, recorder.place)
    drive = [0.0] * len(columns)
    for repeat in range(REPEATS):
        joints, felt = vehicle_run(program, folder, f"sought_{repeat}", impact, pressure, drive, recorder.place)
        misfit = [recorded(i * ROW) - a for i, a in enumerate(felt)]
        right = [sum(a * b for a, b in zip(column, misfit)) - sum(w * d for w, d in zip(row, drive)) for column, row in zip(columns, weights)]
        drive = [d + GAIN * c for d, c in zip(drive, solve(lower, right))]
    return joints


@dataclasses.dataclass
class Truth:
    impact: Impact
    pressures: dict  # pressures of the runs "firm", "strong", "weak", Pa
    joints: dict     # joints of these runs
    motion: dict

    def needed(self, joint):
        return self.joints["firm"][joint]["largest_required_pressure"]


def truth_of(program, folder, impact):
    truth = Truth(impact, {"firm": FIRM}, {}, {})
    for name in ("firm", "strong", "weak"):
        if name != "firm":
            needed = [truth.needed(j) for j in JOINTS]
            truth.pressures[name] = STRONG * max(needed) if name == "strong" else WEAK * min(needed)
        truth.joints[name], truth.motion[name] = true_run(program, folder, impact, truth.pressures[name], name)
        if any(truth.joints[name][j]["slipped"] != (name == "weak") for j in JOINTS):
            raise RuntimeError(f"the joints do not do at the {name} pressure what they were to do")
    return truth


def compared(program, truth, recorder, seed):
    """Returns the errors due to one record: required pressure, slip times, slides, joints judged wrongly. None if a run did not end."""
    runs = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, pressure in truth.pressures.items():
            path = os.path.join(folder, name + ".csv")
            write_record(path, truth.motion[name], recorder, seed)
            signal = read_record(program, folder, path, recorder)
            try:
                if recorder.drive == "vehicle":
                    runs[name] = vehicle_sought(program, folder, truth.impact, pressure, signal, recorder)
                else:
                    runs[name] = simulate(program, folder, name, replay_text(truth.impact, pressure, signal, recorder))
            except (subprocess.TimeoutExpired, RuntimeError):
                return None
    pressure, time, distance, wrong = [], [], [], 0
    for joint in JOINTS:
        pressure.append(runs["firm"][joint]["largest_required_pressure"] / truth.needed(joint) - 1.0)
        wrong += runs["strong"][joint]["slipped"] + (not runs["weak"][joint]["slipped"])
        distance.append(slid(runs["weak"][joint]) - slid(truth.joints["weak"][joint]))
        if runs["weak"][joint]["slipped"]:
            time.append(runs["weak"][joint]["first_slip"] - truth.joints["weak"][joint]["first_slip"])
    worst = lambda values: max(values, key=abs) if values else math.nan
    return {"pressure": worst(pressure), "time": worst(time), "distance": worst(distance), "wrong": wrong}


# Returns the variations of one quantity at a time: heading, and recorders with their names. With a recorder on the frame, at the height at
# which the vehicle's force acts, driven along x, the record is the only source of error.
def record_tables():
    base, fast = Recorder(), Recorder(rate=1000.0)
    vary = dataclasses.replace
    return [
        ("Rate", [(f"{rate:g} Hz", vary(base, rate=float(rate))) for rate in (50, 100, 200, 500, 1000)]),
        ("The recorder's own low-pass, 1 kHz", [("none", vary(fast, low_pass=0.0)), *[(f"{cut} Hz", vary(fast, low_pass=cut / 1000.0)) for cut in (100, 50, 20, 10)]]),
        ("Low-pass without phase shift when the file is read, 1 kHz", [(f"CFC {c}", vary(fast, frequency_class=c)) for c in (60, 30, 10)]),
        ("Bits at ±10 g", [(f"{bits} bits, {2e4 / 2 ** bits:.3g} mg", vary(base, bits=bits)) for bits in (8, 10, 16)]),
        ("Noise", [(f"{noise} mg", vary(base, noise=float(noise))) for noise in (20, 50, 100)]),
        ("Noise, 1 kHz", [("100 mg", vary(fast, noise=100.0))]),
        ("Offset that is left in the record", [(f"{offset} mg", vary(base, offset=float(offset), rest=False)) for offset in (5, 20, 50)]),
        ("Mounted askew", [(f"{tilt}°", vary(base, tilt=float(tilt))) for tilt in (1, 5)]),
        ("Driven along y, too", [("200 Hz", vary(base, axes="xy")), ("1 kHz", vary(fast, axes="xy")), ("200 Hz, noise 20 mg", vary(base, axes="xy", noise=20.0))]),
        ("No fault but 1 kHz and 16 bits", [("", Recorder(1000.0, 16, noise=0.0, offset=0.0, low_pass=0.0))]),
    ]


# Returns variations of the recorder's position and of the treatment of its record.
def way_tables():
    fast = Recorder(rate=1000.0)
    vary = dataclasses.replace
    held = lambda place: (place, vary(fast, place=place, axes="xy", drive="held"))
    return [
        ("The place is driven along x, springs stay", [(place, vary(fast, place=place)) for place in ("frame", "far end", "floor", "lid")]),
        ("The place is driven along x and y, its body does not turn, springs give way", [held("frame"), held("floor"), held("lid")]),
        ("The vehicle's motion is sought that gives the record", [(place, vary(fast, place=place, drive="vehicle")) for place in ("frame", "lid")]),
    ]


def row_of(errors):
    """Returns a table row with the largest error over all seeds."""
    if any(e is None for e in errors):
        return f"no end within {PATIENCE:g} s | | | | "
    worst = {key: max((e[key] for e in errors), key=lambda v: (not math.isnan(v), abs(v))) for key in ("pressure", "time", "distance")}
    spread = statistics.pstdev([e["pressure"] for e in errors])
    wrong = sum(e["wrong"] for e in errors)
    time = "-" if math.isnan(worst["time"]) else f"{1e3 * worst['time']:+.1f} ms"
    return f"{100 * worst['pressure']:+.1f} % | {100 * spread:.1f} % | {wrong} of {4 * len(errors)} | {time} | {1e3 * worst['distance']:+.3f} mm"


def print_truth(truth):
    print(f"\n## {truth.impact.name}: {abs(truth.impact.peak) / LOCAL:g} g for {1e3 * truth.impact.duration:g} ms\n")
    for joint in JOINTS:
        weak = truth.joints["weak"][joint]
        print(f"{joint}: needs {truth.needed(joint) / 1e3:.2f} kPa; at {truth.pressures['weak'] / 1e3:.2f} kPa slips at "
              f"{1e3 * weak['first_slip']:.1f} ms and is {1e3 * slid(weak):.3f} mm from its place at the end; holds at {truth.pressures['strong'] / 1e3:.2f} kPa")
    for place, motion in truth.motion["firm"].items():
        peak = [max(abs(v) for v in axis) / LOCAL for axis in motion[:2]]
        print(f"{place}: up to {peak[0]:.2f} g along x, {peak[1]:.2f} g along y")


def print_tables(program, truth, tables, seeds, pool):
    print_truth(truth)
    waiting = [(heading, [(name, [pool.submit(compared, program, truth, recorder, seed) for seed in range(seeds)]) for name, recorder in rows])
               for heading, rows in tables]
    for heading, rows in waiting:
        print(f"\n| {heading} | pressure | its spread | told wrongly | first slip | slid |\n|---|---|---|---|---|---|")
        for name, futures in rows:
            print(f"| {name} | {row_of([f.result() for f in futures])} |", flush=True)


# Checks that slip is detected correctly with a recorder on the frame, and that errors are below 4 % for the pressure, 8 ms for times and
# 0.2 mm for distances, twice those in the tables. Also checks that two faults are detected: a recorder's filter at 10 Hz, which delays by
# 0.225/10 Hz = 23 ms, and a drive of the lid, which acts at the wrong place.
def check(program, truth):
    good = compared(program, truth, Recorder(), 0)
    slow = compared(program, truth, Recorder(rate=1000.0, low_pass=0.01), 0)
    lid = compared(program, truth, Recorder(rate=1000.0, place="lid"), 0)
    print(f"frame: {good}\n10 Hz: {slow}\nlid: {lid}")
    kept = [good["wrong"] == 0, abs(good["pressure"]) < 0.04, abs(good["time"]) < 8e-3, abs(good["distance"]) < 2e-4,
            0.015 < slow["time"] < 0.035, lid["pressure"] > 0.2, lid["distance"] > 1e-3]
    print("kept" if all(kept) else f"not kept: {kept}")
    return 0 if all(kept) else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("steplap")
    parser.add_argument("--check", action="store_true", help="a few records against bounds")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args()
    program = os.path.abspath(options.steplap)
    truth = {}
    for impact in (STOP,) if options.check else (STOP, SHUNT, RIGID_STOP, RIGID_SHUNT):
        with tempfile.TemporaryDirectory() as folder:
            truth[impact] = truth_of(program, folder, impact)
    if options.check:
        return check(program, truth[STOP])
    with concurrent.futures.ThreadPoolExecutor(options.workers) as pool:
        for impact in (STOP, SHUNT):
            print_tables(program, truth[impact], record_tables(), options.seeds, pool)
        for impact in truth:
            print_tables(program, truth[impact], way_tables(), 1, pool)
    return 0


if __name__ == "__main__":
    sys.exit(main())
