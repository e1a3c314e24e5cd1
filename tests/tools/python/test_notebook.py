"""The notebook in docs/examples/ runs from its first cell to its last; data frames and figures hold what the run holds.

usage: as test_module.py
"""
import json
import os
import pathlib

import numpy as np
import pytest

import steplap

MODELS = pathlib.Path(os.environ["STEPLAP_MODELS"]).resolve()
pandas = pytest.importorskip("pandas", reason="python3-pandas is not installed")
matplotlib = pytest.importorskip("matplotlib", reason="python3-matplotlib is not installed")
matplotlib.use("Agg")


def test_every_cell_of_the_notebook(tmp_path, monkeypatch, capsys):
    notebook = json.loads((MODELS.parent / "docs/examples/what_if.ipynb").read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 8 and all(not cell["outputs"] for cell in notebook["cells"] if cell["cell_type"] == "code")
    monkeypatch.chdir(tmp_path)
    names = {}
    for i, cell in enumerate(cells):
        # The package's models are those of the checkout.
        exec(compile(cell.replace("/usr/share/steplap/models", str(MODELS)), f"cell {i + 1}", "exec"), names)
    margins, verdicts = names["margins"], names["verdicts"]
    # More pressure, more margin, by the laws of friction: each joint bears in proportion to it, and its load hardly changes.
    assert np.all(np.diff(margins, axis=0) > 0.0) and verdicts[-1] == names["run"].verdict
    assert "<html" in (tmp_path / "three_limb.html").read_text()
    assert "front joint" in capsys.readouterr().out


def test_frames_and_figures_hold_the_run():
    run = steplap.load(str(MODELS / "paper/interference.toml"), {"simulation.end": 0.05}).run(estimate="never")
    frame = run.to_pandas()
    assert list(frame.columns) == run.names[1:] and np.array_equal(frame.index, run.t) and np.array_equal(frame.to_numpy(), run.values[:, 1:], equal_nan=True)
    axes = run.plot("active part.x", "active part.y")
    lines = axes.get_lines()
    assert np.array_equal(lines[1].get_ydata(), run["active part.y"]) and lines[0].get_label() == "active part.x [m]"


def test_the_drawing_is_that_of_the_files(tmp_path):
    model = steplap.load(str(MODELS / "layouts/three_limb.toml"), {"simulation.end": 0.01})
    model.run(estimate="never").write(str(tmp_path / "run"))
    assert model.drawing == json.loads((tmp_path / "run/drawing.json").read_text())
    assert {"bodies", "elements", "sheets"} <= set(model.drawing)


def test_a_run_shows_the_machine_and_its_clock_without_other_files():
    run = steplap.load(str(MODELS / "paper/interference.toml"), {"simulation.end": 0.05}).run(estimate="never")
    picture = run.show(height=500)
    # The page without all but the picture and the timeline; nothing is loaded from anywhere.
    assert picture.html.replace("<style>header, footer, #verdict, #near, #plots, #results, #sheets, #more { display: none }</style>", "") == run.page()
    for part in ("machine", "timeline", "verdict", "near", "plots", "results", "sheets", "more"):
        assert f'id="{part}"' in run.page(), part
    assert "default-src 'none'" in picture.html
    shown = picture._repr_html_()
    assert shown.startswith("<iframe") and "height:500px" in shown and "<script" not in shown  # escaped inside of srcdoc
    assert run._repr_html_() == steplap.Picture(run.page(), 900)._repr_html_()
