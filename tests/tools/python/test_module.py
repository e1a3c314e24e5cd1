"""The module of Python against the program: the same numbers, verdicts and files; errors with their fields; arrays without copies.

usage: pytest test_module.py, with PYTHONPATH leading to the module, STEPLAP to the program and STEPLAP_MODELS to the models
"""
import gc
import json
import os
import pathlib
import resource
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import steplap

MODELS = pathlib.Path(os.environ["STEPLAP_MODELS"]).resolve()
PROGRAM = os.environ["STEPLAP"]
PAPER = str(MODELS / "paper/interference.toml")
FIXED_STEPS = str(MODELS / "paper/interference_rk4.toml")
SHORT = {"simulation.end": 0.05}


@pytest.mark.parametrize("name", ["paper/interference", "paper/no_interference", "machines/ladder", "machines/cradle", "layouts/three_limb_bump"])
def test_files_are_those_of_the_program(name, tmp_path):
    path = str(MODELS / f"{name}.toml")
    overrides = {"simulation.end": 0.2}
    steplap.load(path, overrides).run().write(str(tmp_path / "module"))
    subprocess.run([PROGRAM, "simulate", "-q", path, "--set", "simulation.end=0.2", "-o", str(tmp_path / "program")], check=False)
    program = next((tmp_path / "program").rglob("summary.json")).parent
    for file in ("trajectory.csv", "events.csv", "summary.json", "model.toml"):
        assert (tmp_path / "module" / file).read_bytes() == (program / file).read_bytes(), file


def test_arrays_look_into_one_block_and_keep_it():
    run = steplap.load(PAPER, SHORT).run(estimate="never")
    values, column = run.values, run[run.names[3]]
    assert values.shape == (len(run), len(run.names)) and len(run.names) == len(run.units)
    assert np.shares_memory(values, column) and np.shares_memory(values, run.t)
    assert not column.flags.writeable
    kept = column.copy()
    del run, values
    gc.collect()
    assert np.array_equal(column, kept)
    with pytest.raises(KeyError, match="did you mean"):
        steplap.load(PAPER, SHORT).run(estimate="never")["active part.xx"]


def test_values_and_units_by_path():
    model = steplap.load(PAPER)
    assert model.unit("body.active part.mass") == "kg" and model.channels["active part.x"] == "m"
    changed = model.with_values({"simulation.end": 0.25, "gravity": np.array([0.0, -3.7])})
    assert changed.value("simulation.end") == 0.25 and changed.value("gravity.1") == -3.7
    assert model.value("gravity.1") == -9.81


def test_errors_have_fields(tmp_path):
    broken = tmp_path / "broken.toml"
    broken.write_text('[[body]]\nname = "a"\nmass = -1\ninertia = 1\nmas = 2\n')
    with pytest.raises(steplap.ModelError) as caught:
        steplap.load(str(broken))
    lines = sorted(d.line for d in caught.value.diagnostics)
    assert lines == [3, 5] and all(d.file == str(broken) for d in caught.value.diagnostics)
    assert isinstance(caught.value, steplap.Error)
    with pytest.raises(TypeError):
        steplap.load(PAPER, {"simulation.end": object()})
    with pytest.raises(steplap.FileError) as caught:
        steplap.load(PAPER, SHORT).run(estimate="never").write("/proc/steplap")
    assert "steplap" in caught.value.path


def test_samples_are_single_runs_whatever_the_threads():
    model = steplap.load(PAPER, SHORT)
    path, channel = "element.front block.preload", "active part.x"
    values = {path: model.value(path) * np.linspace(0.9, 1.1, 6), "gravity.1": -9.81}
    wanted = [(channel, "high"), (channel, "final"), (channel, "first")]
    one, two = (model.samples(values, wanted, threads=threads) for threads in (1, 3))
    assert one.equals(two) and list(one["trouble"]) == [""] * 6
    assert list(one.columns) == [path, "gravity.1", f"{channel} high", f"error of {channel} high", f"{channel} final", f"error of {channel} final",
                                 f"{channel} first", f"error of {channel} first", "verdict", "trouble"]
    assert one.attrs["units"][path] == "N" and one.attrs["units"][f"error of {channel} high"] == "m"
    for _, row in one.iterrows():
        run = model.with_values({path: row[path]}).run()
        extremes = run.extremes(channel)
        assert row[f"{channel} high"] == extremes["high"] and row[f"{channel} final"] == extremes["final"] and row["verdict"] == run.verdict
        assert row[f"error of {channel} high"] == extremes["high_error"]
    assert model.samples(values, wanted, estimate="never")[f"error of {channel} high"].isna().all()


