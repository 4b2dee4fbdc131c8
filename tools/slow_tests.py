#!/usr/bin/env python3
"""slow_tests.py BUILD: prints tests/slow_tests.txt anew: the names of the tests that took 3 s or more when ctest last ran in
that build folder, with all tests (WEIR_SLOW_TESTS=ON)."""
import glob
import re
import sys
import xml.etree.ElementTree as ElementTree

LEAST_SECONDS = 3
# Tests of weir's main promises. `tools/test.sh` always runs them, however long they take.
KEPT = {
    "Memory.ATwoGibibyteVolumeStaysUnderTheCeiling",
    "StockTools.ValidateEveryKindOfTree",
    "python.interpreter_end",
    "All/Documentation.CommandsGiveTheDocumentedResults/README",
}


def grouped(build):
    """Yields name and seconds of each test that ran with others in one process."""
    for path in glob.glob(f"{build}/test_results/*-*.xml"):
        for case in ElementTree.parse(path).getroot().iter("testcase"):
            yield f"{case.get('classname')}.{case.get('name')}", float(case.get("time", 0))


def alone(build):
    """Yields name and seconds of each test that ran in its own process."""
    with open(f"{build}/Testing/Temporary/LastTest.log", errors="replace") as log:
        text = log.read()
    names = re.findall(r"^\d+/\d+ Testing: (.*)$", text, re.M)
    seconds = re.findall(r"^Test time = +([\d.]+) sec", text, re.M)
    for name, took in zip(names, seconds):
        if not re.fullmatch(r"weir_tests_\w+/\d+", name):
            yield name, float(took)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(f"{sys.argv[1]}/CMakeCache.txt", encoding="utf-8") as cache:
        if "WEIR_SLOW_TESTS:BOOL=OFF" in cache.read():
            sys.exit(f"{sys.argv[1]}: its slow tests are left out; configure it with -D WEIR_SLOW_TESTS=ON and run ctest")
    tests = [*grouped(sys.argv[1]), *alone(sys.argv[1])]
    slow = sorted(name for name, seconds in tests if seconds >= LEAST_SECONDS and name not in KEPT)
    print("# Tests that took 3 s or more on two processors: `tools/test.sh` leaves them out, `tools/test.sh --ci` runs most.")
    print("# Written by tools/slow_tests.py.")
    print("\n".join(slow))


main()
