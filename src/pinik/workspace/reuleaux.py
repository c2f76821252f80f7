"""Maps as HDF5 files in the layout of reuleaux's reachability maps."""

from __future__ import annotations

import io

import numpy as np
import pinocchio

from ..extras import needed_by
from .voxel_map import VoxelMap

__all__ = ["reuleaux_file"]


def reuleaux_file(reach: VoxelMap) -> bytes:
    """A map in the layout that reuleaux (Makhal and Goins 2018) writes and shows.

    `/Poses/poses_dataset` has a row of float32 for each cell and orientation that is reached: the centre of the cell,
    the position, which is the centre too, and the quaternion xyzw. `/Spheres/sphere_dataset` has a row for each cell:
    its centre, and the share of the orientations in percent; its attribute `Resolution` is the size of the cells [m].
    Of a map that tells only directions apart, each has one roll; if any orientation counts, each cell has one.
    """
    with needed_by("an HDF5 file", "hdf5"):
        import h5py

    rows, orientations = np.nonzero(reach.counts.reached)
    centers = reach.grid.centers(reach.counts.cells)
    turns = np.array([pinocchio.Quaternion(R).coeffs() for R in reach.orientations.rotations])
    poses = np.hstack([centers[rows], centers[rows], turns[orientations]]).astype(np.float32)
    inside = np.flatnonzero(reach.counts.reached.any(axis=1))
    spheres = np.column_stack([centers[inside], 100.0 * reach.counts.reached[inside].mean(axis=1)])
    file = io.BytesIO()
    with h5py.File(file, "w") as content:
        content.create_dataset("Poses/poses_dataset", data=poses, maxshape=(None, 10), chunks=True)
        written = content.create_dataset("Spheres/sphere_dataset", data=spheres)
        written.attrs.create("Resolution", np.array([reach.grid.size], dtype=np.float32))
    return file.getvalue()
