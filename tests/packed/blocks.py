"""Streams of blocks to float32 values, bit for bit (FORMAT.md, "Steps and means" to "Values of kind 2").

Entropy decoding is one stream after the other, arithmetic over all blocks at once: one operation of numpy for each that
the format names."""

import dataclasses
import math
import struct

import numpy

import coefficients
from coefficients import BitReader, Invalid

KINDS = ("mean", "transform", "lattice", "raw")
MEAN, TRANSFORM, LATTICE, RAW = range(4)
MOST_STEP = 250
MOST_CODES = 16777214  # the largest number of a mean's codes, 2^24 - 2
OWN_LATTICE, ORDERED = 1, 2
LORENZO, AVERAGE, MINIMUM, MEDIAN = range(4)
F32 = numpy.float32
ROOT_HALF = F32(0.70710678)
BLOCK_STEP = F32(0.044194173)  # 1 / sqrt(512)
COSINE = [F32(math.cos(n * math.pi / 16) / 2) for n in range(8)]


@dataclasses.dataclass
class Constants:
    """The fields of the packed data's header that apply to all streams."""

    minimum: numpy.float32
    maximum: numpy.float32
    coarsest: int
    lattice_minimum: numpy.float32
    lattice_quantum: numpy.float32
    lattice_bits: int
    below_one: numpy.float32
    below_more: numpy.float32
    tables: coefficients.Tables


@dataclasses.dataclass
class Stream:
    """A block's stream after entropy decoding. `numbers`: 512 integers by index, or the values of a raw block."""

    kind: int
    numbers: object = None
    mean: numpy.float32 = None
    step: numpy.float32 = None
    predictor: int = 0
    lattice: int = 0
    minimum: numpy.float32 = None
    quantum: numpy.float32 = None
    base: int = 0


