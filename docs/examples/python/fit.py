"""Finds the friction that explains a measured slide of a block: a study of the kind 'fit', with 95 % intervals."""
import os

import matplotlib.pyplot as plt
import pandas

import steplap

STUDIES = os.environ.get("STEPLAP_MODELS", "/usr/share/steplap/models") + "/studies"

study = steplap.study(f"{STUDIES}/sliding_block_fit.toml")
values = study.findings[study.findings.quantity == "value"].set_index("subject")
print(values[["value", "low", "high"]])

record = pandas.read_csv(f"{STUDIES}/sliding_block_record.csv", comment="#")
fitted = {"element.deck friction.static_friction": values.value["friction"], "signal.push.peak": values.value["peak"],
          "signal.push.duration": values.value["duration"]}
run = steplap.load(f"{STUDIES}/sliding_block.toml", fitted).run()

figure, axes = plt.subplots()
axes.plot(record.iloc[:, 0], record.iloc[:, 1], ".", label="record")
axes.plot(run.t, 1e3 * run["deck friction.slide"], label="fitted")
axes.set_xlabel("t [s]")
axes.set_ylabel("way [mm]")
axes.legend()
figure.savefig("fit.png")
