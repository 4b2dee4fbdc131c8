#!/usr/bin/env python3
"""Checks rules for the structure of the C++ files: tools/structure.py [--figures] [ROOT]

A room is a folder. A unit, a "concept" in messages, is a header with its source.
- Includes run down: a folder includes only files of itself and of the folders that BELOW lists for it. Every included
  file exists.
- There are no include cycles between units. Outside tests/ there are none between rooms either.
- The map in CONTRIBUTING.md names the rooms of its folders, and those of gpu/cuda/.
- No two types in named namespaces have the same qualified name (the one-definition rule).
- A header begins with a comment that says what it is for, and has #pragma once; C headers have guards.
- No file has more than MOST_LINES lines, no folder more than MOST_FILES files, and at most the share MOST_SMALL of
  all units has fewer than SMALL lines.
Prints one line for each fault, PATH:LINE: WHAT, and exits with 1 if there are any. --figures also prints the counts.
"""
import collections
import os
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
MOST_LINES = 400
MOST_FILES = 40
SMALL = 40
MOST_SMALL = 0.2


def faults(name, text, known):
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


def unmapped(names, contributing):
    """Yields (line, message) for each room that the map under "Where things are" does not name beside its folder."""
    lines = contributing.splitlines()
    if "## Where things are" not in lines:
        return
    first = lines.index("```", lines.index("## Where things are")) + 1
    last = lines.index("```", first)
    mapped = collections.defaultdict(set)  # names by folder
    begins = {}
    folder = None
    for number in range(first, last):
        if begin := re.match(r"([a-z]+)/ ", lines[number]):
            folder = begin.group(1)
            begins[folder] = number + 1
        mapped[folder].update(re.findall(r"([a-z0-9_]+)/(?!\w)", lines[number]))
    rooms = {tuple(pathlib.PurePosixPath(name).parent.parts) for name in names}
    for room in sorted(rooms):
        if not room or room[0] not in begins or room[0] in ("tests", "bindings") or room[-1] in mapped[room[0]]:
            continue
        if len(room) == 2 or room[:2] == ("gpu", "cuda"):
            yield begins[room[0]], f"the map does not name {'/'.join(room)}/; add what it holds"


def unit(name):
    """Returns the name of a file's unit: its path without the extension."""
    return re.sub(r"\.(h|cpp|cu|cuh)$", "", name)


def include_graph(texts):
    uses = {unit(name): set() for name in texts}
    for name, text in texts.items():
        for included in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE):
            if included in texts and unit(included) != unit(name):
                uses[unit(name)].add(unit(included))
    return uses


def room_graph(uses):
    """Returns the include graph of folders. A folder with rooms may use its rooms, but the rooms must not use it."""
    rooms = collections.defaultdict(set)
    for one, others in uses.items():
        for other in others:
            here, there = os.path.dirname(one), os.path.dirname(other)
            if here != there:
                rooms[here].add(there)
    return rooms


def circles(uses):
    """Returns the strongly connected components of more than one node (Tarjan's algorithm)."""
    order, low, stack, found = {}, {}, [], []

    def visit(node):
        order[node] = low[node] = len(order)
        stack.append(node)
        for other in sorted(uses.get(node, ())):
            if other not in order:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], order[other])
        if low[node] == order[node]:
            part = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(part) > 1:
                found.append(sorted(part))

    for node in sorted(uses):
        if node not in order:
            visit(node)
    return found


CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
SCOPE = re.compile(r"(?:inline\s+)?namespace\s*([\w:]*)\s*\{"
                   r"|(?:class|struct|union|enum(?:\s+class|\s+struct)?)\s+(?:alignas\([^)]*\)\s*)?([\w:]+)\s*(?:final\s*)?(?::[^;{}()]*)?\{|[{}]")


def types(text):
    """Yields (qualified name, line) of each type defined in a named namespace, but not in a function or a class."""
    text = CODE.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)
    text = re.sub(r"^#.*$", lambda found: " " * len(found.group()), text, flags=re.MULTILINE)
    scopes = []
    for found in SCOPE.finditer(text):
        if found.group() == "}":
            if scopes:
                scopes.pop()
        elif found.group(1) is not None:
            scopes.append(found.group(1) or "(unnamed)")
        elif found.group(2) is not None:
            name = found.group(2)
            if scopes and all(scope and scope != "(unnamed)" for scope in scopes):
                yield "::".join([*scopes, name]), text.count("\n", 0, found.start()) + 1
            scopes.append("")
        else:
            scopes.append("")


def defined_twice(texts):
    places = collections.defaultdict(list)
    for name, text in texts.items():
        for qualified, line in types(text):
            places[qualified].append((name, line))
    for qualified, where in sorted(places.items()):
        # Examples and benchmarks are separate programs, so equal names in them do not conflict.
        together = [(name, line) for name, line in where if not name.startswith(("examples/", "bench/"))]
        if len({name for name, _ in together}) > 1:
            yield *together[1], f"{qualified} is defined in {together[0][0]}:{together[0][1]}, too; rename one"


def main():
    arguments = [a for a in sys.argv[1:] if a != "--figures"]
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    listed = subprocess.run(["git", "ls-files", "-z", "*.h", "*.cpp", "*.cu", "*.cuh"], cwd=root, check=True, text=True,
                            stdout=subprocess.PIPE).stdout
    texts = {name: (root / name).read_text(encoding="utf-8") for name in listed.split("\0") if name}
    found = [f"{name}:{line}: {what}" for name, text in texts.items() for line, what in faults(name, text, set(texts))]
    contributing = root / "CONTRIBUTING.md"
    if contributing.exists():
        found += [f"CONTRIBUTING.md:{line}: {what}" for line, what in unmapped(texts, contributing.read_text(encoding="utf-8"))]
    uses = include_graph(texts)
    rooms = room_graph({one: others for one, others in uses.items() if not one.startswith("tests/")})
    of_files, of_rooms = circles(uses), circles(rooms)
    found += [f"{part[0]}: includes run in a circle: {', '.join(part)}" for part in [*of_files, *of_rooms]]
    twice = list(defined_twice(texts))
    found += [f"{name}:{line}: {what}" for name, line, what in twice]
    folders = collections.Counter(os.path.dirname(name) for name in texts)
    found += [f"{folder}/: has {count} files, more than {MOST_FILES}; part it" for folder, count in sorted(folders.items())
              if count > MOST_FILES]
    lines = {name: len(text.splitlines()) for name, text in texts.items()}
    concepts = collections.Counter()
    for name, count in lines.items():
        concepts[name.rsplit(".", 1)[0]] += count
    small = sum(count < SMALL for count in concepts.values()) / max(len(concepts), 1)
    if small > MOST_SMALL and len(texts) > 100:
        found.append(f".: {small:.0%} of the concepts have fewer than {SMALL} lines; merge those with one user")
    print("\n".join(found) if found else f"{len(texts)} files")
    if "--figures" in sys.argv:
        largest, count = folders.most_common(1)[0]
        print(f"folders {len(folders)}, the largest {largest} with {count} files; circles of files {len(of_files)}, of rooms "
              f"{len(of_rooms)}; types defined twice {len(twice)}; files above 400 lines "
              f"{sum(c > 400 for c in lines.values())}; below {SMALL} lines "
              f"{sum(c < SMALL for c in lines.values()) / max(len(lines), 1):.0%} of the files, {small:.0%} of the concepts")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
