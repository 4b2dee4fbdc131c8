"""weir.convert: the same files as `weir convert` makes, from paths and from arrays in any layout."""

import json
import logging
import math
import unittest

import numpy

import weir
from support import FolderTest, noise, ramp, run_weir, same

TYPES = "bool uint8 int8 uint16 int16 uint32 int32 uint64 int64 float16 float32 float64".split()


class Convert(FolderTest):
    def test_a_file_is_converted_as_by_the_command(self):
        raw = self.folder / "a_96x64x80_int16.raw"
        noise((80, 64, 96)).tofile(raw)
        options = {"rate": 5, "spacing": (1.5, 2, 0.1), "origin": (-1, 0, 7), "background": 3, "encoding": "fpn"}
        record = weir.convert(raw, self.folder / "python.nvdb", **options)
        run_weir("convert", raw, "-o", self.folder / "command.nvdb", "--rate", 5, "--spacing", "1.5,2,0.1",
                 "--origin=-1,0,7", "--background", 3, "--encoding", "fpn")
        self.assertEqual((self.folder / "python.nvdb").read_bytes(), (self.folder / "command.nvdb").read_bytes())
        self.assertEqual((self.folder / "python.nvdb").stat().st_size, math.ceil(96 * 64 * 80 * 4 / 5))
        command = json.loads((self.folder / "command.nvdb.json").read_text())
        for key in ("source", "grid", "error", "file", "selection", "budget", "histogram"):
            self.assertEqual(record[key], command[key], key)
        del command["weir"]["options"]["output"]
        self.assertEqual(record["weir"]["options"], command["weir"]["options"])

    def test_the_output_is_beside_the_input_unless_named(self):
        raw = self.folder / "b_9x9x9_uint8.raw"
        noise((9, 9, 9), numpy.uint8).tofile(raw)
        weir.convert(str(raw), lossless=True)
        self.assertEqual(self.names(), ["b_9x9x9_uint8.nvdb", "b_9x9x9_uint8.nvdb.json", "b_9x9x9_uint8.raw"])

    def test_the_record_is_the_sidecar(self):
        record = weir.convert(noise((20, 30, 40)), self.folder / "a.nvdb", psnr=40)
        self.assertEqual(record, json.loads((self.folder / "a.nvdb.json").read_text()))
        self.assertEqual(record["budget"]["kind"], "psnr")
        self.assertGreaterEqual(record["error"]["psnr_db"], 40)

    def test_an_array_gives_the_bytes_that_a_raw_file_of_it_gives(self):
        values = noise((80, 64, 96), numpy.float32)
        raw = self.folder / "a_96x64x80_float32.raw"
        values.tofile(raw)
        for name, options in {
            "rate": {"rate": 4}, "size": {"size": 1 << 20}, "text": {"size": "0.5MiB", "metric": "farthest"},
            "error": {"max_error": 0.25}, "lossless": {"lossless": True}, "paper": {"rate": 3, "preset": "paper"},
            "fill": {"rate": 3, "fill": "background", "nonfinite": "keep", "threads": 1},
        }.items():
            with self.subTest(name):
                weir.convert(values, self.folder / f"{name}_array.nvdb", **options)
                weir.convert(raw, self.folder / f"{name}_file.nvdb", **options)
                array, file = ((self.folder / f"{name}_{kind}.nvdb").read_bytes() for kind in ("array", "file"))
                self.assertEqual(array, file)

    def test_every_type(self):
        for name in TYPES:
            with self.subTest(name):
                values = noise((9, 10, 11), name)
                grid = self.lossless(values, f"{name}.nvdb")
                self.assertTrue(same(grid.to_numpy(), values.astype(numpy.float32)))
                stored = "uint8" if name == "bool" else name
                self.assertEqual(grid.sidecar["source"]["type"], stored)

    def test_every_layout_reads_the_same_values(self):
        values = ramp(12, 20, 28)
        wide = numpy.zeros((28, 40, 36), numpy.float32)
        wide[:, 1::2, 2::3] = values
        reversed_twice = values[::-1, :, ::-1].copy()[::-1, :, ::-1]
        readonly = values.copy()
        readonly.flags.writeable = False
        unaligned = numpy.frombuffer(b"?" + values.tobytes(), numpy.float32, offset=1).reshape(values.shape)
        mapped = numpy.memmap(self.folder / "map", numpy.float32, "w+", shape=values.shape)
        mapped[:] = values
        layouts = {
            "C": values,
            "Fortran": numpy.asfortranarray(values),
            "transposed": values.transpose(2, 0, 1).copy().transpose(1, 2, 0),
            "steps": wide[:, 1::2, 2::3],
            "negative steps": reversed_twice,
            "read-only": readonly,
            "unaligned": unaligned,
            "memmap": mapped,
            "field of a record": numpy.core.records.fromarrays([values * 2, values], names="a,b").reshape(values.shape)["b"],
        }
        self.assertLess(reversed_twice.strides[0], 0)
        self.assertFalse(unaligned.flags.aligned)
        bytes_of = {}
        for name, layout in layouts.items():
            weir.convert(layout, self.folder / f"{name}.nvdb", lossless=True)
            bytes_of[name] = (self.folder / f"{name}.nvdb").read_bytes()
        for name, content in bytes_of.items():
            self.assertEqual(content, bytes_of["C"], name)

    def test_an_axis_of_stride_zero_is_read_again_and_again(self):
        values = numpy.broadcast_to(numpy.arange(10, dtype=numpy.uint8), (12, 11, 10))
        self.assertTrue(same(self.lossless(values).to_numpy(), values.astype(numpy.float32)))

    def test_axes_are_z_y_x(self):
        grid = self.lossless(ramp(4, 5, 6), spacing=(1, 2, 3), origin=(10, 20, 30), dataset="charge")
        self.assertEqual(grid.extent, (4, 5, 6))
        self.assertEqual(grid.shape, (6, 5, 4))
        self.assertEqual(grid.spacing, (1, 2, 3))
        self.assertEqual(grid.origin, (10, 20, 30))
        self.assertEqual(grid.name, "charge")
        self.assertEqual(grid.to_numpy()[5, 3, 2], 50302)

    def test_a_region_keeps_its_index(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values, roi=((2, 4, 6), (10, 9, 20)))
        self.assertEqual(grid.index_origin, (2, 4, 6))
        self.assertTrue(same(grid.to_numpy(), values[6:20, 4:9, 2:10]))

    def test_missing_values_and_nan(self):
        values = ramp(9, 9, 9)
        values[2, 3, 4] = numpy.nan
        grid = self.lossless(values, nonfinite="keep", missing=302)
        values[0, 3, 2] = numpy.nan
        numpy.testing.assert_array_equal(grid.to_numpy(), values)
        self.assertEqual(grid.sidecar["missing"]["count"], 1)

    def test_progress_has_each_pass_to_its_end(self):
        calls = []
        weir.convert(noise((64, 64, 64)), self.folder / "a.nvdb", progress=lambda *call: calls.append(call))
        total = 64**3 * 4
        self.assertEqual([pass_ for pass_, done, all_ in calls if done == all_], ["survey", "encode"])
        for pass_, done, all_ in calls:
            self.assertLessEqual(done, all_)
            if pass_ == "survey":
                self.assertEqual(all_, total)

    def test_notices_go_to_the_logger(self):
        with self.assertLogs("weir", logging.WARNING) as logs:
            weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb")
        self.assertEqual(len(logs.output), 1)
        self.assertRegex(logs.output[0], r"^WARNING:weir:.*/a\.nvdb: rate 8 would be 365 bytes, less than the smallest tree; writing that: \d+ bytes$")


if __name__ == "__main__":
    unittest.main()
