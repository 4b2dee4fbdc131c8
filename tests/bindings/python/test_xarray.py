"""Grid.to_xarray and xarray.open_dataset(engine="weir"): coordinates and units as in the source, values on demand."""

import pickle
import shutil
import unittest
import unittest.mock

import numpy

try:
    import xarray
except ImportError:
    raise unittest.SkipTest("python3-xarray is missing") from None

import weir
from support import FolderTest, ramp, same


class ToXarray(FolderTest):
    def test_coordinates_are_the_centres_of_voxels(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values, spacing=(0.5, 1, 2), origin=(10, 20, -30), dataset="density")
        array = grid.to_xarray()
        self.assertEqual((array.name, array.dims, array.shape), ("density", ("z", "y", "x"), (28, 20, 12)))
        self.assertEqual(array.dtype, numpy.float32)
        numpy.testing.assert_array_equal(array.x, 10 + 0.5 * numpy.arange(12))
        numpy.testing.assert_array_equal(array.y, 20 + numpy.arange(20.0))
        numpy.testing.assert_array_equal(array.z, -30 + 2 * numpy.arange(28.0))
        self.assertEqual(array.attrs, {"max_abs_error": 0.0})
        self.assertTrue(same(array.values, values))
        self.assertEqual(float(array.sel(z=-26, y=21, x=10.5)), values[2, 1, 1])
        self.assertEqual(float(array.sel(z=-25.9, y=21.2, x=10.4, method="nearest")), values[2, 1, 1])

    def test_the_sidecar_of_another_file_is_logged_and_left_out(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values, spacing=(0.5, 1, 2))
        other = self.lossless(ramp(8, 8, 8), "b.nvdb")
        shutil.copy(f"{other.path}.json", f"{grid.path}.json")
        with self.assertLogs("weir", "WARNING") as logged:
            array = grid.to_xarray()
        self.assertIn(f"{grid.path}.json: is of a file of", logged.output[0])
        self.assertTrue(same(array.values, values))
        self.assertEqual(array.attrs, {})

    def test_a_region_stays_where_it_was(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values, roi=((3, 5, 7), (12, 20, 28)), spacing=(2, 2, 2), origin=(1, 1, 1))
        array = grid.to_xarray()
        self.assertEqual([float(array[axis][0]) for axis in "xyz"], [7, 11, 15])
        self.assertTrue(same(array.values, values[7:, 5:, 3:]))

    def test_values_are_decoded_when_they_are_used(self):
        values = ramp(40, 50, 60)
        grid = self.lossless(values)
        asked = []

        class Core:
            def __getattr__(self, name):
                return getattr(core, name)

            def read(self, low, high, level):
                asked.append((low, high, level))
                return core.read(low, high, level)

        core, grid._core = grid._core, Core()
        array = grid.to_xarray()
        part = array.isel(z=slice(8, 16)).sel(y=3)
        self.assertIn("...", repr(array))
        self.assertEqual(asked, [])
        self.assertTrue(same(part.values, values[8:16, 3]))
        self.assertEqual(asked, [((0, 3, 8), (40, 4, 16), 0)])
        grid._core = core

    def test_every_index_of_xarray(self):
        values = ramp(12, 20, 28)
        array = self.lossless(values).to_xarray()
        for key in (
            numpy.s_[3, ::-2, [1, 5, 2]],
            numpy.s_[::9, :, -1],
            numpy.s_[[0, 27, 3], 4:9, [11, 0]],
            numpy.s_[values[:, 0, 0] > 50000],
            numpy.s_[:, ::-3, :],
            numpy.s_[5::-3, 9:1:-4, ::-40],
            numpy.s_[[6, 11, -11], 5::-3, ::-1],
            numpy.s_[[], ::-2, 3],
        ):
            with self.subTest(key):
                wanted = values[numpy.ix_(*self.lists(key, values.shape))]
                numpy.testing.assert_array_equal(array[key].values.reshape(wanted.shape), wanted)
        places = xarray.DataArray([0, 5, 27], dims="point")
        numpy.testing.assert_array_equal(array.isel(z=places, x=places % 12), values[[0, 5, 27], :, [0, 5, 3]])
        numpy.testing.assert_array_equal(
            array.isel(y=places % 20, x=places % 12, z=slice(20, 3, -4)),
            numpy.moveaxis(values[20:3:-4, [0, 5, 7], [0, 5, 3]], 1, array.isel(y=places % 20).dims.index("point")),
        )

    def test_lists_and_points_decode_what_they_hold(self):
        values = ramp(70, 60, 300)
        values[5:9, 5:9, 5:9] = numpy.nan
        decoded = []
        read = weir.Grid._read

        def noted(grid, key, level):
            found = read(grid, key, level)
            decoded.append(found.size)
            return found

        for keywords in (
            {"lossless": True},
            {"encoding": "packed", "rate": 16},
            {"encoding": "fpn", "rate": 5},
            {"encoding": "fp8", "rate": 3},
        ):
            holds_nan = keywords.get("encoding") not in ("fpn", "fp8")
            given = values if holds_nan else numpy.nan_to_num(values)
            weir.convert(given, self.folder / "a.nvdb", overwrite=True, nonfinite="keep", **keywords)
            for level in (0, 1):
                with (
                    self.subTest(level=level, **keywords),
                    weir.open(self.folder / "a.nvdb") as grid,
                    unittest.mock.patch.object(weir.Grid, "_read", noted),
                ):
                    array, wanted = grid.to_xarray(level=level), grid.to_numpy(level=level)
                    last = wanted.shape[0] - 1
                    decoded.clear()
                    found = array[[last, 0, 7, 0, -1], ::-2, [3, 33]].values
                    self.assertTrue(same(found, wanted[[last, 0, 7, 0, -1]][:, ::-2][:, :, [3, 33]]))
                    self.assertEqual(sum(decoded), (8 + 1) * -(-wanted.shape[1] // 2) * 2)
                    places = numpy.random.default_rng(3).integers(0, wanted.shape, (40, 3))
                    places[:2] = [[5, 5, 5], [-1, -1, -1]]
                    chosen = {axis: xarray.DataArray(places[:, i], dims="point") for i, axis in enumerate("zyx")}
                    decoded.clear()
                    self.assertTrue(same(array.isel(chosen).values, wanted[tuple(places.T)]))
                    self.assertEqual(len(decoded), len({tuple(place // 8 for place in at) for at in places % wanted.shape}))
                    self.assertLess(sum(decoded), 40 * 8**3)
                    chosen["z"][7] = 999
                    with self.assertRaisesRegex(IndexError, "^index 999 is out of bounds for axis 0"):
                        array.isel(chosen).values

    def test_a_quantity_that_is_called_like_an_axis(self):
        for given, name in (("/velocity/x", "velocity_x"), ("z", None), ("/z/y", "z_y")):
            array = self.lossless(ramp(4, 5, 6), name=given.replace("/", "") + ".nvdb", dataset=given).to_xarray()
            self.assertEqual((array.name, array.dims), (name, ("z", "y", "x")))

    @staticmethod
    def lists(key, shape):
        parts = (key if isinstance(key, tuple) else (key,)) + (slice(None),) * 3
        return [numpy.atleast_1d(numpy.arange(count)[part]) for part, count in zip(parts, shape)]

    def test_levels_lie_in_the_middle_of_their_cubes(self):
        grid = self.lossless(ramp(12, 21, 28), spacing=(0.5, 1, 2))
        array = grid.to_xarray(level=2)
        self.assertTrue(same(array.values, grid.to_numpy(level=2)))
        numpy.testing.assert_array_equal(array.x, [0.75, 2.75, 4.75])
        self.assertEqual(list(array.y.values), [1.5, 5.5, 9.5, 13.5, 17.5, 20])
        self.assertTrue(same(array[::2, 1, ::-1].values, grid.to_numpy(level=2)[::2, 1, ::-1]))


class Sidecars(FolderTest):
    """Tests a dataset like a cloud model's NetCDF file."""

    def setUp(self):
        super().setUp()
        try:
            import h5py
        except ImportError:
            self.skipTest("python3-h5py is missing")
        self.values = ramp(12, 20, 28)
        self.heights = 50 * numpy.arange(1, 29) ** 1.5
        with h5py.File(self.folder / "model.h5", "w") as file:
            field = file.create_dataset("qc", data=self.values[None])
            field.attrs["units"], field.attrs["long_name"] = "kg kg-1", "cloud water mixing ratio"
            for axis, (name, values, units) in enumerate(
                (
                    ("time", [3600.0], "seconds since 2000-01-01 00:00:00"),
                    ("height", self.heights, "m"),
                    ("lat", 50 + 0.25 * numpy.arange(20), "degrees_north"),
                    ("lon", 5 + 0.5 * numpy.arange(12), "degrees_east"),
                )
            ):
                scale = file.create_dataset(name, data=numpy.asarray(values, float))
                scale.attrs["units"] = units
                scale.make_scale(name)
                field.dims[axis].attach_scale(scale)
        weir.convert(self.folder / "model.h5", self.folder / "a.nvdb", dataset="/qc", index=[0], lossless=True)

    def test_names_units_time_and_uneven_heights(self):
        with xarray.open_dataset(self.folder / "a.nvdb", engine="weir") as dataset:
            self.assertEqual(list(dataset.data_vars), ["qc"])
            array = dataset["qc"]
            self.assertEqual(array.dims, ("height", "lat", "lon"))
            self.assertEqual(array.attrs["units"], "kg kg-1")
            self.assertEqual(array.attrs["long_name"], "cloud water mixing ratio")
            numpy.testing.assert_allclose(array.height, self.heights)
            numpy.testing.assert_array_equal(array.lon, 5 + 0.5 * numpy.arange(12))
            self.assertEqual([array[axis].units for axis in array.dims], ["m", "degrees_north", "degrees_east"])
            self.assertEqual(array.time.values, numpy.datetime64("2000-01-01T01:00:00"))
            self.assertEqual(float(array.sel(lat=51, lon=6, method="nearest")[3]), self.values[3, 4, 2])

    def test_times_that_are_not_decoded(self):
        with xarray.open_dataset(self.folder / "a.nvdb", engine="weir", decode_times=False) as dataset:
            self.assertEqual(float(dataset.time), 3600)
            self.assertEqual(dataset.time.units, "seconds since 2000-01-01 00:00:00")

    def test_steps_become_a_series(self):
        with xarray.open_dataset(self.folder / "a.nvdb") as first:  # the engine is found by the file's extension
            second = first.assign_coords(time=first.time + numpy.timedelta64(1, "h"))
            series = xarray.concat([first, second], "time")
            self.assertEqual(series.sizes["time"], 2)


class FallingLatitudes(FolderTest):
    """Tests a reanalysis with rows from north to south."""

    def setUp(self):
        super().setUp()
        try:
            import h5py
        except ImportError:
            self.skipTest("python3-h5py is missing")
        self.latitudes = numpy.linspace(60, 30, 31)
        self.levels = numpy.array([1000.0, 850, 500, 250, 100])
        self.values = ramp(40, 31, 5)
        with h5py.File(self.folder / "era5.h5", "w") as file:
            field = file.create_dataset("t", data=self.values, chunks=(2, 7, 11), compression="gzip")
            for axis, (name, places) in enumerate(
                (("level", self.levels), ("latitude", self.latitudes), ("longitude", numpy.arange(40.0)))
            ):
                scale = file.create_dataset(name, data=places)
                scale.make_scale(name)
                field.dims[axis].attach_scale(scale)

    def test_a_row_lies_at_its_latitude(self):
        weir.convert(self.folder / "era5.h5", self.folder / "a.nvdb", lossless=True)
        with xarray.open_dataset(self.folder / "a.nvdb", engine="weir") as dataset:
            array = dataset["t"]
            numpy.testing.assert_array_equal(array.latitude, self.latitudes[::-1])
            for row, latitude in enumerate(self.latitudes):
                numpy.testing.assert_array_equal(array.sel(latitude=latitude), self.values[:, row])
            for plane, level in enumerate(self.levels):
                numpy.testing.assert_array_equal(array.sel(level=level), self.values[plane, ::-1])

    def test_the_grid_and_a_region_have_rising_positions(self):
        record = weir.convert(
            self.folder / "era5.h5", self.folder / "a.nvdb", lossless=True, roi=((3, 2, 0), (40, 6, 5))
        )
        self.assertEqual(record["source"]["reversed_axes"], ["y"])
        grid = weir.open(self.folder / "a.nvdb")
        self.addCleanup(grid.close)
        self.assertEqual((grid.origin[1], grid.spacing[1]), (30, 1))
        array = grid.to_xarray()
        self.assertEqual(list(array.latitude.values), [32, 33, 34, 35])
        numpy.testing.assert_array_equal(array.sel(latitude=33), self.values[:, 27, 3:])


class Convert(FolderTest):
    """weir.convert of a DataArray."""

    def array(self, **changes):
        values = ramp(4, 5, 6)
        fields = {
            "dims": ("height", "lat", "lon"),
            "coords": {
                "height": ("height", [0.0, 10, 30, 60, 100, 150], {"units": "m", "axis": "Z"}),
                "lat": ("lat", 50 - 0.5 * numpy.arange(5), {"units": "degrees_north"}),
                "lon": ("lon", 7 + 0.25 * numpy.arange(4, dtype=numpy.float32), {"units": "degrees_east"}),
                "time": numpy.datetime64("2000-01-02T12:00:00"),
            },
            "name": "qc",
            "attrs": {"units": "kg/kg", "long_name": "cloud water"},
        }
        return xarray.DataArray(values, **{**fields, **changes})

    def test_place_units_names_and_time_are_kept(self):
        with self.assertLogs("weir") as logs:
            record = weir.convert(self.array(), self.folder / "a.nvdb", lossless=True)
        self.assertEqual(
            [line.split(": ", 1)[1] for line in logs.output if "axis" in line],
            [
                "qc: axis y (lat) falls from 50 to 48: rows are read in reverse order, so that positions rise",
                "qc: axis z (height): irregular coordinates from 0 to 150, taken as indices, 1 apart; spacing sets "
                "another distance"
            ],
        )
        source = record["source"]
        self.assertEqual(source["dataset"], "qc")
        self.assertEqual((source["units"], source["long_name"]), ("kg/kg", "cloud water"))
        self.assertEqual(source["axes"], ["lon", "lat", "height"])
        self.assertEqual(source["axis_units"], ["degrees_east", "degrees_north", "m"])
        self.assertEqual(source["time"], {"value": 946814400.0, "units": "seconds since 1970-01-01 00:00:00"})
        self.assertEqual(record["grid"]["voxel_size"], [0.25, 0.5, 1.0])
        self.assertEqual(record["grid"]["origin"], [7.0, 48.0, 0.0])
        with weir.open(self.folder / "a.nvdb") as grid:
            again = grid.to_xarray()
            self.assertTrue(same(again.values, self.array().values[:, ::-1]))  # lat falls
            xarray.testing.assert_equal(again.drop_vars("time").sortby("lat", ascending=False), self.array().drop_vars("time"))
            self.assertEqual(again.time, self.array().time)

    def test_coordinates_that_rise_and_fall_are_not_turned_round(self):
        longitudes = numpy.concatenate([numpy.arange(0, 180, 90), numpy.arange(-180, 0, 90)]).astype(float)
        array = self.array().assign_coords(lon=("lon", longitudes))
        with self.assertLogs("weir") as logs:
            weir.convert(array, self.folder / "a.nvdb", lossless=True)
        (said,) = [line for line in logs.output if "lon" in line]
        self.assertIn(
            "qc: axis x (lon): coordinates from 0 to -90 that rise and fall, taken as indices; source.sortby('lon') puts "
            "them in order",
            said,
        )
        with weir.open(self.folder / "a.nvdb") as grid:
            self.assertTrue(same(grid.to_numpy(), array.values[:, ::-1]))  # lat alone falls
            numpy.testing.assert_array_equal(grid.to_xarray().lon, longitudes)

    def test_dates_along_an_axis_are_kept(self):
        days = numpy.datetime64("2000-01-01") + numpy.arange(6).astype("timedelta64[D]")
        array = xarray.DataArray(
            ramp(4, 5, 6), dims=("day", "lat", "lon"), coords={"day": days.astype("datetime64[ns]")}, name="rain"
        )
        with self.assertLogs("weir") as logs:
            weir.convert(array, self.folder / "a.nvdb", lossless=True)
        self.assertIn("rain: axis z (day): dates from 2000-01-01T00:00:00", logs.output[0])
        with xarray.open_dataset(self.folder / "a.nvdb", engine="weir") as dataset:
            numpy.testing.assert_array_equal(dataset["rain"].day, days.astype("datetime64[ns]"))

    def test_coordinates_that_are_no_numbers_are_said(self):
        array = self.array().assign_coords(lon=("lon", list("abcd")), lat=("lat", [0, 1, numpy.nan, 3, 4]))
        with self.assertLogs("weir") as logs:
            weir.convert(array, self.folder / "a.nvdb", lossless=True)
        said = "\n".join(logs.output)
        self.assertIn("axis x (lon): coordinates of type <U1, taken as indices", said)
        self.assertIn("axis y (lat): coordinates that are missing or not finite, taken as indices", said)

    def test_texts_that_are_no_unicode_are_replaced(self):
        record = weir.convert(self.array(attrs={"units": "m\ud800"}), self.folder / "a.nvdb", lossless=True)
        self.assertEqual(record["source"]["units"], "m?")

    def test_axes_are_ordered_by_what_they_are(self):
        values = ramp(4, 5, 6)
        for dims in (("x", "y", "z"), ("lon", "lat", "level"), ("x", "depth", "y")):
            by_name = {"x": 2, "lon": 2, "y": 1, "lat": 1}
            array = xarray.DataArray(values.transpose([by_name.get(name, 0) for name in dims]), dims=dims)
            self.assertTrue(same(self.lossless(array, overwrite=True).to_numpy(), values), dims)
        array = xarray.DataArray(values, dims=("a", "b", "c"))
        self.assertTrue(same(self.lossless(array, overwrite=True).to_numpy(), values), "as they are")

    def test_keywords_come_first(self):
        record = weir.convert(
            self.array(), self.folder / "a.nvdb", spacing=(1, 2, 3), origin=(4, 5, 6), dataset="q", lossless=True
        )
        self.assertEqual(record["grid"]["voxel_size"], [1, 2, 3])
        self.assertEqual(record["grid"]["origin"], [4, 5, 6])
        self.assertEqual(record["source"]["dataset"], "q")

    def test_axes_of_one_position_are_left_out_and_others_are_refused(self):
        one = self.array().expand_dims("member")
        self.assertTrue(same(self.lossless(one).to_numpy(), self.array().values[:, ::-1]))
        two = xarray.concat([self.array()] * 2, "member")
        self.assertEqual(
            self.refused(weir.UsageError, weir.convert, two, self.folder / "b.nvdb"),
            "source has the axes (member, height, lat, lon), it must have three; choose with source.isel(member=0)",
        )
        self.assertEqual(
            self.refused(weir.UsageError, weir.convert, self.array()[0], self.folder / "b.nvdb"),
            "source has the axes (lat, lon), it must have three",
        )
        self.assertEqual(
            self.refused(TypeError, weir.convert, self.array().to_dataset(), self.folder / "b.nvdb"),
            "source is a Dataset, it must be a path, a numpy array, an xarray.DataArray or an array with DLPack or"
            " __cuda_array_interface__; give one of its arrays, source[NAME]",
        )

    def test_of_axes_of_one_position_those_of_space_stay(self):
        coords = {
            "z": ("z", [700.0], {"units": "m"}),
            "height": ("height", [500.0], {"units": "m"}),
            "time": ("time", numpy.array(["2020-01-01"], "datetime64[ns]")),
        }
        values = ramp(14, 9, 1)
        for dims, z in (
            (("z", "time", "y", "x"), "z"),
            (("time", "z", "y", "x"), "z"),
            (("height", "time", "lat", "lon"), "height"),
            (("height", "member", "lat", "lon"), "height"),
            (("time", "member", "height", "lat", "lon"), "height"),
        ):
            with self.subTest(dims):
                array = xarray.DataArray(
                    values.reshape((1,) * (len(dims) - 2) + (9, 14)),
                    dims=dims,
                    coords={name: coords[name] for name in dims if name in coords},
                )
                record = weir.convert(array, self.folder / "a.nvdb", lossless=True, overwrite=True)
                self.assertEqual(record["source"]["axes"], [dims[-1], dims[-2], z])
                self.assertEqual(record["grid"]["origin"], [0, 0, coords[z][1][0]])
                self.assertEqual(record["source"].get("time", {}).get("value"), 1577836800 if "time" in dims else None)
                with weir.open(self.folder / "a.nvdb") as grid:
                    self.assertTrue(same(grid.to_numpy(), values))
        series = xarray.DataArray(ramp(14, 9, 8)[:, None], dims=("time", "z", "y", "x"))
        self.assertTrue(same(self.lossless(series, overwrite=True).to_numpy(), ramp(14, 9, 8)), "nothing else to leave out")

    def test_a_time_of_another_calendar_is_kept(self):
        try:
            import cftime
        except ImportError:
            self.skipTest("python3-cftime is missing")
        for date, seconds in (
            (cftime.DatetimeNoLeap(2000, 1, 1), 30 * 365 * 86400),
            (cftime.Datetime360Day(2000, 2, 30, 12), (30 * 360 + 59.5) * 86400),
        ):
            with self.subTest(date):
                record = weir.convert(
                    self.array().assign_coords(time=date), self.folder / "a.nvdb", lossless=True, overwrite=True
                )
                self.assertEqual(
                    record["source"]["time"],
                    {"value": seconds, "units": "seconds since 1970-01-01 00:00:00", "calendar": date.calendar},
                )
                with xarray.open_dataset(self.folder / "a.nvdb", engine="weir") as dataset:
                    self.assertEqual(dataset.time.item(), date)

    def test_a_time_that_cannot_be_kept_is_said(self):
        for time, shown in ((numpy.datetime64("NaT", "ns"), "'NaT'"), ("noon", "'noon'")):
            with self.subTest(shown), self.assertLogs("weir") as logs:
                array = self.array().assign_coords(time=time)
                record = weir.convert(array, self.folder / "a.nvdb", lossless=True, overwrite=True)
                self.assertNotIn("time", record["source"])
                self.assertIn(
                    f"WARNING:weir:qc: time is {shown}, no date of a known calendar and no finite number; it is left out",
                    logs.output,
                )

    def test_attributes_that_are_arrays(self):
        record = weir.convert(self.array(attrs={"units": numpy.array(["K"])}), self.folder / "a.nvdb", lossless=True)
        self.assertEqual(record["source"]["units"], "K")
        self.assertEqual(
            self.refused(weir.UsageError, weir.convert, self.array(attrs={"units": numpy.arange(2)}), self.folder / "b.nvdb"),
            "source has units that are an array of int64 with the shape (2,); set source.attrs['units'] to a text",
        )
        array = self.array().assign_coords(lon=("lon", numpy.arange(4), {"units": numpy.arange(2)}))
        self.assertEqual(
            self.refused(weir.UsageError, weir.convert, array, self.folder / "b.nvdb"),
            "source['lon'] has units that are an array of int64 with the shape (2,); set source['lon'].attrs['units'] to a"
            " text",
        )
        self.assertEqual(self.names(), ["a.nvdb", "a.nvdb.json"])

    def test_the_accessor(self):
        record = self.array().weir.convert(self.folder / "a.nvdb", lossless=True)
        self.assertEqual(record["source"]["dataset"], "qc")
        self.assertEqual(self.names(), ["a.nvdb", "a.nvdb.json"])


class Engine(FolderTest):
    def test_of_a_file_without_a_sidecar(self):
        values = ramp(12, 20, 28)
        self.lossless(values)
        (self.folder / "a.nvdb.json").unlink()
        with xarray.open_dataset(self.folder / "a.nvdb", engine="weir") as dataset:
            (name,) = dataset.data_vars
            self.assertEqual(dataset[name].attrs, {})
            self.assertTrue(same(dataset[name].values, values))

    def test_a_closed_dataset_lets_go_of_its_file(self):
        self.lossless(ramp(12, 20, 28))
        dataset = xarray.open_dataset(self.folder / "a.nvdb", engine="weir")
        (name,) = dataset.data_vars
        dataset.close()
        self.assertEqual(
            self.refused(weir.UsageError, lambda: dataset[name].values),
            "a.nvdb: is closed; open it again with weir.open",
        )

    def test_options_and_errors(self):
        grid = self.lossless(ramp(16, 16, 16))
        with xarray.open_dataset(grid.path, engine="weir", level=1) as dataset:
            self.assertEqual(dict(dataset.sizes), {"z": 8, "y": 8, "x": 8})
        with self.assertRaises(FileNotFoundError):
            xarray.open_dataset(self.folder / "no.nvdb", engine="weir")

    def test_it_knows_files_and_urls_by_their_names(self):
        from weir.xarray_backend import WeirBackendEntrypoint

        engine = WeirBackendEntrypoint()
        for name in ("a.nvdb", self.folder / "a.NVDB", "a?.nvdb", "https://host/a.nvdb?key=1", "s3://bucket/a.nvdb#1"):
            self.assertTrue(engine.guess_can_open(name), name)
        for name in ("a.nc", "https://host/a.nc?b.nvdb", "a.nvdb?key=1", b"a.nvdb", 3):
            self.assertFalse(engine.guess_can_open(name), name)

    def test_it_is_pickled_as_its_path(self):
        values = ramp(12, 20, 28)
        array = pickle.loads(pickle.dumps(self.lossless(values).to_xarray()))
        self.assertTrue(same(array.values, values))

    def test_chunks_are_whole_blocks(self):
        try:
            import dask.array  # noqa: F401
        except ImportError:
            self.skipTest("python3-dask is missing")
        values = ramp(12, 20, 300)
        self.lossless(values)
        with xarray.open_dataset(self.folder / "a.nvdb", engine="weir", chunks={}) as dataset:
            (name,) = dataset.data_vars
            self.assertEqual(dataset[name].chunks, ((128, 128, 44), (20,), (12,)))
            self.assertEqual(float(dataset[name].max()), values.max())


if __name__ == "__main__":
    unittest.main()
