"""Compares integration methods: do results agree within their error estimates, and what do they cost? One row per method."""
import os
import time

import pandas

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")
CHANNEL = "active part.ax"

model = steplap.load(f"{MODELS}/paper/no_interference.toml")
rows = []
for method in ("dop853", "tsit5", "rodas5p", "auto"):
    began = time.process_time()
    run = model.run(method=method, estimate="always")
    extremes = run.extremes(CHANNEL)
    rows.append({"method": method, "largest": extremes["high"], "error": extremes["high_error"], "verdict": run.verdict,
                 "CPU [s]": round(time.process_time() - began, 2)})
table = pandas.DataFrame(rows).set_index("method")
print(table.to_string())
spread = table["largest"].max() - table["largest"].min()
print(f"spread {spread:.2g} m/s2, largest two errors together {table['error'].nlargest(2).sum():.2g} m/s2")
