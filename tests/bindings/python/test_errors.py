"""Tests the errors of wrong calls: the class and the whole message. A failed call must leave no files behind."""

import errno
import os
import pickle
import unittest

import numpy

import weir
from support import FolderTest, noise, ramp
from weir.errors import InputNotFoundError, InputSystemError, IoNotFoundError


class Errors(FolderTest):
    def convert(self, kind, source, **keywords):
        before = self.names()
        message = self.refused(kind, weir.convert, source, self.folder / "out.nvdb", **keywords)
        self.assertEqual(self.names(), before)
        return message

    def test_classes(self):
        for kind in (weir.UsageError, weir.InputError, weir.BudgetError, weir.IoError):
            self.assertTrue(issubclass(kind, weir.Error))
        self.assertTrue(issubclass(weir.UsageError, ValueError))
        self.assertTrue(issubclass(weir.IoError, OSError))

    def test_arguments(self):
        for message, keywords in {
            'rate is "-1.5", it must be a positive number: dense float32 bytes / file bytes': {"rate": -1.5},
            'rate is "nan", it must be a positive number: dense float32 bytes / file bytes': {"rate": float("nan")},
            "size, rate, psnr, max_error and lossless exclude each other; give one": {"rate": 2, "lossless": True},
            'size is "10 horses", it must be a size such as 1048577, 64MiB or 1.5GB': {"size": "10 horses"},
            'encoding is "zip", it must be auto, float, fpn, fp4, fp8, fp16 or packed': {"encoding": "zip"},
            "metric farthest has no error target; psnr and max_error select by sse": {"metric": "farthest", "psnr": 9},
            'background is "inf", it must be auto or a finite float32': {"background": float("inf")},
            'spacing is "1,2", it must be x,y,z, three numbers in world units': {"spacing": (1, 2)},
            'memory is "1000", it must be a size of at least 64.0 MiB, like 512MiB': {"memory": 1000},
            "dims says how to read a file; source is an array": {"dims": (9, 9, 9)},
            "roi is ((0, 0), (1, 1, 1)), it must be ((x0, y0, z0), (x1, y1, z1)), x0 inclusive, x1 exclusive": {
                "roi": ((0, 0), (1, 1, 1))
            },
        }.items():
            with self.subTest(message):
                self.assertEqual(self.convert(weir.UsageError, ramp(9, 9, 9), **keywords), message)

    def test_arrays(self):
        values = ramp(9, 9, 9)
        for message, array in {
            "source has 2 axes, it must have three: [z, y, x]": values[0],
            "source has 4 axes, it must have three: [z, y, x]": values[None],
            "source is of complex128, it must be one of bool, uint8, int8, uint16, int16, uint32, int32, uint64, "
            "int64, float16, float32, float64, bfloat16": values.astype(complex),
            "source has the other byte order (>f4); give source.astype(source.dtype.newbyteorder('='))": values.astype(
                ">f4"
            ),
            "source is a masked array; give source.filled(VALUE), missing=VALUE and missing_policy": (
                numpy.ma.masked_less(values, 5)
            ),
        }.items():
            with self.subTest(message):
                self.assertEqual(self.convert(weir.UsageError, array), message)

    def test_a_path_with_a_null_byte(self):
        weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", lossless=True)
        path = os.fsencode(self.folder / "a.nvdb") + b"\0zzz"
        message = f"path is {path!r}, and no path has a null byte; correct it"
        for call in (
            lambda: weir.open(os.fsdecode(path)),
            lambda: weir.convert(os.fsdecode(path)),
            lambda: weir.convert(ramp(9, 9, 9), path),
        ):
            with self.assertRaises(weir.UsageError) as raised:
                call()
            self.assertEqual(str(raised.exception), message)
        self.assertEqual(
            self.convert(weir.UsageError, ramp(9, 9, 9), dataset="a\0b"),
            "dataset has a null character, which ends a text; leave it out",
        )
        self.assertEqual(self.names(), ["a.nvdb", "a.nvdb.json"])

    def test_an_empty_path(self):
        for call in (lambda: weir.open(""), lambda: weir.open(b""), lambda: weir.convert("", self.folder / "a.nvdb")):
            self.assertEqual(self.refused(weir.UsageError, call), "the path is empty; name a file")
        self.assertEqual(self.names(), [])

    def test_an_empty_array(self):
        self.assertIn("0x9x9", self.convert(weir.InputError, numpy.zeros((9, 9, 0), numpy.float32)))

    def test_what_is_no_volume(self):
        message = self.refused(TypeError, weir.convert, [[[1.0]]], self.folder / "out.nvdb")
        self.assertEqual(
            message,
            "source is a list, it must be a path, a numpy array, an xarray.DataArray or an array with DLPack or"
            " __cuda_array_interface__",
        )
        for module, remedy in (
            ("h5py._hl.dataset", "give the path of its file with dataset=NAME, which is streamed, or numpy.asarray(source)"),
            ("zarr.core", "give the path of its file with dataset=NAME, which is streamed, or numpy.asarray(source)"),
            ("dask.array.core", "give numpy.asarray(source)"),
        ):
            lazy = type("Array", (), {"__array__": lambda self: ramp(9, 9, 9), "__module__": module})()
            message = self.refused(TypeError, weir.convert, lazy, self.folder / "out.nvdb")
            self.assertEqual(message.split("; ")[1], remedy)
        message = self.refused(weir.UsageError, weir.convert, ramp(9, 9, 9))
        self.assertEqual(message, "output is missing: an array has no name to make one from")
        message = self.refused(TypeError, weir.convert, ramp(9, 9, 9), "a.nvdb", rte=8)
        self.assertEqual(message, "convert() got an unexpected keyword argument 'rte'")

    def test_arguments_of_other_types(self):
        self.lossless(ramp(9, 9, 9)).close()
        values, output = ramp(9, 9, 9), self.folder / "out.nvdb"
        before = self.names()
        for message, call in {
            "dataset is 5, it must be a text or a list of texts": lambda: weir.convert(values, output, dataset=5),
            "dataset is [5], it must be a text or a list of texts": lambda: weir.convert(values, output, dataset=[5]),
            "progress is 5, it must be a function, progress(pass, done, total)": (
                lambda: weir.convert(values, output, progress=5)
            ),
            "output is 5, it must be a path": lambda: weir.convert(values, 5),
            "path is 5, it must be a path": lambda: weir.open(5),
            "path is None, it must be a path": lambda: weir.open(None),
        }.items():
            with self.subTest(message):
                self.assertEqual(self.refused(TypeError, call), message)
        with weir.open(self.folder / "a.nvdb") as grid:
            for call in (grid.verify, grid.render):
                message = self.refused(TypeError, call, progress=5)
                self.assertEqual(message, "progress is 5, it must be a function, progress(pass, done, total)")
        message = self.refused(weir.UsageError, weir.convert, values, "a\ud800.nvdb")
        self.assertEqual(message, "output is 'a\\ud800.nvdb', which no file system can hold; correct it")
        self.assertEqual(self.names(), before)

    def test_an_array_with_the_older_interface_of_numpy(self):
        source = type("Array", (), {"__array_interface__": ramp(9, 9, 9).__array_interface__})()
        message = self.refused(TypeError, weir.convert, source, self.folder / "out.nvdb")
        self.assertEqual(message.split("; ")[1], "give numpy.asarray(source)")

    def test_a_missing_input(self):
        message = self.refused(InputNotFoundError, weir.convert, self.folder / "no.nrrd")
        self.assertEqual(message, "no.nrrd: cannot open for reading: No such file or directory")

    def test_failures_of_the_system_have_number_and_name(self):
        (self.folder / "a.nhdr").write_text(
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 9 9 9\nencoding: raw\nendian: little\ndata file: a.raw\n"
        )
        (self.folder / "file").write_text("")
        for kind, builtin, number, name, call in (
            (InputNotFoundError, FileNotFoundError, errno.ENOENT, "no.h5", lambda: weir.convert(self.folder / "no.h5")),
            (InputNotFoundError, FileNotFoundError, errno.ENOENT, "no.nvdb", lambda: weir.open(self.folder / "no.nvdb")),
            (InputNotFoundError, FileNotFoundError, errno.ENOENT, "a.raw", lambda: weir.convert(self.folder / "a.nhdr")),
            (InputSystemError, OSError, errno.ENOTDIR, "file/a.nvdb", lambda: weir.open(self.folder / "file/a.nvdb")),
            (
                IoNotFoundError,
                FileNotFoundError,
                errno.ENOENT,
                "no",
                lambda: weir.convert(ramp(9, 9, 9), self.folder / "no/out.nvdb"),
            ),
        ):
            with self.subTest(name), self.assertRaises(builtin) as raised:
                call()
            error = raised.exception
            self.assertIs(error.__class__, kind)
            self.assertEqual(error.errno, number)
            self.assertEqual(error.filename, str(self.folder / name))
            self.assertIn(name, str(error))
            self.assertNotIn("Errno", str(error))
            again = pickle.loads(pickle.dumps(error))
            self.assertEqual((str(again), again.errno, again.filename), (str(error), number, error.filename))

    def test_a_file_that_may_not_be_read(self):
        paths = [self.folder / name for name in ("a.raw", "a.nvdb")]
        for path in paths:
            path.write_bytes(bytes(1000))
            path.chmod(0)
        self.folder.chmod(0o755)
        user = os.geteuid()
        if user == 0:
            os.seteuid(65534)  # the user nobody, because root may read every file
        try:
            for path, call in zip(paths, (weir.convert, weir.open)):
                with self.assertRaises(PermissionError) as raised:
                    call(path)
                self.assertIsInstance(raised.exception, weir.Error)
                self.assertEqual((raised.exception.errno, raised.exception.filename), (errno.EACCES, str(path)))
                self.assertIn("Permission denied", str(raised.exception))
        finally:
            os.seteuid(user)

    def test_an_output_that_exists(self):
        weir.convert(ramp(9, 9, 9), self.folder / "out.nvdb", lossless=True)
        self.assertEqual(
            self.convert(weir.UsageError, ramp(9, 9, 9)), "out.nvdb: exists; choose another output or pass overwrite"
        )
        weir.convert(ramp(9, 9, 9) + 1, self.folder / "out.nvdb", lossless=True, overwrite=True)
        with weir.open(self.folder / "out.nvdb") as grid:
            self.assertEqual(grid.range, (1, 80809))

    def test_the_output_is_the_input(self):
        weir.convert(ramp(9, 9, 9), self.folder / "out.nvdb", lossless=True)
        message = self.convert(weir.UsageError, self.folder / "out.nvdb", overwrite=True)
        self.assertEqual(message, "out.nvdb: is the input; choose another output")

    def test_a_directory(self):
        message = self.refused(weir.UsageError, weir.convert, ramp(9, 9, 9), self.folder)
        self.assertEqual(message, f"{self.folder}: is a directory; name a file in it")

    def test_a_size_that_cannot_be_met(self):
        message = self.convert(weir.BudgetError, noise((9, 9, 9)), size=1000)
        self.assertRegex(message, r"^out\.nvdb: .*1000")

    def test_values_that_are_not_finite(self):
        values = ramp(9, 9, 9)
        values[0, 0, 0] = numpy.inf
        message = self.convert(weir.InputError, values)
        self.assertIn("nonfinite", message)
        self.assertNotIn("--", message)

    def test_a_directory_that_is_missing(self):
        message = self.refused(IoNotFoundError, weir.convert, ramp(9, 9, 9), self.folder / "no" / "out.nvdb")
        self.assertIn("no", message)

    def test_paths_of_any_bytes(self):
        path = os.fsencode(self.folder) + b"/\xff\xe4.nvdb"
        weir.convert(ramp(9, 9, 9), os.fsdecode(path), lossless=True)
        with weir.open(os.fsdecode(path)) as grid:
            self.assertEqual(grid.range, (0, 80808))
        message = self.refused(InputNotFoundError, weir.open, os.fsdecode(path + b".no"))
        self.assertTrue(message.startswith("\udcff\udce4.nvdb.no: "), ascii(message))


