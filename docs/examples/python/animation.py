"""Makes a GIF of a sliding ladder with matplotlib, from the outlines of the bodies. In a notebook run.show() gives an animated picture."""
import os

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np

import steplap

MODELS = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models")

model = steplap.load(f"{MODELS}/machines/ladder.toml", {"element.foot friction.static_friction": 0.2, "simulation.end": 0.8})
run = model.run(output_step=0.02)
figure, axes = plt.subplots()
axes.set_aspect("equal")
axes.set_xlim(-2.2, 2.2)
axes.set_ylim(-0.3, 3.8)
bodies = [(body["name"], np.array(body["outline"]), axes.fill([0.0], [0.0], alpha=0.6)[0]) for body in model.drawing["bodies"] if body["outline"]]


def draw(row):
    for name, outline, patch in bodies:
        x, y, angle = (run[f"{name}.{part}"][row] for part in ("x", "y", "theta"))
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        patch.set_xy(outline @ turn.T + (x, y))
    axes.set_title(f"t = {run.t[row]:.2f} s")


matplotlib.animation.FuncAnimation(figure, draw, frames=range(0, len(run), 4)).save("ladder.gif", writer="pillow", dpi=60)
print(len(run), "rows, until", run.t[-1], "s")
