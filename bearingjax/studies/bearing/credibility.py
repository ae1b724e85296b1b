"""How far a result is to be trusted: its model, the range of that, nearest cases."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...design import rows_of
from ...element import Finite
from ...report.report_model import Section, labelled_facts
from ...validation import Near, cases, nearest_cases

_MOST_TILT = 10.0
"""Tilt up to which linearised kinematics are used [mrad]."""

_CONTACTS = "elastic contacts between rigid rings, in quasi-static equilibrium"
_STIFF = """rings and seats stiff beside the contacts, smooth raceways, pressures that
 leave no dents"""

_MODELS = {
    "solve": (_CONTACTS, _STIFF, "statics preload contact speed"),
    "life": (
        f"fatigue of raceways by ISO 281 and ISO/TS 16281; {_CONTACTS}",
        f"{_STIFF}; no wear, corrosion, currents or life of grease",
        "life statics",
    ),
    "shaft": (
        f"shafts of Timoshenko's beams, rigid teeth and belts; {_CONTACTS}",
        f"no torsion of shafts, no heat along them; {_STIFF}",
        "shafts preload statics",
    ),
    "rotor": (
        f"""shaft of Timoshenko's beams, or rigid; small motions about the static
 equilibrium, or nonlinear forces of the supports; in bearings {_CONTACTS}""",
        f"no torsion, no internal damping of the turning shaft; {_STIFF}",
        "rotors",
    ),
    "noise": (
        "rigid ring, rolling elements as masses, damped elastic contacts, form errors",
        """below the bending modes of real rings; waves and damping are seldom known:
 levels compare designs and do not foretell the reading of a rig""",
        "noise rotors",
    ),
    "skid": (
        f"tractions in oil films, drag and cage move rolling elements; {_CONTACTS}",
        """no resistance to rolling, no seals, one temperature of the oil, stresses that
 the law of traction sustains""",
        "skidding",
    ),
    "contact": (
        "two elastic half-spaces without friction, in rectangular cells",
        "contact small against the bodies; at a sharp end smaller cells raise the peak",
        "contact",
    ),
}
"""Model of each command, its range, and the subjects of cases like its results."""


def credibility_section(
    study: str, bearings: Iterable[tuple[str, Any, Any]] = ()
) -> Section:
    """Return model, range and the nearest validation cases of a result.

    Args:
        study: Command that made it: "solve", of sweeps too, "life", "shaft", ….
        bearings: Name, element and load (..., 3 or more) [N] of each bearing, of which
            the largest counts; of several the nearest case of each, once.
    """
    model, within, subjects = (" ".join(x.split()) for x in _MODELS[study])
    bearings, near, lacking = list(bearings), {}, []
    for name, element, load in bearings:
        row = rows_of(element.bearing)[0].bearing
        size = np.linalg.norm(np.nan_to_num(np.asarray(load)[..., :3]), axis=-1)
        count = 2 if len(bearings) == 1 else 1
        found = nearest_cases(row, float(size.max()), count, subjects.split())
        for one in found:
            near.setdefault(one.case.name, []).append((name, one))
        lacking += [] if found else [name]
    told = [_words(*zip(*pairs, strict=True)) for pairs in near.values()]
    told += [f"{_head(lacking)}none of this type"] if lacking else []
    own = [
        f"{case.name} ({case.trust})"
        for case in cases().values()
        if case.calculation == f"bearingjax {study}" and not case.type
    ]
    told += [f"of no bearing by itself: {', '.join(own)}"] if own else []
    if near or own:
        told.append("`bearingjax validate CASE` compares theirs with ours")
    if not all(isinstance(element.kinematics, Finite) for _, element, _ in bearings):
        within += f", tilts up to {_MOST_TILT:g} mrad"
    heads = ["model", "range", "nearest cases", *[""] * len(told)]
    return [labelled_facts(zip(heads, (model, within, *told), strict=False))]


def _words(names: tuple[str, ...], near: tuple[Near, ...]) -> str:
    """Say how bearings compare with the case that is the nearest to each of them."""
    size, load = (
        " to ".join(dict.fromkeys(f"{end(ratios):.2g}" for end in (min, max)))
        for ratios in ([x.size for x in near], [x.load for x in near])
    )
    who = "this bearing has" if len(near) == 1 else "these bearings have"
    words = f"{_head(names)}{near[0].case.name} ({near[0].case.trust}): {who} {size}"
    loaded = (
        f" and {load} times its load/d²" if load != "0" else ", and no load is given"
    )
    return f"{words} times its pitch diameter d{loaded}"


def _head(names: Iterable[str]) -> str:
    return "".join(f"{text}: " for text in [", ".join(names)] if text)
