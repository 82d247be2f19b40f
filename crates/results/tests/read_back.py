"""Reads synthetic stores with xarray and checks every kind of value against its formula.

usage: read_back.py DIR, where DIR was filled by `cargo run -p catenix-results --example
synthetic_store -- DIR`. Needs xarray and zarr 3. The formulas are those of tests/common/mod.rs.
"""

import shutil
import sys
import tempfile
import warnings
import zipfile
from pathlib import Path

import numpy as np
import xarray as xr
import zarr

QUANTITIES = [
    "x", "y", "z", "effective_tension", "wall_tension", "shear_force", "bend_moment",
    "curvature", "torque", "von_mises_stress", "declination",
]  # fmt: skip


def line_value(quantity: str, node, time):
    return 1000.0 * QUANTITIES.index(quantity) + 100.0 * node + time


def archive(store: Path, case: str) -> zarr.storage.ZipStore:
    return zarr.storage.ZipStore(store / "cases" / f"{case}.zip", mode="r")


def check_complete(store: Path) -> None:
    case = xr.open_zarr(archive(store, "a"), consolidated=False)
    assert case["time"].dims == ("time",) and case["time"].attrs["units"] == "s"
    np.testing.assert_array_equal(case["time"], np.arange(81) * 0.25)
    offset = case["buffer.offset_x"]
    assert offset.attrs["units"] == "m"
    np.testing.assert_array_equal(offset, -10.0 - case["time"])
    np.testing.assert_array_equal(case["pipe.end_b.force_x"], 2000.0 + 10.0 * case["time"])
    assert case.attrs["status"] == "complete"
    assert case.attrs["solver_steps"] == 80
    assert float(offset.sel(time=slice(12.0, 20.0)).mean()) == -26.0

    line = xr.open_zarr(archive(store, "a"), group="lines/pipe", consolidated=False)
    np.testing.assert_array_equal(line["arc_length"], [0.0, 10.0, 20.0, 30.0])
    np.testing.assert_array_equal(line["field_time"], np.arange(21.0))
    node = np.arange(4)
    for quantity in QUANTITIES:
        field = line[quantity]
        assert field.dims == ("field_time", "arc_length") and field.dtype == np.float32
        expected = line_value(quantity, node[None, :], np.arange(21.0)[:, None])
        np.testing.assert_array_equal(field, expected)
        np.testing.assert_array_equal(line[f"{quantity}_min"], line_value(quantity, node, 12.0))
        np.testing.assert_allclose(line[f"{quantity}_mean"], line_value(quantity, node, 16.0))
        np.testing.assert_array_equal(line[f"{quantity}_max"], line_value(quantity, node, 20.0))
        np.testing.assert_array_equal(line[f"{quantity}_run_min"], line_value(quantity, node, 0.0))
        np.testing.assert_array_equal(line[f"{quantity}_run_max"], line_value(quantity, node, 20.0))
        np.testing.assert_array_equal(line[f"static_{quantity}"], line_value(quantity, node, 0.0))
        np.testing.assert_allclose(line[f"{quantity}_std"], 8.0 / 12.0**0.5, rtol=1e-3)


def check_modes(store: Path) -> None:
    modes = xr.open_zarr(archive(store, "a"), group="modes", consolidated=False)
    np.testing.assert_array_equal(modes["mode"], [1.0, 2.0, 3.0])
    assert modes["frequency"].attrs["units"] == "Hz"
    np.testing.assert_array_equal(modes["frequency"].sel(mode=[2, 3]), [0.5, 1.0])
    np.testing.assert_array_equal(modes["effective_mass_z"], [3.0, 6.0, 9.0])
    assert np.isnan(modes["damping_ratio"][0])
    assert modes.attrs["counted"] == 3 and modes.attrs["total_mass_kg"] == [10.0, 20.0, 30.0]
    line = xr.open_zarr(archive(store, "a"), group="modes/lines/pipe", consolidated=False)
    body = xr.open_zarr(archive(store, "a"), group="modes/bodies/buffer", consolidated=False)
    mode, node = np.arange(1, 4)[:, None], np.arange(4)[None, :]
    for part, unit in [("displacement", "m"), ("rotation", "rad")]:
        for axis in range(3):
            component = axis + (3 if part == "rotation" else 0)
            name = f"{part}_{'xyz'[axis]}"
            shape = line[name]
            assert shape.dims == ("mode", "arc_length") and shape.attrs["units"] == unit
            np.testing.assert_array_equal(shape, 100.0 * mode + 10.0 * node + component)
            assert body[name].dims == ("mode",)
            np.testing.assert_array_equal(body[name], 100.0 * mode[:, 0] + component)
    assert float(line["displacement_y"].sel(mode=2, arc_length=10.0)) == 211.0


def check_interrupted(store: Path) -> None:
    case = xr.open_zarr(archive(store, "b"), consolidated=False)
    assert case.attrs["status"] == "interrupted"
    assert case.sizes["time"] == 41
    assert not case["buffer.offset_x"].isnull().any()


def check_killed(store: Path) -> None:
    case = xr.open_zarr(store, group="cases/a", consolidated=False)
    assert case.attrs["status"] == "running"
    rows = case.attrs["history_rows"]
    assert rows == 2
    assert case.sizes["time"] == 81, "shapes do not depend on when the process died"
    np.testing.assert_array_equal(case["time"], np.arange(81) * 0.25)
    assert not case["buffer.offset_x"][:rows].isnull().any()
    assert case["buffer.offset_x"][rows:].isnull().all()
    assert float(case["buffer.offset_x"].dropna("time")[-1]) == -10.25


def check_tree(store: Path) -> None:
    study = zarr.open_group(store, mode="r", use_consolidated=False)
    assert study.attrs["catenix_store_format"] == 2
    assert study.attrs["case_names"] == ["a", "b"]
    assert len(study.attrs["model_sha256"]) == 64
    cases = {
        name: xr.open_datatree(archive(store, name), engine="zarr", consolidated=False)
        for name in study.attrs["case_names"]
    }
    assert cases["b"]["lines/pipe/effective_tension"].shape == (21, 4)


def check_unpacked(store: Path) -> None:
    """Cases that are laid out as folders are groups of the store."""
    with tempfile.TemporaryDirectory() as directory:
        copy = Path(shutil.copytree(store, Path(directory) / "copy.zarr"))
        for archive in list((copy / "cases").glob("*.zip")):
            with zipfile.ZipFile(archive) as packed:
                assert packed.testzip() is None
                packed.extractall(archive.with_suffix(""))
            archive.unlink()
        tree = xr.open_datatree(copy, engine="zarr", consolidated=False)
        assert tree.attrs["case_names"] == ["a", "b"]
        assert tree["cases/b/lines/pipe/effective_tension"].shape == (21, 4)


def main() -> None:
    directory = Path(sys.argv[1])
    warnings.simplefilter("error")
    complete = directory / "complete" / "results.zarr"
    check_complete(complete)
    check_modes(complete)
    check_tree(complete)
    check_unpacked(complete)
    check_interrupted(directory / "interrupted" / "results.zarr")
    check_killed(directory / "killed" / "results.zarr")
    print("read_back: xarray", xr.__version__, "reads the stores as written")


if __name__ == "__main__":
    main()
