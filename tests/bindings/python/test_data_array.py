"""Tests weir.convert of a DataArray: undecoded values, and irregular, falling or overruled coordinates."""

import logging
import unittest

import numpy

try:
    import xarray
except ImportError:
    raise unittest.SkipTest("python3-xarray is missing") from None

import weir
from support import FolderTest, ramp, same


class DataArrayTest(FolderTest):
    def array(self, values=None, attrs=None, **coords):
        """Returns an array [z, y, x] with coordinates on some axes, each its values or (values, attributes)."""
        given = {
            axis: (axis, *(found if isinstance(found, tuple) else (found,))) for axis, found in coords.items()
        }
        return xarray.DataArray(
            ramp(8, 5, 6) if values is None else values, dims=("z", "y", "x"), coords=given, name="t", attrs=attrs
        )

    def converted(self, array, **keywords):
        """Converts the array. Returns the sidecar and the logged lines."""
        with self.assertLogs("weir") as logs:
            record = weir.convert(array, self.folder / "a.nvdb", overwrite=True, **{"lossless": True, **keywords})
            logging.getLogger("weir").warning("there is one line at least")
        lines = [line.removeprefix("WARNING:weir:").removeprefix("memory: ") for line in logs.output]
        return record, [line for line in lines if line.startswith("t: ")]

    def seen(self):
        """As Grid.to_xarray has it."""
        grid = weir.open(self.folder / "a.nvdb")
        self.addCleanup(grid.close)
        return grid.to_xarray()


