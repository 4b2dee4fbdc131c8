"""A volume as computed tomography gives one, of 16 bits: shells, a gentle texture and noise in every voxel.

It is a sum of volumes by `weir sample` with fixed seeds. Voxels are lanes of one large integer, since Python has no array
arithmetic of its own.
"""

import pathlib
import tempfile

_PARTS = (("sphere", 1, 11), ("turbulence", 1, 8), *(("noise", seed, 5) for seed in (1, 2, 3, 4)))  # kind, seed, bits
_LANE_BITS = 16


def write_phantom(path, extent, weir):
    """Writes it as raw uint16. The values stay below 2^12; four uniform noises make one that is nearly normal."""
    total = 0
    voxels = extent[0] * extent[1] * extent[2]
    with tempfile.TemporaryDirectory(dir=pathlib.Path(path).parent) as directory:
        for kind, seed, bits in _PARTS:
            part = pathlib.Path(directory) / f"{kind}_{seed}.raw"
            weir.run("sample", kind, "--dims", ",".join(str(n) for n in extent), "--type", "uint16", "--seed", seed,
                     "-o", part)
            total += _highest_bits(int.from_bytes(part.read_bytes(), "little"), bits, voxels)
    pathlib.Path(path).write_bytes(total.to_bytes(_LANE_BITS // 8 * voxels, "little"))


def _highest_bits(lanes, bits, count):
    """Returns the highest `bits` bits of each lane as a number."""
    mask = int.from_bytes(((1 << bits) - 1).to_bytes(_LANE_BITS // 8, "little") * count, "little")
    return (lanes >> (_LANE_BITS - bits)) & mask
