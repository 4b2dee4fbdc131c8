#!/usr/bin/env bash
# Makes the input files of the commands in README.md and docs/, in the current folder; see document.h.
set -euo pipefail

weir sample cloud --dims 256,256,256 -o density_256x256x256_float32.raw --log-level error
python=/usr/bin/python3 # Debian's Python, for which h5py and netCDF4 are installed
"$python" - <<'END'
import h5py, netCDF4, numpy

density = numpy.fromfile("density_256x256x256_float32.raw", "<f4").reshape(256, 256, 256)
part = density[64:192, 64:192, 64:192]
with open("dump.bin", "wb") as dump:
    dump.write(bytes(1024))
    (density * 60000).astype(">u2").tofile(dump)
with h5py.File("run_0042.h5", "w") as run:
    run.create_dataset("fields/density", data=part, chunks=(32, 32, 32), compression="gzip", shuffle=True)
    run["fields/density"].attrs["units"] = "kg m-3"
with h5py.File("steps.h5", "w") as steps:
    steps.create_dataset("temperature", data=numpy.stack([part, 2 * part]), chunks=(1, 32, 64, 64))
with h5py.File("flow.h5", "w") as flow:
    flow["velocity"] = numpy.stack([part, 2 * part, 3 * part], axis=-1)
with h5py.File("wind.h5", "w") as wind:
    for name, factor in (("u", 1), ("v", 2), ("w", -3)):
        wind[name] = factor * part
with netCDF4.Dataset("wrf.nc", "w") as wrf:
    for name, size in (("Time", 2), ("z", 64), ("y", 128), ("x", 128)):
        wrf.createDimension(name, size)
    wrf.createVariable("QCLOUD", "f4", ("Time", "z", "y", "x"))[:] = part.reshape(2, 64, 128, 128)
for i in range(2):
    with h5py.File("out_%04d.h5" % i, "w") as out:
        out["rho"] = (i + 1) * part
    with open("step_%04d.nrrd" % i, "wb") as step:
        step.write(b"NRRD0004\ntype: float\ndimension: 3\nsizes: 128 128 128\nendian: little\nencoding: raw\n\n")
        part.astype("<f4").tofile(step)
for i in range(64):
    (part[i] * 60000).astype("<u2").tofile("plane_%05d.raw" % i)
END
printf '[volume]\nrange = [0.1, 1]\nopacity = [[0.1, 0], [0.4, 0], [1, 0.8]]\n' >surface.toml
