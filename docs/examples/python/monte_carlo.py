"""Probability that a ladder slips if the friction of the floor is uncertain: 400 runs. Runs without a reliable result are counted separately."""
import os

import numpy as np

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")
COUNT, CONFIDENCE = 400, 1.96  # number of runs; normal quantile of a 95 % interval

model = steplap.load(f"{MODELS}/machines/ladder.toml", {"simulation.end": 0.5})
friction = np.random.default_rng(1).normal(0.3, 0.04, COUNT)
runs = model.samples({"element.foot friction.static_friction": friction}, [("foot friction.slide", "low"), ("foot friction.slide", "high")],
                     estimate="never")

answered = runs["trouble"] == ""
slid = np.maximum(-runs["foot friction.slide low"], runs["foot friction.slide high"])[answered] > 1e-3  # more than 1 mm
p = slid.mean()
half = CONFIDENCE * np.sqrt(p * (1.0 - p) / len(slid))
print(f"{COUNT - len(slid)} runs without an answer")
print(f"slips with a probability of {p:.3f}, 95 % interval {p - half:.3f} to {p + half:.3f}")