def test_what_a_sample_cannot_be_is_said_and_has_no_number():
    model = steplap.load(PAPER, SHORT)
    (row,) = model.samples({"element.front block.stiffness": -1.0}, [("active part.x", "high")]).to_dict("records")
    assert np.isnan(row["active part.x high"]) and row["verdict"] == "open" and "stiffness" in row["trouble"]
    with pytest.raises(steplap.ModelError):
        model.samples({"element.nobody.stiffness": 1.0}, [("active part.x", "high")])
    stiffness = "element.front block.stiffness"
    for values in ({stiffness: np.ones((2, 2))}, {stiffness: np.ones(2), "gravity.1": np.ones(3)}, {stiffness: np.ones(0), "gravity.1": 1.0}):
        with pytest.raises(ValueError, match="all of one length"):
            model.samples(values, [("active part.x", "high")])
    for threads in (100000, 10**12):
        with pytest.raises((ValueError, TypeError), match="threads"):
            model.samples({"gravity.1": -9.81}, [("active part.x", "high")], threads=threads)


def test_other_threads_go_on_and_ctrl_c_ends_a_run():
    # Fixed steps: 2e7 of them take minutes, whereas a method that chooses its steps crosses a decayed motion at once.
    model = steplap.load(FIXED_STEPS, {"simulation.end": 2000.0, "output.step": 1.0})
    ticks = []
    stop = threading.Event()

    def tick():
        while not stop.wait(0.01):
            ticks.append(time.monotonic())

    ticker = threading.Thread(target=tick)
    ticker.start()
    killer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    killer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            model.run(estimate="never")
    finally:
        # A thread or a signal that outlived a failure would stop the tests that follow.
        killer.cancel()
        stop.set()
        ticker.join()
    assert len(ticks) > 3  # the lock was free; on a busy machine not each hundredth of a second is met


def test_no_run_leaves_memory_behind():
    model = steplap.load(PAPER, {"simulation.end": 0.01})
    for _ in range(20):
        model.run(estimate="never")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(200):
        model.run(estimate="never")
    # A run holds some hundred kB: 200 of them that stayed would be beyond this. kB
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 8000


def test_page_summary_and_equilibrium():
    model = steplap.load(PAPER, SHORT)
    run = model.run(estimate="never")
    assert "<html" in run.page() and run.summary == json.loads(run.json())
    assert run.summary["model"]["file"] == PAPER and run.verdict in ("hold", "open", "inspect", "reject")
    poses = steplap.load(str(MODELS / "machines/stacked_blocks.toml")).equilibrium()
    assert all(len(pose) == 3 for pose in poses.values())


def test_a_rest_that_is_found_by_overturning_is_a_warning():
    foot = {"kind": "unilateral_contact", "stiffness": 1e7, "damping": 1e5}
    box = {"gravity": [6.0, -9.81], "body": [{"name": "box", "mass": 1000.0, "inertia": 500.0, "position": [0.0, 1.0]}],
           "element": [{"name": "front", "a": {"body": "box", "at": [0.4, 0.0]}, **foot}, {"name": "rear", "a": {"body": "box", "at": [-0.4, 0.0]}, **foot},
                       {"name": "floor", "kind": "coulomb_stick", "contacts": ["front", "rear"], "static_friction": 0.8}]}
    model = steplap.build(box)
    for ask in (model.equilibrium, model.modes):
        with pytest.warns(UserWarning, match="does not stand as given"):
            ask()


def test_a_model_from_a_text_is_that_of_its_file(tmp_path):
    path = MODELS / "machines/ladder.toml"
    by_file, by_text = steplap.load(str(path)), steplap.loads(path.read_text(), path=str(path))
    assert by_text.text == by_file.text and by_text.path == by_file.path
    by_file.run().write(str(tmp_path / "file"))
    by_text.run().write(str(tmp_path / "text"))
    for file in ("trajectory.csv", "events.csv", "summary.json", "model.toml"):
        assert (tmp_path / "file" / file).read_bytes() == (tmp_path / "text" / file).read_bytes(), file
    changed = {"simulation.end": 0.01}
    assert by_text.with_values(changed).text == by_file.with_values(changed).text
    (row,) = by_text.with_values(changed).samples({"gravity.1": -9.81}, [("ladder.y", "final")]).to_dict("records")
    assert row["trouble"] == "" and row["ladder.y final"] == by_file.with_values(changed).run(estimate="never").extremes("ladder.y")["final"]
    with pytest.raises(steplap.ModelError) as caught:
        steplap.loads('[[body]]\nname = "a"\nmass = -1\ninertia = 1\n', path="made.toml")
    assert [(d.file, d.line, d.column) for d in caught.value.diagnostics] == [("made.toml", 3, 8)]


