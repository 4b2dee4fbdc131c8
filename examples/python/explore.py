"""What does a rate cost? A stirred dye, kept at several rates; error against rate; a slice and a picture to look at.

    python3 explore.py [FOLDER]      # writes stirred_RATE.nvdb, rates.csv, slice.png and picture.png there

The lines `# %%` make it a notebook in editors that know them.
"""

# %% The simulation: a drop of dye in an ABC flow (Arnold, Beltrami, Childress), stirred by tracing each voxel back to
# where its fluid was.
import csv
import os
import pathlib
import struct
import sys
import zlib

import numpy

import weir

N = int(os.environ.get("EXPLORE_VOXELS", 128))  # along each axis
FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")


def velocity(x, y, z):
    return (
        numpy.sin(z) + 0.7 * numpy.cos(y),
        0.9 * numpy.sin(x) + numpy.cos(z),
        0.7 * numpy.sin(y) + 0.9 * numpy.cos(x),
    )


axis = numpy.linspace(0, 2 * numpy.pi, N, endpoint=False, dtype=numpy.float32)
z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
for _ in range(24):
    u, v, w = velocity(x, y, z)
    u, v, w = velocity(x - 0.04 * u, y - 0.04 * v, z - 0.04 * w)  # midpoint
    x, y, z = x - 0.08 * u, y - 0.08 * v, z - 0.08 * w
distance = sum(numpy.sin((p - numpy.pi) / 2) ** 2 for p in (x, y, z))
dye = numpy.maximum(0, 1 - 1.2 * distance).astype(numpy.float32)  # [z, y, x]

# %% Kept at several rates: what weir says was lost is what numpy finds.
rows = []
for rate in (10, 8, 6, 4, 2):
    path = FOLDER / f"stirred_{rate}.nvdb"
    record = weir.convert(dye, path, rate=rate, spacing=(1 / N,) * 3, dataset="dye", overwrite=True)
    with weir.open(path) as grid:
        difference = numpy.abs(grid.to_numpy() - dye)
    error = record["error"]
    assert difference.max() == numpy.float32(error["max_abs"])
    rows.append((rate, path.stat().st_size, error["psnr_db"], error["max_abs"]))

with open(FOLDER / "rates.csv", "w", newline="") as file:
    csv.writer(file).writerows([("rate", "bytes", "psnr_db", "max_abs"), *rows])
print(f"{dye.nbytes:,} bytes of float32, {numpy.count_nonzero(dye) / dye.size:.0%} of it dye")
for rate, size, psnr, largest in rows:
    print(f"rate {rate:2}: {size:9,} bytes, " + ("lossless" if psnr is None else f"{psnr:5.1f} dB, at most {largest:.2g}"))

# %% A slice: as simulated, as kept at the highest rate, and 20 times the difference.


def write_png(path, pixels):
    """Writes uint8 [y, x, 3]."""
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    chunks = (b"IHDR", struct.pack(">IIBBBBB", *pixels.shape[1::-1], 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, body in chunks:
            file.write(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)))


middle = numpy.s_[N // 2 : N // 2 + 1]
with weir.open(FOLDER / "stirred_10.nvdb") as grid:
    kept = grid.to_numpy(middle)[0]
    picture = grid.render(mode="dvr", size=(4 * N, 3 * N), camera=(35, 25))
simulated = dye[middle][0]
panels = numpy.hstack([simulated, kept, 20 * numpy.abs(kept - simulated)])
grey = (255 * numpy.clip(panels, 0, 1)).astype(numpy.uint8)
write_png(FOLDER / "slice.png", numpy.repeat(grey[::-1, :, None], 3, axis=2))  # y upwards
write_png(FOLDER / "picture.png", picture)

# %% Values at positions: along a line through the middle, without decoding the volume.
with weir.open(FOLDER / "stirred_2.nvdb") as grid:
    line = numpy.full((9, 3), N / 2)
    line[:, 0] = numpy.linspace(0.5, N - 0.5, 9)
    print("along x:", " ".join(f"{value:.3f}" for value in grid.sample(line)))
