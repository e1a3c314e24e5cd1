"""Makes a decision from the file of a shock recorder. The record is synthetic: two shocks along x, gravity of 1 g along z."""
import os

import numpy as np
import pandas

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")

t = np.arange(0.0, 10.0, 0.001)  # s
x = sum(peak * np.where(abs(t - at) < 0.025, np.cos(np.pi * (t - at) / 0.05), 0.0) for peak, at in ((0.6, 3.0), (0.2, 6.0)))  # g
noise = 0.005 * np.random.default_rng(1).standard_normal((3, len(t)))
record = pandas.DataFrame({"Time (s)": t, "X Acceleration (g)": x + noise[0], "Y Acceleration (g)": noise[1], "Z Acceleration (g)": 1.0 + noise[2]})
record.to_csv("shock.csv", index=False, float_format="%.6f")

found = steplap.assess("shock.csv", models=[f"{MODELS}/assess/transformer.toml"], output="arrival", gravity="z", cfc=60, voyage="0,10",
                       threshold="0.3 g", samples=0)
print(found.decision, "-", found.reason)
print(found.reasons[["criterion", "outcome", "text"]].to_string())
print("The sheet: steplap report arrival -o arrival.html")
