"""What users of Python expect of any module: paths, pickles, signatures, iteration; and that nothing aborts the interpreter.

usage: as test_module.py
"""
import copy
import inspect
import multiprocessing
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import steplap

MODELS = pathlib.Path(os.environ["STEPLAP_MODELS"]).resolve()
PAPER = MODELS / "paper/interference.toml"
SHORT = {"simulation.end": 0.05}


def test_paths_are_those_of_pathlib(tmp_path):
    run = steplap.load(PAPER, SHORT).run(estimate="never")
    run.write(tmp_path / "run")
    assert (tmp_path / "run/summary.json").exists()
    assert steplap.loads(PAPER.with_name("no_interference.toml").read_text(), path=PAPER).path == str(PAPER)


def test_a_missing_file_is_file_not_found(tmp_path):
    missing = tmp_path / "nowhere.toml"
    extending = tmp_path / "extending.toml"
    extending.write_text('extends = "nowhere.toml"\n')
    for path in (missing, extending):  # itself, and what it names
        with pytest.raises(FileNotFoundError) as caught:
            steplap.load(path)
        error = caught.value
        assert isinstance(error, steplap.ModelError) and isinstance(error, steplap.FileError)
        assert error.filename == error.path == str(missing) and error.errno == 2 and len(error.diagnostics) == 1
    with pytest.raises(steplap.ModelError) as caught:
        steplap.load(tmp_path)  # a folder is not missing
    assert not isinstance(caught.value, FileNotFoundError)


def test_names_that_are_not_utf8_are_named_in_errors():
    with pytest.raises(FileNotFoundError) as caught:
        steplap.load("/nowhere/\udcff.toml")
    assert caught.value.filename == "/nowhere/\udcff.toml"


# The text of a model holds its overrides: laid over it again, they change nothing.
@pytest.mark.parametrize("name", ["paper/interference", "layouts/three_limb", "loads/wagon_vibration", "machines/ladder"])
def test_a_pickled_model_makes_the_same_run(name, tmp_path):
    model = steplap.load(MODELS / f"{name}.toml", {"simulation.end": 0.05, "gravity": [0.0, -9.8]})
    kept = pickle.loads(pickle.dumps(model))
    assert (kept.text, kept.path, kept.overrides) == (model.text, model.path, model.overrides)
    assert np.array_equal(kept.run(estimate="never").values, model.run(estimate="never").values, equal_nan=True)
    assert kept.with_values({"simulation.end": 0.02}).value("simulation.end") == 0.02


def test_a_pickled_run_has_the_same_results_and_files(tmp_path):
    run = steplap.load(PAPER, {"simulation.end": 0.2}).run()
    for kept in (pickle.loads(pickle.dumps(run)), copy.deepcopy(run)):
        assert np.array_equal(kept.values, run.values, equal_nan=True) and kept.names == run.names and kept.units == run.units
        for name in ("verdict", "distrust", "caps", "energy_residual", "failure", "summary"):
            assert getattr(kept, name) == getattr(run, name), name
        for name in ("criteria", "findings", "events"):
            assert list(map(repr, getattr(kept, name))) == list(map(repr, getattr(run, name))), name
        assert all(str(kept.extremes(channel)) == str(run.extremes(channel)) for channel in run.names[1:])
        assert kept.page() == run.page()
    run.write(tmp_path / "run")
    kept.write(tmp_path / "kept")
    files = sorted(path.name for path in (tmp_path / "run").iterdir())
    assert files == sorted(path.name for path in (tmp_path / "kept").iterdir())
    for file in files:
        assert (tmp_path / "run" / file).read_bytes() == (tmp_path / "kept" / file).read_bytes(), file


def test_a_pickle_of_another_version_is_refused():
    run = steplap.load(PAPER, SHORT).run(estimate="never")
    old = pickle.dumps(run, protocol=2).replace(steplap.__version__.encode(), b"0.0.9", 1)
    with pytest.raises(ValueError, match="pickled by steplap 0.0.9"):
        pickle.loads(old)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_protocol_pickles_and_what_cannot_says_so(protocol):
    model = steplap.load(PAPER, SHORT)
    assert pickle.loads(pickle.dumps(model, protocol)).text == model.text
    with pytest.raises(TypeError, match="cannot pickle 'Joint'"):
        pickle.dumps(model.joints()[0], protocol)


def test_errors_pickle_with_their_fields(tmp_path):
    broken = tmp_path / "broken.toml"
    broken.write_text('[[body]]\nname = "a"\nmass = -1\ninertia = 1\nmas = 2\n')
    for path in (broken, tmp_path / "nowhere.toml"):
        with pytest.raises(steplap.ModelError) as caught:
            steplap.load(path)
        kept = pickle.loads(pickle.dumps(caught.value))
        assert type(kept) is type(caught.value) and str(kept) == str(caught.value)
        assert [(d.file, d.line, d.column, d.message) for d in kept.diagnostics] == [(d.file, d.line, d.column, d.message) for d in caught.value.diagnostics]
    failure = pickle.loads(pickle.dumps(steplap.FileError("full", "out", 3)))
    assert (failure.path, failure.line, str(failure)) == ("out", 3, "full")


