"""What `weir compare --derived` says is what numpy computes of the same values."""

import json
import unittest

import numpy
import weir
from support import FolderTest, run_weir


def similarity(a, b, value_range):
    """Mean SSIM over windows of 8^3 that begin at every fourth voxel, as docs/budget.md defines it."""
    c1, c2 = (0.01 * value_range) ** 2, (0.03 * value_range) ** 2
    starts = [range(0, n - 7, 4) if n >= 8 else range(1) for n in a.shape]
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


class Derived(FolderTest):
    def check(self, values, spacing, **options):
        values.astype("<f4").tofile(self.folder / "a.raw")
        z, y, x = values.shape
        weir.convert(values, self.folder / "a.nvdb", spacing=spacing, overwrite=True, **options)
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
        steps = spacing[::-1]
        of_error = numpy.sqrt(sum(part**2 for part in numpy.gradient(decoded - source, *steps)))
        of_source = numpy.sqrt(sum(part**2 for part in numpy.gradient(source, *steps)))
        rms = numpy.sqrt((of_error**2).mean())
        gradient = said["gradient"]
        self.assertAlmostEqual(gradient["rms"] / rms, 1, delta=1e-6)
        self.assertAlmostEqual(gradient["relative_rms"] / (rms / numpy.sqrt((of_source**2).mean())), 1, delta=1e-6)
        self.assertAlmostEqual(gradient["max_abs"] / of_error.max(), 1, delta=1e-6)
        self.assertEqual(gradient["voxels"], values.size)
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


if __name__ == "__main__":
    unittest.main()