def step_size(number):
    if not -MOST_STEP <= number <= MOST_STEP:
        raise Invalid(f"step number {number}")
    if number % 2 == 0:
        return F32(2.0 ** (-number // 2))
    return ROOT_HALF * F32(2.0 ** (-(number - 1) // 2))


def mean_lattice(step, means):
    """Returns (distance of two codes, bits of a code) for a region with block means from means[0] to means[1]."""
    quantum = step * BLOCK_STEP
    with numpy.errstate(over="ignore"):
        codes = (means[1] - means[0]) / quantum
    if not codes < MOST_CODES:
        raise Invalid("the code of the mean has more than 24 bits")
    return quantum, (int(codes) + 1).bit_length()


def parse(stream, constants, means):
    """Parses a block's stream into a Stream. `means`: the region's lowest and highest mean, float32."""
    if not stream:
        raise Invalid("an empty stream")
    kind = stream[0] & 3
    if kind == RAW:
        return parse_raw(stream)
    if kind == LATTICE:
        return parse_lattice(stream, constants)
    step = step_size(constants.coarsest + (stream[0] >> 2))
    quantum, bits = mean_lattice(step, means)
    front = BitReader(stream, 1)
    numbers = None
    if kind == MEAN:
        code = front.take(bits)
    else:
        end = front.take(5) + 1
        numbers, code = coefficients.decode_coefficients(stream, front, end, bits, constants.tables, True)
    return Stream(kind, numbers, mean=means[0] + F32(code) * quantum, step=step)


def parse_raw(stream):
    if stream[0] & ~7:
        raise Invalid(f"first byte {stream[0]} of a raw block")
    values = 1 if stream[0] & 4 else 512
    if len(stream) != 1 + 4 * values:
        raise Invalid(f"{len(stream)} bytes for {values} raw values")
    return Stream(RAW, numpy.frombuffer(stream, "<f4", values, 1))


def parse_lattice(stream, constants):
    predictor, lattice = stream[0] >> 2 & 3, stream[0] >> 4 & 3
    if stream[0] >> 6 or lattice > ORDERED:
        raise Invalid(f"first byte {stream[0]} of a block on a lattice")
    minimum, quantum = constants.lattice_minimum, constants.lattice_quantum
    if lattice == OWN_LATTICE:
        if len(stream) < 9:
            raise Invalid("the stream ends in its lattice")
        minimum, quantum = map(F32, struct.unpack_from("<2f", stream, 1))
        if not (numpy.isfinite(minimum) and numpy.isfinite(quantum)):
            raise Invalid("the stream's own lattice is not finite")
    front = BitReader(stream, 9 if lattice == OWN_LATTICE else 1)
    bits = {OWN_LATTICE: 24, ORDERED: 32}.get(lattice, constants.lattice_bits)
    end = front.take(6)
    if end > 32:
        raise Invalid(f"{end} rows of residuals")
    numbers, base = coefficients.decode_coefficients(stream, front, end, bits, constants.tables, False)
    return Stream(LATTICE, numbers, predictor=predictor, lattice=lattice, minimum=minimum, quantum=quantum, base=base)


def values_of(streams, constants):
    """Returns the values of parsed streams as float32 [block, x, y, z]."""
    values = numpy.empty((len(streams), 8, 8, 8), numpy.float32)
    with numpy.errstate(all="ignore"):
        for kind, decode in ((MEAN, means_only), (TRANSFORM, transformed), (LATTICE, on_lattices), (RAW, raw)):
            chosen = [n for n, stream in enumerate(streams) if stream.kind == kind]
            if chosen:
                values[chosen] = decode([streams[n] for n in chosen], constants)
    return values


def column(numbers):
    return numpy.array(numbers, numpy.float32)[:, None, None, None]


def clamped(values, constants):
    low, high = constants.minimum, constants.maximum
    return numpy.where(values >= low, numpy.where(values <= high, values, high), low)


def means_only(streams, constants):
    return clamped(column([stream.mean for stream in streams]), constants)


def transformed(streams, constants):
    signed = numpy.array([stream.numbers for stream in streams], numpy.int64).reshape(-1, 8, 8, 8)
    size = numpy.abs(signed)
    below = numpy.where(size == 1, constants.below_one, constants.below_more)
    values = (size.astype(numpy.float32) - below) * column([stream.step for stream in streams])
    values = numpy.where(signed < 0, -values, values)
    values = numpy.where(signed == 0, F32(0), values)
    for axis in (3, 2, 1):
        values = inverse_transform(values, axis)
    return clamped(column([stream.mean for stream in streams]) + values, constants)


def inverse_transform(values, axis):
    """Eight numbers along `axis`; Python evaluates each sum from left to right, numpy rounds each operation."""
    _, c1, c2, c3, c4, c5, c6, c7 = COSINE
    x0, x1, x2, x3, x4, x5, x6, x7 = numpy.moveaxis(values, axis, 0)
    a0, a1 = c4 * (x0 + x4), c4 * (x0 - x4)
    a2, a3 = c2 * x2 + c6 * x6, c6 * x2 - c2 * x6
    e0, e3, e1, e2 = a0 + a2, a0 - a2, a1 + a3, a1 - a3
    o0 = c1 * x1 + c3 * x3 + c5 * x5 + c7 * x7
    o1 = c3 * x1 - c7 * x3 - c1 * x5 - c5 * x7
    o2 = c5 * x1 - c1 * x3 + c7 * x5 + c3 * x7
    o3 = c7 * x1 - c5 * x3 + c3 * x5 - c1 * x7
    out = [e0 + o0, e1 + o1, e2 + o2, e3 + o3, e3 - o3, e2 - o2, e1 - o1, e0 - o0]
    return numpy.stack(out, axis)


def raw(streams, _):
    return numpy.array([numpy.broadcast_to(stream.numbers, 512) for stream in streams]).reshape(-1, 8, 8, 8)


def on_lattices(streams, constants):
    values = numpy.empty((len(streams), 8, 8, 8), numpy.float32)
    for way in {(stream.predictor, stream.lattice == ORDERED) for stream in streams}:
        chosen = [n for n, stream in enumerate(streams) if (stream.predictor, stream.lattice == ORDERED) == way]
        values[chosen] = on_lattice([streams[n] for n in chosen], *way, constants)
    return values


def on_lattice(streams, predictor, ordered, constants):
    residuals = numpy.array([stream.numbers for stream in streams], numpy.int64).reshape(-1, 8, 8, 8)
    residuals[:, 0, 0, 0] = [stream.base for stream in streams]
    codes = undo_prediction(residuals, predictor, ordered)
    if ordered:
        return numpy.where(codes < 0, codes ^ 0x7fffffff, codes).astype(numpy.int32).view(numpy.float32)
    if codes.max() >= 1 << 24:
        raise Invalid("a code on a lattice has more than 24 bits")
    scaled = codes.astype(numpy.float32) * column([stream.quantum for stream in streams])
    return clamped(scaled + column([stream.minimum for stream in streams]), constants)


def wrapped(numbers, ordered):
    """Reduces numbers modulo 2^32 to the range of i32 or u32, stored in 64 bits."""
    return numbers.astype(numpy.int32 if ordered else numpy.uint32).astype(numpy.int64)


def undo_prediction(residuals, predictor, ordered):
    """Returns the codes, int64, from residuals [block, x, y, z]. The residual at (0, 0, 0) is the base code."""
    codes = numpy.zeros_like(residuals)
    codes[:, 0, 0, 0] = wrapped(residuals[:, 0, 0, 0], ordered)
    for x, y, z in numpy.ndindex(8, 8, 8):
        if x or y or z:
            predicted = predict(codes, x, y, z, predictor)
            codes[:, x, y, z] = wrapped(predicted + residuals[:, x, y, z], ordered)
    return codes


def predict(u, x, y, z, predictor):
    """Predicts the code at (x, y, z) from the codes before it."""
    near = [u[:, x - 1, y, z]] * (x > 0) + [u[:, x, y - 1, z]] * (y > 0) + [u[:, x, y, z - 1]] * (z > 0)
    if predictor == AVERAGE:
        return sum(near) // len(near)
    if predictor == MINIMUM:
        return numpy.minimum.reduce(near)
    if len(near) == 1:
        return near[0]
    if len(near) == 2:
        across = u[:, x - (x > 0), y - (y > 0), z - (z > 0)]
        return near[0] + near[1] - across
    a, b, c = near
    ab, ac, bc = u[:, x - 1, y - 1, z], u[:, x - 1, y, z - 1], u[:, x, y - 1, z - 1]
    if predictor == MEDIAN:
        return numpy.median([a + b - ab, a + c - ac, b + c - bc], axis=0).astype(numpy.int64)
    return a + b + c - ab - ac - bc + u[:, x - 1, y - 1, z - 1]
