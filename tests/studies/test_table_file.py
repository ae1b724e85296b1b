"""Files of tables: what is written is read again."""

import sys

import numpy as np
import pytest

from bearingjax.files.table_file import read_table, write_table

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
