"""Reads exports with pandas, pyarrow, xarray and VTK and compares every value with the store.

usage: read_back.py STORE DIR, where DIR was filled from STORE by `cargo run -p catenix-export
--example export_all -- STORE DIR`. The store itself is read with xarray. Numbers of double
precision must be equal to the last bit, and so must those of single precision.
"""

import json
import sys
import warnings
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pyarrow.parquet
import xarray as xr
import zarr
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

QUANTITIES = [
    "x", "y", "z", "effective_tension", "wall_tension", "shear_force", "bend_moment",
    "curvature", "torque", "von_mises_stress", "declination",
]  # fmt: skip
CURVES = ["min", "mean", "max", "std", "run_min", "run_max"]
CF_UNITS = {"deg": "degree", "1/m": "m-1"}


def location(store: Path, case: str):
    """The archive of a case that has ended, the folder of another."""
    folder = store / "cases" / case
    archive = folder.with_name(f"{case}.zip")
    return zarr.storage.ZipStore(archive, mode="r") if archive.exists() else folder


def open_group(store: Path, case: str, group: str | None = None) -> xr.Dataset:
    return xr.open_zarr(location(store, case), group=group, consolidated=False).load()


class Stored:
    """What the store holds of a case, cut to the rows that were written."""

    def __init__(self, store: Path, case: str):
        self.store, self.case = store, case

        whole = open_group(store, case)
        self.attrs = whole.attrs
        rows = {"time": slice(whole.attrs.get("history_rows", 0))}
        self.histories = whole.isel({key: rows[key] for key in rows if key in whole.sizes})
        self.channels = {
            array.attrs["channel"]: array
            for array in self.histories.data_vars.values()
            if "channel" in array.attrs
        }
        scene = json.loads(whole.attrs["scene_json"])
        self.objects = [item["name"] for item in scene["vessels"] + scene["bodies"]]
        self.lines = {}
        # Of a case that has not begun there is nothing but its description.
        for line in scene["lines"] if "history_rows" in whole.attrs else []:
            group = open_group(store, case, f"lines/{line['name']}")
            fields = slice(whole.attrs.get("field_rows", 0))
            self.lines[line["name"]] = group.isel(field_time=fields)

    def quantities(self, line: str) -> list[str]:
        return [name for name in QUANTITIES if name in self.lines[line]]


def same(found, wanted) -> None:
    """Equal to the last bit, in the precision of what is wanted."""
    wanted = np.asarray(wanted)
    np.testing.assert_array_equal(np.asarray(found).astype(wanted.dtype), wanted)


def check_table(stored: Stored, read, has_std: bool) -> None:
    check_modes(stored.store, stored.case, read)
    histories = read("histories")
    assert list(histories)[0] == "time [s]"
    assert len(histories.columns) == len(stored.channels) + 1
    same(histories["time [s]"], stored.histories["time"])
    for name, channel in stored.channels.items():
        same(histories[f"{name} [{channel.attrs['units']}]"], channel)

    graphs = read("range_graphs").set_index(["line", "quantity"])
    static = read("static_shape").set_index("line")
    fields = read("fields").set_index("line")
    for name, line in stored.lines.items():
        same(static.loc[name]["arc_length [m]"], line["arc_length"])
        times, nodes = line.sizes["field_time"], line.sizes["arc_length"]
        field = fields.loc[name]
        same(field["time [s]"], np.repeat(line["field_time"].values, nodes))
        same(field["arc_length [m]"], np.tile(line["arc_length"].values, times))
        for quantity in stored.quantities(name):
            units = line[quantity].attrs["units"]
            same(static.loc[name][f"{quantity} [{units}]"], line[f"static_{quantity}"])
            same(field[f"{quantity} [{units}]"], line[quantity].values.ravel())
            graph = graphs.loc[(name, quantity)]
            assert (graph["unit"] == units).all()
            same(graph["arc_length [m]"], line["arc_length"])
            for curve in CURVES:
                if f"{quantity}_{curve}" in line:
                    same(graph[curve], line[f"{quantity}_{curve}"])
            if not has_std:
                assert graph["std"].isnull().all()
                same(graph["max"], line[quantity].max("field_time").values.astype(float))


