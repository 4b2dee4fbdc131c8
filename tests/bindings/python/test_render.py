"""Tests that Grid.render makes the same picture as `weir render`."""

import unittest

import numpy

import weir
from png import read_png
from support import FolderTest, ramp, run_weir
from weir.errors import InputNotFoundError


def ball(n=32):
    """Returns a volume that is 1 in the middle and falls to 0."""
    z, y, x = (numpy.mgrid[0:n, 0:n, 0:n] + 0.5) / n - 0.5
    return numpy.maximum(0, 1 - 2 * numpy.sqrt(x * x + y * y + z * z)).astype(numpy.float32)


class Render(FolderTest):
    def test_pictures_are_those_of_the_command(self):
        grid = self.lossless(ball())
        scene = self.folder / "scene.toml"
        scene.write_text("[lighting]\nexposure = 2\n")
        for keywords, options in (
            ({"mode": "dvr"}, ["--mode", "dvr"]),
            ({"mode": "path", "spp": 2, "seed": 7}, ["--mode", "path", "--spp", 2, "--seed", 7]),
            ({"mode": "iso", "iso": 0.5, "camera": (10, -20, 1.5)}, ["--mode", "iso", "--iso", 0.5, "--camera=10,-20,1.5"]),
            (
                {"mode": "mip", "colormap": "heat", "range": (0, 0.5), "filter": "nearest", "scene": scene},
                ["--mode", "mip", "--colormap", "heat", "--range", "0,0.5", "--filter", "nearest", "--scene", scene],
            ),
        ):
            with self.subTest(keywords):
                picture = grid.render(size=(60, 40), backend="cpu", **keywords)
                run_weir("render", grid.path, "-o", self.folder / "a.png", "--size", "60x40", "--backend", "cpu", "--overwrite", *options)
                self.assertEqual((picture.shape, picture.dtype), ((40, 60, 3), numpy.uint8))
                numpy.testing.assert_array_equal(picture, read_png(self.folder / "a.png"))
                self.assertGreater(picture.std(), 5)

    def test_levels_of_detail_are_those_of_the_command(self):
        grid = self.lossless(ball(64))
        fine = grid.render(size=(60, 40), backend="cpu", spp=2)
        for keywords, options in (
            ({"lod": "auto"}, ["--lod", "auto"]),
            ({"lod": 1.5}, ["--lod", "1.5"]),
            ({"lod": 1, "lod_scattered": 2}, ["--lod", "1", "--lod-scattered", "2"]),
        ):
            with self.subTest(keywords):
                picture = grid.render(size=(60, 40), backend="cpu", spp=2, **keywords)
                run_weir("render", grid.path, "-o", self.folder / "a.png", "--size", "60x40", "--backend", "cpu", "--spp", 2, "--overwrite", *options)
                numpy.testing.assert_array_equal(picture, read_png(self.folder / "a.png"))
                self.assertTrue((picture != fine).any() or keywords["lod"] == "auto")
        self.assertEqual(
            self.refused(weir.UsageError, grid.render, lod_scattered=1),
            "lod_scattered needs lod auto or a number of levels",
        )

    def test_options_of_devices_have_no_effect_without_one(self):
        grid = self.lossless(ball())
        plain = grid.render(size=(16, 9), mode="mip", backend="cpu")
        with self.assertLogs("weir", "WARNING") as logs:
            picture = grid.render(size=(16, 9), mode="mip", backend="cpu", devices=[0, 1], device_memory="1GiB")
        numpy.testing.assert_array_equal(picture, plain)
        self.assertEqual(
            logs.output,
            ["WARNING:weir:backend cpu was chosen, and devices and device_memory have no effect"],
        )
        self.assertEqual(
            self.refused(weir.UsageError, grid.render, devices=[]),
            "devices is an empty list; name a device in it, or leave it out",
        )

    def test_linear_is_radiance(self):
        picture = self.lossless(ball()).render(size=(30, 20), mode="dvr", linear=True)
        self.assertEqual((picture.shape, picture.dtype), ((20, 30, 3), numpy.float32))
        self.assertTrue(numpy.isfinite(picture).all())
        self.assertGreater(picture[10, 15].max(), 0)

    def test_a_colour_bar_stands_beside_the_picture(self):
        grid = self.lossless(ball(), dataset="density")
        plain = grid.render(size=(60, 80), mode="mip", colormap="viridis")
        both = grid.render(size=(60, 80), mode="mip", colormap="viridis", colorbar=True)
        numpy.testing.assert_array_equal(both[:, :60], plain)
        self.assertEqual(tuple(both[40, 61]), (255, 255, 255))
        numpy.testing.assert_allclose(both[70, 75], (68, 1, 84), atol=6)  # viridis at 0
        numpy.testing.assert_allclose(both[9, 75], (253, 231, 37), atol=9)
        self.assertEqual(
            self.refused(weir.UsageError, grid.render, linear=True, colorbar=True),
            "linear asks for radiance, colorbar for colours as a screen shows them; give one of them",
        )

    def test_progress_counts_samples(self):
        calls = []
        self.lossless(ball()).render(size=(30, 20), spp=3, progress=lambda *call: calls.append(call))
        self.assertEqual(calls[-1], ("render", 1800, 1800))

    def test_a_size_is_a_pair_or_a_text(self):
        grid = self.lossless(ball())
        picture = grid.render(size=(16, 9), mode="mip")
        for size in ("16x9", [16, 9], numpy.array([16, 9]), (numpy.uint8(16), numpy.array(9))):
            with self.subTest(size):
                numpy.testing.assert_array_equal(grid.render(size=size, mode="mip"), picture)

    def test_a_size_that_is_none(self):
        grid = self.lossless(ramp(9, 9, 9))
        form = "it must be (width, height), two whole numbers of pixels, or a text, '960x720'"
        for size in (5, None, (16,), (16, 9, 1), (16.0, 9), (True, 9), ("16", "9"), {16, 9}):
            with self.subTest(size):
                self.assertEqual(self.refused(weir.UsageError, grid.render, size=size), f"size is {size!r}, {form}")
        self.assertEqual(
            self.refused(weir.UsageError, grid.render, size=numpy.ones((2, 2))),
            f"size is an array of float64 with the shape (2, 2), {form}",
        )

    def test_what_cannot_be_rendered(self):
        grid = self.lossless(ramp(9, 9, 9))
        for message, keywords in {
            'size is "0x9", it must be WxH in pixels, each from 1 to 32768 and 268435456 together': {"size": (0, 9)},
            'size is "16", it must be WxH in pixels, each from 1 to 32768 and 268435456 together': {"size": "16"},
            'camera is "1,99", it must be AZIMUTH,ELEVATION[,ZOOM] in degrees, elevation from -90 to 90, '
            "zoom from 0.01 to 100": {"camera": (1, 99)},
            'mode is "oil", it must be path, dvr, iso or mip': {"mode": "oil"},
            'spp is "0", it must be a whole number from 1 to 1048576': {"spp": 0},
        }.items():
            self.assertEqual(self.refused(weir.UsageError, grid.render, **keywords), message)
        message = self.refused(InputNotFoundError, grid.render, scene=self.folder / "no.toml")
        self.assertEqual(message, "no.toml: cannot read the scene; it must be an existing TOML file")


if __name__ == "__main__":
    unittest.main()