# A mass on a spring swings with sqrt(k/m) by the damping ratio c/(2 sqrt(k m)), from the elongation it is given.
def test_a_model_is_built_from_dictionaries_and_its_modes_are_known():
    k, m, c = 800.0, 2.0, 3.0
    oscillator = steplap.build({
        "title": 'a mass "on" a spring', "gravity": np.array([0.0, 0.0]),
        "simulation": {"end": 1.0, "tolerance": 1e-10},
        "body": [{"name": "mass", "mass": "2 kg", "inertia": 1, "velocity": [0.1, 0.0]}],
        "element": [{"name": "spring", "kind": "spring_damper", "a": "mass", "b": {"body": "ground", "at": [0.0, 0.0]}, "axis": [1, 0], "stiffness": k, "damping": c},
                    {"name": "guide", "kind": "prismatic", "a": "ground", "b": "mass", "axis": [1, 0]}]})
    assert oscillator.title == 'a mass "on" a spring' and oscillator.value("element.spring.damping") == c
    (mode,) = oscillator.modes()
    omega, zeta = np.sqrt(k / m), c / (2.0 * np.sqrt(k * m))
    assert abs(2.0 * np.pi * mode.natural_frequency / omega - 1.0) < 1e-10  # rounding of an eigenvalue
    assert abs(mode.damping_ratio / zeta - 1.0) < 1e-8
    assert abs(mode.eigenvalue - omega * complex(-zeta, np.sqrt(1.0 - zeta**2))) < 1e-8 * omega
    assert abs(mode.shape["mass"][0] - 1.0) < 1e-12 and abs(mode.shape["mass"][1]) < 1e-12
    run = oscillator.run()
    damped = omega * np.sqrt(1.0 - zeta**2)
    assert np.allclose(run["mass.x"], 0.1 / damped * np.exp(-zeta * omega * run.t) * np.sin(damped * run.t), atol=1e-9)  # tolerance 1e-10 a step
    assert abs(run.energy_residual) < 1e-6
    with pytest.raises(TypeError, match="body.mass"):
        steplap.build({"body": [{"name": "a", "mass": object()}]})


def test_joints_are_those_of_the_command_line():
    path = str(MODELS / "layouts/three_limb.toml")
    wrench = (53e3, -88e3, 0.0)
    said = json.loads(subprocess.run([PROGRAM, "joint", path, "--wrench", "53 kN,-88 kN,0", "--json"], check=True, capture_output=True, text=True).stdout)
    tables = {result["about"]: result["tables"] for result in said["results"] if "tables" in result}
    joints = steplap.load(path).joints()  # the model goes, they keep it
    assert [joint.name for joint in joints] == list(tables) and len(joints) == 3
    gc.collect()
    for joint in joints:
        table, required = tables[joint.name], joint.required(*wrench)
        assert [row["sliding"]["value"] for row in table["capacity"]] == list(joint.sliding)
        assert [row["alone"]["value"] for row in table["capacity"]] == list(joint.alone)
        assert required["usage"] == table["usage"]["u"] and required["pressure"] == table["usage"]["p_req"]["value"]
        assert required["margin"] == 1.0 / required["usage"]
        # Along x alone the joint bears its capacity, and what it takes grows with the wrench.
        assert abs(joint.required(joint.alone[0], 0.0, 0.0)["usage"] - 1.0) < 1e-9
        assert abs(joint.required(2.0 * wrench[0], 2.0 * wrench[1], 0.0)["usage"] / required["usage"] - 2.0) < 1e-9  # a solution to 1e-10
        assert all(row["overlap"] > 0.0 for row in joint.interfaces)


def test_a_joint_without_interfaces_holds_whatever_it_takes():
    bodies = [{"name": name, "mass": 1, "inertia": 1} for name in ("part", "limb")]
    (joint,) = steplap.build({"body": bodies, "element": [{"name": "joint", "kind": "step_lap_joint", "limb": "limb", "active_part": "part"}]}).joints()
    assert joint.interfaces == [] and list(joint.sliding) == list(joint.alone) == [np.inf] * 3
    assert joint.required(1e9, 0.0, 0.0) == {"usage": 0.0, "margin": np.inf, "pressure": None, "centre": None}


def test_the_page_about_python_says_what_is_true(tmp_path, monkeypatch):
    page = (MODELS.parent / "docs/how-to/use_from_python.md").read_text()
    blocks = [part.split("```")[0] for part in page.split("```python\n")[1:]]
    assert len(blocks) >= 4
    matplotlib = pytest.importorskip("matplotlib", reason="python3-matplotlib is not installed")
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "models").symlink_to(MODELS.resolve())
    names = {}
    for block in blocks:
        exec(compile(block, "use_from_python.md", "exec"), names)
    assert (tmp_path / "out/braked/summary.json").exists()
