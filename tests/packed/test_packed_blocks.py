"""Tests the independent decoder of streams with block_encoder.py: `python3 -m unittest` in this folder."""

import pathlib
import random
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))

import block_encoder as encoder  # noqa: E402
import blocks  # noqa: E402
import coefficients  # noqa: E402
from coefficients import Invalid, PLACES  # noqa: E402
from samples import F32, MEANS, UNIFORM, constants, damage, random_numbers, uneven_tables, values_of  # noqa: E402


class Contexts(unittest.TestCase):
    def test_levels_are_those_of_the_formula_in_floating_point(self):
        for t in range(400):
            self.assertEqual(coefficients.level(t), min(23, int(numpy.floor(3 * numpy.log2(1 + 4 * t / 6) + 1e-12))))

    def test_neighbours_come_before_what_depends_on_them(self):
        place_of = {at: place for place, (at, *_) in enumerate(PLACES)}
        for place, (_, a, b, c, _, _) in enumerate(PLACES):
            for near in (a, b, c):
                self.assertTrue(near == coefficients.NONE or 0 < place_of[near] < place)

    def test_a_prefix_holds_a_smaller_cube(self):
        for places, cube in ((8, 2), (64, 4)):
            inside = {coefficients.index(i, j, k) for i in range(cube) for j in range(cube) for k in range(cube)}
            self.assertEqual({at for at, *_ in PLACES[:places]}, inside)


class Transform(unittest.TestCase):
    def test_random_coefficients_come_back(self):
        rng = random.Random(1)
        for end in (1, 2, 7, 8, 9, 20, 32):
            for size in (0, 1, 2, 5, 12, 24, 31):
                given = constants(uneven_tables(rng) if size % 2 else UNIFORM)
                numbers = random_numbers(rng, end, size)
                code = rng.getrandbits(encoder.mean_bits(9, given, MEANS))
                stream = encoder.transform_stream(9, end, numbers, code, given, MEANS, bytes(rng.randrange(4)))
                with self.subTest(end=end, size=size):
                    found = blocks.parse(stream, given, MEANS)
                    self.assertEqual(found.numbers, numbers)
                    self.assertEqual(found.mean, MEANS[0] + F32(code) * (found.step * blocks.BLOCK_STEP))

    def test_values_are_those_of_the_cosine_transform(self):
        rng = random.Random(2)
        numbers = random_numbers(rng, 32, 4)
        given = constants(below_one=F32(0), below_more=F32(0))
        stream = encoder.transform_stream(6, 32, numbers, 100, given, MEANS)
        n = numpy.arange(8)
        basis = numpy.cos(numpy.outer(n, 2 * n + 1) * numpy.pi / 16) / 2
        basis[0] /= numpy.sqrt(2)
        cube = numpy.array(numbers, float).reshape(8, 8, 8) * 2.0 ** -3
        expected = numpy.einsum("ijk,ix,jy,kz->xyz", cube, basis, basis, basis).ravel()
        self.assertLess(abs(values_of(stream, given) - expected - blocks.parse(stream, given, MEANS).mean).max(), 1e-5)

    def test_recovery_points_and_clamps_hold(self):
        given = constants(minimum=F32(0.25), maximum=F32(0.375))
        numbers = [0] * 512
        numbers[1], numbers[8] = -1, 3
        stream = encoder.transform_stream(2, 1, numbers, 14, given, (F32(0), F32(1)))
        found = values_of(stream, given, (F32(0), F32(1)))
        self.assertEqual((found.min(), found.max()), (F32(0.25), F32(0.375)))

    def test_the_example_of_the_document_is_what_it_says(self):
        given = constants(minimum=F32(0), maximum=F32(1), below_one=F32(0.125), below_more=F32(0.0625))
        numbers = [0] * 512
        numbers[1], numbers[8] = 7, -1
        means = (F32(0), F32(1))
        stream = encoder.transform_stream(12, 1, numbers, 700, given, means)
        document = pathlib.Path(__file__).parents[2] / "format" / "FORMAT.md"
        text = document.read_text()
        self.assertIn(f"\n{stream.hex(' ')}\n", text)
        found = values_of(stream, given, means).reshape(8, 8, 8)
        for x, y, z in (0, 0, 0), (0, 0, 7), (3, 4, 5), (7, 7, 7):
            bits = int(found[x, y, z].view(numpy.uint32))
            self.assertIn(f"| {x}, {y}, {z} | {str(found[x, y, z])} | {bits:08x} |", text)


class Means(unittest.TestCase):
    def test_a_mean_is_in_every_voxel(self):
        for field in (0, 7, 30):
            bits = encoder.mean_bits(field, constants(), MEANS)
            for code in (0, 1, (1 << bits) - 1):
                found = values_of(encoder.mean_stream(field, code, constants(), MEANS))
                quantum = blocks.step_size(field) * blocks.BLOCK_STEP
                self.assertEqual(set(found), {MEANS[0] + F32(code) * quantum})

    def test_more_than_24_bits_are_refused(self):
        for means in ((F32(0), F32(3e38)), (F32(-3e38), F32(3e38)), (F32(0), F32(800000))):
            with self.assertRaisesRegex(Invalid, "24 bits"):
                values_of(bytes([0] * 8), None, means)

    def test_steps_halve_every_two(self):
        for number in range(-250, 249):
            self.assertEqual(blocks.step_size(number), 2 * blocks.step_size(number + 2))
        self.assertEqual((blocks.step_size(0), blocks.step_size(1)), (1, F32(0.5 ** 0.5)))


