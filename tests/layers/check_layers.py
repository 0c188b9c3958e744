#!/usr/bin/env python3
"""Proves the layer rule (docs/pipeline.md, CONTRIBUTING.md) from the #include lines.

usage: check_layers.py SOURCE_FOLDER

Prints one line a violation, `file:line: what`, and exits with 1 if there is any, with 2 if it found
nothing to check.
"""

import pathlib
import re
import sys

CHAIN = ["core", "geometry", "camera", "detection", "stereo", "pose", "motion", "pipeline"]


def up_to(layer):
    return set(CHAIN[: CHAIN.index(layer) + 1])


# Layer -> the other layers whose headers it may include.
ALLOWED = {layer: up_to(layer) for layer in CHAIN}
ALLOWED["capture"] = {"core"}
ALLOWED["calibration"] = up_to("detection")
ALLOWED["simulation"] = up_to("pose")
ALLOWED["io"] = up_to("motion")

# Single headers beyond that: plain values which files are read into.
EXTRA_HEADERS = {
    "io": {
        "simulation/scenario.h",
        "calibration/calibration.h",
        "calibration/calibration_setup.h",
        "calibration/find_control_points.h",
        "calibration/target.h",
    }
}

STD_HEADERS = set(
    """algorithm any array atomic bitset cassert ccomplex cctype cerrno cfenv cfloat charconv chrono
    cinttypes climits clocale cmath codecvt complex condition_variable csetjmp csignal cstdarg
    cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar cwctype deque exception execution
    filesystem forward_list fstream functional future initializer_list iomanip ios iosfwd iostream
    istream iterator limits list locale map memory memory_resource mutex new numeric optional
    ostream queue random ratio regex scoped_allocator set shared_mutex sstream stack stdexcept
    streambuf string string_view strstream system_error thread tuple type_traits typeindex typeinfo
    unordered_map unordered_set utility valarray variant vector""".split()
)

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SUFFIXES = {".h", ".cc"}


def includes(path):
    """Yields (line number, what) of every #include line, also of disabled ones."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def target_of(root, path, name):
    """Finds the project file that an include names: (top folder, path below it), or None.

    The top folder is `public` (include/stereomotion), `private` (src) or `apps`.
    """
    if name.startswith("stereomotion/"):
        return "public", name[len("stereomotion/"):]
    if name.startswith("apps/"):
        return "apps", name
    folders = {
        "public": root / "include" / "stereomotion",
        "private": root / "src",
        "apps": root / "apps",
    }
    for base in (path.parent, folders["private"], folders["apps"], root):
        found = (base / name).resolve()
        for top, folder in folders.items():
            if found.is_file() and found.is_relative_to(folder.resolve()):
                return top, found.relative_to(folder.resolve()).as_posix()
    first = name.split("/")[0]
    return ("private", name) if first in ALLOWED and "/" in name else None


def check_include(root, path, layer, is_public, name):
    """Returns what is wrong with one include, or None."""
    target = target_of(root, path, name)
    if target is None:
        if not is_public:
            return None
        if name in STD_HEADERS or name.startswith("Eigen/"):
            return None
        return f"public header includes {name}: only std, Eigen and stereomotion headers may appear"
    top, below = target
    if top == "apps":
        return f"includes {name}: nothing includes apps"
    if is_public and top == "private":
        return f"public header includes the private {name}"
    if is_public and not name.startswith("stereomotion/"):
        return f"spells {name} by a path that is not installed: write stereomotion/{below}"
    other = below.split("/")[0]
    if other not in ALLOWED:
        return f"includes {name}: {other} is no layer"
    if other == layer or other in ALLOWED[layer] or below in EXTRA_HEADERS.get(layer, ()):
        return None
    return f"{layer} includes {name}: it may see only {', '.join(sorted(ALLOWED[layer]))}"


def check_tree(root):
    """Returns (number of files checked, list of violations) of a source tree."""
    count, violations = 0, []
    for folder, is_public in (("include/stereomotion", True), ("src", False)):
        base = root / folder
        for path in sorted(p for p in base.rglob("*") if p.suffix in SUFFIXES):
            count += 1
            where = path.relative_to(root)
            layer = path.relative_to(base).parts[0]
            if layer not in ALLOWED:
                violations.append(f"{where}:1: lies in no layer's folder")
                continue
            for number, name in includes(path):
                wrong = check_include(root, path, layer, is_public, name)
                if wrong:
                    violations.append(f"{where}:{number}: {wrong}")
    return count, violations


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    count, violations = check_tree(pathlib.Path(arguments[1]).resolve())
    for violation in violations:
        print(violation)
    if count == 0:
        print(f"{arguments[1]}: no headers or sources found", file=sys.stderr)
        return 2
    print(f"{count} files, {len(violations)} violations")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