class Undecoded(DataArrayTest):
    def counts(self, **attrs):
        return self.array((ramp(8, 5, 6) % 1000).astype(numpy.int16), attrs)

    def test_packed_values_are_refused(self):
        for attrs, said in (
            ({"scale_factor": 0.01}, "scale_factor 0.01"),
            ({"scale_factor": numpy.float32(0.5), "add_offset": 273.15}, "scale_factor 0.5"),
            ({"scale_factor": numpy.array([1.0]), "add_offset": 273.15}, "add_offset 273.15"),
            ({"add_offset": "x"}, "add_offset 'x'"),
            ({"scale_factor": numpy.arange(2)}, "scale_factor an array of int64 with the shape (2,)"),
            ({"_Unsigned": "true"}, "_Unsigned 'true'"),
        ):
            with self.subTest(said):
                key = said.partition(" ")[0]
                self.assertEqual(
                    self.refused(weir.UsageError, weir.convert, self.counts(**attrs), self.folder / "a.nvdb"),
                    f"source has {said}, so its values are not decoded; give what xarray.decode_cf makes of its "
                    f"dataset, or delete source.attrs['{key}'] where that was applied",
                )
        self.assertEqual(self.names(), [])

    def test_packing_that_changes_nothing_is_taken(self):
        array = self.counts(scale_factor=1.0, add_offset=numpy.array([0]), _Unsigned="false")
        self.converted(array)
        self.assertTrue(same(self.seen().values, array.values.astype(numpy.float32)))

    def test_packed_coordinates_are_refused(self):
        array = self.array(x=(numpy.arange(8, dtype=numpy.int16), {"scale_factor": 0.25}))
        self.assertEqual(
            self.refused(weir.UsageError, weir.convert, array, self.folder / "a.nvdb"),
            "source['x'] has scale_factor 0.25, so its values are not decoded; give what xarray.decode_cf makes of its "
            "dataset, or delete source['x'].attrs['scale_factor'] where that was applied",
        )

    def test_what_decode_cf_makes_of_it_is_taken(self):
        array = self.counts(scale_factor=0.25, add_offset=100.0)
        decoded = xarray.decode_cf(array.to_dataset())["t"]
        self.converted(decoded)
        self.assertTrue(same(self.seen().values, decoded.values.astype(numpy.float32)))
        self.assertEqual(float(self.seen()[0, 0, 3]), 100.75)

    def test_the_attributes_name_the_missing_value(self):
        for kind, attrs in (
            ("int16", {"_FillValue": numpy.int16(-999)}),
            ("int16", {"missing_value": -999.0}),
            ("int32", {"_FillValue": numpy.array([-999]), "missing_value": numpy.int16(-999)}),
            ("float32", {"_FillValue": numpy.float32(1e20)}),
            ("float32", {"_FillValue": 1e20, "missing_value": numpy.float32(1e20)}),
            ("float32", {"_FillValue": numpy.nan, "missing_value": 1e20}),
            ("float64", {"missing_value": 1e20}),
        ):
            with self.subTest(kind=kind, attrs=attrs):
                values = (ramp(8, 5, 6) % 1000).astype(kind)
                values[2, 1, :3] = -999 if "int" in kind else 1e20
                array = self.array(values, attrs)
                message = self.refused(weir.InputError, weir.convert, array, self.folder / "b.nvdb", lossless=True)
                stored = "-999" if "int" in kind else "1e+20"
                self.assertEqual(
                    message,
                    f"memory, dataset t: 3 of 240 voxels (1.3 %) hold no data (stored as {stored}), the first at "
                    f"0,1,2; choose missing_policy background or, to take {stored} for data, missing_policy keep",
                )
                record, _ = self.converted(array, missing_policy="background")
                self.assertEqual((record["missing"]["count"], record["missing"]["policy"]), (3, "background"))
                self.assertEqual(record["value_range"], [0, 407])

    def test_a_missing_value_that_is_given_comes_first(self):
        values = ramp(8, 5, 6)
        values[0, 0, :2] = -1
        record, _ = self.converted(self.array(values, {"_FillValue": 107.0}), missing=-1, missing_policy="background")
        self.assertEqual((record["missing"]["count"], record["missing"]["values"]), (2, ["-1"]))
        self.converted(self.array(values, {"_FillValue": 1, "missing_value": 2}), missing=-9)

    def test_several_missing_values_are_refused(self):
        for attrs, said in (
            ({"_FillValue": -9999, "missing_value": -1}, "_FillValue -9999 and missing_value -1"),
            ({"missing_value": numpy.array([-1, -2])}, "missing_value -1 and missing_value -2"),
        ):
            self.assertEqual(
                self.refused(weir.UsageError, weir.convert, self.counts(**attrs), self.folder / "a.nvdb"),
                f"source has {said}, and one number can stand for no data; give what xarray.decode_cf makes of its "
                "dataset, or name the one with missing",
            )

    def test_a_missing_value_that_is_no_number_is_refused(self):
        self.assertEqual(
            self.refused(weir.UsageError, weir.convert, self.counts(missing_value="-1"), self.folder / "a.nvdb"),
            "source has missing_value '-1', it must be a number; correct or delete source.attrs['missing_value']",
        )

    def test_a_missing_value_that_the_type_cannot_hold_is_said(self):
        for number in (-32769, 0.5):
            record, said = self.converted(self.counts(_FillValue=number))
            self.assertEqual(
                said,
                [
                    f"t: its attribute _FillValue is {number}, and no int16 is, so it marks no voxel; missing names "
                    "the stored value that stands for no data"
                ],
            )
            self.assertEqual(record["missing"]["values"], [])


class Coordinates(DataArrayTest):
    def test_irregular_whole_numbers_are_irregular(self):
        places = 5400000 + numpy.array([0, 1, 3, 4, 5, 6, 8, 9], numpy.int32)
        record, said = self.converted(self.array(x=places))
        self.assertEqual(
            said,
            [
                "t: axis x (x): irregular coordinates from 5400000 to 5400009, taken as indices, 1 apart; spacing sets "
                "another distance"
            ],
        )
        self.assertEqual(record["source"]["irregular_axes"]["x"], places.tolist())
        numpy.testing.assert_array_equal(self.seen().x, places)

    def test_regular_whole_numbers_are_regular(self):
        record, said = self.converted(self.array(x=5400000 + 3 * numpy.arange(8, dtype=numpy.int32)))
        self.assertEqual((said, record["grid"]["voxel_size"][0], record["grid"]["origin"][0]), ([], 3, 5400000))

    def test_float32_may_be_off_by_its_rounding(self):
        places = (5400000.3 + 3.3 * numpy.arange(8)).astype(numpy.float32)
        self.assertEqual(sorted(set(numpy.diff(places).tolist())), [3.0, 3.5])
        record, said = self.converted(self.array(x=places))
        self.assertEqual(said, [])
        self.assertAlmostEqual(record["grid"]["voxel_size"][0], 3.3, 1)


