"""A criterion programmed in Python: the acceleration of a lead may exceed 0.5 m/s2 for at most 20 ms. It is open if it cannot be decided."""
import os

import numpy as np

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")
LIMIT, LONGEST = 0.5, 0.02  # m/s2; s


def longest_beyond(t, values, limit):
    """Returns the length of the longest interval with |values| > limit, and its uncertainty, one sample at each end, s."""
    beyond = np.concatenate([[False], np.abs(values) > limit, [False]])
    begins, ends = np.flatnonzero(~beyond[:-1] & beyond[1:]), np.flatnonzero(beyond[:-1] & ~beyond[1:]) - 1
    lengths = t[ends] - t[begins]
    return (lengths.max() if len(lengths) else 0.0), 2.0 * np.diff(t).max()


run = steplap.load(f"{MODELS}/paper/no_interference.toml").run(output_step=0.0005)
length, error = longest_beyond(run.t, run["active part.ax"], LIMIT)
if run.failure or run.distrust or abs(length - LONGEST) <= error:
    verdict = "open"
else:
    verdict = "hold" if length < LONGEST else "inspect"
print(f"{1e3 * length:.2f} ms beyond {LIMIT} m/s2, uncertain by {1e3 * error:.2f} ms: {verdict}; the model's own criteria: {run.verdict}")
