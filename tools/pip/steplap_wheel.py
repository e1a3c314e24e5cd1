"""Builds the wheel of the module `steplap` with CMake, for pip (PEP 517). Requires only Python and the packages for the build (tools/setup).

Settings of pip, each as --config-settings NAME=VALUE:
  build-dir   a finished build with STEPLAP_PYTHON_MODULE=ON; if not given, the module is built in build/pip
  jobs        number of parallel compilations (default: all processors)
"""
import base64
import hashlib
import os
import pathlib
import platform
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATE = (1980, 1, 1, 0, 0, 0)  # date of all files, fixed so that equal sources give equal bytes


def version():
    found = re.search(r"project\s*\(\s*steplap\s+VERSION\s+([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    if not found:
        raise SystemExit("steplap: CMakeLists.txt does not say a version")
    return found[1]


def system():
    """Returns the system whose shared libraries the module loads: "Debian GNU/Linux 12 (bookworm), x86_64"."""
    return f"{platform.freedesktop_os_release()['PRETTY_NAME']}, {platform.machine()}"


def metadata():
    head = {"Metadata-Version": "2.1", "Name": "steplap", "Version": version(), "Summary": "Planar multibody dynamics with honest friction",
            "License": "MIT", "Platform": system(), "Requires-Python": ">=3.11", "Requires-Dist": "numpy", "Description-Content-Type": "text/markdown"}
    return "".join(f"{key}: {value}\n" for key, value in head.items()) + "\n" + (ROOT / "README.md").read_text(encoding="utf-8")


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def run(*command):
    print("steplap:", *command, flush=True)
    if subprocess.run(command, cwd=ROOT).returncode != 0:
        raise SystemExit(f"steplap: '{command[0]} {command[1]}' failed; what building needs is installed by: tools/setup pybind11-dev python3-dev python3-numpy")


def build(settings):
    """Returns the folder of a build that contains the module."""
    given = settings.get("build-dir")
    folder = (ROOT / (given or "build/pip")).resolve()
    if not given:
        run("cmake", "-S", str(ROOT), "-B", str(folder), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DSTEPLAP_TESTS=OFF", "-DSTEPLAP_PYTHON_MODULE=ON",
            f"-DPython_EXECUTABLE={sys.executable}")
        run("cmake", "--build", str(folder), "--target", "steplap_python", "--parallel", settings.get("jobs") or str(os.cpu_count()))
    name = "_steplap" + sysconfig.get_config_var("EXT_SUFFIX")
    if not (folder / "python" / "steplap" / name).exists():
        raise SystemExit(f"steplap: '{folder}' holds no module for this Python ({name}): configure with -DSTEPLAP_PYTHON_MODULE=ON and build steplap_python, or leave build-dir out")
    return folder


class Wheel:
    def __init__(self, path):
        self.file = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self.record = []

    def add(self, name, data, mode=0o644):
        info = zipfile.ZipInfo(name, DATE)
        info.external_attr = (0o100000 | mode) << 16
        info.compress_type = zipfile.ZIP_DEFLATED
        self.file.writestr(info, data)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.record.append(f"{name},sha256={digest},{len(data)}\n")

    def close(self, name):
        self.add(name, ("".join(self.record) + f"{name},,\n").encode())
        self.file.close()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = build(config_settings or {})
    name = f"steplap-{version()}-{tag()}.whl"
    info = f"steplap-{version()}.dist-info"
    with tempfile.TemporaryDirectory() as staging:
        run("cmake", "--install", str(folder), "--component", "python", "--prefix", staging, "--strip")
        wheel = Wheel(pathlib.Path(wheel_directory) / name)
        installed = pathlib.Path(staging) / "lib/python3/dist-packages"
        for path in sorted(p for p in installed.rglob("*") if p.is_file()):
            wheel.add(str(path.relative_to(installed)), path.read_bytes(), 0o755 if path.suffix == ".so" else 0o644)
    wheel.add(f"{info}/METADATA", metadata().encode())
    wheel.add(f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: steplap\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode())
    for notice in ("LICENSE", "THIRD_PARTY.md"):
        wheel.add(f"{info}/{notice}", (ROOT / notice).read_bytes())
    wheel.close(f"{info}/RECORD")
    return name


def build_sdist(sdist_directory, config_settings=None):
    """Makes a source archive of the files known to git, with the required metadata."""
    base = f"steplap-{version()}"
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")
    with tempfile.TemporaryDirectory() as folder, tarfile.open(pathlib.Path(sdist_directory) / f"{base}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        described = pathlib.Path(folder) / "PKG-INFO"
        described.write_text(metadata(), encoding="utf-8")
        archive.add(described, f"{base}/PKG-INFO")
        for name in sorted(filter(None, files)):
            archive.add(ROOT / name, f"{base}/{name}", recursive=False)
    return f"{base}.tar.gz"
