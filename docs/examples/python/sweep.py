"""Clamping pressure required by the joints of a transformer: a sweep, with the error of each number."""
import os

import matplotlib.pyplot as plt
import numpy as np

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")
PATH, RESPONSE = "core.core.pressure", "front joint.margin low"

model = steplap.load(f"{MODELS}/layouts/three_limb.toml")
pressures = model.value(PATH) * np.linspace(0.4, 1.2, 6)
sweep = model.samples({PATH: pressures}, [("front joint.margin", "low")])

figure, axes = plt.subplots()
axes.errorbar(sweep[PATH] / 1e3, sweep[RESPONSE], sweep[f"error of {RESPONSE}"].fillna(0.0), marker="o")
axes.axhline(1.5, color="black", linewidth=0.8)
axes.set_xlabel("pressure [kPa]")
axes.set_ylabel("least margin of the front joint")
figure.savefig("sweep.png")
print(sweep.to_string())
