"""Reads a PNG of 8-bit RGB as an array, without an image library."""

import struct
import zlib

import numpy

_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def read_png(path):
    """Returns the pixels of a PNG of 8-bit RGB without interlacing as uint8 [y, x, 3]."""
    data = path.read_bytes()
    assert data[:8] == _SIGNATURE
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
            assert (depth, colour) == (8, 2), (depth, colour)
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    return _unfilter(numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, 1 + 3 * width))


def _unfilter(rows):
    """Undoes the filters of PNG's rows (specification, section 9)."""
    height, length = rows.shape[0], rows.shape[1] - 1
    pixels = numpy.zeros((height + 1, length + 3), numpy.int64)  # with a zero row above and a zero pixel at the left
    for y in range(height):
        kind, row = rows[y, 0], rows[y, 1:].astype(numpy.int64)
        if kind in (0, 2):
            pixels[y + 1, 3:] = row + (pixels[y, 3:] if kind == 2 else 0)
        else:
            for x in range(length):
                left, up, corner = pixels[y + 1, x], pixels[y, x + 3], pixels[y, x]
                pixels[y + 1, x + 3] = (row[x] + _predict(kind, left, up, corner)) & 255
        pixels[y + 1] &= 255
    return pixels[1:, 3:].reshape(height, -1, 3).astype(numpy.uint8)


def _predict(kind, left, up, corner):
    if kind == 1:
        return left
    if kind == 3:
        return (left + up) // 2
    estimate = left + up - corner
    return min((abs(estimate - left), 0, left), (abs(estimate - up), 1, up), (abs(estimate - corner), 2, corner))[2]