def ran(model):
    return model.run(estimate="never")


def test_multiprocessing_and_joblib_pass_models_and_runs():
    models = [steplap.load(PAPER, {"simulation.end": end}) for end in (0.02, 0.03)]
    alone = [ran(model).values for model in models]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        runs = pool.map(ran, models)
    assert all(np.array_equal(run.values, values, equal_nan=True) for run, values in zip(runs, alone))
    with pytest.raises(steplap.ModelError), multiprocessing.get_context("fork").Pool(1) as pool:
        pool.map(steplap.load, ["/nowhere.toml"])
    joblib = pytest.importorskip("joblib", reason="python3-joblib is not installed")
    runs = joblib.Parallel(n_jobs=2)(joblib.delayed(ran)(model) for model in models)
    assert all(np.array_equal(run.values, values, equal_nan=True) for run, values in zip(runs, alone))


def test_a_run_is_iterated_as_a_data_frame():
    run = steplap.load(PAPER, SHORT).run(estimate="never")
    assert list(run) == list(run.keys()) == run.names and "t" in run and "nobody.x" not in run
    assert np.array_equal(dict(run)["active part.x"], run["active part.x"])


def test_frames_are_writable_and_have_units():
    pytest.importorskip("pandas", reason="python3-pandas is not installed")
    run = steplap.load(PAPER, SHORT).run(estimate="never")
    frame = run.to_pandas()
    frame.iloc[0, 0] = 1e9
    frame["active part.x"] *= 2.0
    assert frame.attrs["units"]["active part.x"] == "m" and np.nanmax(run.values) < 1e9


def test_signatures_have_names_and_defaults():
    assert list(inspect.signature(steplap.load).parameters) == ["path", "values"]
    assert list(inspect.signature(steplap.Model.run).parameters)[:3] == ["self", "method", "tolerance"]
    assert inspect.signature(steplap.load(PAPER).run).parameters["estimate"].default == "cheap"


def test_a_list_in_itself_is_an_error():
    endless = []
    endless.append(endless)
    for make in (steplap.load(PAPER).with_values, steplap.build):
        with pytest.raises(TypeError, match="'gravity' is nested"):
            make({"gravity": endless})


@pytest.mark.parametrize("name", ["Criterion", "Event", "Finding", "Joint", "Mode", "Model", "Run"])
def test_no_object_is_without_contents(name):
    cls = getattr(steplap, name)
    for make in (cls, lambda: cls.__new__(cls), type("Own", (cls,), {})):
        with pytest.raises(TypeError, match="constructor"):
            make()


# The model takes minutes; the interpreter ends after half a second, whatever its daemon thread computes.
def test_exit_while_a_thread_runs_is_an_exit():
    code = f"""if True:
        import steplap, threading, time
        model = steplap.load({str(MODELS / "paper/interference_rk4.toml")!r}, {{"simulation.end": 2000.0, "output.step": 1.0}})
        threading.Thread(target=model.run, daemon=True).start()
        time.sleep(0.5)
        print("ends")"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, "ends\n"), done.stderr


# CPU time, because the machine may be busy. One that computes on all processors counts the work of all.
def seconds_to_stop(compute, after):
    sent = []

    def interrupt():
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, interrupt)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            compute()
        return time.process_time() - sent[0]
    finally:
        timer.cancel()


ENDLESS = {"simulation.end": 2000.0, "output.step": 1.0}


@pytest.mark.parametrize("after", [0.2, 1.0, 2.0])
def test_ctrl_c_stops_a_run_with_its_estimate_within_a_fifth_of_a_second(after):
    model = steplap.load(MODELS / "paper/interference_rk4.toml", {"simulation.end": 3.0})
    assert seconds_to_stop(lambda: [model.run(estimate="always", second_opinion=True) for _ in range(50)], after) < 0.2


def test_ctrl_c_stops_samples_within_a_fifth_of_a_second():
    model = steplap.load(MODELS / "paper/interference_rk4.toml", ENDLESS)
    wanted = [("active part.x", "high")]
    assert seconds_to_stop(lambda: model.samples({"gravity.1": np.full(8, -9.81)}, wanted), 0.5) < 0.2 * os.cpu_count()


def test_a_run_beyond_its_time_limit_is_open_and_has_what_was_found():
    model = steplap.load(MODELS / "paper/interference_rk4.toml", ENDLESS)
    began = time.monotonic()
    run = model.run(time_limit=0.5)
    assert time.monotonic() - began < 20.0  # of hours, on a busy machine, too
    assert run.verdict == "open" and "time limit of 0.5 s" in run.failure and 0.0 < run.t[-1] < 2000.0
    with pytest.raises(ValueError, match="time_limit"):
        model.run(time_limit=0.0)
    with pytest.raises(steplap.NumericalFailure, match="memory limit of 1 MB"):
        model.run(memory_limit=1e6)  # Python alone holds more
    with pytest.raises(ValueError, match="memory_limit"):
        model.run(memory_limit=0.0)
