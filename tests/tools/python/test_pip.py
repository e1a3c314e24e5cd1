"""pip install . from the checkout, into a virtual environment, without a network: from the build that is there, so that nothing is built twice.

usage: as test_module.py, with STEPLAP_BUILD leading to the build
"""
import os
import pathlib
import re
import subprocess
import zipfile

import pytest

PYTHON = "/usr/bin/python3"
ROOT = pathlib.Path(os.environ["STEPLAP_MODELS"]).resolve().parent
BUILD = os.environ.get("STEPLAP_BUILD", "")
HAS_PIP = subprocess.run([PYTHON, "-m", "pip", "--version"], capture_output=True).returncode == 0

needs_pip = pytest.mark.skipif(not HAS_PIP, reason="python3-pip is not installed")


def pip(environment, *arguments):
    # As a user calls it: without the path to the module that is built.
    clean = {key: value for key, value in os.environ.items() if not key.startswith("PYTHONPATH")}
    return subprocess.run([PYTHON, "-m", "pip", "--python", str(environment / "bin/python"), "--disable-pip-version-check", *arguments],
                          capture_output=True, text=True, env=clean, cwd=environment)


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pip")
    # --system-site-packages: numpy is Debian's.
    subprocess.run([PYTHON, "-m", "venv", "--system-site-packages", "--without-pip", str(folder)], check=True)
    return folder


@needs_pip
def test_installed_used_and_removed(environment):
    done = pip(environment, "install", "--no-index", str(ROOT), "--config-settings", f"build-dir={BUILD}")
    assert done.returncode == 0, done.stdout + done.stderr
    clean = {key: value for key, value in os.environ.items() if not key.startswith("PYTHONPATH")}
    said = subprocess.run([str(environment / "bin/python"), "-c",
                           f"import steplap; print(steplap.__file__); print(steplap.load('{ROOT}/models/paper/interference.toml', {{'simulation.end': 0.01}}).run().verdict)"],
                          capture_output=True, text=True, env=clean, cwd=environment)
    assert said.returncode == 0, said.stderr
    assert said.stdout.startswith(str(environment)) and said.stdout.split()[-1] in ("hold", "open", "inspect", "reject")
    shown = pip(environment, "show", "-f", "steplap").stdout
    for file in ("steplap/_steplap.pyi", "steplap/py.typed", "steplap/_steplap.", "LICENSE", "THIRD_PARTY.md"):
        assert file in shown, shown
    assert re.search(r"^Requires: numpy$", shown, re.M)
    assert pip(environment, "uninstall", "-y", "steplap").returncode == 0
    assert not list(environment.rglob("*steplap*"))


@needs_pip
def test_the_wheel_is_the_same_each_time(environment):
    names = []
    for folder in ("first", "second"):
        done = pip(environment, "wheel", "--no-index", "--no-deps", "-w", str(environment / folder), str(ROOT), "--config-settings", f"build-dir={BUILD}")
        assert done.returncode == 0, done.stdout + done.stderr
        names += list((environment / folder).glob("*.whl"))
    assert names[0].name == names[1].name and names[0].read_bytes() == names[1].read_bytes()
    with zipfile.ZipFile(names[0]) as wheel:
        assert wheel.testzip() is None
        version = names[0].name.split("-")[1]
        assert f"Version: {version}\n" in wheel.read(f"steplap-{version}.dist-info/METADATA").decode()
        assert {"steplap/__init__.py", "steplap/_steplap.pyi", "steplap/py.typed"} < set(wheel.namelist())


@needs_pip
def test_a_wheel_is_installed_from_its_folder(environment):
    built = pip(environment, "wheel", "--no-index", "--no-deps", "-w", str(environment / "wheels"), str(ROOT), "--config-settings", f"build-dir={BUILD}")
    assert built.returncode == 0, built.stdout + built.stderr
    done = pip(environment, "install", "--no-index", "--find-links", str(environment / "wheels"), "steplap")
    assert done.returncode == 0, done.stdout + done.stderr
    clean = {key: value for key, value in os.environ.items() if not key.startswith("PYTHONPATH")}
    said = subprocess.run([str(environment / "bin/python"), "-c", f"import steplap; print(steplap.cases('{ROOT}/models/cases/lorry.toml').verdict)"],
                          capture_output=True, text=True, env=clean, cwd=environment)
    assert said.stdout == "hold\n", said.stderr
    assert pip(environment, "uninstall", "-y", "steplap").returncode == 0


@needs_pip
def test_a_build_without_the_module_is_refused_in_words(environment, tmp_path):
    done = pip(environment, "install", "--no-index", str(ROOT), "--config-settings", f"build-dir={tmp_path}")
    assert done.returncode != 0
    assert "holds no module for this Python" in done.stdout + done.stderr
