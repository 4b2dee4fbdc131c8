"""Helpers of the tests: constants of a file, random numbers of a block, the decoding of one stream, damage."""

import numpy

import blocks
import coefficients
from coefficients import PLACES

F32 = numpy.float32
UNIFORM = [256 * j for j in range(16)] * coefficients.TABLES
MEANS = (F32(-1), F32(2))


def uneven_tables(rng):
    """Returns random tables of cumulative frequencies, in which each frequency is at least 1."""
    return [v for _ in range(coefficients.TABLES) for v in [0, *sorted(rng.sample(range(1, 4096), 15))]]


def constants(tables=UNIFORM, **changed):
    values = dict(minimum=F32(-1000), maximum=F32(1000), coarsest=0, lattice_minimum=F32(-3), lattice_quantum=F32(0.25),
                  lattice_bits=12, below_one=F32(0.125), below_more=F32(0.0625), tables=coefficients.Tables(tables))
    return blocks.Constants(**{**values, **changed})


def random_numbers(rng, end, size):
    """Returns 512 random numbers by index, zero from place 16 `end` on. `size`: the most bits of a magnitude."""
    numbers = [0] * 512
    for at, *_ in PLACES[1:16 * end]:
        numbers[at] = rng.choice((-1, 1)) * rng.getrandbits(rng.randrange(size + 1)) if size else 0
    return numbers


def values_of(stream, given=None, means=MEANS):
    given = given or constants()
    return blocks.values_of([blocks.parse(stream, given, means)], given)[0].ravel()


def damage(stream, rng):
    changed = bytearray(stream)
    for _ in range(rng.randrange(1, 4)):
        changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed[:rng.randrange(1, len(changed) + 1)] if rng.random() < 0.3 else changed)
