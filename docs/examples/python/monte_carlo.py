"""How likely does a ladder slip if the friction of the floor is hardly known? 400 runs; each that is not certain is counted apart."""
import os

import numpy as np

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")
COUNT, CONFIDENCE = 400, 1.96  # quantile of 95 %

model = steplap.load(f"{MODELS}/machines/ladder.toml", {"simulation.end": 0.5})
friction = np.random.default_rng(1).normal(0.3, 0.04, COUNT)
runs = model.samples({"element.foot friction.static_friction": friction}, [("foot friction.slide", "low"), ("foot friction.slide", "high")],
                     estimate="never")

answered = runs["trouble"] == ""
slid = np.maximum(-runs["foot friction.slide low"], runs["foot friction.slide high"])[answered] > 1e-3  # m
p = slid.mean()
half = CONFIDENCE * np.sqrt(p * (1.0 - p) / len(slid))
print(f"{COUNT - len(slid)} runs without an answer")
print(f"slips with a probability of {p:.3f}, 95 % interval {p - half:.3f} to {p + half:.3f}")
