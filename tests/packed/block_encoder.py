"""Encodes streams of blocks for tests of the decoder. The caller makes every choice; rate and error play no role."""

import numpy

import blocks
import coefficients
from coefficients import BANDS, ESCAPE, LEVEL, LEVELS, LOWEST_STATE, MOST_MAGNITUDE, PLACES


def bits(value, count):
    """Returns the bits of a number, the lowest first."""
    return [value >> n & 1 for n in range(count)]


def pack(values):
    """Packs a list of bits into bytes."""
    return bytes(sum(bit << n for n, bit in enumerate(values[at:at + 8])) for at in range(0, len(values), 8))


class Coder:
    """The decoder's steps in reverse: what is put first is decoded last."""

    def __init__(self, payload, count):
        self.x = [LOWEST_STATE | payload >> 16 * state & 0xffff for state in range(count)]
        self.words = b""

    def make_room(self, state, limit):
        if self.x[state] >= limit:
            self.words += (self.x[state] & 0xffff).to_bytes(2, "little")
            self.x[state] >>= 16

    def symbol(self, state, first, frequency):
        self.make_room(state, frequency << 20)
        self.x[state] = self.x[state] // frequency << 12 | self.x[state] % frequency + first

    def bypass(self, state, value, count):
        if count > 16:
            self.bypass(state, value >> 16, count - 16)
            count = 16
        self.make_room(state, 1 << 32 - count)
        self.x[state] = self.x[state] << count | value & (1 << count) - 1


def steps_of(numbers, end, banded):
    """Returns (place, context, symbol, [(value, bits) that follow uncoded]) for each of the first 16 `end` places."""
    capped = [min(abs(m), MOST_MAGNITUDE) for m in numbers] + [0]
    for place in range(1, 16 * end):
        at, a, b, c, weight, its_band = PLACES[place]
        t = weight * (capped[a] + capped[b] + capped[c])
        context = LEVELS * (its_band if banded else BANDS) + LEVEL[min(t, 320)]
        k = coefficients.extra_bits(t)
        y, plain = abs(numbers[at]) >> k, []
        if y >= ESCAPE:
            length = (y - ESCAPE + 1).bit_length() - 1
            plain = [(length, 5), (y - ESCAPE + 1 - (1 << length), length)]
        yield place, context, min(y, ESCAPE), plain + [(abs(numbers[at]), k)] * (k > 0)


def encode(first_bytes, end, end_bits, numbers, code, code_bits, tables, banded, gap=b""):
    """Returns a stream of coded values. `end`: in units of 16 places; `end_bits`: (value, bits) in the front; `gap`:
    bytes after the front."""
    count = 0 if end == 0 else 1 if end <= 8 else 2
    signs = [int(numbers[at] < 0) for at, *_ in PLACES[1:16 * end] if numbers[at]]
    inside = min(len(signs), 16 * count)
    moved = min(16 * count - inside, code_bits)
    before = len(signs) - inside
    payload = sum(bit << n for n, bit in enumerate(signs[before:])) | (code & (1 << moved) - 1) << inside
    coder = Coder(payload, count)
    for place, context, y, plain in reversed(list(steps_of(numbers, end, banded))):
        for value, size in reversed(plain):
            coder.bypass(place % count, value, size)
        coder.symbol(place % count, tables.first[context][y], tables.frequency[context][y])
    short = [int(x < 1 << 24) for x in coder.x]
    front = bits(*end_bits) + short + bits(code >> moved, code_bits - moved) + signs[:before]
    states = b"".join(x.to_bytes(4 - s, "little") for x, s in reversed(list(zip(coder.x, short))))
    return first_bytes + pack(front) + gap + coder.words + states


def mean_bits(field, constants, means):
    return blocks.mean_lattice(blocks.step_size(constants.coarsest + field), means)[1]


def mean_stream(field, code, constants, means):
    return bytes([field << 2]) + pack(bits(code, mean_bits(field, constants, means)))


def transform_stream(field, end, numbers, code, constants, means, gap=b""):
    """Returns a stream of kind 1. `numbers`: 512 numbers by index; those at places from 16 `end` on are zero."""
    return encode(bytes([blocks.TRANSFORM | field << 2]), end, (end - 1, 5), numbers, code,
                  mean_bits(field, constants, means), constants.tables, True, gap)


def lattice_stream(predictor, codes, constants, lattice=0, own=(0, 0), end=None):
    """Returns a stream of kind 2. `codes`: 512 by index, u32, or i32 if ordered. `end`: None for the shortest."""
    code = numpy.array(codes, numpy.int64).reshape(1, 8, 8, 8)
    residuals = [0] * 512
    for n, at in enumerate(numpy.ndindex(8, 8, 8)):
        if n:
            residual = code[(slice(None), *at)] - blocks.predict(code, *at, predictor)
            residuals[n] = int(blocks.wrapped(residual, True)[0])
    if end is None:
        end = max((place // 16 + 1 for place, (at, *_) in enumerate(PLACES) if residuals[at]), default=0)
    first = bytes([blocks.LATTICE | predictor << 2 | lattice << 4])
    if lattice == blocks.OWN_LATTICE:
        first += numpy.array(own, "<f4").tobytes()
    code_bits = {blocks.OWN_LATTICE: 24, blocks.ORDERED: 32}.get(lattice, constants.lattice_bits)
    return encode(first, end, (end, 6), residuals, int(codes[0]) & 0xffffffff, code_bits, constants.tables, False)


def raw_stream(values):
    """Returns a stream of kind 3, of 512 values or of one value for all voxels."""
    return bytes([blocks.RAW | (len(values) == 1) << 2]) + numpy.array(values, "<f4").tobytes()
