"""Common part of check_by_scipy and check_wheels_by_scipy: compares random scenes in steplap and SciPy.

A scene is made from a seed. `toml()` returns its model file for steplap. `solve(tolerance)` returns SciPy's final values, or raises NoAnswer.
`finals(summary)` returns tuples of a name, steplap's value, its error estimate (None: unknown), and the value's index in the result of
solve(). Values must agree within three times steplap's error estimate, three times the difference of two tolerances of SciPy, and 1e-8. Runs
with an unknown error are counted separately, like runs that stop.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy

FINEST = 1e-12  # tolerance of SciPy used if two larger ones agree with each other but not with steplap, because both may miss a kink


class NoAnswer(Exception):
    pass


def worst(scene, summary, exact, rough):
    """Returns the largest ratio of a difference to the permitted one, and the name of the value; ratio None if an error is unknown."""
    ratio, where = 0.0, ""
    for name, value, error, place in scene.finals(summary):
        if error is None:
            return None, name
        allowed = 3 * error + 3 * abs(exact[place] - rough[place]) + 1e-8 * (1 + abs(exact[place]))
        now = abs(value - exact[place]) / allowed
        if not now <= ratio:  # also true for NaN
            ratio, where = now, f"{name}: {value} and {exact[place]}, error {error}"
    return ratio, where


def outcome(given, scene, path, folder, integrator, exact, rough):
    """Runs a scene with one integrator. Returns the kind of result and a message."""
    run = subprocess.run([given.program, "simulate", path, "-o", folder, "--force", "--estimate-error", "-q", "--integrator", integrator], capture_output=True, text=True)
    if run.returncode != 0:
        return "stop", run.stderr.strip().splitlines()[0]
    with open(os.path.join(folder, "scene", "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    ratio, where = worst(scene, summary, exact, rough)
    if ratio is not None and not ratio <= 1:
        ratio, where = worst(scene, summary, scene.solve(FINEST), exact)
    if ratio is None:
        return "with an unknown error", where
    return ("agree", "") if ratio <= 1 else ("disagree", f"{ratio:.3g} times what is allowed, {where}")


def main(description, scene_of, tolerances):
    """Runs the scenes of the command line. `tolerances`: two tolerances of SciPy, the finer one first."""
    arguments = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("first", type=int)
    arguments.add_argument("last", type=int)
    arguments.add_argument("--integrators", default="auto,rodas5p")
    arguments.add_argument("--program", default=os.path.join(os.path.dirname(__file__), "..", "build", "release", "bin", "steplap"))
    given = arguments.parse_args()
    counts = {"agree": 0, "disagree": 0, "stop": 0, "with an unknown error": 0, "without an answer of SciPy": 0}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.toml")
        for seed in range(given.first, given.last + 1):
            scene = scene_of(seed)
            with open(path, "w", encoding="utf-8") as file:
                file.write(scene.toml())
            try:
                exact, rough = (scene.solve(tolerance) for tolerance in tolerances)
                for integrator in given.integrators.split(","):
                    how, text = outcome(given, scene, path, folder, integrator, exact, rough)
                    counts[how] += 1
                    if text:
                        print(f"{seed} {integrator}: {how}: {text}", flush=True)
            except (NoAnswer, numpy.linalg.LinAlgError):  # the latter for constraint rows that become dependent
                counts["without an answer of SciPy"] += 1
    print(", ".join(f"{count} {what}" for what, count in counts.items()))
    sys.exit(1 if counts["disagree"] else 0)
