"""Files of tables: what is written is read again."""

import sys

import numpy as np
import pytest

from bearingjax.files.table_file import in_shown_units, in_si, read_table, write_table

COLUMNS = {
    "load [N]": np.array([1.0, -2.5e-300, np.nan, np.inf, 1 / 3]),
    "n_loaded": np.array([3, 0, -1, 2**40, 7]),
    "stable": np.array([True, False, True, True, False]),
    "name": np.array(["a", 'with "quotes", and comma', "", "1e3", "ü\nb"]),
}


@pytest.mark.parametrize("ending", ["csv", "parquet", "xlsx"])
def test_table_round_trip(tmp_path, ending):
    path = tmp_path / f"t.{ending}"
    write_table(COLUMNS, path)
    found = read_table(path, ["name"])
    assert list(found) == list(COLUMNS)
    for header, column in COLUMNS.items():
        if header == "load [N]" and ending == "xlsx":  # no infinity, 16 digits
            wanted = np.where(np.isinf(column), np.nan, column)
            np.testing.assert_allclose(found[header], wanted, rtol=1e-15)
        else:
            np.testing.assert_array_equal(found[header], column)
        assert found[header].dtype.kind in (column.dtype.kind, "O")


def test_shown_units_round_trip():
    """Units by the largest number of a column; what has no unit, or words, stays."""
    columns = {
        "clearance [m]": np.array([2e-5, np.nan, 57e-6, -np.inf]),
        "bore [m]": np.array([65e-3, 1e-6, 0.0, 1.0]),
        "gx [rad]": np.array([1e-3, 0.0, -2e-3, 0.0]),
        "angle [rad]": np.radians([40.0, 1.0, 2.0, 3.0]),
        "speed [rad/s]": np.array([100.0, -50.0, 1.0, 0.0]) * np.pi,
        "inner_ring [K]": np.array([333.15, 273.15, np.nan, 0.0]),
        "life [rev]": np.array([1e9, np.inf, 1.0, 2e6]),
        "stiffness [N/m]": np.full(4, 1e8),
        "k [m]": np.arange(4),
        "name [mm": np.array(["a", "b", "c", "d"]),
    }
    shown = in_shown_units(columns)
    assert list(shown) == [
        "clearance [µm]", "bore [mm]", "gx [mrad]", "angle [deg]", "speed [rpm]",
        "inner_ring [°C]", "life [million rev]", "stiffness [N/m]", "k [m]",
        "name [mm",
    ]  # fmt: skip
    clearance = [20.0, np.nan, 57.0, -np.inf]
    np.testing.assert_array_equal(shown["clearance [µm]"], clearance)
    np.testing.assert_array_equal(shown["speed [rpm]"], [3000.0, -1500.0, 30.0, 0.0])
    np.testing.assert_array_equal(shown["inner_ring [°C]"][:2], [60.0, 0.0])
    again = in_si(shown)
    assert list(again) == list(columns)
    for header, column in columns.items():
        if column.dtype.kind == "f":
            np.testing.assert_allclose(again[header], column, rtol=1e-14)
        else:
            np.testing.assert_array_equal(again[header], column)


def test_sheet_has_number_formats_and_a_frozen_header(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    columns = {
        "uy [µm]": np.array([12.3456, -1.0]),
        "life [million rev]": np.array([123456.7, np.inf]),
        "tiny [N]": np.array([1e-9, 0.0]),
        "n": np.array([1, 2]),
    }
    write_table(columns, tmp_path / "t.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "t.xlsx").active
    formats = [cell.number_format for cell in sheet[2]]
    assert formats == ["0.000", "0", "0.0000E+00", "General"]
    assert sheet.freeze_panes == "A2" and sheet["B3"].value is None
    assert sheet.column_dimensions["B"].width == len("life [million rev]") + 2


def test_csv_needs_no_optional_package(tmp_path, monkeypatch):
    for package in ("pandas", "pyarrow", "openpyxl"):
        monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.setattr("bearingjax.files.table_file._BLOCK", 2)
    write_table(COLUMNS, tmp_path / "t.csv")
    found = read_table(tmp_path / "t.csv", ["name"])
    for header, column in COLUMNS.items():
        np.testing.assert_array_equal(found[header], column)


@pytest.mark.parametrize("text", ["a,b\n1\n", "a,b\n1,2\n3,4,5\n", "a\n\xe4\n"])
def test_read_table_rejects_files_that_are_no_table(tmp_path, text):
    path = tmp_path / "t.csv"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(ValueError):
        read_table(path)
    (tmp_path / "t.xlsx").write_bytes(b"no sheet")
    with pytest.raises(ValueError):
        read_table(tmp_path / "t.xlsx")