def check_modes(store: Path, case: str, read) -> None:
    """Modes are stored in the synthetic stores only."""
    tree = xr.open_datatree(location(store, case), engine="zarr", consolidated=False)
    if "modes" not in tree:
        return
    stored, table, shapes = tree["modes"], read("modes"), read("mode_shapes")
    same(table["mode"], stored["mode"])
    for column, name in [
        ("frequency [Hz]", "frequency"),
        ("omega_squared [rad2/s2]", "omega_squared"),
        ("damping_ratio [1]", "damping_ratio"),
        ("effective_mass_z [kg]", "effective_mass_z"),
    ]:
        same(table[column], stored[name])
    for kind in ["lines", "bodies"]:
        for _, part in sorted(stored[kind].children.items()):
            shape = shapes[shapes["name"] == part.attrs["name"]]
            for component in ["displacement", "rotation"]:
                unit = "m" if component == "displacement" else "rad"
                for axis in "xyz":
                    wanted = part[f"{component}_{axis}"].values.ravel()
                    same(shape[f"{component}_{axis} [{unit}]"], wanted)
            if kind == "lines":
                count = part.sizes["mode"]
                same(shape["arc_length [m]"], np.tile(part["arc_length"].values, count))


def check_csv(stored: Stored, case: str, directory: Path, has_std: bool) -> None:
    def read(what: str) -> pd.DataFrame:
        return pd.read_csv(directory / f"{case}_{what}.csv")

    check_table(stored, read, has_std)
    description = json.loads((directory / f"{case}_columns.json").read_text(encoding="utf-8"))
    assert description["status"] == stored.attrs["status"]
    columns = description["tables"][f"{case}_histories.csv"]
    assert [column["column"] for column in columns] == list(read("histories"))


def check_parquet(stored: Stored, case: str, directory: Path, has_std: bool) -> None:
    def read(what: str) -> pd.DataFrame:
        return pd.read_parquet(directory / f"{case}_{what}.parquet")

    check_table(stored, read, has_std)
    table = pyarrow.parquet.read_table(directory / f"{case}_histories.parquet")
    assert all(str(kind) == "double" for kind in table.schema.types)
    metadata = table.schema.metadata
    assert metadata[b"catenix_status"].decode() == stored.attrs["status"]
    columns = json.loads(metadata[b"catenix_columns"])
    assert [column["column"] for column in columns] == table.column_names
    assert {column["unit"] for column in columns} >= {"s", "m", "N", "N m", "deg"}
    fields = pyarrow.parquet.read_schema(directory / f"{case}_fields.parquet")
    assert str(fields.field("effective_tension [N]").type) == "float"


def check_netcdf(stored: Stored, case: str, directory: Path, engine: str) -> None:
    with xr.open_dataset(directory / f"{case}.nc", engine=engine) as dataset:
        assert dataset.attrs["Conventions"].startswith("CF-")
        assert dataset.attrs["status"] == stored.attrs["status"]
        assert len(dataset.attrs["model_sha256"]) == 64
        same(dataset["time"], stored.histories["time"])
        assert dataset["time"].dtype == np.float64 and dataset["time"].attrs["units"] == "s"
        for name, channel in stored.channels.items():
            units = channel.attrs["units"]
            assert dataset[name].dims == ("time",)
            assert dataset[name].attrs["units"] == CF_UNITS.get(units, units)
            assert dataset[name].attrs["long_name"] == channel.attrs["long_name"]
            same(dataset[name], channel)
        for name, line in stored.lines.items():
            same(dataset["field_time"], line["field_time"])
            same(dataset[f"{name}.arc_length"], line["arc_length"])
            for quantity in stored.quantities(name):
                field = dataset[f"{name}.{quantity}"]
                assert field.dims == ("field_time", f"{name}.arc_length")
                assert field.dtype == np.float32
                same(field, line[quantity])
                same(dataset[f"{name}.static_{quantity}"], line[f"static_{quantity}"])
                for curve in CURVES:
                    if f"{quantity}_{curve}" in line:
                        same(dataset[f"{name}.{quantity}_{curve}"], line[f"{quantity}_{curve}"])
            tension = dataset[f"{name}.effective_tension"]
            assert {f"{name}.{axis}" for axis in "xyz"} <= set(tension.coords)


