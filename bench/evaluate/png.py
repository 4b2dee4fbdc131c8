"""PNG files of 8-bit RGB, and sheets of several: the standard library has none. ISO/IEC 15948, filters of chapter 9."""

import dataclasses
import struct
import zlib

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_CHANNELS = 3
_RGB = 2


@dataclasses.dataclass
class Picture:
    width: int
    height: int
    rows: list  # a bytearray for each row, from the top, 3 bytes per pixel


def blank(width, height, color=(255, 255, 255)):
    return Picture(width, height, [bytearray(bytes(color) * width) for _ in range(height)])


def paste(picture, part, x, y):
    """Lays `part`, which fits, over `picture` with its upper left corner at x, y."""
    for row, values in enumerate(part.rows):
        picture.rows[y + row][_CHANNELS * x : _CHANNELS * (x + part.width)] = values


def read_png(path):
    """Reads a PNG of 8-bit RGB without interlacing, as weir writes it. Raises ValueError for others."""
    with open(path, "rb") as file:
        content = file.read()
    if content[:8] != _SIGNATURE:
        raise ValueError(f"{path}: is no PNG")
    at, packed, header = 8, b"", None
    while at < len(content):
        length, name = struct.unpack(">I4s", content[at : at + 8])
        body = content[at + 8 : at + 8 + length]
        if name == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif name == b"IDAT":
            packed += body
        at += 12 + length
    width, height, depth, color, _, _, interlaced = header
    if (depth, color, interlaced) != (8, _RGB, 0):
        raise ValueError(f"{path}: is a PNG of {depth} bits and colour type {color}, 8 bits of RGB are read")
    return Picture(width, height, _unfilter(zlib.decompress(packed), width, height))


def _unfilter(data, width, height):
    stride = _CHANNELS * width
    above = bytearray(stride)
    rows = []
    for y in range(height):
        kind = data[y * (stride + 1)]
        row = bytearray(data[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            left = row[i - _CHANNELS] if i >= _CHANNELS else 0
            corner = above[i - _CHANNELS] if i >= _CHANNELS else 0
            row[i] = (row[i] + _predicted(kind, left, above[i], corner)) & 255
        rows.append(row)
        above = row
    return rows


def _predicted(kind, left, up, corner):
    if kind == 0:
        return 0
    if kind == 1:
        return left
    if kind == 2:
        return up
    if kind == 3:
        return (left + up) // 2
    # Paeth: whichever of the three is nearest to their linear estimate, in this order where they tie.
    estimate = left + up - corner
    distances = (abs(estimate - left), abs(estimate - up), abs(estimate - corner))
    return (left, up, corner)[distances.index(min(distances))]


def write_png(path, picture):
    data = bytearray()
    for row in picture.rows:
        data.append(1)  # "Sub": each byte less the one of the pixel before
        data += row[:_CHANNELS]
        data += bytes((here - before) & 255 for here, before in zip(row[_CHANNELS:], row))
    header = struct.pack(">IIBBBBB", picture.width, picture.height, 8, _RGB, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(_SIGNATURE)
        for name, body in ((b"IHDR", header), (b"IDAT", zlib.compress(bytes(data), 9)), (b"IEND", b"")):
            file.write(struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body)))