class OpenErrors(FolderTest):
    def test_no_file(self):
        message = self.refused(InputNotFoundError, weir.open, self.folder / "a.nvdb")
        self.assertEqual(message, "a.nvdb: cannot open: No such file or directory")

    def test_a_message_is_one_line_whatever_a_path_holds(self):
        for name, shown in (("no\nfile", "no\\nfile"), ("\x1b[31mred", "\\x1b[31mred")):
            with self.assertRaises(FileNotFoundError) as raised:
                weir.open(self.folder / name)
            self.assertEqual(
                str(raised.exception).replace(f"{self.folder}/", ""), f"{shown}: cannot open: No such file or directory"
            )
            self.assertEqual(raised.exception.filename, str(self.folder / name))

    def test_options_may_be_paths_of_any_bytes(self):
        odd = os.path.join(os.fsencode(self.folder), b"w\xff")
        os.mkdir(odd)
        weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", lossless=True, work_dir=odd)
        message = self.refused(
            weir.UsageError, weir.convert, ramp(9, 9, 9), self.folder / "b.nvdb", lossless=True, dataset="\ud800"
        )
        self.assertEqual(message, "dataset is '\\ud800', which no file system and no file can hold; correct it")

    def test_directories_that_are_missing(self):
        for keywords, source in (
            ({"lossless": True, "work_dir": self.folder / "no"}, ramp(9, 9, 9)),
            ({"stack": True, "dims": (3, 3, 3), "type": "uint8"}, self.folder / "no/a%05d.raw"),
        ):
            with self.subTest(keywords), self.assertRaises(FileNotFoundError) as raised:
                weir.convert(source, self.folder / "c.nvdb", **keywords)
            self.assertEqual(raised.exception.errno, errno.ENOENT)
            self.assertEqual(raised.exception.filename, str(self.folder / "no"))

    def test_no_nanovdb(self):
        (self.folder / "a.nvdb").write_bytes(b"nothing" * 1000)
        message = self.refused(weir.InputError, weir.open, self.folder / "a.nvdb")
        self.assertTrue(message.startswith("a.nvdb: "), message)
        self.assertNotIn("\n", message)

    def test_the_sidecar_of_another_file(self):
        weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", lossless=True)
        weir.convert(ramp(19, 9, 9), self.folder / "b.nvdb", lossless=True)
        (self.folder / "b.nvdb.json").replace(self.folder / "a.nvdb.json")
        sizes = [(self.folder / name).stat().st_size for name in ("b.nvdb", "a.nvdb")]
        with weir.open(self.folder / "a.nvdb") as grid, self.assertRaises(weir.InputError) as raised:
            grid.certificate
        self.assertEqual(
            str(raised.exception).replace(f"{self.folder}/", ""),
            f"a.nvdb.json: is of a file of {sizes[0]} bytes with another checksum, "
            f"a.nvdb has {sizes[1]} bytes; convert it again",
        )

    def test_a_damaged_sidecar(self):
        grid = self.lossless(ramp(9, 9, 9))
        (self.folder / "a.nvdb.json").write_text("{")
        with self.assertRaises(weir.InputError):
            grid.sidecar


if __name__ == "__main__":
    unittest.main()