class Lattice(unittest.TestCase):
    def test_codes_come_back_by_every_predictor(self):
        rng = random.Random(3)
        given = constants(uneven_tables(rng), minimum=F32(-1e9), maximum=F32(1e9))
        for predictor in range(4):
            for bits, lattice in ((0, 0), (3, 0), (12, 0), (24, 1)):
                codes = [rng.getrandbits(bits) for _ in range(512)]
                stream = encoder.lattice_stream(predictor, codes, given, lattice, (F32(7), F32(0.5)))
                minimum, quantum = (F32(7), F32(0.5)) if lattice else (F32(-3), F32(0.25))
                with self.subTest(predictor=predictor, bits=bits):
                    found = values_of(stream, given)
                    self.assertTrue((found == numpy.array(codes, numpy.float32) * quantum + minimum).all())

    def test_floats_come_back_bit_for_bit(self):
        rng = random.Random(4)
        for predictor in range(4):
            pattern = numpy.array([rng.getrandbits(32) for _ in range(512)], numpy.uint32)
            if predictor % 2:
                pattern[:] = numpy.array([rng.gauss(0, 1e-3) for _ in range(512)], numpy.float32).view(numpy.uint32)
            signed = pattern.view(numpy.int32).astype(numpy.int64)
            codes = numpy.where(signed < 0, signed ^ 0x7fffffff, signed)
            stream = encoder.lattice_stream(predictor, codes, constants(), blocks.ORDERED)
            self.assertEqual(values_of(stream).tobytes(), pattern.tobytes())

    def test_values_beyond_the_range_are_clamped_but_floats_are_not(self):
        rng = random.Random(7)
        given = constants(minimum=F32(-2.5), maximum=F32(3))
        codes = [rng.getrandbits(12) for _ in range(512)]
        for lattice, own, minimum, quantum in ((0, (0, 0), -3, 0.25), (1, (7, -0.5), 7, -0.5), (1, (0, 3e38), 0, 3e38)):
            stream = encoder.lattice_stream(1, codes, given, lattice, own)
            exact = numpy.array(codes) * quantum + minimum
            with self.subTest(lattice=lattice, quantum=quantum):
                self.assertTrue((exact > 3).any() and (exact < 3).any())
                self.assertTrue((values_of(stream, given) == exact.clip(-2.5, 3).astype(numpy.float32)).all())
        bits = numpy.array([1e9, -1e9] * 256, numpy.float32).view(numpy.int32).astype(numpy.int64)
        ordered = numpy.where(bits < 0, bits ^ 0x7fffffff, bits)
        floats = values_of(encoder.lattice_stream(1, ordered, given, blocks.ORDERED), given)
        self.assertEqual(set(floats), {F32(1e9), F32(-1e9)})

    def test_one_code_needs_no_states(self):
        stream = encoder.lattice_stream(0, [77] * 512, constants())
        self.assertEqual(len(stream), 1 + (6 + 12 + 7) // 8)
        self.assertEqual(set(values_of(stream)), {F32(77 * 0.25 - 3)})

    def test_wrong_lattices_are_refused(self):
        large = encoder.lattice_stream(0, [0] * 511 + [1 << 24], constants())
        for stream, why in ((large, "24 bits"), (bytes([2 | 3 << 4]), "first byte"), (b"\2\x21", "rows")):
            with self.assertRaisesRegex(Invalid, why):
                values_of(stream)


class Wrapping(unittest.TestCase):
    """Tests numbers of the whole range of 32 bits, which no ordinary block has."""

    def test_the_largest_magnitude_of_a_transform_is_a_negative_number(self):
        numbers = [0] * 512
        numbers[1], numbers[8] = -(1 << 31), (1 << 31) - 1
        stream = encoder.transform_stream(3, 1, numbers, 1, constants(), MEANS)
        self.assertEqual(blocks.parse(stream, constants(), MEANS).numbers, numbers)

    def test_a_magnitude_beyond_32_bits_is_refused(self):
        numbers = [0] * 512
        numbers[1], numbers[8] = 1 << 20, 1 << 33
        stream = encoder.transform_stream(3, 1, numbers, 1, constants(), MEANS)
        with self.assertRaisesRegex(Invalid, "32 bits"):
            values_of(stream)


class Damage(unittest.TestCase):
    def test_what_is_left_over_is_refused(self):
        numbers = random_numbers(random.Random(5), 4, 3)
        stream = encoder.transform_stream(3, 4, numbers, 1, constants(), MEANS)
        for changed, why in ((stream[:1] + stream[5:], "words|bits|ends"), (stream[:1], "front bits"), (b"", "empty"),
                             (stream[:3], "shorter|words"), (stream[:-1] + b"\x7f", "ends at|words")):
            with self.assertRaisesRegex(Invalid, why):
                values_of(changed)

    def test_changed_bits_raise_nothing_but_invalid(self):
        rng = random.Random(6)
        given = constants(uneven_tables(rng))
        for _ in range(300):
            end = rng.randrange(1, 33)
            stream = rng.choice((
                encoder.transform_stream(5, end, random_numbers(rng, end, 6), 9, given, MEANS),
                encoder.lattice_stream(rng.randrange(4), [rng.getrandbits(9) for _ in range(512)], given),
                encoder.raw_stream([1.0] * 512), encoder.mean_stream(5, 1, given, MEANS)))
            try:
                values_of(damage(stream, rng), given)
            except Invalid:
                pass


if __name__ == "__main__":
    unittest.main()
