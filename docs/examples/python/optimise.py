"""Finds the damping ratio with the least deceleration of a stopped mass, by SciPy. Closed form: 0.81 v sqrt(k/m) at a ratio of 0.265."""
import numpy as np
import scipy.optimize

import steplap

MASS, STIFFNESS, SPEED = 2.0, 800.0, 0.5  # kg, N/m, m/s
OMEGA = np.sqrt(STIFFNESS / MASS)

buffer = steplap.build({
    "title": "a mass runs into a spring and a damper", "gravity": [0.0, 0.0],
    "simulation": {"end": 0.3, "tolerance": 1e-10},
    "body": [{"name": "mass", "mass": MASS, "inertia": 1.0, "velocity": [SPEED, 0.0]}],
    "element": [{"name": "buffer", "kind": "spring_damper", "a": "mass", "b": {"body": "ground", "at": [0.0, 0.0]}, "axis": [1, 0],
                 "stiffness": STIFFNESS, "damping": 1.0},
                {"name": "guide", "kind": "prismatic", "a": "ground", "b": "mass", "axis": [1, 0]}]})


def shock(ratio):
    """Returns the largest deceleration divided by v sqrt(k/m), for a damping ratio."""
    run = buffer.with_values({"element.buffer.damping": 2.0 * ratio * np.sqrt(STIFFNESS * MASS)}).run(estimate="never")
    return -run.extremes("mass.ax")["low"] / (SPEED * OMEGA)


best = scipy.optimize.minimize_scalar(shock, bounds=(0.05, 0.45), method="bounded", options={"xatol": 1e-3})
print(f"damping ratio {best.x:.4f}, shock {best.fun:.5f}")
