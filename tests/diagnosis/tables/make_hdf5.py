#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Writes the HDF5 files beside it, by the HDF Group's own library (Debian: python3-h5py).   usage: make_hdf5.py FOLDER"""
import sys

import h5py
import numpy as np

folder = sys.argv[1]
t = np.arange(400) * 1e-3
r = 0.01 * np.sin(20 * t)
x, u = np.round(1e6 * r) * 1e-6, 10 * np.cos(20 * t)

with h5py.File(f"{folder}/packed.h5", "w") as f:
    f["gain"], f["note"] = 3.0, "text"
    log = f.create_group("log")
    log["t_s"] = t
    log.create_dataset("x_ref_m", data=r, chunks=(64,), compression="gzip", shuffle=True, fletcher32=True)
    log.create_dataset("x_pos_m", data=x, chunks=(33,), compression="gzip")
    log.create_dataset("x_cmd_V", data=u.astype(">f4"), chunks=(400,))
    log.create_dataset("count", data=np.arange(400, dtype="i2") - 200, maxshape=(None,))
    log["on"] = np.arange(400) % 7 != 0
    log.create_dataset("pair", data=np.stack([r, x], 1), chunks=(50, 1), compression="gzip")
with h5py.File(f"{folder}/latest.h5", "w", libver="latest") as f:
    f["t_s"] = t
with h5py.File(f"{folder}/lzf.h5", "w") as f:
    f.create_dataset("t_s", data=t, chunks=(64,), compression="lzf")
# As MATLAB's save -v7.3 lays it out: a header of 512 bytes, column vectors on their side, texts as numbers with a class.
with h5py.File(f"{folder}/level73.mat", "w", userblock_size=512) as f:
    for name, values in dict(t_s=t, x_ref_m=r, x_pos_m=x, x_cmd_V=u.astype("f4")).items():
        f.create_dataset(name, data=values.reshape(1, -1), chunks=(1, 100), compression="gzip").attrs["MATLAB_class"] = np.bytes_("double")
    f.create_dataset("note", data=np.array([[104], [105]], "u2")).attrs["MATLAB_class"] = np.bytes_("char")
    f.create_group("#refs#")["a"] = np.zeros(3)
with open(f"{folder}/level73.mat", "r+b") as f:
    f.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\0\2IM")
