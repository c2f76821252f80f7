"""Maps survive their files; reuleaux's layout is what its readers look for; other files are refused in words."""

from __future__ import annotations

import numpy as np
import pytest

import pinik


@pytest.fixture(scope="module")
def found(ur5):
    tool = np.eye(4)
    tool[2, 3] = 0.1
    return pinik.reach(
        ur5, "tool0", cell=0.2, samples=20_000, directions=12, rolls=4, axis="x", tool=tool, relative_to="shoulder_link"
    )


@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_a_map_survives_its_file(found, suffix, tmp_path):
    found.save(tmp_path / f"map{suffix}")
    back = pinik.ReachMap.load(tmp_path / f"map{suffix}")
    assert str(back) == str(found)
    assert (back.grid, back.relative_to, back.unit) == (found.grid, "shoulder_link", found.unit)
    np.testing.assert_array_equal(back.tool, found.tool)
    np.testing.assert_array_equal(back.orientations.rotations, found.orientations.rotations)
    for name, values in vars(found.counts).items():
        np.testing.assert_array_equal(getattr(back.counts, name), values)
    np.testing.assert_array_equal(back.manipulability, found.manipulability)
    assert back.machine is None
    with pytest.raises(pinik.InputError, match="robot"):
        back.draw()


@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_a_file_has_what_other_programs_read(found, suffix, tmp_path):
    found.save(tmp_path / f"map{suffix}")
    if suffix == ".npz":
        columns = np.load(tmp_path / "map.npz")
    else:
        parquet = pytest.importorskip("pyarrow.parquet")
        columns = parquet.read_table(tmp_path / "map.parquet").to_pydict()
    place = np.array([columns["x"], columns["y"], columns["z"]]).T
    assert found.filter(place).tolist() == (np.array(columns["share"]) > 0).tolist()
    for k in range(0, len(place), 97):
        assert found.at(place[k]).share == columns["share"][k]


def test_equal_maps_have_equal_bytes(found, ur5, tmp_path):
    found.save(tmp_path / "one.npz")
    found.save(tmp_path / "two.npz")
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()


def test_reuleauxs_layout(found, tmp_path):
    import h5py

    found.save(tmp_path / "map.h5")
    with h5py.File(tmp_path / "map.h5") as file:
        poses, spheres = file["Poses/poses_dataset"][:], file["Spheres/sphere_dataset"][:]
        assert file["Spheres/sphere_dataset"].attrs["Resolution"] == pytest.approx([0.2])
        assert (poses.dtype, spheres.dtype) == (np.float32, np.float64)
    assert poses.shape == (found.counts.reached.sum(), 10)
    np.testing.assert_allclose(np.linalg.norm(poses[:, 6:], axis=1), 1.0, atol=1e-6)
    assert len(spheres) == found.workspace().sum()
    for center, percent in zip(spheres[::50, :3], spheres[::50, 3], strict=True):
        assert found.at(center).share == pytest.approx(percent / 100)
    x, y, z, w = poses[:, 6:].T.astype(float)
    approach = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)]).T  # the x axis
    own = found.orientations.rotations[np.nonzero(found.counts.reached)[1]] @ [1.0, 0.0, 0.0]
    np.testing.assert_allclose(approach, own, atol=1e-5)


@pytest.mark.parametrize("name", ["map.npz", "map.parquet"])
def test_what_is_no_map_is_refused(name, tmp_path):
    path = tmp_path / name
    for content in (b"", b"nonsense", None):
        if content is None:
            np.savez(path.with_suffix(".npz"), head=np.zeros(3, dtype=np.uint8), other=np.zeros(2))
            path = path.with_suffix(".npz")
        else:
            path.write_bytes(content)
        with pytest.raises(pinik.InputError, match="map"):
            pinik.ReachMap.load(path)
    with pytest.raises(pinik.InputError, match="no such file"):
        pinik.ReachMap.load(tmp_path / "none.npz")
    with pytest.raises(pinik.InputError, match="npz"):
        pinik.ReachMap.load(tmp_path / "none.h5")


def test_maps_in_which_nothing_is_reached_are_written_and_read(two_link, tmp_path):
    empty = pinik.reach(two_link, "tip", box=((5, 5, 5), (6, 6, 6)), cell=0.5, samples=100)
    for name in ("map.npz", "map.parquet"):
        empty.save(tmp_path / name)
        assert str(pinik.ReachMap.load(tmp_path / name)) == str(empty)
    with pytest.raises(pinik.InputError, match="no cell of the map is reached, so there is nothing to show"):
        empty.save_page(tmp_path / "page.html")
    with pytest.raises(pinik.InputError, match="places"):
        empty.at("here")
