#!/usr/bin/env python3
"""Checks what holds of every C++ file: tools/structure.py [ROOT]

- Includes run down: a folder uses itself and those that BELOW lists for it, and every file that is included is there.
- A header begins with a comment that says what it is for, and has #pragma once; C headers have guards.
- No file has more than MOST_LINES lines.
Prints one line for each fault, PATH:LINE: WHAT, and exits with 1 where there is one.
"""
import pathlib
import re
import subprocess
import sys

BELOW = {
    "format": [],
    "ingest": ["format"],
    "compressor": ["format", "ingest"],
    "gpu": ["format"],
    "daemon": ["format", "ingest", "compressor"],
    "tools": ["format", "ingest", "compressor", "gpu", "daemon"],
    "bindings": ["format", "ingest", "compressor", "gpu", "tools"],
    "bench": ["format", "ingest", "compressor", "gpu"],
    "examples": ["format", "gpu"],
    "tests": ["format", "ingest", "compressor", "gpu", "daemon", "tools", "bindings"],
}
MOST_LINES = 600


def faults(root, name, known):
    text = (root / name).read_text(encoding="utf-8")
    lines = text.splitlines()
    folder = name.split("/")[0]
    if folder not in BELOW:
        yield 1, f"{folder}/ is no folder of C++ files; name it in tools/structure.py with what it may include"
        return
    for number, line in enumerate(lines, 1):
        found = re.match(r'#include "([^"]+)"', line)
        if not found:
            continue
        included = found.group(1)
        installed = "/" not in included and f"bindings/c/{included}" in known
        beside = str(pathlib.PurePosixPath(name).parent / included)
        if not installed and included not in known and beside not in known:
            yield number, f'there is no "{included}"'
        elif "/" in included and included.split("/")[0] not in [folder, *BELOW[folder]]:
            yield number, f'{folder}/ is below {included.split("/")[0]}/ and may not include "{included}"'
    if name.endswith((".h", ".cuh")):
        if not lines or not lines[0].startswith(("//", "/*")):
            yield 1, "begins without a comment that says what it is for"
        if "#pragma once" not in lines and not re.search(r"^#ifndef \w+_H\n#define \w+_H$", text, re.MULTILINE):
            yield 1, "has no #pragma once"
    if len(lines) > MOST_LINES:
        yield MOST_LINES + 1, f"has {len(lines)} lines, more than {MOST_LINES}; split it"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    listed = subprocess.run(["git", "ls-files", "-z", "*.h", "*.cpp", "*.cu", "*.cuh"], cwd=root, check=True, text=True,
                            stdout=subprocess.PIPE).stdout
    names = [name for name in listed.split("\0") if name]
    found = [f"{name}:{line}: {what}" for name in names for line, what in faults(root, name, set(names))]
    print("\n".join(found) if found else f"{len(names)} files")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
