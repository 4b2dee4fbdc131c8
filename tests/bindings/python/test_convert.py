"""weir.convert: the same files as `weir convert` makes, from paths and from arrays in any layout."""

import json
import logging
import math
import os
import pathlib
import subprocess
import sys
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

    def test_at_most_pads_nothing(self):
        values = numpy.arange(8000, dtype=numpy.float32).reshape(20, 20, 20)
        longest = weir.convert(values, self.folder / "a.nvdb", lossless=True)["file"]["bytes"]
        self.assertEqual(weir.convert(values, self.folder / "b.nvdb", size=longest + 5)["file"]["bytes"], longest + 5)
        record = weir.convert(values, self.folder / "c.nvdb", size=longest + 5, at_most=True)
        self.assertEqual(record["file"]["bytes"], longest)
        self.assertEqual(os.path.getsize(self.folder / "c.nvdb"), longest)

    def test_options_of_files_are_refused_of_arrays(self):
        remedy = "which is for files; the conversion of an array cannot be continued, leave it out"
        for given, said in (
            ({"resume": "on"}, "resume is 'on'"),
            ({"save_interval": 5}, "save_interval is 5"),
            ({"save_interval": 0.5}, "save_interval is 0.5"),
        ):
            message = self.refused(weir.UsageError, weir.convert, ramp(9, 9, 9), self.folder / "a.nvdb", **given)
            self.assertEqual(message, f"{said}, {remedy}")
        self.assertEqual(self.names(), [])
        for resume in ("auto", "off", None):
            weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", resume=resume, overwrite=True)

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

    def test_component_chooses_from_an_array_of_vectors_in_a_file(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("h5py is missing")
        values = noise((20, 21, 22 * 3), numpy.float32).reshape(20, 21, 22, 3)
        with h5py.File(self.folder / "v.h5", "w") as file:
            file["v"] = values
        length = numpy.sqrt((values.astype("f8") ** 2)[..., 0] + (values.astype("f8") ** 2)[..., 1] + (values.astype("f8") ** 2)[..., 2])
        for component, wanted in ((1, values[..., 1]), ("x", values[..., 0]), ("magnitude", length)):
            weir.convert(self.folder / "v.h5", self.folder / "v.nvdb", component=component, lossless=True, overwrite=True)
            found = weir.open(self.folder / "v.nvdb").to_numpy()
            self.assertTrue(same(found, numpy.ascontiguousarray(wanted, numpy.float32)), component)

    def test_lengths_of_vectors_of_integers_are_no_integers(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("h5py is missing")
        for kind in (numpy.uint8, numpy.int8, numpy.uint16, numpy.int16):
            values = noise((20, 21, 22 * 3), kind).reshape(20, 21, 22, 3)
            values[:, :, :15] = (3, 4, 12)
            with h5py.File(self.folder / "v.h5", "w") as file:
                file["v"] = values
            x, y, z = (values[..., component].astype("f8") for component in range(3))
            length = numpy.sqrt(x * x + y * y + z * z).astype(numpy.float32)
            for encoding in ("float", "auto", "packed"):
                with self.subTest(kind=kind, encoding=encoding):
                    record = weir.convert(
                        self.folder / "v.h5",
                        self.folder / "v.nvdb",
                        component="magnitude",
                        lossless=True,
                        encoding=encoding,
                        overwrite=True,
                    )
                    self.assertEqual(record["background"]["value"], 13)
                    self.assertTrue(same(weir.open(self.folder / "v.nvdb").to_numpy(), length))

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

    def test_ghost_cells_are_left_out(self):
        values = noise((20, 30, 40))
        weir.convert(values, self.folder / "a.nvdb", lossless=True, ghost=(3, 2, 1))
        with weir.open(self.folder / "a.nvdb") as grid:
            self.assertTrue(same(grid.to_numpy(), values[1:-1, 2:-2, 3:-3].astype(numpy.float32)))

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

    def test_missing_policy(self):
        values = ramp(9, 9, 9)
        message = r"1 of 729 voxels .* choose missing_policy background or, to take 302 for data, missing_policy keep$"
        with self.assertRaisesRegex(weir.InputError, message):
            weir.convert(values, self.folder / "a.nvdb", missing=302)
        grid = self.lossless(values, missing=302, missing_policy="keep")
        self.assertTrue(same(grid.to_numpy(), values))
        self.assertEqual(grid.sidecar["missing"], {"count": 1, "values": ["302"], "policy": "keep"})
        grid = self.lossless(values, name="b.nvdb", missing=302, missing_policy="background")
        self.assertEqual(grid.to_numpy()[0, 3, 2], grid.sidecar["background"]["value"])

    def test_progress_has_each_pass_to_its_end(self):
        calls = []
        weir.convert(noise((64, 64, 64)), self.folder / "a.nvdb", rate=2, progress=lambda *call: calls.append(call))
        total = 64**3 * 4
        self.assertEqual([pass_ for pass_, done, all_ in calls if done == all_], ["survey", "encode"])
        for pass_, done, all_ in calls:
            self.assertLessEqual(done, all_)
            if pass_ == "survey":
                self.assertEqual(all_, total)

    def test_rounding_is_refused_beyond_the_bound_and_said_where_no_error_counts_it(self):
        values = numpy.random.default_rng(3).integers(2**30, 2**40, (9, 9, 9))
        message = self.refused(weir.BudgetError, weir.convert, values, self.folder / "a.nvdb", max_error=1)
        self.assertRegex(
            message,
            r"^memory: float32, which files hold, rounds 7\d\d values by up to 32\d\d\d, more than max_error 1 allows; "
            r"allow max_error 32\d\d\d or more, or subtract an offset from the values first$",
        )
        with self.assertLogs("weir", logging.WARNING) as logs:
            record = weir.convert(values, self.folder / "a.nvdb", lossless=True)
        loss = record["conversion_loss"]
        self.assertEqual(
            [line for line in logs.output if "rounded" in line],
            [
                f"WARNING:weir:memory: {loss['inexact']} values were rounded to float32, which files hold, by up to "
                f"{loss['max_abs_error']:g}, and no error counts that"
            ],
        )

    def test_names_that_are_too_long_are_refused(self):
        message = self.refused(weir.UsageError, weir.convert, ramp(4, 4, 4), self.folder / "a.nvdb", dataset="x" * 256)
        self.assertEqual(message, "dataset has 256 bytes, a grid's name has at most 255")

    def test_notices_go_to_the_logger(self):
        with self.assertLogs("weir", logging.WARNING) as logs:
            weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb")
        self.assertEqual(len(logs.output), 1)
        self.assertRegex(logs.output[0], r"^WARNING:weir:.*/a\.nvdb: no budget was given, and rate 8 would keep less than 40 dB of so small a volume; written .*: \d+ bytes, rate 0\.009\d+; give a budget for another size$")


class SeveralPositions(FolderTest):
    """Tests an NRRD file that holds three volumes."""

    def setUp(self):
        super().setUp()
        self.values = numpy.stack([ramp(5, 6, 7) + step for step in range(3)])
        header = "NRRD0004\ntype: float\ndimension: 4\nsizes: 5 6 7 3\nendian: little\nencoding: raw\n\n"
        (self.folder / "run.nrrd").write_bytes(header.encode() + self.values.astype("<f4").tobytes())

    def test_a_range_converts_each_and_returns_a_list(self):
        for index, steps in (("0:2", [0, 1]), ("*", [0, 1, 2]), ("2:", [2])):
            records = weir.convert(self.folder / "run.nrrd", f"{self.folder}/out/", index=index, lossless=True, overwrite=True)
            self.assertEqual([record["source"]["index"] for record in records], [[step] for step in steps])
            for step in steps:
                with weir.open(self.folder / f"out/run_{step}.nvdb") as grid:
                    self.assertTrue((grid.to_numpy() == self.values[step]).all())

    def test_one_position_is_one_record(self):
        for index, step in ((1, 1), ("-1", 2), ([0], 0)):
            record = weir.convert(self.folder / "run.nrrd", self.folder / "a.nvdb", index=index, lossless=True, overwrite=True)
            self.assertEqual(record["source"]["index"], [step])


class SeparateLevels(FolderTest):
    """A plotfile of two levels: the middle half of 64^3 cells is refined by 2."""

    def setUp(self):
        super().setUp()
        script = pathlib.Path(os.environ["WEIR_SOURCE"]) / "tests/tools/project/document_plotfile.py"
        subprocess.run([sys.executable, script, self.folder / "plt00042"], check=True)

    def test_each_level_is_a_file_and_a_record(self):
        records = weir.convert(self.folder / "plt00042", f"{self.folder}/out/", dataset="density", levels="separate",
                               psnr=50, encoding="float", background=-1)
        self.assertEqual([record["source"]["level"] for record in records],
                         [{"number": 1, "count": 2}, {"number": 0, "count": 2}])
        self.assertEqual([record["missing"]["count"] for record in records], [0, 32**3])
        with weir.open(self.folder / "out/plt00042_density_level_0.nvdb") as fine:
            self.assertEqual(fine.to_numpy().shape, (64, 64, 64))
            self.assertEqual(tuple(fine.spacing), (1 / 128, 1 / 128, 1 / 128))
        with weir.open(self.folder / "out/plt00042_density_level_1.nvdb") as coarse:
            values = coarse.to_numpy()
            self.assertEqual(values.shape, (64, 64, 64))
            self.assertTrue((values[16:48, 16:48, 16:48] == -1).all())
            self.assertTrue((values[:16] > 0).all())

    def test_what_keeps_voxels_without_a_value_is_refused(self):
        with self.assertRaisesRegex(ValueError, "nonfinite keep does not go with levels separate"):
            weir.convert(self.folder / "plt00042", dataset="density", levels="separate", nonfinite="keep")


class SeveralDatasets(FolderTest):
    """A VTK image with two arrays of scalars and one of vectors."""

    def setUp(self):
        super().setUp()
        self.values = {"a": ramp(5, 6, 7), "b": ramp(5, 6, 7) + 1}
        text = "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 6 7\n"
        text += "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 210\n"
        for name, values in self.values.items():
            text += f"SCALARS {name} float\nLOOKUP_TABLE default\n{' '.join(map(str, values.ravel()))}\n"
        vectors = numpy.stack([self.values["a"], 2 * self.values["a"], 3 * self.values["a"]], -1)
        text += f"VECTORS v float\n{' '.join(map(str, vectors.ravel()))}\n"
        (self.folder / "run.vtk").write_text(text)

    def test_a_list_converts_each(self):
        records = weir.convert(self.folder / "run.vtk", f"{self.folder}/out/", dataset=["a", "b"], lossless=True)
        self.assertEqual([record["source"]["dataset"] for record in records], ["a", "b"])
        for name, values in self.values.items():
            with weir.open(self.folder / f"out/run_{name}.nvdb") as grid:
                self.assertTrue((grid.to_numpy() == values).all())

    def test_a_pattern_in_a_list_and_a_list_of_one(self):
        records = weir.convert(self.folder / "run.vtk", self.folder / "{dataset}.nvdb", dataset=("*",), lossless=True)
        self.assertEqual(len(records), 2)
        self.assertTrue({"a.nvdb", "b.nvdb"} <= set(self.names()))
        (record,) = weir.convert(self.folder / "run.vtk", self.folder / "one.nvdb", dataset=["b"], lossless=True)
        self.assertEqual(record["source"]["dataset"], "b")

    def test_what_a_list_cannot_be(self):
        path = self.folder / "run.vtk"
        for message, source, dataset in (
            ("dataset is an empty list; name a dataset in it", path, []),
            ("dataset is a list; an array is one volume, whose name is a text", ramp(9, 9, 9), ["a"]),
            (
                "run.vtk: names 2 volumes; give dataset as a list for all of them, or convert them one by one",
                path,
                "*",
            ),
        ):
            self.assertEqual(
                self.refused(weir.UsageError, weir.convert, source, self.folder / "x.nvdb", dataset=dataset), message
            )
        self.assertEqual(self.names(), ["run.vtk"])

    def test_a_component_of_vectors(self):
        for component, factor in ((0, 1), ("y", 2), ("2", 3)):
            weir.convert(
                self.folder / "run.vtk", self.folder / "v.nvdb", dataset="v", component=component, lossless=True, overwrite=True
            )
            with weir.open(self.folder / "v.nvdb") as grid:
                self.assertTrue((grid.to_numpy() == factor * self.values["a"]).all())


if __name__ == "__main__":
    unittest.main()
