"""Holds THIRD_PARTY.md to what the compiler read: licences.py ROOT BUILD NINJA

Every header from outside the project belongs to a package of the table, and no header of CGAL is under the GPL alone.
"""

import collections
import pathlib
import re
import subprocess
import sys


def headers(build, ninja):
    """All files outside the project on which any object of the build depends."""
    listing = subprocess.run([ninja, "-C", build, "-t", "deps"], capture_output=True, text=True, check=True).stdout
    return sorted({line.strip() for line in listing.splitlines() if line.startswith("    /usr/")})


def packages(files):
    """Which Debian package each file is of; files that none knows are of the name ''."""
    found = collections.defaultdict(list)
    for start in range(0, len(files), 1000):
        part = files[start : start + 1000]
        answer = subprocess.run(["dpkg", "-S", *part], capture_output=True, text=True).stdout
        known = {}
        for line in answer.splitlines():
            package, _, path = line.rpartition(": ")
            known[path] = package.split(",")[0].split(":")[0]
        for file in part:
            found[known.get(file, "")].append(file)
    return found


def main():
    root, build, ninja = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    table = {m.group(1) for m in re.finditer(r"^\| (\S+)[^|]*\| [^|]+\| [^|]+\| [^|]+\|$", (root / "THIRD_PARTY.md").read_text(), re.M)}
    read = headers(build, ninja)
    if len(read) < 500:
        sys.exit(f"the build knows of {len(read)} headers of others only: it is not complete")
    wrong = []
    for package, files in packages(read).items():
        # Versions in names change with the system; what they are does not.
        name = re.sub(r"^(libboost)[0-9.]+-dev$", r"\g<1>1.74-dev", re.sub(r"^(lib(?:stdc\+\+|gcc))-[0-9]+-dev$", r"\1-12-dev", package))
        if package and name not in table:
            wrong.append(f"{package} is not in the table of THIRD_PARTY.md: {files[0]}")
    cgal = [file for file in read if "/CGAL/" in file]
    if not cgal:
        wrong.append("no header of CGAL was read: is this the build of the program?")
    for file in cgal:
        if identifier := re.search(r"SPDX-License-Identifier: (.*)", pathlib.Path(file).read_text(errors="replace")):
            if re.search(r"(?<!L)GPL", identifier.group(1)):
                wrong.append(f"{file} is under {identifier.group(1).strip()}")
    fftw = [file for file in read if file.endswith("fftw3.h")]
    wrong += [f"{file} is under the GPL" for file in fftw]
    print("\n".join(wrong) or f"{len(read)} headers of others, {len(cgal)} of them CGAL's: all under licences of the table")
    sys.exit(1 if wrong else 0)


main()
