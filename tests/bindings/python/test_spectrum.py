"""Tests that `weir compare --spectrum` agrees with what numpy computes from the same values."""

import csv
import json
import unittest

import numpy
import weir
from support import FolderTest, run_weir


def spectra(source, decoded, spacing):
    """Returns for arrays [z, y, x]: wave numbers, and power of source, decoded and error per shell
    (docs/budget.md)."""
    shape = [min(n, 64) for n in source.shape]
    steps = spacing[::-1]
    hann = [numpy.sin(numpy.pi * (numpy.arange(n) + 0.5) / n) ** 2 for n in shape]
    window = hann[0][:, None, None] * hann[1][None, :, None] * hann[2][None, None, :]
    numbers = numpy.meshgrid(*(numpy.fft.fftfreq(n, h) for n, h in zip(shape, steps)), indexing="ij")
    width = min(1 / (n * h) for n, h in zip(shape, steps) if n > 1)
    shell = numpy.maximum(numpy.rint(numpy.sqrt(sum(part**2 for part in numbers)) / width).astype(int), 1)
    powers = numpy.zeros((3, shell.max() + 1))
    count = 0
    begins = [sorted({*range(0, n - m + 1, max(m // 2, 1)), n - m}) for n, m in zip(source.shape, shape)]
    for corner in numpy.array(numpy.meshgrid(*begins)).reshape(3, -1).T:
        box = tuple(slice(at, at + n) for at, n in zip(corner, shape))
        for number, values in enumerate((source[box], decoded[box], decoded[box] - source[box])):
            mean = (values * window).sum() / window.sum()
            power = numpy.abs(numpy.fft.fftn((values - mean) * window)) ** 2
            power[0, 0, 0] = 0
            powers[number] += numpy.bincount(shell.ravel(), power.ravel()) / (values.size * (window**2).sum())
        count += 1
    shell[0, 0, 0] = 0
    taken = numpy.unique(shell)[1:]
    return taken * width, powers[:, taken] / count, count


class Spectrum(FolderTest):
    def test_equals_numpy(self):
        random = numpy.random.default_rng(3)
        z, y, x = numpy.mgrid[0:70, 0:41, 0:98]
        values = numpy.sin(x * 0.3 + y * 0.2) * 4 + random.standard_normal(x.shape) * 0.1 + 20
        name = self.folder / "a_98x41x70_float32.raw"
        values.astype("<f4").tofile(name)
        spacing = (0.5173, 0.45, 0.75)  # no frequency lies between two shells
        weir.convert(name, self.folder / "a.nvdb", spacing=spacing, psnr=40, encoding="packed")
        table = self.folder / "a.csv"
        compare = ("compare", name, self.folder / "a.nvdb", "--spacing", "0.5173,0.45,0.75", "--json")
        said = json.loads(run_weir(*compare, "--spectrum", table))["spectrum"]
        source = values.astype(numpy.float32).astype(numpy.float64)
        decoded = weir.open(self.folder / "a.nvdb").to_numpy().astype(numpy.float64)
        numbers, powers, count = spectra(source, decoded, spacing)
        self.assertEqual(said["block"], [64, 41, 64])
        self.assertEqual((said["blocks"], said["left_out"]), (count, 0))
        numpy.testing.assert_allclose(said["wave_number"], numbers, rtol=1e-12)
        for key, power in zip(("source", "decoded", "error"), powers):
            numpy.testing.assert_allclose(said[key], power, rtol=1e-6, atol=1e-15)
        with open(table, encoding="utf-8") as lines:
            rows = list(csv.DictReader(lines))
        self.assertEqual(list(rows[0]), ["wave_number", "modes", "source", "decoded", "error"])
        for key in rows[0]:
            numpy.testing.assert_allclose([float(row[key]) for row in rows], said[key], rtol=1e-8)


if __name__ == "__main__":
    unittest.main()
