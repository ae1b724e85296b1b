"""How far a result is to be trusted: its model, the range of that, nearest cases."""

from typing import Any

import numpy as np

from ...design import rows_of
from ...element import Finite
from ...report.report_model import Section, labelled_facts
from ...validation import nearest_cases

_MOST_TILT = 10.0
"""Tilt up to which linearised kinematics are used [mrad]."""


def credibility_section(element: Any, load: Any) -> Section:
    """Return model, range and the nearest validation cases of a solved bearing.

    Args:
        element: Its element.
        load: On the moving ring (6,) [N, N m].
    """
    row = rows_of(element.bearing)[0].bearing
    finite = isinstance(element.kinematics, Finite)
    facts = [
        ("model", "elastic contacts between rigid rings, in quasi-static equilibrium"),
        (
            "range",
            "rings and seats stiff beside the contacts, smooth raceways, pressures"
            " that leave no dents"
            + ("" if finite else f", tilts up to {_MOST_TILT:g} mrad"),
        ),
    ]
    near = nearest_cases(row, float(np.linalg.norm(np.asarray(load)[:3])))
    told = [
        f"{one.case.name} ({one.case.trust}): this bearing has {one.size:.2g} times its"
        " pitch diameter d"
        + (f" and {one.load:.2g} times its load/d²" if one.load else ", and no load")
        for one in near
    ]
    facts.append(("nearest cases", told[0] if told else "none of this type"))
    facts += [("", text) for text in told[1:]]
    facts.append(("", "`bearingjax validate CASE` compares theirs with ours"))
    return [labelled_facts(facts if told else facts[:-1])]
