"""The scripts of docs/examples/python run within seconds, are short, and say what is true.

usage: as test_module.py
"""
import math
import os
import pathlib
import re
import subprocess
import sys

import pytest
import scipy.optimize
import scipy.stats

MODELS = pathlib.Path(os.environ["STEPLAP_MODELS"]).resolve()
SCRIPTS = sorted((MODELS.parent / "docs/examples/python").glob("*.py"))

pytest.importorskip("pandas", reason="python3-pandas is not installed")
pytest.importorskip("matplotlib", reason="python3-matplotlib is not installed")


@pytest.fixture(scope="module")
def said(tmp_path_factory):
    """What a script prints, and the folder in which it ran."""
    outputs = {}

    def run(name):
        if name not in outputs:
            folder = tmp_path_factory.mktemp(name)
            script = MODELS.parent / f"docs/examples/python/{name}.py"
            done = subprocess.run([sys.executable, str(script)], cwd=folder, capture_output=True, text=True, env={**os.environ, "MPLBACKEND": "Agg"})
            assert done.returncode == 0, done.stderr
            outputs[name] = done.stdout, folder
        return outputs[name]

    return run


def numbers(text, pattern):
    return [float(number) for number in re.search(pattern, text).groups()]


def test_there_are_eight_of_less_than_40_lines():
    assert len(SCRIPTS) == 8 and all(len(script.read_text().splitlines()) < 40 for script in SCRIPTS)


def test_sweep(said):
    output, folder = said("sweep")
    margins = [float(line.split()[2]) for line in output.splitlines()[1:]]
    assert len(margins) == 6 and margins == sorted(margins)  # friction grows with pressure
    assert (folder / "sweep.png").exists()


def test_fit(said):
    output, folder = said("fit")
    value, low, high = numbers(output, r"friction +(\S+) +(\S+) +(\S+)")
    # The record was made with 0.3 and noise: within three of the interval's half widths.
    assert low < value < high and abs(value - 0.3) < 1.5 * (high - low)
    assert (folder / "fit.png").exists()


def test_monte_carlo(said):
    output, _ = said("monte_carlo")
    p, = numbers(output, r"probability of (\S+),")
    exact = scipy.stats.norm.cdf((math.tan(math.radians(15.0)) - 0.3) / 0.04)  # it stands from 1/(2 tan a) = tan 15 deg on
    assert abs(p - exact) < 3.0 * math.sqrt(exact * (1.0 - exact) / 400.0)  # three standard deviations of 400 samples


def test_optimise(said):
    output, _ = said("optimise")
    ratio, shock = numbers(output, r"damping ratio (\S+), shock (\S+)")

    # Largest deceleration of x'' + 2 z w x' + w^2 x = 0 from x' = v, over v w, for z < 1/2.
    def exact(z):
        root = math.sqrt(1.0 - z * z)
        return math.exp(-z / root * math.atan2((1.0 - 4.0 * z * z) * root, z * (3.0 - 4.0 * z * z)))

    best = scipy.optimize.minimize_scalar(exact, bounds=(0.05, 0.45), method="bounded")
    assert abs(ratio - best.x) < 5e-3  # near a minimum the abscissa is known to the tolerance of the search, 1e-3, only
    assert abs(shock / best.fun - 1.0) < 1e-5


def test_own_criterion(said):
    output, _ = said("own_criterion")
    length, error = numbers(output, r"(\S+) ms beyond .* uncertain by (\S+) ms")
    assert length >= 0.0 and abs(error - 1.0) < 1e-6  # two samples 0.5 ms apart
    assert re.search(r": (hold|open|inspect); the model", output)


def test_recorder_to_decision(said):
    output, folder = said("recorder_to_decision")
    assert re.match(r"(energise|inspect|return|open) - ", output) and (folder / "arrival/assessment.json").exists()


def test_animation(said):
    _, folder = said("animation")
    assert (folder / "ladder.gif").read_bytes()[:6] == b"GIF89a"


def test_compare_methods(said):
    output, _ = said("compare_methods")
    spread, together = numbers(output, r"spread (\S+) m/s2, largest two errors together (\S+) m/s2")
    assert spread <= together
