"""Tests that `weir compare --derived` and `--certify gradient` agree with numpy's results for the same values."""

import json
import unittest

import numpy
import weir
from support import FolderTest, run_weir


def similarity(a, b, value_range):
    """Returns the mean SSIM over windows of 8^3 at every fourth voxel and at the upper faces, as in
    docs/budget.md."""
    c1, c2 = (0.01 * value_range) ** 2, (0.03 * value_range) ** 2
    starts = [sorted({*range(0, n - 7, 4), max(n - 8, 0)}) for n in a.shape]
    found = []
    for z in starts[0]:
        for y in starts[1]:
            for x in starts[2]:
                u, v = (values[z : z + 8, y : y + 8, x : x + 8] for values in (a, b))
                covariance = ((u - u.mean()) * (v - v.mean())).mean()
                found.append(
                    (2 * u.mean() * v.mean() + c1)
                    * (2 * covariance + c2)
                    / ((u.mean() ** 2 + v.mean() ** 2 + c1) * (u.var() + v.var() + c2))
                )
    return numpy.mean(found)


def sizes_of_gradient(values, steps):
    return numpy.sqrt(sum(part**2 for part in numpy.gradient(values, *steps)))


class Derived(FolderTest):
    def check_gradient(self, said, source, decoded, spacing):
        """`said` of two arrays [z, y, x] of float64, in which NaN is no value."""
        of_error = sizes_of_gradient(decoded - source, spacing[::-1])
        of_source = sizes_of_gradient(source, spacing[::-1])
        taken = ~numpy.isnan(of_error)
        rms = numpy.sqrt((of_error[taken] ** 2).mean())
        self.assertAlmostEqual(said["rms"] / rms, 1, delta=1e-6)
        relative = rms / numpy.sqrt((of_source[taken] ** 2).mean())
        self.assertAlmostEqual(said["relative_rms"] / relative, 1, delta=1e-6)
        self.assertAlmostEqual(said["max_abs"] / of_error[taken].max(), 1, delta=1e-6)
        self.assertEqual(said["voxels"], taken.sum())
        self.assertEqual(said["left_out"], source.size - taken.sum())

    def check(self, values, spacing, **options):
        values.astype("<f4").tofile(self.folder / "a.raw")
        z, y, x = values.shape
        made = weir.convert(
            values, self.folder / "a.nvdb", spacing=spacing, certify="gradient", overwrite=True, **options
        )
        said = json.loads(
            run_weir(
                *("compare", self.folder / "a.raw", self.folder / "a.nvdb", "--derived", "--json"),
                *("--dims", f"{x},{y},{z}", "--type", "float32", "--spacing", ",".join(map(str, spacing))),
            )
        )["derived"]
        source = values.astype(numpy.float64)
        decoded = weir.open(self.folder / "a.nvdb").to_numpy().astype(numpy.float64)
        error = numpy.sort(numpy.abs(decoded - source), axis=None)
        for share, found in said["quantiles"].items():
            exact = error[int(numpy.ceil(float(share) * error.size)) - 1]
            self.assertTrue(exact <= found <= exact * (1 + 1 / 256) + 1e-300, (share, exact, found))
        self.check_gradient(said["gradient"], source, decoded, spacing)
        self.assertEqual(made["error"]["gradient"], said["gradient"])
        self.assertAlmostEqual(said["ssim"], similarity(source, decoded, values.max() - values.min()), delta=1e-9)
        octaves = said["octaves"]
        self.assertEqual(octaves["zeros"] + sum(octaves["counts"]), values.size)
        exponent = octaves["first"] + len(octaves["counts"]) - 1
        self.assertTrue(2.0**exponent <= error[-1] < 2.0 ** (exponent + 1))

    def test_smooth_and_rough_volumes(self):
        z, y, x = numpy.mgrid[0:37, 0:40, 0:51].astype(numpy.float32)
        waves = numpy.sin(x * 0.2) * numpy.cos(y * 0.15 + z * 0.1) + 300
        noise = numpy.random.default_rng(5).standard_normal((20, 33, 17))
        self.check(waves.astype(numpy.float32), (0.5, 0.25, 2.0), rate=12, encoding="packed")
        self.check(noise.astype(numpy.float32), (1.0, 1.0, 1.0), psnr=20, encoding="fpn")

    def test_thin_volumes(self):
        values = numpy.random.default_rng(6).standard_normal((5, 40, 9)).cumsum(axis=1).astype(numpy.float32)
        self.check(values, (1.0, 3.0, 1.0), psnr=40, encoding="packed")

    def test_certified_gradient_of_every_encoding(self):
        z, y, x = numpy.mgrid[0:19, 0:24, 0:33]
        values = (numpy.sin(x * 0.4) + numpy.cos(y * 0.3) * z).astype(numpy.float32)
        for encoding in "float fpn fp4 fp8 fp16 packed".split():
            options = {"size": 350000} if encoding == "float" else {"psnr": 30}
            output = self.folder / f"{encoding}.nvdb"
            made = weir.convert(values, output, certify="gradient", encoding=encoding, **options)
            decoded = weir.open(output).to_numpy().astype(numpy.float64)
            self.check_gradient(made["error"]["gradient"], values.astype(numpy.float64), decoded, (1, 1, 1))

    def test_vorticity_and_divergence(self):
        z, y, x = numpy.mgrid[0:21, 0:33, 0:42] * numpy.array([0.5, 1, 0.25]).reshape(3, 1, 1, 1)
        field = (numpy.sin(y * 0.3 + x) + z, numpy.cos(x + z), numpy.sin(x * 0.5) * y)
        paths, errors, sources = [], [], []
        for name, values in zip("uvw", field):
            values = values.astype("<f4")
            source, output = self.folder / f"{name}_42x33x21_float32.raw", self.folder / f"{name}.nvdb"
            values.tofile(source)
            weir.convert(source, output, spacing=(0.25, 1, 0.5), psnr=40)
            paths += [source, output]
            sources.append(values.astype(numpy.float64))
            errors.append(weir.open(output).to_numpy().astype(numpy.float64) - sources[-1])
        compare = ("compare", *paths[:2], "--vector", *paths[2:], "--spacing", "0.25,1,0.5", "--json")
        said = json.loads(run_weir(*compare))["vector"]

        def derived(of):
            (uz, uy, ux), (vz, vy, vx), (wz, wy, wx) = (numpy.gradient(one, 0.5, 1, 0.25) for one in of)
            return numpy.sqrt((wy - vz) ** 2 + (uz - wx) ** 2 + (vx - uy) ** 2), numpy.abs(ux + vy + wz)

        for key, error, source in zip(("vorticity", "divergence"), derived(errors), derived(sources)):
            rms, source_rms = numpy.sqrt((error**2).mean()), numpy.sqrt((source**2).mean())
            self.assertAlmostEqual(said[key]["rms"] / rms, 1, delta=1e-6)
            self.assertAlmostEqual(said[key]["source_rms"] / source_rms, 1, delta=1e-6)
            self.assertAlmostEqual(said[key]["relative_rms"] / (rms / source_rms), 1, delta=1e-6)
            self.assertAlmostEqual(said[key]["max_abs"] / error.max(), 1, delta=1e-6)
        self.assertEqual((said["voxels"], said["left_out"]), (21 * 33 * 42, 0))

    def test_largest_error_bounds_that_of_the_gradient(self):
        values = numpy.random.default_rng(8).standard_normal((12, 17, 30)).astype(numpy.float32)
        for spacing in ((1, 1, 1), (0.5, 2, 1)):
            options = {"max_error": 0.25, "spacing": spacing, "encoding": "packed", "overwrite": True}
            error = weir.convert(values, self.folder / "a.nvdb", certify="gradient", **options)["error"]
            bound = 2 * error["max_abs"] * numpy.sqrt(sum(1 / h**2 for h in spacing))
            self.assertTrue(0 < error["gradient"]["max_abs"] <= bound, (error, bound))

    def test_certified_gradient_of_a_region_of_integers_some_missing(self):
        random = numpy.random.default_rng(7)
        stored = random.integers(0, 900, (21, 30, 40)).cumsum(axis=2).astype("<u2")
        stored[3:6, 10, 20:25] = 65535
        name = self.folder / "a_40x30x21_uint16.raw"
        stored.tofile(name)
        for policy in ("background", "keep"):
            options = {"psnr": 40, "missing": 65535, "nonfinite": policy, "overwrite": True}
            made = weir.convert(
                name, self.folder / "a.nvdb", roi="2:39,1:,:20", spacing=(1, 2, 0.5), certify="gradient", **options
            )
            compare = ("compare", name, self.folder / "a.nvdb", "--derived", "--json", "--spacing", "1,2,0.5")
            said = json.loads(run_weir(*compare))
            gradient = made["error"]["gradient"]
            self.assertEqual(gradient, said["derived"]["gradient"])
            source = stored[:20, 1:, 2:39].astype(numpy.float64)
            source[source == 65535] = numpy.nan
            decoded = weir.open(self.folder / "a.nvdb").to_numpy().astype(numpy.float64)
            self.check_gradient(gradient, source, decoded, (1, 2, 0.5))
            self.assertGreater(gradient["left_out"], 0)


if __name__ == "__main__":
    unittest.main()