class Falling(DataArrayTest):
    latitudes = numpy.linspace(60, 58, 5)
    note = "t: axis y (y) falls from 60 to 58: rows are read in reverse order, so that positions rise"

    def test_it_is_said_and_kept_as_of_a_file(self):
        record, said = self.converted(self.array(y=self.latitudes))
        self.assertEqual(said, [self.note])
        self.assertEqual(record["source"]["reversed_axes"], ["y"])
        for axis, elements in (("x", "columns"), ("z", "planes")):
            count = {"x": 8, "z": 6}[axis]
            record, said = self.converted(self.array(**{axis: numpy.float32(0.1) * numpy.arange(count, 0, -1, "f4")}))
            self.assertEqual(
                said,
                [
                    f"t: axis {axis} ({axis}) falls from {count / 10} to 0.1: {elements} are read in reverse order, so "
                    "that positions rise"
                ],
            )
            self.assertEqual(record["source"]["reversed_axes"], [axis])

    def test_a_region_counts_from_the_lowest_position(self):
        array = self.array(y=self.latitudes)
        self.converted(array, roi=((0, 0, 0), (8, 2, 6)))
        self.assertEqual(self.seen().y.values.tolist(), [58, 58.5])
        self.assertTrue(same(self.seen().values, array.values[:, :-3:-1]))

    def test_it_is_said_beside_a_spacing_that_is_given(self):
        record, said = self.converted(self.array(y=self.latitudes), spacing=(1, 2, 3))
        self.assertEqual(said, [self.note])
        self.assertEqual(record["source"]["reversed_axes"], ["y"])

    def test_coordinates_that_are_irregular_too(self):
        levels = numpy.array([1000, 850, 700, 500, 300, 100])
        record, said = self.converted(self.array(z=levels))
        falls = "t: axis z (z) falls from 1000 to 100: planes are read in reverse order, so that positions rise"
        self.assertEqual(
            said,
            [
                f"{falls}; irregular coordinates from 100 to 1000, taken as indices, 1 apart; spacing sets another "
                "distance"
            ],
        )
        self.assertEqual(record["source"]["irregular_axes"]["z"], levels[::-1].tolist())
        self.assertEqual(record["source"]["reversed_axes"], ["z"])
        record, said = self.converted(self.array(z=levels), spacing=(1, 1, 2))
        self.assertEqual(said, [falls])
        self.assertNotIn("irregular_axes", record["source"])


class Spaced(DataArrayTest):
    """Tests that positions are those of the grid if a spacing is given."""

    def test_irregular_coordinates_are_left_out(self):
        heights = [0.0, 10, 30, 60, 100, 150]
        for places in (heights, [0.0, 10, 10, 30, 60, 100], [0.0, 10, 5, 30, 60, 100]):
            record, said = self.converted(self.array(z=(places, {"units": "m"})), spacing=(1, 1, 25), origin=(0, 0, 5))
            self.assertEqual(said, [])
            self.assertNotIn("irregular_axes", record["source"])
            array = self.seen()
            self.assertEqual(array.z.values.tolist(), [5, 30, 55, 80, 105, 130])
            self.assertEqual(array.z.units, "m")
            with xarray.open_dataset(self.folder / "a.nvdb", engine="weir") as dataset:
                self.assertEqual(dataset.z.values.tolist(), [5, 30, 55, 80, 105, 130])

    def test_dates_stay(self):
        days = (numpy.datetime64("2000-01-01") + numpy.arange(6).astype("timedelta64[D]")).astype("datetime64[ns]")
        self.converted(self.array(z=days), spacing=(1, 1, 2))
        numpy.testing.assert_array_equal(self.seen().z, days)

    def test_numbers_that_count_time_become_no_other_dates(self):
        units = {"units": "hours since 2000-01-01"}
        self.converted(self.array(z=(6.0 * numpy.arange(6), units)), spacing=(1, 1, 2))
        self.assertEqual(self.seen().z.values.tolist(), [0, 2, 4, 6, 8, 10])
        self.converted(self.array(z=([0.0, 6, 24, 30, 48, 54], units)), spacing=(1, 1, 2))
        self.assertEqual(self.seen().z.values[2], numpy.datetime64("2000-01-02"))


if __name__ == "__main__":
    unittest.main()
