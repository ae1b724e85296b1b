"""How far tapered bores are driven up."""

import numpy as np

from ....catalogue.entry import bearing_of_entry, catalogue_entries
from ....design.bearing_set import rows_of
from ....fits import Mounting, needed_drive_up, with_bearing_dimensions


def drive_up(
    bores: np.ndarray, taper: float, reduction: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the travel that takes clearance of the spherical roller bearings of a
    range of bores, and by how much it differs among them.

    Args:
        bores: The range, above the first up to the second [m].
        taper: Of the bore [1]; 1:30 are those of the series 240 and 241.
        reduction: Clearance taken (n,) [m].
    """
    found = []
    for entry in catalogue_entries():
        steep = not entry.designation.startswith("24")
        inside = bores[0] < entry.bore <= bores[1] * (1.0 + 1e-9)
        if entry.type == "spherical_roller" and inside and steep == (taper > 0.05):
            d, big, width = entry.bore, entry.outside_diameter, entry.width
            seats = Mounting(
                d, big, 2.0 * big, 0.0, -1e-4, ring_width=width, bore_taper=taper
            )
            seats = with_bearing_dimensions(
                seats, rows_of(bearing_of_entry(entry))[0].bearing
            )
            found.append([float(needed_drive_up(seats, x)) for x in reduction])
    reduced = {"mean": np.mean, "least": np.min, "largest": np.max}
    return {name: of(found, axis=0) for name, of in reduced.items()}
