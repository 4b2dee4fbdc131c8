"""Tests that all front ends know the same options and refuse wrong ones for the same reason."""

import inspect
import json
import re
import unittest

import weir
from support import SOURCE, FolderTest, ramp

WRONG = json.loads((SOURCE / "tests/tools/options/wrong_options.json").read_text())


def keyword(option):
    return option.replace("-", "_")


class Options(FolderTest):
    def test_wrong_options_are_refused_for_the_same_reason(self):
        for wrong in WRONG:
            reason = re.sub(r"\{([^}]*)\}", lambda option: keyword(option[1]), wrong["reason"])
            with self.subTest(reason):
                given = {keyword(key): text for key, text in wrong["given"].items()}
                message = self.refused(weir.UsageError, weir.convert, ramp(9, 9, 9), self.folder / "a.nvdb", **given)
                self.assertEqual(message, reason)

    def test_flags_take_what_is_true_or_false(self):
        import numpy

        for value in (True, 1, numpy.True_):
            record = weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", lossless=value, overwrite=1)
            self.assertEqual(record["weir"]["options"]["lossless"], "true")
        for value in (False, 0, numpy.False_, None):
            record = weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", lossless=value, overwrite=True)
            self.assertNotIn("lossless", record["weir"]["options"])

    def test_arrays_without_axes_and_paths_of_bytes_are_what_they_hold(self):
        import numpy

        record = weir.convert(
            ramp(9, 9, 9),
            self.folder / "a.nvdb",
            psnr=numpy.array(40.5),
            lossless=numpy.array(False),
            spacing=(numpy.array(1), 2, 3),
            dataset=b"rho",
            work_dir=str(self.folder).encode(),
        )
        options = record["weir"]["options"]
        self.assertEqual(
            {name: options.get(name) for name in ("psnr", "lossless", "spacing", "dataset", "work-dir")},
            {"psnr": "40.5", "lossless": None, "spacing": "1,2,3", "dataset": "rho", "work-dir": str(self.folder)},
        )
        self.assertEqual(record["source"]["dataset"], "rho")

    def test_a_masked_number_is_refused(self):
        import numpy

        lowest = numpy.ma.masked_array([1.0, 2.0], mask=True).min()
        for spacing in (lowest, (1, 2, lowest)):
            with self.assertRaisesRegex(weir.UsageError, "^a number that is masked has no value; give one$"):
                weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", spacing=spacing)

    def test_the_keywords_of_convert_are_those_of_the_table(self):
        page = (SOURCE / "docs/options.md").read_text()
        table = set(re.findall(r"^\| `--[^|]*(?:\\\|[^|]*)*\| `(\w+)` \|", page, re.MULTILINE))
        keywords = set(inspect.signature(weir.convert).parameters) - {"source", "output", "progress"}
        self.assertEqual(keywords, table)


if __name__ == "__main__":
    unittest.main()
