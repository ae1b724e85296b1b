"""Text and matrices of other programs: encodings, columns, decimal marks, pipes."""

import os

import numpy as np
import pytest
import scipy.io

from bearingjax.files.output_files import read_matrix
from bearingjax.files.text_file import read_text

WANTED = np.array([[1.5, -2.0, 0.0], [-2.0, 300.0, 1e-3], [0.0, 1e-3, 7.0]])
ROWS = "1.5,-2,0\n-2,300,1e-3\n0,0.001,7.0\n"
MATRICES = {
    "commas": ROWS,
    "commas and blanks": ROWS.replace(",", ", "),
    "commas at the end": ROWS.replace("\n", ",\n"),
    "blanks": ROWS.replace(",", "  "),
    "tabs": ROWS.replace(",", "\t"),
    "semicolons": ROWS.replace(",", ";"),
    "rows that end in a semicolon": ROWS.replace(",", " ").replace("\n", ";\n"),
    "semicolons and decimal commas": ROWS.replace(",", ";").replace(".", ","),
    "blanks and decimal commas": ROWS.replace(",", " ").replace(".", ","),
    "tabs and decimal commas": ROWS.replace(",", "\t").replace(".", ","),
    "minus": ROWS.replace("-2", "−2"),
    "comments": f"# K\n\n{ROWS}# end\n",
    "Windows": ROWS.replace("\n", "\r\n"),
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("what", MATRICES)
def test_read_matrix_of_text(tmp_path, what, encoding):
    path = tmp_path / "Gehäuse, links.csv"
    path.write_bytes(MATRICES[what].encode(encoding))
    np.testing.assert_array_equal(read_matrix(path), WANTED)


@pytest.mark.parametrize("name", ["K.MTX", "K.mtx", "K.NPY", "K.npy"])
def test_read_matrix_of_a_program(tmp_path, name):
    with (tmp_path / name).open("wb") as file:
        if name.lower().endswith("npy"):
            np.save(file, WANTED)
        else:
            scipy.io.mmwrite(file, WANTED)
    np.testing.assert_array_equal(read_matrix(tmp_path / name), WANTED)


REFUSED = {
    "two.csv": (
        b"1,5;2.5\n2;1\n",
        "line 1 has a decimal comma, '1,5', and line 1 a dec",
    ),
    "thousands.csv": (
        b"1,500 2,500\n2,500 1,500\n",
        "line 1: the comma of '1,500' may",
    ),
    "ragged.csv": (b"1,2\n1\n", "line 2 has 1 numbers, not 2"),
    "word.csv": (b"1,2\n1,much\n", "line 2: could not convert string to float: 'much'"),
    "nan.csv": (b"1,2\n1,nan\n", "row 2, column 2 is nan; finite numbers are wanted"),
    "oblong.csv": (b"1,2\n", "has the shape (1, 2); a square is wanted"),
    "empty.csv": (b"", "has no numbers"),
    "empty.npy": (b"", "No data left in file"),
    "latin.csv": ("1 # ä\n".encode("latin-1"), "cannot be read: 'utf-8' codec"),
    "complex.mtx": (
        b"%%MatrixMarket matrix array complex general\n1 1\n1 2\n",
        "has complex numbers; real ones are wanted",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_read_matrix_rejects(tmp_path, name):
    content, message = REFUSED[name]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError) as caught:
        read_matrix(tmp_path / name)
    told = str(caught.value)
    assert told.startswith(f"{name}: {message}") and "\n" not in told


@pytest.mark.parametrize("read", [read_text, read_matrix])
def test_pipes_and_devices_are_not_read(tmp_path, read):
    pipe = tmp_path / "p.mtx"
    os.mkfifo(pipe)
    for path in (pipe, pipe.with_name("p.csv").parent / os.devnull):
        with pytest.raises(ValueError, match="it is a pipe or a device; name a file"):
            read(path)
    with pytest.raises(ValueError, match="No such file or directory"):
        read(tmp_path / "none.csv")
    with pytest.raises(ValueError, match="a file name has no NUL"):
        read(tmp_path / "a\0b.csv")