def read_poly_data(path: Path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def words(array) -> list[str]:
    return [array.GetValue(index) for index in range(array.GetNumberOfValues())]


def check_vtk(stored: Stored, case: str, directory: Path) -> None:
    collection = ElementTree.parse(directory / f"{case}.pvd").getroot()[0]
    entries = [(float(item.get("timestep")), item.get("part"), item.get("file")) for item in collection]
    lines = [(time, file) for time, part, file in entries if part == "0"]
    bodies = [(time, file) for time, part, file in entries if part == "1"]
    times = next(iter(stored.lines.values()))["field_time"].values
    same([time for time, _ in lines], times)
    same([time for time, _ in bodies], times)
    for index, (time, file) in enumerate(lines):
        data = read_poly_data(directory / file)
        assert vtk_to_numpy(data.GetFieldData().GetArray("TimeValue"))[0] == time
        assert data.GetNumberOfLines() == data.GetNumberOfCells() == len(stored.lines)
        assert words(data.GetCellData().GetAbstractArray("line")) == list(stored.lines)
        assert data.GetPointData().GetScalars().GetName() == "effective_tension [N]"
        points = vtk_to_numpy(data.GetPoints().GetData())
        start = 0
        for number, line in enumerate(stored.lines.values()):
            cell = data.GetCell(number).GetPointIds()
            nodes = np.arange(start, start + line.sizes["arc_length"])
            start += nodes.size
            same([cell.GetId(i) for i in range(cell.GetNumberOfIds())], nodes)
            for axis, name in enumerate("xyz"):
                same(points[nodes, axis], line[name][index])
            arrays = data.GetPointData()
            same(vtk_to_numpy(arrays.GetArray("arc_length [m]"))[nodes], line["arc_length"])
            assert (vtk_to_numpy(arrays.GetArray("line_index"))[nodes] == number).all()
            for quantity in QUANTITIES[3:]:
                if quantity in line:
                    label = f"{quantity} [{line[quantity].attrs['units']}]"
                    same(vtk_to_numpy(arrays.GetArray(label))[nodes], line[quantity][index])
    for time, file in bodies:
        data = read_poly_data(directory / file)
        assert words(data.GetPointData().GetAbstractArray("name")) == stored.objects
        points = vtk_to_numpy(data.GetPoints().GetData())
        quaternions = vtk_to_numpy(data.GetPointData().GetArray("quaternion_wxyz"))
        # Rounding of the products of sines and cosines.
        np.testing.assert_allclose(np.linalg.norm(quaternions, axis=1), 1.0, rtol=1e-14)
        for number, name in enumerate(stored.objects):
            for axis in range(3):
                channel = stored.channels[f"{name}.{'xyz'[axis]}"].sel(time=time)
                same(points[number, axis], channel)


def main() -> None:
    store, directory = Path(sys.argv[1]) / "results.zarr", Path(sys.argv[2])
    warnings.simplefilter("error")
    study = xr.open_zarr(store, consolidated=False)
    exported = 0
    for case in study.attrs["case_names"]:
        stored = Stored(store, case)
        if stored.attrs.get("history_rows", 0) == 0:
            continue
        exported += 1
        has_std = any("effective_tension_std" in line for line in stored.lines.values())
        check_csv(stored, case, directory / "csv", has_std)
        check_parquet(stored, case, directory / "parquet", has_std)
        check_netcdf(stored, case, directory / "netcdf", "scipy")
        check_vtk(stored, case, directory / "vtk")
    assert exported > 0
    print(f"read_back: pandas, pyarrow, xarray and VTK read {exported} exported cases as stored")


if __name__ == "__main__":
    main()
