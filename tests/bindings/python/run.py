"""Runs the tests of one file: run.py test_NAME.py. If all tests were skipped, prints why and exits with 77."""

import importlib.util
import pathlib
import sys
import unittest


def main() -> int:
    path = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(path.parent))
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except unittest.SkipTest as reason:
        print(f"skipped: {reason}")
        return 77
    result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromModule(module))
    if result.testsRun == 0:
        print(f"{path}: has no tests", file=sys.stderr)
        return 1
    if result.wasSuccessful() and len(result.skipped) == result.testsRun:
        return 77
    return 0 if result.wasSuccessful() else 1


sys.exit(main())
